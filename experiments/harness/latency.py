"""Latency of the machine's memory by working set: a pointer chase.

It visits every cache line of an array once, in random order, and each access must wait for the one
before: so long does a query wait that goes from record to record.
"""

from __future__ import annotations

from functools import lru_cache
from time import perf_counter

import numpy as np
from numba import njit
from numpy.typing import NDArray

LINE = 64
WORDS = LINE // 8
STEPS = 4_000
SAMPLES = 5
MOST_WARMING = 1_000_000


def latency_now(working_set: int) -> float:
    """Seconds per access in a working set of so many bytes, as the machine is at this moment.

    On a shared machine the caches are as large as the neighbors leave them, and that changes within
    seconds: a case is compared with the latency measured right beside it.
    """
    chain = random_cycle(max(working_set // LINE, 2))
    place = chase(chain, 0, min(len(chain) // WORDS, MOST_WARMING))
    seconds = []
    for _ in range(SAMPLES):
        begin = perf_counter()
        place = chase(chain, place, STEPS)
        seconds.append((perf_counter() - begin) / STEPS)
    return float(np.median(seconds))


@lru_cache(maxsize=1)
def random_cycle(lines: int) -> NDArray[np.int64]:
    """(8 · lines,) int64: the first word of each line names the line to visit after it."""
    order = np.random.default_rng(0).permutation(lines)
    chain = np.zeros(WORDS * lines, np.int64)
    chain[WORDS * order] = np.roll(order, -1)
    return chain


@njit(cache=True)
def chase(chain: NDArray[np.int64], line: int, steps: int) -> int:
    """The line reached from ``line`` after so many steps."""
    for _ in range(steps):
        line = chain[WORDS * line]
    return line
