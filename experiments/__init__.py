"""What is measured, how it is judged, and the command line."""
