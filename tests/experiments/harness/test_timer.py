"""Laws of timing: a delay while a case is calibrated does not decide what is timed."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from experiments.harness.timer import _seconds_per_query


class Delayed:
    """Asked ``slow`` times it takes a hundred times as long, and then a microsecond a handle."""

    def __init__(self, slow: set[int]) -> None:
        self.slow = slow
        self.calls = 0

    def sweep(self, query: str, handles: np.ndarray) -> None:
        end = perf_counter() + len(handles) * 1e-6 + (2e-3 if self.calls in self.slow else 0)
        self.calls += 1
        while perf_counter() < end:
            pass


def test_one_delayed_try_leaves_no_round_with_too_few_handles() -> None:
    pool = np.arange(64)
    for delayed in range(5):
        seconds = _seconds_per_query(Delayed({delayed}), "vertex_faces", pool, 2e-4)
        assert 1e-6 <= seconds < 1e-5
