"""Does a measured cost grow as claimed? NumPy alone is needed."""
