"""What the documents say, and what a run makes of it."""
