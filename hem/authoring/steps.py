"""What follows from the steps between half-edges, written once for whatever records them.

Half-edges are what a structure takes for them: records of their own, or the two sides of an edge.
A step is ``step(m, h) -> handle``, such as ``following``, ``previous``, ``twin``, ``origin``,
``tip``, ``face``; ``apex`` is the third corner of the triangle that h lies in, and ``across`` the
face beyond it. A negative number is none.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import Kernel, kernel
from hem.authoring.operations import LEFT, RIGHT, C, D


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


def then(first: Kernel, second: Kernel) -> Kernel:
    """Make one step of two, of which the first always leads somewhere."""

    @kernel
    def both(m: Any, h: int) -> int:
        return int(second(m, first(m, h)))

    return both


def smaller_of_twins(twin: Kernel) -> Kernel:
    """Make ``edge_of(m, h)``: the name of an edge is the smaller of its two half-edges."""

    @kernel
    def edge_of(m: Any, h: int) -> int:
        other = twin(m, h)
        return h if other < 0 else min(h, other)

    return edge_of


def recorded(end: int, mark: Kernel) -> Kernel:
    """Make ``exists(m, it)``: whether there is such a record, and ``mark(m, it)`` says it lives.

    ``end``: the column of ``counts`` that says how many records are in use.
    """

    @kernel
    def exists(m: Any, it: int) -> bool:
        return bool(0 <= it < m.counts[end] and mark(m, it) >= 0)

    return exists


def ends(origin: Kernel, tip: Kernel) -> Kernel:
    """Make ``edge_vertices`` of an edge that is named by a half-edge. Cost O(1)."""

    @kernel
    def edge_vertices(m: Any, e: int, out: Array) -> int:
        a, b = origin(m, e), tip(m, e)
        out[0], out[1] = min(a, b), max(a, b)
        return 2

    return edge_vertices


def faces_beside(face: Kernel, across: Kernel) -> Kernel:
    """Make ``edge_faces`` of an edge that is named by a half-edge in a face. Cost O(1)."""

    @kernel
    def edge_faces(m: Any, e: int, out: Array) -> int:
        out[0] = face(m, e)
        beyond = across(m, e)
        if beyond < 0:
            return 1
        out[1] = beyond
        return 2

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
        return (left >= 0) + (right >= 0)

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
