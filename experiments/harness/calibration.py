"""Two fixed loops that tell how fast the machine is now: one computes, one waits for the memory.

They need NumPy and Numba alone, so that they can be read beside code of any other checkout.
"""

from functools import lru_cache
from time import perf_counter

import numpy as np
from numba import njit
from numpy.typing import NDArray

WORDS = 2_048  # int64 in the table that the calibration loop walks: 16 KB, found in the first cache
STEPS = 2_000
WALKS = 5
LINE, LINE_WORDS = 64, 8  # a cache line in bytes, and in int64
CHASE_STEPS = 4_000
SAMPLES = 5
MOST_WARMING = 1_000_000


def calibration_loop() -> float:
    """Seconds per step of a walk that reads and computes: the least of some, as delays only add.

    Takes some ten microseconds. The memory's latency will not do: where the caches end it changes
    up to threefold from run to run, beside cases that stay within a fifth.
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


def latency_now(working_set: int) -> float:
    """Seconds per access in a working set of so many bytes, as the machine is at this moment.

    On a shared machine the caches are as large as the other tenants leave them, and that changes
    within seconds: a case is compared with the latency measured right beside it.
    """
    chain = random_cycle(max(working_set // LINE, 2))
    place = chase(chain, 0, min(len(chain) // LINE_WORDS, MOST_WARMING))
    seconds = []
    for _ in range(SAMPLES):
        begin = perf_counter()
        place = chase(chain, place, CHASE_STEPS)
        seconds.append((perf_counter() - begin) / CHASE_STEPS)
    return float(np.median(seconds))


@lru_cache(maxsize=1)
def random_cycle(lines: int) -> NDArray[np.int64]:
    """(8 · lines,) int64: the first word of each line names the line to visit after it.

    Every line once, in random order: each access waits for the one before, as a query does that
    goes from record to record.
    """
    order = np.random.default_rng(0).permutation(lines)
    chain = np.zeros(LINE_WORDS * lines, np.int64)
    chain[LINE_WORDS * order] = np.roll(order, -1)
    return chain


@njit(cache=True)
def chase(chain: NDArray[np.int64], line: int, steps: int) -> int:
    """The line reached from ``line`` after so many steps."""
    for _ in range(steps):
        line = chain[LINE_WORDS * line]
    return line
