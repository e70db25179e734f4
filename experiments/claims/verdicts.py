"""From a run to a judged claim: by work and by time, in each variable apart.

Work counts are exact, so they decide; time is judged beside them. Asked in consecutive order, a
query finds what it needs in the caches, and time shows its steps. Asked at random it waits for
memory, which is slower the larger the mesh. Both are judged against the latency measured beside.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from experiments.claims.cells import load_claims
from experiments.claims.claim import BOUND, Claim, Exactly, Growth
from experiments.claims.curves import Curves, axes_of, curves
from experiments.claims.outcome import Outcome
from experiments.harness import Axis
from experiments.runs import Run
from experiments.runs.catalog import experiments
from hem.complexity import Bound, Verdict, judge

CASE_ERROR = 0.15
"""How far cases of one curve stray, beyond what their own rounds tell: each is measured within some
milliseconds, and other tenants of the machine slow its caches for longer than that."""

FLAT = 0.5
"""Slope in n_ev below which what grows comes on top of a larger part that does not."""

NAN = float("nan")


@dataclass(frozen=True, eq=False)
class JudgedClaim:
    """A claim, what became of it, and why.

    ``outcome``: by what is exact where there is such a measure, else by time; ``outcome_time``: by
    time. ``found``: short, such as ``O(n_ev)`` or ``6.33``; ``reason``: a sentence. ``verdicts``:
    of a growth, by axis. ``values``: of a quantity. ``work`` and ``seconds``: per query at the
    largest size, at random handles where that was measured. ``bytes_per_vertex``: of a claim about
    memory.
    """

    claim: Claim
    outcome: Outcome
    found: str
    reason: str = ""
    outcome_time: Outcome = Outcome.NO_CLAIM
    verdicts: Mapping[Axis, Verdict] = field(default_factory=dict)
    values: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    work: float = NAN
    seconds: float = NAN
    bytes_per_vertex: float = NAN


def judge_cells(run: Run, claims: list[Claim] | None = None) -> list[JudgedClaim]:
    """Every cell of every table, or these."""
    every = load_claims() if claims is None else claims
    return [judge_cell(curves(run), claim) for claim in every]


def judge_cell(of_run: Curves, claim: Claim) -> JudgedClaim:
    """One cell of a table."""
    if isinstance(claim.expects, Exactly):
        return _judge_bytes(of_run, claim, claim.expects.value)
    assert isinstance(claim.expects, Growth), claim.key
    axes = axes_of(claim.table)
    found = {axis: _verdict(of_run, claim, claim.expects, axis) for axis in axes}
    verdicts = {axis: verdict for axis, verdict in found.items() if verdict is not None}
    outcomes = {
        measure: _combined(
            claim.expects, [axis for axis in axes if axis.measure == measure], verdicts
        )
        for measure in ("work", "time")
    }
    counted = any(axis.exact for axis in axes)
    timed = Axis.RANDOM_FACES if Axis.RANDOM_FACES in axes else Axis.TIME_FACES
    return JudgedClaim(
        claim=claim,
        outcome=outcomes["work" if counted else "time"],
        outcome_time=outcomes["time"],
        found=_class_found(
            [axis for axis in axes if axis.measure == ("work" if counted else "time")], verdicts
        ),
        reason=" ".join(it.reason for axis, it in verdicts.items() if axis.exact == counted),
        verdicts=verdicts,
        work=of_run.curve(Axis.WORK_FACES, claim.structure, claim.subject, claim.table).largest,
        seconds=of_run.curve(timed, claim.structure, claim.subject, claim.table).largest,
    )


def _judge_bytes(of_run: Curves, claim: Claim, printed: float | None) -> JudgedClaim:
    found = of_run.bytes_per_vertex(claim.structure)
    if printed is None:
        outcome = Outcome.NO_CLAIM
    elif np.isnan(found):
        outcome = Outcome.UNDETERMINED
    else:
        outcome = Outcome.CONSISTENT if found == printed else Outcome.VIOLATED
    shown = "?" if np.isnan(found) else f"{found:,.4g}"
    return JudgedClaim(claim, outcome, shown, bytes_per_vertex=found)


def _verdict(of_run: Curves, claim: Claim, growth: Growth, axis: Axis) -> Verdict | None:
    """Judge one claim along one axis; None without any cases.

    Where nothing is claimed the class found is what matters, and O(1) is asked about.
    """
    curve = of_run.curve(axis, claim.structure, claim.subject, claim.table)
    if not len(curve):
        return None
    # What reads nothing at all costs something all the same: the call.
    samples = [np.maximum(it, 1) if axis.exact else it for it in curve.samples]
    expected = growth.classes.get(axis.variable, "O(1)")
    bound: Bound = "upper" if expected.startswith(BOUND) else "tight"
    return judge(
        curve.sizes,
        samples,
        expected.removeprefix(BOUND),
        None if axis.exact else of_run.latencies(curve),
        exact=axis.exact,
        latency_error=CASE_ERROR,
        unseen=(claim.table, axis) in _just_written(),
        bound=bound,
    )


@lru_cache(maxsize=1)
def _just_written() -> set[tuple[str, Axis]]:
    """Tables and axes whose cases run on a mesh that was copied just before."""
    every = experiments().values()
    return {(it.table.name, axis) for it in every if it.table for axis in it.just_written}


def _combined(growth: Growth, axes: list[Axis], verdicts: Mapping[Axis, Verdict]) -> Outcome:
    """The worst of the verdicts in the variables that are claimed."""
    claimed = [axis for axis in axes if axis.variable in growth.classes]
    return Outcome.worst(
        verdicts[axis].outcome if axis in verdicts else Outcome.UNDETERMINED for axis in claimed
    )


def _class_found(axes: list[Axis], verdicts: Mapping[Axis, Verdict]) -> str:
    """What was measured in the table's own terms, such as ``O(n_ev)``; ``?`` where it was not."""
    if not axes or any(axis not in verdicts for axis in axes):
        return "?"
    factors = [
        verdicts[axis].best[2:-1].replace("n", axis.symbol)
        for axis in axes
        if verdicts[axis].best != "O(1)"
    ]
    by_valence = [verdicts[axis].slope for axis in axes if axis.variable == "valence"]
    joint = " + " if by_valence and by_valence[0] < FLAT else " · "
    return f"O({joint.join(factors) or '1'})"
