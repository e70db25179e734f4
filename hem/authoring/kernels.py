"""What kernels are made of: the compiler's decorator, and the parts that structures share.

A kernel answers one query for one element: ``vertex_faces(m, v, out) -> count`` reads the records
``m``, writes the neighbors of ``v`` to ``out`` and tells how many there are.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]
Kernel = Callable[..., Any]

kernel: Callable[[Kernel], Kernel] = njit(forceinline=True)
"""Compiles a kernel or a part of one, inlined wherever it is called.

A call would push some forty fields of the records' arrays, which takes longer than most queries.
"""

part: Callable[[Kernel], Kernel] = njit
"""Compiles a part of an algorithm that is large and called from several places: not inlined."""


VERTICES, EDGES, FACES, VERTEX_END, EDGE_END, FACE_END = range(6)
"""Columns of a structure's ``counts``: how many elements are live, and how many records are in use.

Live and dead elements lie before the end, room for new ones behind it.
"""

VERTEX_ROOM, EDGE_ROOM, FACE_ROOM, VALENCE, SIDES, EDGE_GROWTH = range(6, 12)
"""More columns: how many records there is room for, bounds on the valence of any vertex and on the
sides of any face, and how many records of edges a new face may need.

The bound on the valence is one on the sides as well: there is scratch for that many neighbors.
"""


def named(*kernels: Kernel) -> dict[str, Kernel]:
    """The kernels of a structure by query."""
    return {getattr(kernel, "py_func", kernel).__name__: kernel for kernel in kernels}


def circulator(clockwise: Kernel, counterclockwise: Kernel) -> Kernel:
    """Make ``around(m, start, v, out) -> (count, closed)`` of two steps ``step(m, item, v)``.

    A step goes from one item at vertex ``v`` (a half-edge, an edge, a triangle) to the next, or to
    a negative number at the border. The items come counterclockwise. A fan open at the border is
    circulated from both sides of ``start``. Cost O(valence).
    """

    def around(m: Any, start: int, v: int, out: Array) -> tuple[int, bool]:
        count, item = 0, start
        while item >= 0:
            out[count] = item
            count += 1
            item = clockwise(m, item, v)
            if item == start:
                reverse(out, count)
                return count, True
        reverse(out, count)
        item = counterclockwise(m, start, v) if count else -1
        while item >= 0:
            out[count] = item
            count += 1
            item = counterclockwise(m, item, v)
        return count, False

    compiled: Kernel = kernel(around)
    return compiled


def found_by_steps(first: Kernel, clockwise: Kernel, reaches: Kernel, back: Kernel) -> Kernel:
    """Make ``find(m, a, b) -> item``: the first item around a that reaches b, or -1.

    ``first(m, v)`` is an item to begin at, or -1; ``reaches(m, item, v, w)`` tells whether the item
    at v is the one for w. The steps are those of ``circulator``. Cost O(valence of a).
    """

    def find(m: Any, a: int, b: int) -> int:
        start = first(m, a)
        item = start
        while item >= 0:
            if reaches(m, item, a, b):
                return item
            item = clockwise(m, item, a)
            if item == start:
                return -1
        item = back(m, start, a) if start >= 0 else -1
        while item >= 0:
            if reaches(m, item, a, b):
                return item
            item = back(m, item, a)
        return -1

    compiled: Kernel = kernel(find)
    return compiled


def joined_by_steps(first: Kernel, clockwise: Kernel, ends: Kernel, find: Kernel) -> Kernel:
    """Make ``joined(m, a, b) -> bool``: whether an edge joins two vertices that have faces.

    ``ends(m, item, v, w)`` tells whether the edge that leaves v for an item ends at w, and ``find``
    finds an item at v whose face has w. Both vertices are circulated by turns, so the cost is
    O(the smaller of both valences); where the first that comes to an end lies on the border, its.
    """

    def joined(m: Any, a: int, b: int) -> bool:
        from_a, from_b = first(m, a), first(m, b)
        at_a, at_b = from_a, from_b
        while not ends(m, at_a, a, b) and not ends(m, at_b, b, a):
            at_a = clockwise(m, at_a, a)
            if at_a == from_a:
                return False
            if at_a < 0:
                return bool(find(m, a, b) >= 0)
            at_b = clockwise(m, at_b, b)
            if at_b == from_b:
                return False
            if at_b < 0:
                return bool(find(m, b, a) >= 0)
        return True

    compiled: Kernel = kernel(joined)
    return compiled


def edges_at_both_ends(edge_vertices: Kernel, vertex_edges: Kernel) -> Kernel:
    """Make the kernel ``edge_edges``: the edges at either end, without the edge itself."""

    def edge_edges(m: Any, e: int, out: Array) -> int:
        edge_vertices(m, e, out)
        a, b = out[0], out[1]
        around = vertex_edges(m, a, out)
        count = without(out, around, e)
        if count == around:  # the handle names two vertices that are not joined
            return 0
        return count + without(out[count:], vertex_edges(m, b, out[count:]), e)

    compiled: Kernel = kernel(edge_edges)
    return compiled


@kernel
def reverse(out: Array, count: int) -> None:
    """Turn the first ``counts`` elements round, in place."""
    first, last = 0, count - 1
    while first < last:
        out[first], out[last] = out[last], out[first]
        first += 1
        last -= 1


@kernel
def without(out: Array, count: int, value: int) -> int:
    """Take ``value`` out of the first ``counts`` elements, in place -> how many are left."""
    left = 0
    for i in range(count):
        if out[i] != value:
            out[left] = out[i]
            left += 1
    return left


@kernel
def append_face(out: Array, count: int, face: int) -> int:
    """Append a face beyond the next edge of a triangle, unless it was just met -> the new count.

    Two triangles that share two edges share all three, so the last one met is the only candidate.
    """
    if count and out[count - 1] == face:
        return count
    out[count] = face
    return count + 1


@kernel
def distinct(out: Array, count: int) -> int:
    """Keep each of the first ``counts`` elements once, in order, in place -> how many are left.

    The next up to 4 · ``counts`` elements of ``out`` serve as a hash table. Cost O(count) expected.
    """
    size = 1
    while size < 2 * count:
        size *= 2
    table = out[count : count + size]
    for i in range(size):
        table[i] = -1
    kept = 0
    for i in range(count):
        value = out[i]
        place = (value * 40503 + (value >> 16)) & (size - 1)
        while table[place] >= 0 and table[place] != value:
            place = (place + 1) & (size - 1)
        if table[place] < 0:
            table[place] = value
            out[kept] = value
            kept += 1
    return kept


@kernel
def pack(a: int, b: int) -> int:
    """The handle of edge (a, b) where no edges are recorded: both vertices in one int64."""
    return int((np.int64(min(a, b)) << 32) | np.int64(max(a, b)))


@kernel
def edge_vertices(m: Any, e: int, out: Array) -> int:
    """The kernel where no edges are recorded: unpacked from the handle, nothing is read."""
    out[0] = e >> 32
    out[1] = e & 0xFFFFFFFF
    return 2


@kernel
def coordinate(m: Any, v: int, i: int) -> float:
    """x, y or z of vertex v; NaN if it is dead."""
    return float(m.vertex_point[v, i])


@kernel
def place(m: Any, v: int, point: Array) -> None:
    """Give a vertex its position, be it new or not."""
    for i in range(3):
        m.vertex_point[v, i] = point[i]


@kernel
def bury(m: Any, v: int) -> None:
    """Make a vertex dead."""
    for i in range(3):
        m.vertex_point[v, i] = np.nan


@kernel
def isolate(m: Any, v: int) -> None:
    """See to it that vertex v has no faces, where it would not know of them anyway."""


@kernel
def anchor(m: Any, v: int, f: int) -> None:
    """Let vertex v know of the face f at it, where it would not know of any."""


@kernel
def sides(m: Any, f: int) -> int:
    """How many sides face f has, where all are triangles."""
    return 3


@kernel
def vertex_exists(m: Any, v: int) -> bool:
    """Whether there is a record for v, live or dead; who asks further finds no faces there."""
    return bool(0 <= v < m.counts[VERTEX_END])


@kernel
def edge_exists(m: Any, e: int) -> bool:
    """Whether the handle names two vertices, where no edges are recorded."""
    return bool(0 <= e >> 32 < e & 0xFFFFFFFF < m.counts[VERTEX_END])
