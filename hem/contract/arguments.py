"""What users hand to operations, checked and brought into shape."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.authoring import Refusal
from hem.engine import kept
from hem.errors import MeshError

MOST = 1 << 63  # more than any handle
SPARSE = 512
"""Names this many times as large as they are many are sorted, as bits for all would take longer."""
NO_POINT = np.zeros((1, 3), np.float32)  # the positions of operations that take none


def rows(handles: Array | Sequence[int], ends: Array | int = -1) -> Array:
    """(n, 3) int64: the arguments of n operations."""
    arguments = np.full((len(handles), 3), -1, np.int64)
    arguments[:, 0], arguments[:, 1] = handles, ends
    return arguments


def integer(called: str, element: str, handle: Any) -> int:
    """One handle; MeshError for what is no such integer."""
    if isinstance(handle, np.ndarray) and handle.ndim == 0:
        handle = handle[()]
    if not isinstance(handle, int | np.integer) or isinstance(handle, bool):
        raise MeshError(
            f"{called} takes a {element} handle (an integer) or an array of them, "
            f"not {type(handle).__name__} {handle!r}"
        )
    if not -MOST <= handle < MOST:
        raise MeshError(f"{called}: there is no such {element}: {handle}")
    return int(handle)


def number(called: str, of: Any) -> int:
    """How many; MeshError for what is no such number, or more than indices can name."""
    most = np.iinfo(np.int32).max
    if not isinstance(of, int | np.integer) or isinstance(of, bool) or not 0 <= of <= most:
        raise MeshError(f"{called} takes a number from 0 to {most:,}, not {of!r}")
    return int(of)


def grown(splits: Any, vertices: int, faces: int) -> tuple[int, int]:
    """How many vertices and faces there are after so many splits; MeshError for too many."""
    more = number("reserve", splits)
    ends = vertices + more, faces + 2 * more
    if max(ends) > np.iinfo(np.int32).max:
        raise MeshError(f"{max(ends):,} vertices or faces are more than handles can name")
    return ends


def integers(called: str, values: ArrayLike, dimensions: tuple[int, ...] = (0, 1)) -> Array:
    """One handle or a row of them; MeshError for anything but such integers."""
    try:
        given = np.asarray(values)
    except ValueError as error:  # rows of several lengths
        raise MeshError(f"{called} takes a 1-D array of integers: {error}") from error
    if given.ndim not in dimensions or (given.size and given.dtype.kind not in "iu"):
        one = "one handle or " if 0 in dimensions else "handles: "
        raise MeshError(
            f"{called} takes {one}a 1-D array of integers, not {given.dtype} of shape {given.shape}"
        )
    return given


def handles(called: str, values: ArrayLike) -> Array:
    """(n,) int64; MeshError for what is no row of integers."""
    return integers(called, values, (1,)).astype(np.int64)


def any_twice(names: Array) -> bool:
    """Whether a name of ``names`` (n,) >= 0 comes again. O(n), or O(n log n) if some are large."""
    end = int(names.max(initial=-1)) + 1
    if end > SPARSE * len(names):
        ordered = np.sort(names)
        return bool((ordered[1:] == ordered[:-1]).any())
    return bool(_comes_again(names, np.zeros(end // 8 + 1, np.uint8)))


@kept
def _comes_again(names: Array, met: Array) -> bool:
    """Whether a name comes again; ``met`` has a bit for each."""
    for name in names:
        bit = np.uint8(1 << (name & 7))
        if met[name >> 3] & bit:
            return True
        met[name >> 3] |= bit
    return False


def positions(called: str, points: ArrayLike, n: int) -> Array:
    """(n, 3) float32; MeshError for what is no position per handle, naming the rows."""
    try:
        given = np.asarray(points, np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise MeshError(f"{called} takes points as {n} rows of three numbers: {error}") from error
    if n == 0 and given.size == 0:
        return NO_POINT
    if given.shape != (n, 3):
        raise MeshError(f"{called} takes one point per handle, ({n}, 3), not {given.shape}")
    with np.errstate(over="ignore"):
        rounded = np.ascontiguousarray(given, np.float32)
    if not np.isfinite(rounded).all():
        bad = ~np.isfinite(rounded).all(axis=1)  # to tell which they are takes five times as long
        raise MeshError(Refusal.NOT_FINITE.words, rows=np.flatnonzero(bad))
    return rounded


def refusal(operation: str, args: tuple[Any, ...], point: Any) -> MeshError:
    """The error for arguments of one operation that are no handles, or no point."""
    args = tuple(it for it in args if it is not ...)
    wrong = [it for it in args if not isinstance(it, int | np.integer) or isinstance(it, bool)]
    if wrong:
        return MeshError(f"{operation} takes handles (integers), not {wrong[0]!r}")
    if any(not -MOST <= it < MOST for it in args):
        return MeshError(f"{operation}: there is no such element: {max(args, key=abs)}")
    return MeshError(f"{operation} takes a point of three finite float32 numbers, not {point!r}")
