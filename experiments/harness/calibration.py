"""A fixed loop that slows as compiled queries do when the machine is busy.

It needs NumPy and Numba alone, so that it can be read beside code of any other checkout.
"""

from __future__ import annotations

from time import perf_counter

import numpy as np
from numba import njit
from numpy.typing import NDArray

WORDS = 2_048
"""int64 in the table that the calibration loop walks: 16 KB, found in the first cache."""
STEPS = 2_000
WALKS = 5


def calibration_loop() -> float:
    """Seconds per step of a walk that reads and computes: the least of some, as delays only add.

    Takes some ten microseconds. The memory's latency will not do: where the caches end, readings of
    it were measured to change by a quarter to threefold from run to run, beside cases that stayed
    within a twentieth to a fifth.
    """
    return min(_seconds() for _ in range(WALKS)) / STEPS


def _seconds() -> float:
    begin = perf_counter()
    compiled_walk(_TABLE, STEPS)
    return perf_counter() - begin


def walk(table: NDArray[np.int64], steps: int) -> int:
    """Four walks side by side, so that computing and waiting both count."""
    a, b, c, d = 0, 1, 2, 3
    for step in range(steps):
        a = table[(a + step) % WORDS]
        b = table[(b ^ a) % WORDS]
        c = table[(c + 3) % WORDS]
        d = table[(d ^ step) % WORDS]
    return a + b + c + d


compiled_walk = njit(cache=True)(walk)
_TABLE = np.random.default_rng(0).permutation(WORDS)
