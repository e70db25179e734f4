"""Three fixed loops that tell how fast the machine is now.

One reads and computes, as the cases do; one waits for the memory; one fills its core. What runs on
the core's other thread is felt by that last one most: the others leave half of the core unused.

They need NumPy and Numba alone, so that they can be read beside code of any other checkout.
"""

from collections.abc import Callable
from functools import lru_cache
from time import perf_counter

import numpy as np
from numba import njit
from numpy.typing import NDArray

WORDS = 2_048  # int64 in the table that the calibration loop walks: 16 KB, found in the first cache
STEPS = 2_000
WALKS = 5
CACHE_LINE, CACHE_LINE_WORDS = 64, 8  # a cache line in bytes, and in int64
CHASE_STEPS = 4_000
FILLING_STEPS = 4_000
SAMPLES = 5
MOST_WARMING = 1_000_000


def calibration_loop() -> float:
    """Seconds per step of a walk that reads and computes: the least of some, as delays only add.

    Takes some ten microseconds. The memory's latency will not do: where the caches end it changes
    up to threefold from run to run, beside cases that stay within a fifth.
    """
    return min(_seconds(compiled_walk, STEPS) for _ in range(WALKS)) / STEPS


def filling_loop() -> float:
    """Seconds per step of a loop that fills its core: the least of some, a few microseconds each.

    Where another program runs on the other thread of the core it takes 1.6 to 1.9 times as long,
    and queries up to 1.7 times; the calibration loop, whose steps wait for each other, 1.16 times.
    """
    return min(_seconds(fill, FILLING_STEPS) for _ in range(WALKS)) / FILLING_STEPS


def _seconds(loop: Callable[[NDArray[np.int64], int], int], steps: int) -> float:
    begin = perf_counter()
    loop(_TABLE, steps)
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


@njit(cache=True)
def fill(table: NDArray[np.int64], steps: int) -> int:
    """Four sums side by side whose steps do not wait for each other."""
    a, b, c, d = 0, 0, 0, 0
    for step in range(steps):
        a += table[7 * step & WORDS - 1] ^ step
        b += table[11 * step & WORDS - 1] + step
        c ^= table[13 * step & WORDS - 1]
        d += step * step
    return a + b + c + d


_TABLE = np.random.default_rng(0).permutation(WORDS)


def latency_now(working_set: int) -> float:
    """Seconds per access in a working set of so many bytes, as the machine is at this moment.

    On a shared machine the caches are as large as the other tenants leave them, and that changes
    within seconds: a case is compared with the latency measured right beside it.
    """
    chain = random_cycle(max(working_set // CACHE_LINE, 2))
    place = chase(chain, 0, min(len(chain) // CACHE_LINE_WORDS, MOST_WARMING))
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
    chain = np.zeros(CACHE_LINE_WORDS * lines, np.int64)
    chain[CACHE_LINE_WORDS * order] = np.roll(order, -1)
    return chain


@njit(cache=True)
def chase(chain: NDArray[np.int64], line: int, steps: int) -> int:
    """The line reached from ``line`` after so many steps."""
    for _ in range(steps):
        line = chain[CACHE_LINE_WORDS * line]
    return line
