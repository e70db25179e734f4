"""What is worse than the baseline, the other checkout or the last commits."""
