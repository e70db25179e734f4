"""What the machine's memory does to costs, measured where a function works.

A function that goes from record to record waits for the memory's latency, one that reads along for
its bandwidth, and one that makes something new for the system, which gives memory page by page.
"""

import sys
import timeit
from collections.abc import Callable
from functools import reduce
from itertools import repeat
from operator import getitem
from time import perf_counter, thread_time
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity.notation import Array

STEPS = 1_000  # accesses per sample
SAMPLES = 5
LARGEST = 1 << 25  # bytes; what takes more is measured as this
CELL = 80  # bytes of a list of one
WAITS = 2  # of a step from list to list: for the list, and for what it holds
SMALLEST = 16 * 1024  # bytes; less than that is in the first cache, and beside what a call takes
QUICKEST = 2e-11  # seconds that a byte takes at least, as a program reads it that does more
AT_BEST = 5e-9  # seconds: what a step from record to record takes at least, in the caches
Call = Callable[[], object]
CLOCK = perf_counter if sys.platform == "win32" else thread_time
"""The processor's time: what other programs take meanwhile is of no function's cost. Windows counts
that in ticks of 1/64 s, though it says otherwise, and a sample takes less."""


def memory_times(working_sets: ArrayLike) -> Array:
    """(3, k) seconds: a dependent access, reading a byte, and writing a byte of new memory.

    working_sets: (k,) bytes; those above ``LARGEST`` are measured as this. Each is measured right
    now, as other tenants of the machine leave the caches; takes some milliseconds per megabyte, and
    as much memory as the largest.
    """
    sets = np.clip(np.asarray(working_sets, float), SMALLEST, LARGEST).astype(int)
    distinct, place = np.unique(sets, return_inverse=True)
    taken = np.array([[take(size) for size in distinct] for take in (_chase, _read, _write)])
    # None is more than that of any larger set: disturbances only add.
    rising = np.minimum.accumulate(taken[:, ::-1], axis=1)[:, ::-1]
    rising[0] = AT_BEST + (rising[0] - rising[0, 0]) / WAITS
    return rising[:, place]


def _chase(size: int) -> float:
    """Seconds per step through lists that hold one another at random, Python's part included.

    The least counts, as delays only add; each sample goes on where the last one ended.
    """
    cells: list[list[Any]] = [[] for _ in range(size // CELL)]
    order = np.random.default_rng(0).permutation(len(cells)).tolist()
    for here, there in zip(order, [*order[1:], order[0]], strict=True):
        cells[here].append(cells[there])
    place, seconds = cells[0], []
    for _ in range(SAMPLES + 1):  # the first finds what building them left in the caches
        begin = CLOCK()
        place = reduce(getitem, repeat(0, STEPS), place)
        seconds.append(CLOCK() - begin)
    for cell in cells:
        cell.clear()  # a cycle is freed by nobody else while garbage is not collected
    return min(seconds[1:]) / STEPS


def _read(size: int) -> float:
    return _seconds_per_byte(np.ones(size // 8).sum, np.ones(8).sum, size)


def _write(size: int) -> float:
    def write(size: int = size) -> None:
        np.empty(size, np.uint8).fill(1)

    return _seconds_per_byte(write, lambda: write(8), size)


def _seconds_per_byte(call: Call, empty: Call, size: int) -> float:
    """What a call takes beyond one that does next to nothing."""
    many = max(1, (1 << 20) // size)
    taken, beside = (min(timeit.repeat(it, "", CLOCK, SAMPLES, many)) for it in (call, empty))
    return max(taken - beside, 0.0) / many / size + QUICKEST
