"""Arrays with room behind them, so that they grow where they are.

Such an array is a view of a longer one that nobody else writes to, and grows by viewing more of it:
O(1), as nothing is moved. The rows that are not viewed yet cost addresses; the system gives them
memory when they are first written, in pages of 4 kB, or of 2 MB where NumPy asks for huge ones.
Copies and pickles hold what is viewed.

- From 1 MB on there are addresses for eight times as many rows, and for 32 MB in any case. So an
  edit moves an array only once the mesh has grown eightfold. Smaller ones have room for as many
  rows again; moving them takes less than a millisecond.
- Memory with so many addresses is fresh from the system, which takes twice as long to write as
  memory that was used before. So what nobody views any more is kept for the next array, up to
  256 MB of what was in use; ``give_back`` lets go of it.
- Windows counts addresses as memory. There a new array has room for a quarter as many rows again,
  and one that was moved for as many.
"""

import math
import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from hem.arrays import Array

SLACK, SLACK_BYTES = 4, 1 << 20
"""What there is room for behind a new array: of so many rows one more, or so many bytes."""

ADDRESSES = 8 if os.name != "nt" else 1
"""How many times the rows that it needs an array has addresses for, if it takes ``LARGE`` bytes."""

LARGE = 1 << 20
SMALL = 1 << 16  # bytes up to which to move an array is nothing
FRESH = 32 << 20  # bytes from which on malloc takes fresh memory (glibc: M_MMAP_THRESHOLD)
KEPT = 256 << 20  # bytes of memory that was in use and is kept for the next arrays

_kept: dict[int, tuple[int, Array]] = {}
"""By its id a block that nobody views any more, and the bytes of it that were in use."""

# The C library keeps blocks that are no larger than one that it saw freed: so what building takes
# for a while, too, is memory that was used before. Nothing is written here.
np.empty(FRESH - SMALL, np.uint8)


def give_back() -> int:
    """Let go of all memory that is kept for the next arrays -> the bytes of it never written.

    Cost O(1) per array.
    """
    unwritten = sum(block.nbytes - used for used, block in _kept.values())
    _kept.clear()
    return unwritten


def _keep(block: Array, used: int) -> None:
    """Keep a block, and of the others the last ones that were in use; none at exit."""
    if _kept is None:  # Python takes names away then
        return
    _kept[id(block)] = used, block
    total = 0
    for key, (held, _) in reversed(_kept.copy().items()):
        total += held
        if total > KEPT:
            _kept.pop(key, None)


def _block(size: int, used: int) -> Array:
    """(size or more,) bytes: kept ones, about so many of which were in use, or fresh ones."""
    fits = [(held, key) for key, (held, it) in _kept.copy().items() if it.nbytes >= size]
    for held, key in sorted(fits):
        if used <= 2 * held <= 4 * used and (found := _kept.pop(key, None)):
            return found[1]
    return np.empty(size, np.uint8)


class _Room:
    """Who owns the longer array; so no view of any other array is taken for one with room.

    ``block``: the memory that is kept once nobody views it, of which ``used`` bytes were in use.
    """

    def __init__(self, array: Array, block: Array | None = None, used: int = 0) -> None:
        self._array, self._block, self.used = array, block, used

    def __del__(self, keep: Callable[[Array, int], None] = _keep) -> None:
        if self._block is not None:
            keep(self._block, self.used)

    @property
    def __array_interface__(self) -> dict[str, Any]:
        """How NumPy makes an array of it, whose base it is."""
        return self._array.__array_interface__


def rows(n: int, *width: int, dtype: DTypeLike, zeros: bool = False) -> Array:
    """(n, …): an array with room, empty, or ``zeros`` in the room as well."""
    row = _row_bytes(width, dtype)
    return _longest(n, _addresses(n, row, LARGE), width, dtype, zeros)[:n]


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
    kind = array.shape[1:], array.dtype, zeros
    if longest is None or wanted > len(longest):
        addresses = _addresses(more, _row_bytes(*kind[:2]), SMALL)
        longest = _longest(more, addresses, *kind)
        longest[:used] = array[:used]
    owner: Any = longest.base
    owner.used = max(owner.used, longest[:more].nbytes)
    return longest[:more]


def behind(*arrays: Array) -> int:
    """Bytes of addresses behind arrays, for which there is no memory yet."""
    longest = ((it, _whole(it)) for it in arrays)
    return sum(whole.nbytes - it.nbytes for it, whole in longest if whole is not None)


def _addresses(n: int, row: int, large: int) -> int:
    """How many rows of so many bytes there are addresses for where n are needed."""
    if ADDRESSES > 1 and n * row >= large:
        return max(ADDRESSES * n, FRESH // row)
    return n + max(n // SLACK, min(n, SLACK_BYTES // row))


def _whole(array: Array) -> Array | None:
    """The array that one with room is the first rows of."""
    base: Any = array.base
    return base if isinstance(base, np.ndarray) and isinstance(base.base, _Room) else None


def _row_bytes(width: tuple[int, ...], dtype: DTypeLike) -> int:
    return np.dtype(dtype).itemsize * math.prod(width)


def _longest(
    n: int, addresses: int, width: tuple[int, ...], dtype: DTypeLike, zeros: bool
) -> Array:
    """All rows there are addresses for, as an array whose views have it as their base.

    Just n where no more may be promised than there is memory.
    """
    row = _row_bytes(width, dtype)
    try:
        if zeros or addresses * row <= FRESH - row:
            make = np.zeros if zeros else np.empty
            return np.asarray(_Room(make((addresses, *width), dtype)))
        block = _block(addresses * row, n * row)
    except MemoryError:
        if addresses == n:
            raise
        return _longest(n, n, width, dtype, zeros)
    array = block[: addresses * row].view(dtype).reshape(addresses, *width)
    return np.asarray(_Room(array, block, n * row))
