"""Timing a query: as many handles per round as last long enough, and other ones every round."""

from __future__ import annotations

from itertools import count
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.harness.latency import latency_now
from experiments.harness.presets import Preset
from hem.contract.structure import Structure

Array = NDArray[Any]

MOST_HANDLES = 1_000_000
FEWEST_ROUNDS = 5
CALIBRATIONS = 3
"""Times that a number of handles is tried before it is believed to last long enough."""


class TooSlowError(RuntimeError):
    """A case would take longer than its profile allows."""


def time_query(
    benchmark: Any, s: Structure, query: str, pool: Array, profile: Preset
) -> dict[str, Any]:
    """Time ``s.sweep(query, …)`` over the handles in ``pool`` -> samples, handles and latency.

    Successive rounds take successive handles of the pool and begin again only when all have been
    asked, so that a large mesh is not answered out of the caches by what the last round left there.
    All are asked once before, so that a small one is. Raises TooSlowError before it takes long.
    """
    seconds = _seconds_per_query(s, query, pool, profile.round_seconds / 4)
    handles = int(np.clip(profile.round_seconds / seconds, 1, MOST_HANDLES))
    rounds = int(np.clip(profile.case_seconds / (seconds * handles), 0, profile.rounds))
    if rounds < FEWEST_ROUNDS:
        raise TooSlowError(
            f"one query takes {seconds:.3g} s, a case may take {profile.case_seconds} s"
        )
    latency = latency_now(sum(s.memory().values()))
    if seconds * len(pool) < profile.case_seconds:
        s.sweep(query, pool)
    windows = (np.arange(handles) + handles * k for k in count())

    def successive() -> tuple[tuple[str, Array], dict[str, Any]]:
        return (query, pool[next(windows) % len(pool)]), {}

    benchmark.pedantic(s.sweep, setup=successive, rounds=rounds, warmup_rounds=1)
    samples = _per_query(benchmark.stats, handles) if benchmark.stats else []  # --benchmark-disable
    return {"samples": np.array(samples), "handles": handles, "latency": latency}


def _per_query(stats: Any, handles: int) -> list[float]:
    """Seconds per query, in pytest-benchmark's own statistics as well.

    A round takes as many handles as last long enough, so that rounds last the same however slow a
    query is: `--benchmark-compare` of rounds would find every regression to be none.
    """
    samples = [seconds / handles for seconds in stats.stats.data]
    stats.stats.data[:], stats.iterations = samples, handles
    return samples


def _seconds_per_query(s: Structure, query: str, pool: Array, enough: float) -> float:
    """The least of some tries: one that was delayed would leave a round with too few handles.

    Then it is the call that is timed: asked of one handle a query of 6 ns takes 1.7 µs.
    """
    s.sweep(query, pool[:1])  # compiles
    handles = 1
    while True:
        asked = pool[np.arange(handles) % len(pool)]
        seconds = _seconds(s, query, asked)
        for _ in range(CALIBRATIONS - 1):
            if seconds >= enough:
                seconds = min(seconds, _seconds(s, query, asked))
        if seconds >= enough or handles >= MOST_HANDLES:
            return max(seconds / handles, 1e-10)
        handles *= 4


def _seconds(s: Structure, query: str, handles: Array) -> float:
    begin = perf_counter()
    s.sweep(query, handles)
    return perf_counter() - begin
