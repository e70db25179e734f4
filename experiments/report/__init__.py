"""A run in; figures, tables and pages out."""
