"""Walks around a vertex or a face, and the queries that follow: written once over the steps taken.

A circulator writes all that it comes past: ``circulate(m, element, out) -> (count, closed)``.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import Kernel, append_face, kernel, without


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


@kernel
def as_met(m: Any, h: int, at: int) -> int:
    """What is met on the way around a vertex or a face, where that is a half-edge already."""
    return h


def from_vertex(first: Kernel, around: Kernel, enter: Kernel = as_met) -> Kernel:
    """Make the circulator of a vertex that begins at ``first(m, v)``. Cost O(valence).

    ``enter(m, it, v)`` is the half-edge that leaves v for what ``first`` leads to.
    """

    @kernel
    def circulate(m: Any, v: int, out: Array) -> tuple[int, bool]:
        start = first(m, v)
        if start < 0:
            return 0, True
        return around(m, enter(m, start, v), v, out)

    return circulate


def each(circulate: Kernel, give: Kernel) -> Kernel:
    """Make a query: ``give(m, h)`` of every half-edge that the circulator comes past."""

    @kernel
    def query(m: Any, element: int, out: Array) -> int:
        count, _ = circulate(m, element, out)
        for i in range(count):
            out[i] = give(m, out[i])
        return count

    return query


def each_but_last(circulate: Kernel, give: Kernel) -> Kernel:
    """Make a query as ``each``, without the last half-edge if a fan is open.

    It leaves the vertex along the border, and has no face.
    """

    @kernel
    def query(m: Any, v: int, out: Array) -> int:
        count, closed = circulate(m, v, out)
        faces = count if closed else count - 1
        for i in range(faces):
            out[i] = give(m, out[i])
        return faces

    return query


def each_and_last(circulate: Kernel, give: Kernel, last: Kernel) -> Kernel:
    """Make a query as ``each``, with ``last(m, h)`` of the last half-edge too if a fan is open.

    No half-edge leaves the vertex beyond it, but the edge and the neighbor are there.
    """

    @kernel
    def query(m: Any, v: int, out: Array) -> int:
        count, closed = circulate(m, v, out)
        h = out[count - 1]
        for i in range(count):
            out[i] = give(m, out[i])
        if closed or count == 0:
            return count
        out[count] = last(m, h)
        return count + 1

    return query


def each_side(first: Kernel, following: Kernel, give: Kernel, enter: Kernel = as_met) -> Kernel:
    """Make a query of a triangle: ``give(m, h)`` of its half-edges from ``first(m, f)``. O(1).

    ``enter(m, it, f)`` is the half-edge in f of what ``first`` and ``following(m, h)`` lead to.
    """

    @kernel
    def query(m: Any, f: int, out: Array) -> int:
        it = first(m, f)
        for i in range(3):
            h = enter(m, it, f)
            out[i] = give(m, h)
            it = following(m, h)
        return 3

    return query


def faces_across(
    first: Kernel, following: Kernel, across: Kernel, enter: Kernel = as_met
) -> Kernel:
    """Make ``face_faces`` as ``each_side``: ``across(m, h)`` is the face beyond h, or -1."""

    @kernel
    def face_faces(m: Any, f: int, out: Array) -> int:
        it, count = first(m, f), 0
        for _ in range(3):
            h = enter(m, it, f)
            face = across(m, h)
            if face >= 0:
                count = append_face(out, count, face)
            it = following(m, h)
        return count

    return face_faces


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


@kernel
def reverse(out: Array, count: int) -> None:
    """Turn the first ``counts`` elements round, in place."""
    first, last = 0, count - 1
    while first < last:
        out[first], out[last] = out[last], out[first]
        first += 1
        last -= 1
