"""Walks around a vertex or a face, and the queries that follow: written once over the steps taken.

A circulator writes what is given by all that it comes past: ``circulate(m, element, out) -> (count,
last)``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import Kernel, append_face, kernel, without

Giving = Callable[[Kernel], Kernel]
"""Makes a circulator that writes what the kernel gives."""


def circulator(clockwise: Kernel, counterclockwise: Kernel) -> Giving:
    """Make, for ``give(m, item, v)``, ``around(m, start, v, out) -> (count, last)``.

    A step ``step(m, item, v)`` goes from one item at vertex ``v`` (a half-edge, an edge, a
    triangle) to the next, or to a negative number at the border. What the items give comes
    counterclockwise. A fan open at the border is circulated from both sides of ``start``; ``last``
    is its last item, and -1 where the fan is closed. Cost O(valence).
    """

    def giving(give: Kernel) -> Kernel:
        @kernel
        def around(m: Any, start: int, v: int, out: Array) -> tuple[int, int]:
            count, item = 0, start
            while item >= 0:  # what is given is written at once: to come back to it takes longer
                out[count] = give(m, item, v)
                count += 1
                item = clockwise(m, item, v)
                if item == start:
                    reverse(out, count)
                    return count, -1
            reverse(out, count)
            last = start
            item = counterclockwise(m, start, v) if count else -1
            while item >= 0:
                out[count] = give(m, item, v)
                count += 1
                last = item
                item = counterclockwise(m, item, v)
            return count, last

        return around

    return giving


@kernel
def as_met(m: Any, h: int, at: int) -> int:
    """What is met on the way around a vertex or a face, where that is what is wanted."""
    return h


def from_vertex(first: Kernel, around: Giving, enter: Kernel = as_met) -> Giving:
    """Make, for ``give(m, h)``, the circulator of a vertex that begins at ``first(m, v)``.

    ``enter(m, it, v)`` is the half-edge that leaves v for what ``first`` leads to. O(valence).
    """

    def giving(give: Kernel) -> Kernel:
        @kernel
        def give_of(m: Any, h: int, v: int) -> int:
            return give(m, h)

        walk = around(give_of)

        @kernel
        def circulate(m: Any, v: int, out: Array) -> tuple[int, int]:
            start = first(m, v)
            if start < 0:
                return 0, -1
            return walk(m, enter(m, start, v), v, out)

        return circulate

    return giving


def each(giving: Giving, give: Kernel) -> Kernel:
    """Make a query: what is given by every half-edge that a circulator comes past."""
    circulate = giving(give)

    @kernel
    def query(m: Any, element: int, out: Array) -> int:
        count, _ = circulate(m, element, out)
        return count

    return query


def each_but_last(giving: Giving, give: Kernel) -> Kernel:
    """Make a query as ``each``, without the last half-edge if a fan is open.

    It leaves the vertex along the border, and has no face.
    """
    circulate = giving(give)

    @kernel
    def query(m: Any, v: int, out: Array) -> int:
        count, last = circulate(m, v, out)
        return count if last < 0 else count - 1

    return query


def each_and_last(giving: Giving, give: Kernel, last_of: Kernel) -> Kernel:
    """Make a query as ``each``, with ``last_of(m, h)`` of the last half-edge if a fan is open.

    No half-edge leaves the vertex beyond it, but the edge and the neighbor are there.
    """
    circulate = giving(give)

    @kernel
    def query(m: Any, v: int, out: Array) -> int:
        count, last = circulate(m, v, out)
        if last < 0:
            return count
        out[count] = last_of(m, last)
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
