"""Which ranges of a render mesh have to be uploaded."""

from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array
from hem.edit import FACE, PARENT

Ranges = NDArray[np.int64]


def dirty_ranges(touched: Sequence[ArrayLike], nearby: int) -> tuple[Ranges, Ranges]:
    """The ranges (k, 2) of vertices and of triangles that logs of edits name, begin and end each.

    Elements at most ``nearby`` apart share a range. Cost O(k log k) for k entries.
    """
    log = np.concatenate([np.zeros(0, np.int64), *(np.asarray(it, np.int64) for it in touched)])
    log.sort()  # by index, as that is in the upper bits
    ranges = np.empty((2, len(log), 2), np.int64)
    vertices, triangles = _runs(log, nearby, ranges)
    return ranges[0, :vertices], ranges[1, :triangles]


@njit(cache=True)
def _runs(log: Array, nearby: int, ranges: Array) -> Array:
    count = np.zeros(2, np.int64)
    for entry in log:
        if entry & 7 == PARENT:
            continue
        kind, index = (1 if entry & 7 >= FACE else 0), entry >> 3
        last = count[kind] - 1
        if last >= 0 and index <= ranges[kind, last, 1] + nearby:
            ranges[kind, last, 1] = index + 1
        else:
            ranges[kind, last + 1, 0], ranges[kind, last + 1, 1] = index, index + 1
            count[kind] += 1
    return count
