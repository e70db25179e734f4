"""Timing a query: as many handles per round as last long enough, and other ones every round."""

from itertools import count

import numpy as np

from experiments.harness.calibration import latency_now
from experiments.harness.cases import Case, Measurement, elements_at, in_order_of
from experiments.harness.oracle import check_query
from experiments.harness.reference import Reference, typical
from experiments.harness.timer import Timer, took
from experiments.presets import Preset
from hem.arrays import Array
from hem.contract import Structure, Sweep

MOST_HANDLES, CHECKED_HANDLES = 1_000_000, 3
FEWEST_ROUNDS = 5
TRIES = 3  # times that a number of handles is tried before it is believed to last long enough


def checked_handles(case: Case) -> tuple[Structure, Array]:
    """The structure of a case and its handles; CheckFailedError if some answers are wrong."""
    s = case.build()
    # Where the valence varies those at hubs, as many at every valence.
    handles = in_order_of(case, elements_at(s, case.query.source, case.hubs))
    check_query(s, case.mesh(), case.query, handles[:CHECKED_HANDLES])
    return s, handles


def time_query(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check a case against the triangle list, then time it; skipped where that takes too long.

    Successive rounds take successive handles and begin again only when all have been asked, so that
    a large mesh is not answered out of the caches by what the last round left there. All are asked
    once before, so that a small one is. Where sizes are compared by time, the reference loop is
    timed before and after.
    """
    s, handles = checked_handles(case)
    sweep = s.prepare_sweep(case.query.name, handles)
    seconds = _seconds_per_query(sweep, preset.round_seconds / 4)
    many = int(np.clip(preset.round_seconds / seconds, 1, MOST_HANDLES))
    rounds = int(np.clip(preset.case_seconds / (seconds * many), 0, preset.rounds))
    if rounds < FEWEST_ROUNDS:
        reason = f"one query takes {seconds:.3g} s, a case may take {preset.case_seconds} s"
        return case.result("time", s, skipped=reason)
    latency = latency_now(sum(s.memory().values()))
    judged = case.family == preset.families[0] and s.compiled
    reference = Reference(case, preset) if judged else None
    if seconds * len(handles) < preset.case_seconds:
        sweep.run()
        if reference:
            reference.ask(reference.sweep)
    beside = reference.seconds(many) if reference else []
    begins = count(0, many)

    def successive() -> tuple[Sweep]:
        return (sweep.successive(next(begins), many),)

    timed = timer(Sweep.run, setup=successive, rounds=rounds, per=many)
    beside += reference.seconds(many) if reference else []
    return case.result("time", s, latency=latency, reference=typical(beside), **timed.fields)


def _seconds_per_query(sweep: Sweep, enough: float) -> float:
    """The least of some tries: one that was delayed would leave a round with too few handles.

    Then it is the call that is timed: asked of one handle a query of 6 ns takes 1.7 µs.
    """
    sweep.successive(0, 1).run()  # compiles
    many = 1
    while True:
        asked = sweep.successive(0, many)
        seconds = min(took(asked.run)[1] for _ in range(TRIES))
        if seconds >= enough or many >= MOST_HANDLES:
            return max(seconds / many, 1e-10)
        many *= 4
