"""How far judge and gate can be trusted, and how fast ours is beside others; run by hand.

Each file is a command, ``python -m experiments.validation.NAME``: ``accuracy`` asks judges about
synthetic curves and ``real_functions`` about functions of known cost, ``advice`` holds predictions
to what was measured, ``speed`` times other libraries beside all that walk here, up to a million
vertices, ``aa`` runs the A/A test of the gates, ``mutants`` injects faults that the gates must
catch.
Nobody imports them but notebooks.
"""
