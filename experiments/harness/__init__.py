"""How one case is measured."""
