"""How far judge and gate can be trusted, and how other libraries compare; run by hand.

Each file is a command, ``python -m experiments.validation.NAME``: ``accuracy`` asks judges about
synthetic curves, ``aa`` runs the A/A test of the gates, ``mutants`` injects faults that the gates
must catch, ``peers`` times other libraries, ``peers_cpp`` those in C++, ``budgets`` a fracture.
Nobody imports them but the notebook on accuracy.
"""
