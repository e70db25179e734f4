"""Arrays with room behind them, so that they grow where they are.

Such an array is a view of a longer one that nobody else writes to, and grows by viewing more of it:
O(1), as nothing is moved. The rows that are not viewed yet cost addresses; the system gives them
memory when they are first written, in pages of 4 kB, or of 2 MB where NumPy asks for huge ones.
Copies and pickles hold what is viewed.

- When it is made there is room for a quarter as many rows again, and for 1 MB where that is more,
  but for no more than as many again: building takes as long as without. Eight times as many made it
  up to a third slower from 100,000 vertices on, as malloc uses memory of that size only once.
- Where that is too little it is moved once, to where it can become eight times as large as it has
  to be, and 32 MB in any case. Windows, where addresses are counted as memory, gives as much again.
- Who asks for more than twice as many rows says how many there will be, as who builds. They get
  what a new array gets: memory that was used before, which takes half the time of fresh one.
"""

import math
import os
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from hem.arrays import Array

SLACK, SLACK_BYTES = 4, 1 << 20
"""What there is room for behind a new array: of so many rows one more, or so many bytes."""

ADDRESSES = 8 if os.name != "nt" else 1
"""How many times the rows that it needs an array has addresses for once it was moved."""

FRESH = 32 << 20  # bytes from which on malloc takes fresh memory (glibc: M_MMAP_THRESHOLD)
SMALL = 1 << 16  # bytes up to which to move an array is nothing


class _Room:
    """Who owns the longer array; so no view of any other array is taken for one with room."""

    def __init__(self, array: Array) -> None:
        self._array = array

    @property
    def __array_interface__(self) -> dict[str, Any]:
        """How NumPy makes an array of it, whose base it is."""
        return self._array.__array_interface__


def rows(n: int, *width: int, dtype: DTypeLike, zeros: bool = False) -> Array:
    """(n, …): an array with room, empty, or ``zeros`` in the room as well."""
    return _longest(n + _slack(n, _row_bytes(width, dtype)), width, dtype, zeros)[:n]


def roomy(array: Array, dtype: DTypeLike | None = None) -> Array:
    """A copy with room. O(n)."""
    copy = rows(len(array), *array.shape[1:], dtype=dtype or array.dtype)
    copy[...] = array
    return copy


def longer(array: Array, used: int, wanted: int, zeros: bool = False) -> Array:
    """An array of at least ``wanted`` rows that begins with the first ``used``.

    The same memory if there is room, else twice as much or more, so that one new row costs O(1) in
    the long run. ``zeros``: whether it was made so.
    """
    if wanted <= len(array):
        return array
    longest, more = _whole(array), max(wanted, 2 * used)
    if longest is not None and wanted <= len(longest):
        return longest[:more]
    kind = array.shape[1:], array.dtype, zeros
    row, addresses = _row_bytes(*kind[:2]), more
    if wanted > 2 * used and used * row > SMALL:
        addresses += _slack(more, row)
    elif ADDRESSES > 1 and more * row > SMALL:
        addresses = max(ADDRESSES * more, FRESH // row)
    try:
        longest = _longest(addresses, *kind)
    except MemoryError:  # where no more may be promised than there is
        longest = _longest(more, *kind)
    longest[:used] = array[:used]
    return longest[:more]


def behind(*arrays: Array) -> int:
    """Bytes of addresses behind arrays, for which there is no memory yet."""
    longest = ((it, _whole(it)) for it in arrays)
    return sum(whole.nbytes - it.nbytes for it, whole in longest if whole is not None)


def _slack(n: int, row: int) -> int:
    """How many rows there is room for behind n new ones of so many bytes."""
    return max(n // SLACK, min(n, SLACK_BYTES // row))


def _whole(array: Array) -> Array | None:
    """The array that one with room is the first rows of."""
    base: Any = array.base
    return base if isinstance(base, np.ndarray) and isinstance(base.base, _Room) else None


def _row_bytes(width: tuple[int, ...], dtype: DTypeLike) -> int:
    return np.dtype(dtype).itemsize * math.prod(width)


def _longest(n: int, width: tuple[int, ...], dtype: DTypeLike, zeros: bool) -> Array:
    """All rows there are addresses for, as an array whose views have it as their base."""
    make = np.zeros if zeros else np.empty
    return np.asarray(_Room(make((n, *width), dtype)))
