"""Breaking a surface, as in thesis 4.4."""
