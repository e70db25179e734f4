"""What follows from the steps between half-edges, written once for whatever records them.

Half-edges are what a structure takes for them: records of their own, or the two sides of an edge.
A step is ``step(m, h) -> handle``, such as ``following``, ``previous``, ``twin``, ``origin``,
``tip``, ``face``; ``apex`` is the third corner of the triangle that h lies in, and ``across`` the
face beyond it. A negative number is none.
"""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring.ahead import ask
from hem.authoring.kernels import Kernel, kernel
from hem.authoring.operations import LEFT, RIGHT, C, D
from hem.authoring.walks import Given


def place_of(records: type[Any], array: str) -> int:
    """Which of the ``records`` an array is. Raises TypeError, with the file, where it is none."""
    if array not in records._fields:
        here = f"{inspect.getfile(records)}: {records.__name__}"
        raise TypeError(f"{here} has no array {array!r}; there are {', '.join(records._fields)}")
    return int(records._fields.index(array))


def column(records: type[Any], array: str, which: int) -> Kernel:
    """Make ``read(m, it)``: one column of an array of the ``records``, a ``NamedTuple`` of them."""
    place = place_of(records, array)  # getattr would count references, for 15 ns a read

    @kernel
    def read(m: Any, it: int) -> int:
        return int(m[place][np.uint64(it), which])

    return read


def columns(records: type[Any], array: str, count: int) -> list[Kernel]:
    """Make ``read(m, it)`` of each of the first ``count`` columns."""
    return [column(records, array, which) for which in range(count)]


def entries(records: type[Any], *arrays: str) -> list[Kernel]:
    """Make ``read(m, it)`` of each of the arrays that hold one reference for every element."""

    def entry(place: int) -> Kernel:
        @kernel
        def read(m: Any, it: int) -> int:
            return int(m[place][np.uint64(it)])

        return read

    return [entry(place_of(records, array)) for array in arrays]


def asking(records: type[Any], array: str, items: int = 1) -> Kernel:
    """Make ``ahead(m, it)``: ask for the record that a pass over all reads some time after its.

    ``items``: how many share a record, as the two directions of an edge do. See
    ``hem.authoring.ahead``.
    """
    place = place_of(records, array)

    @kernel
    def ahead(m: Any, it: int) -> None:
        ask(m[place], it // items)

    return ahead


@kernel
def clear_vertex(m: Any, v: int) -> None:
    """See to it that vertex v has no faces, where its half-edge is recorded."""
    m.vertex_half_edge[v] = -1


def then(first: Kernel, second: Kernel) -> Kernel:
    """Make one step of two, of which the first always leads somewhere."""

    @kernel
    def both(m: Any, h: int) -> int:
        return int(second(m, first(m, h)))

    return both


def entering(step: Kernel, enter: Kernel) -> Kernel:
    """Make ``turn(m, h, v)``, which leaves v again, of a step to what is no half-edge yet.

    ``enter(m, it, v)`` is the half-edge that leaves v for what the step leads to.
    """

    @kernel
    def turn(m: Any, h: int, v: int) -> int:
        it = step(m, h)
        return enter(m, it, v) if it >= 0 else -1

    return turn


def others_of_triangle(following: Kernel) -> Kernel:
    """Make ``others(m, h)``: the two half-edges that come after h in its triangle."""

    @kernel
    def others(m: Any, h: int) -> tuple[int, int]:
        after = following(m, h)
        return after, following(m, after)

    return others


def smaller_of_twins(twin: Kernel) -> Given:
    """Make ``edge_of(m, h)``: the name of an edge is the smaller of its two half-edges."""

    @kernel
    def edge_of(m: Any, h: int) -> int:
        other = twin(m, h)
        return h if other < 0 else min(h, other)

    @kernel
    def smaller(m: Any, h: int, other: int) -> int:
        return min(h, other)

    return Given(edge_of, smaller)


def ending(origin: Kernel, tip: Kernel) -> Given:
    """The end of a half-edge, where its twin begins."""

    @kernel
    def beginning(m: Any, h: int, other: int) -> int:
        return int(origin(m, other))

    return Given(tip, beginning)


def of_its_own(give: Kernel) -> Given:
    """What a half-edge gives that its twin does not tell."""

    @kernel
    def beside(m: Any, h: int, other: int) -> int:
        return int(give(m, h))

    return Given(give, beside)


def recorded(end: int, mark: Kernel) -> Kernel:
    """Make ``exists(m, it)``: whether there is such a record, and ``mark(m, it)`` says it lives.

    ``end``: the column of ``counts`` that says how many records are in use.
    """

    @kernel
    def exists(m: Any, it: int) -> bool:
        return bool(0 <= it < m.counts[end] and mark(m, it) >= 0)

    return exists


def ends(origin: Kernel, tip: Kernel) -> Kernel:
    """Make ``edge_vertices`` of one end of an edge and the other: the smaller first. O(1)."""

    @kernel
    def edge_vertices(m: Any, e: int, out: Array) -> int:
        a, b = origin(m, e), tip(m, e)
        out[0], out[1] = min(a, b), max(a, b)
        return 2

    return edge_vertices


def faces_beside(face: Kernel, across: Kernel) -> Kernel:
    """Make ``edge_faces`` of the faces on both sides of an edge, of which one may be none. O(1)."""

    @kernel
    def edge_faces(m: Any, e: int, out: Array) -> int:
        here, there, count = face(m, e), across(m, e), 0
        if here >= 0:
            out[0] = here
            count = 1
        if there >= 0:
            out[count] = there
            count += 1
        return count

    return edge_faces


def left_first(twin: Kernel, origin: Kernel, tip: Kernel) -> Kernel:
    """Make ``left_and_right(m, e)``: first the half-edge from the smaller to the larger vertex."""

    @kernel
    def left_and_right(m: Any, e: int) -> tuple[int, int]:
        other = twin(m, e)
        return (e, other) if origin(m, e) < tip(m, e) else (other, e)

    return left_and_right


def diamond_of(edge_vertices: Kernel, left_and_right: Kernel, face: Kernel, apex: Kernel) -> Kernel:
    """Make ``diamond(m, e, at) -> faces`` where no half-edge lies outside the border. Cost O(1)."""

    @kernel
    def diamond(m: Any, e: int, at: Array) -> int:
        left, right = left_and_right(m, e)
        edge_vertices(m, e, at)
        at[LEFT], at[RIGHT], at[C], at[D] = -1, -1, -1, -1
        if left >= 0:
            at[LEFT], at[C] = face(m, left), apex(m, left)
        if right >= 0:
            at[RIGHT], at[D] = face(m, right), apex(m, right)
        return int(left >= 0) + int(right >= 0)  # where Python runs it, too: True and True is True

    return diamond


def ending_at(tip: Kernel) -> Kernel:
    """Make ``ends_at(m, h, v, w)``: whether h, which leaves v, ends at w."""

    @kernel
    def ends_at(m: Any, h: int, v: int, w: int) -> bool:
        return bool(tip(m, h) == w)

    return ends_at


def within_triangle(tip: Kernel, apex: Kernel) -> Kernel:
    """Make ``in_triangle(m, h, v, w)``: whether w is a corner of the face of h, which leaves v."""

    @kernel
    def in_triangle(m: Any, h: int, v: int, w: int) -> bool:
        return bool(tip(m, h) == w or apex(m, h) == w)

    return in_triangle


def between(find_half_edge: Kernel, edge_of: Kernel) -> Kernel:
    """Make ``edge_between(m, a, b)``: the edge between two vertices, or -1. Cost: that of finding.

    ``find_half_edge(m, a, b)`` finds the half-edge that runs a → b; one there may be the other way.
    """

    @kernel
    def edge_between(m: Any, a: int, b: int) -> int:
        h = find_half_edge(m, a, b)
        if h < 0:
            h = find_half_edge(m, b, a)
        return edge_of(m, h) if h >= 0 else -1

    return edge_between


def left_face(find: Kernel, face: Kernel) -> Kernel:
    """Make ``face_left_of(m, a, b)``: the face of the half-edge found from a to b, or -1."""

    @kernel
    def face_left_of(m: Any, a: int, b: int) -> int:
        h = find(m, a, b)
        return face(m, h) if h >= 0 else -1

    return face_left_of


def from_smallest(following: Kernel, origin: Kernel) -> Kernel:
    """Make ``smallest(m, h)``: the one in the triangle of h that leaves its smallest corner."""

    @kernel
    def smallest(m: Any, h: int) -> int:
        found = other = h
        for _ in range(2):
            other = following(m, other)
            if origin(m, other) < origin(m, found):
                found = other
        return found

    return smallest
