"""One file per library: what it calls its queries, operations and algorithms."""
