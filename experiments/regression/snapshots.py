"""From a run to the few figures of each claim that the history and the baseline keep."""

from functools import cache
from typing import Any, NamedTuple, Self

import numpy as np

from experiments import claims
from experiments.claims import NO_CLAIM, Claim, Curves, JudgedClaim, Kind, Outcome, curves
from experiments.harness import Axis
from experiments.runs import Run, tables

LEAST_SLOPE = 0.01
"""Slopes of counts that differ by less are the same one: not even they come out alike everywhere,
to the last digit."""

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
    of ``time_sizes``; ``relative``: the time in memory accesses, which take what they took beside
    the measurement; ``bytes`` per vertex.
    Judges the run, which takes some seconds.
    """
    cells = [judged for judged in claims.judge_run(run) if judged.claim.structure]
    figures = {str(ClaimName.of(judged.claim)): _figures(run, judged) for judged in cells}
    return {name: kept for name, kept in figures.items() if kept}


def class_figures(run: Run) -> dict[str, Figures]:
    """Of every claim the ``classes`` that its counts show, by axis, and what becomes of it."""
    figures: dict[str, Figures] = {}
    for judged in claims.judge_cells(run):
        claim, classes = judged.claim, Figures()
        for axis, verdict in judged.verdicts.items():
            if len(curves(run).of(claim, axis)) >= LEAST_SIZES:
                outcome = verdict.outcome if axis.variable in claim.classes else Outcome.NO_CLAIM
                classes[axis.key] = [verdict.best, outcome]
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
    if not judged.was_measured:
        return {}
    known = {"kind": judged.claim.kind.value}
    if not judged.verdicts:
        return {**known, "outcome": judged.outcome, "bytes": _short(judged.values[0])}
    slopes = {
        axis.key: [_short(it) for it in (verdict.slope, verdict.slope_low, verdict.slope_high)]
        for axis, verdict in judged.verdicts.items()
    }
    claim, figures = judged.claim, Figures(**known, slopes=slopes)
    seen = {axis.exact for axis in judged.verdicts}  # what was not measured has not changed
    for name, it, exact in (
        ("outcome", judged.outcome, True), ("outcome_time", judged.outcome_time, False)
    ):  # fmt: skip
        if exact in seen or it is Outcome.NO_CLAIM:
            figures[name] = it
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
