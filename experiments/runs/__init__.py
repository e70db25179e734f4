"""All cases into a folder, and a folder into a table."""
