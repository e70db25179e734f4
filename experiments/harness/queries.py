"""Timing a query: as many handles per round as last long enough, and other ones every round."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.harness.cases import Case, queried_handles
from experiments.harness.latency import latency_now
from experiments.harness.measurement import Measurement
from experiments.harness.oracle import CHECKED_HANDLES, check_query
from experiments.harness.presets import Preset
from experiments.harness.timer import Timer
from hem.contract import Structure

Array = NDArray[Any]

MOST_HANDLES = 1_000_000
FEWEST_ROUNDS = 5
TRIES = 3
"""Times that a number of handles is tried before it is believed to last long enough."""


def time_checked_query(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check a case against the triangle list, then time it; skipped where that takes too long."""
    s = case.build()
    handles = queried_handles(case, s)
    check_query(s, case.mesh(), case.query, handles[:CHECKED_HANDLES])
    try:
        timed = time_query(timer, s, case.query.name, handles, preset)
    except TooSlowError as reason:
        return case.result("time", s, skipped=str(reason))
    return case.result("time", s, checked=True, **timed)


class TooSlowError(RuntimeError):
    """A case would take longer than its preset allows."""


def time_query(
    timer: Timer, s: Structure, query: str, handles: Array, preset: Preset
) -> dict[str, Any]:
    """Time ``s.sweep(query, …)`` over handles -> the fields of a measurement.

    Successive rounds take successive handles and begin again only when all have been asked, so that
    a large mesh is not answered out of the caches by what the last round left there. All are asked
    once before, so that a small one is. Raises TooSlowError before it takes long.
    """
    seconds = _seconds_per_query(s, query, handles, preset.round_seconds / 4)
    many = int(np.clip(preset.round_seconds / seconds, 1, MOST_HANDLES))
    rounds = int(np.clip(preset.case_seconds / (seconds * many), 0, preset.rounds))
    if rounds < FEWEST_ROUNDS:
        raise TooSlowError(
            f"one query takes {seconds:.3g} s, a case may take {preset.case_seconds} s"
        )
    latency = latency_now(sum(s.memory().values()))
    if seconds * len(handles) < preset.case_seconds:
        s.sweep(query, handles)
    windows = (np.arange(many) + many * k for k in count())

    def successive() -> tuple[tuple[str, Array], dict[str, Any]]:
        return (query, handles[next(windows) % len(handles)]), {}

    timed = timer(s.sweep, setup=successive, rounds=rounds, per=many)
    return {**timed.fields, "handles": many, "latency": latency}


def _seconds_per_query(s: Structure, query: str, handles: Array, enough: float) -> float:
    """The least of some tries: one that was delayed would leave a round with too few handles.

    Then it is the call that is timed: asked of one handle a query of 6 ns takes 1.7 µs.
    """
    s.sweep(query, handles[:1])  # compiles
    many = 1
    while True:
        asked = handles[np.arange(many) % len(handles)]
        seconds = _seconds(s.sweep, query, asked)
        for _ in range(TRIES - 1):
            if seconds >= enough:
                seconds = min(seconds, _seconds(s.sweep, query, asked))
        if seconds >= enough or many >= MOST_HANDLES:
            return max(seconds / many, 1e-10)
        many *= 4


def _seconds(call: Callable[..., Any], *given: Any) -> float:
    begin = perf_counter()
    call(*given)
    return perf_counter() - begin
