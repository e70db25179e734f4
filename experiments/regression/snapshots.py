"""From a run to the few figures of each claim that the history and the baseline keep."""

from functools import cache
from typing import Any, NamedTuple, Self

import numpy as np

from experiments import claims
from experiments.claims import NO_CLAIM, Claim, Curves, JudgedClaim, Kind, Outcome, curves
from experiments.harness import Axis
from experiments.runs import Run, tables

LEAST_SLOPE = 0.01
"""Slopes of counts that differ by less are the same one: their last digits differ by machine."""

LEAST_SIZES = 4  # sizes below which counts show no class
DIGITS = 5
NOTHING = 1e-12  # what rounding leaves of nothing
Figures = dict[str, Any]  # what is kept of a claim, see `claim_figures`


class ClaimName(NamedTuple):
    """What names a claim of a table: in files as ``table/structure/subject``."""

    table: str
    structure: str
    subject: str

    def __str__(self) -> str:
        return "/".join(self)

    @classmethod
    def of(cls, claim: Claim) -> Self:
        """The name of a claim."""
        return cls(claim.table, claim.structure, claim.subject)

    @classmethod
    def read(cls, text: str) -> Self:
        """A name as it stands in a file."""
        return cls(*text.split("/"))


def claim_figures(run: Run) -> dict[str, Figures]:
    """The figures of every claim by ``table/structure/subject``, as far as it was measured.

    ``kind``: who claims it; ``outcome`` by work, which decides (of memory: by bytes), and
    ``outcome_time``; ``slopes`` with their intervals, by axis; ``work``, accesses at
    ``work_faces``, the largest mesh; ``seconds`` at ``time_faces``, the largest one that was timed,
    of ``time_sizes``; ``relative``: the time in memory accesses, as long as they took beside it;
    ``bytes`` per vertex. Judges the run: seconds.
    """
    measured = (it for it in claims.judge_run(run) if it.claim.structure and it.was_measured)
    return {str(ClaimName.of(it.claim)): _figures(run, it) for it in measured}


def class_figures(run: Run) -> dict[str, Figures]:
    """Of every claim the ``classes`` that its counts show, by axis, and what becomes of it."""
    figures: dict[str, Figures] = {}
    for claim, verdicts in ((it.claim, it.verdicts) for it in claims.judge_cells(run)):
        classes = {
            axis.key: [it.best, it.outcome if axis.variable in claim.classes else Outcome.NO_CLAIM]
            for axis, it in verdicts.items()
            if len(curves(run).of(claim, axis)) >= LEAST_SIZES
        }
        if classes:
            figures[str(ClaimName.of(claim))] = {"classes": classes}
    return figures


def describe_claim(name: str) -> tuple[str, str]:
    """A claim as in "Table 1, Vertex → Faces: O(n_ev); thesis 3.1", and its kind; or nothing."""
    claim = _claims().get(name)
    if claim is None:
        return "", ""
    printed = "nothing claimed" if claim.printed == NO_CLAIM else claim.printed
    who = "" if claim.kind is Kind.EXPECTED else f"{claim.kind}, "  # which its source says, too
    said = f"{tables()[claim.table].title}, {claim.title}: {printed}; {who}{claim.source}"
    return said, claim.kind.value


@cache
def _claims() -> dict[str, Claim]:
    return {str(ClaimName.of(claim)): claim for claim in claims.load_claims()}


def _figures(run: Run, judged: JudgedClaim) -> Figures:
    known = {"kind": judged.claim.kind.value}
    if not judged.verdicts:
        return {**known, "outcome": judged.outcome, "bytes": _short(judged.values[0])}
    slopes = {
        axis.key: [_short(it) for it in (verdict.slope, verdict.slope_low, verdict.slope_high)]
        for axis, verdict in judged.verdicts.items()
    }
    claim, figures = judged.claim, Figures(**known, slopes=slopes)
    seen = {"outcome" if axis.exact else "outcome_time" for axis in judged.verdicts}
    for name in ("outcome", "outcome_time"):
        if name in seen or getattr(judged, name) is Outcome.NO_CLAIM:  # else it has not changed
            figures[name] = getattr(judged, name)
    work = curves(run).of(claim, Axis.WORK_FACES)
    if len(work):
        figures |= {"work": _short(judged.work), "work_faces": int(work.sizes[-1])}
    return figures if run.machines else {**figures, **_time(curves(run), claim)}


def _time(of_run: Curves, claim: Claim) -> Figures:
    """Seconds at the largest size, and the median over all sizes of seconds per memory access.

    At any one size where the caches end, the latency differs between runs by a factor of two or
    more; the median over the sizes came back within 2 % (standard deviation, nine runs).
    """
    axis = Axis.RANDOM_FACES if claim.table == "queries" else Axis.TIME_FACES
    curve = of_run.of(claim, axis)
    if not len(curve):
        return {}
    faces, sizes = int(curve.sizes[-1]), len(curve)
    figures = {"seconds": _short(curve.largest), "time_faces": faces, "time_sizes": sizes}
    latency = curve.cases["latency"].to_numpy(float)
    if not np.isnan(latency).any():
        figures["relative"] = _short(np.exp(np.median(np.log(curve.centers / latency))))
    return figures


def _short(value: float) -> float:
    """Five digits, and none of next to nothing."""
    return float(f"{value:.{DIGITS}g}") if abs(value) > NOTHING else 0.0
