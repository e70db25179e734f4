"""What the documents say, and what a run makes of it.

``load_claims`` gives the cells of the tables, ``sentence_claims`` the sentences. ``judge_run``
judges them all, once per run; ``curves`` gives the measurements behind them.
"""

from __future__ import annotations

from functools import lru_cache

from experiments.claims.break_even import MIXES, break_even
from experiments.claims.cells import load_claims
from experiments.claims.claim import (
    ERRATA,
    MEMORY,
    NO_CLAIM,
    SENTENCES,
    Between,
    Claim,
    Exactly,
    Growth,
    Shown,
)
from experiments.claims.curves import Curve, Curves, axes_of, curves
from experiments.claims.kept import keep_judged, read_judged
from experiments.claims.outcome import Outcome
from experiments.claims.quantities import judge_sentences, ratios, sentence_claims, span
from experiments.claims.verdicts import JudgedClaim, judge_cell, judge_cells
from experiments.runs import Run


@lru_cache(maxsize=4)
def judge_run(run: Run) -> list[JudgedClaim]:
    """Every cell of every table, then every sentence.

    A run is judged once, which takes some seconds; what a finished one gave is kept beside it.
    """
    claims = [*load_claims(), *sentence_claims()]
    kept = read_judged(run.folder, claims)
    if kept is not None:
        return kept
    judged = [*judge_cells(run), *judge_sentences(run)]
    if "finished" in run.meta and run.folder.exists():
        keep_judged(run.folder, judged)
    return judged


__all__ = [
    "ERRATA",
    "MEMORY",
    "MIXES",
    "NO_CLAIM",
    "SENTENCES",
    "Between",
    "Claim",
    "Curve",
    "Curves",
    "Exactly",
    "Growth",
    "JudgedClaim",
    "Outcome",
    "Shown",
    "axes_of",
    "break_even",
    "curves",
    "judge_cell",
    "judge_cells",
    "judge_run",
    "judge_sentences",
    "load_claims",
    "ratios",
    "sentence_claims",
    "span",
]
