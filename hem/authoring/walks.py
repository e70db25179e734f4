"""Walks around a vertex, written once over the steps that a structure takes."""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import Kernel, kernel, without


def circulator(clockwise: Kernel, counterclockwise: Kernel) -> Kernel:
    """Make ``around(m, start, v, out) -> (count, closed)`` of two steps ``step(m, item, v)``.

    A step goes from one item at vertex ``v`` (a half-edge, an edge, a triangle) to the next, or to
    a negative number at the border. The items come counterclockwise. A fan open at the border is
    circulated from both sides of ``start``. Cost O(valence).
    """

    @kernel
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

    return around


def found_by_steps(first: Kernel, clockwise: Kernel, reaches: Kernel, back: Kernel) -> Kernel:
    """Make ``find(m, a, b) -> item``: the first item around a that reaches b, or -1.

    ``first(m, v)`` is an item to begin at, or -1; ``reaches(m, item, v, w)`` tells whether the item
    at v is the one for w. The steps are those of ``circulator``. Cost O(valence of a).
    """

    @kernel
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

    return find


def joined_by_steps(first: Kernel, clockwise: Kernel, ends: Kernel, find: Kernel) -> Kernel:
    """Make ``joined(m, a, b) -> bool``: whether an edge joins two vertices that have faces.

    ``ends(m, item, v, w)`` tells whether the edge that leaves v for an item ends at w, and ``find``
    finds an item at v whose face has w. Both vertices are circulated by turns, so the cost is
    O(the smaller of both valences); where the first that comes to an end lies on the border, its.
    """

    @kernel
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

    return joined


def half_edge_column(which: int) -> Kernel:
    """Make ``read(m, h)``: one column of the records of half-edges."""

    @kernel
    def read(m: Any, h: int) -> int:
        return int(m.half_edge[h, which])

    return read


@kernel
def leaving(m: Any, v: int) -> int:
    """The half-edge that is recorded at vertex v."""
    return int(m.vertex_half_edge[v])


@kernel
def within(m: Any, f: int) -> int:
    """The half-edge that is recorded at face f."""
    return int(m.face_half_edge[f])


@kernel
def as_named(m: Any, e: int) -> int:
    """The name of an edge that has one name only."""
    return e


def edges_at_both_ends(
    edge_vertices: Kernel, vertex_edges: Kernel, edge_of: Kernel = as_named
) -> Kernel:
    """Make the kernel ``edge_edges``: the edges at either end, without the edge itself.

    ``edge_of(m, h)`` is the name of an edge that may be asked for by more than one handle.
    """

    @kernel
    def edge_edges(m: Any, e: int, out: Array) -> int:
        edge_vertices(m, e, out)
        a, b = out[0], out[1]
        around = vertex_edges(m, a, out)
        name = e
        count = without(out, around, name)
        if count == around:
            name = edge_of(m, e)
            count = without(out, around, name)
        if count == around:  # the handle names two vertices that are not joined
            return 0
        return count + without(out[count:], vertex_edges(m, b, out[count:]), name)

    return edge_edges


@kernel
def reverse(out: Array, count: int) -> None:
    """Turn the first ``counts`` elements round, in place."""
    first, last = 0, count - 1
    while first < last:
        out[first], out[last] = out[last], out[first]
        first += 1
        last -= 1
