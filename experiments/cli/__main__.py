"""``python -m experiments.cli``."""

from experiments.cli import app

app()
