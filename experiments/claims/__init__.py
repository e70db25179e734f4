"""What the documents say, and what a run makes of it.

``load_claims`` gives the cells of the tables, ``sentence_claims`` the sentences. ``judge_run``
judges them all, once per run; ``curves`` gives the measurements behind them.
"""

from experiments.claims.cells import load_claims
from experiments.claims.claim import (
    CLAIMED,
    MEMORY,
    NO_CLAIM,
    NOT_POSSIBLE,
    SENTENCES,
    Between,
    Claim,
    Exactly,
    Growth,
    JudgedClaim,
    Kind,
    Outcome,
    tally,
)
from experiments.claims.curves import Curve, Curves, curves
from experiments.claims.errata import ERRATA
from experiments.claims.quantities import (
    MIXES,
    break_even,
    in_digits,
    judge_sentences,
    sentence_claims,
)
from experiments.claims.verdicts import (
    BY_TIME,
    CASE_ERROR,
    DETERMINED,
    Family,
    class_told,
    judge_cells,
    judge_families,
    judge_run,
)

__all__ = [
    "BY_TIME", "CASE_ERROR", "CLAIMED", "DETERMINED", "ERRATA", "MEMORY", "MIXES", "NOT_POSSIBLE",
    "NO_CLAIM", "SENTENCES", "Between", "Claim", "Curve", "Curves", "Exactly", "Family",
    "Growth", "JudgedClaim", "Kind", "Outcome", "break_even", "class_told", "curves", "in_digits",
    "judge_cells", "judge_families", "judge_run", "judge_sentences", "load_claims",
    "sentence_claims", "tally",
]  # fmt: skip
