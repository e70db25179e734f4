"""How far judge and gate can be trusted, and how quickly things break; run by hand.

Each file is a command, ``python -m experiments.validation.NAME``: ``accuracy`` asks judges about
synthetic curves, ``aa`` runs the A/A test of the gates, ``mutants`` injects faults that the gates
must catch, ``budgets`` times a fracture.
Nobody imports them but the notebook on accuracy.
"""
