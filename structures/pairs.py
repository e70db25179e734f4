"""Plankton's half-edges: by index, in pairs, with borders and polygons (the article on Plankton).

The half-edges 2k and 2k + 1 are the two sides of an edge, so that neither has to store the other::

              c                     a, b, c   counterclockwise from outside
            ╱   ╲                   h         the half-edge from a to b
      next ╱     ╲ previous         start     a
          ╱   f   ╲                 face      f, or -1 outside the border
         b ◀───h── a                next      the half-edge from b on, in the same face
           ──pair─▶                 previous  the half-edge that leads to a, in the same face
                                    pair      h ^ 1, the half-edge from b to a

Invariants

- ``next`` of ``previous`` of h is h, and so the other way round; both have the face of h.
- ``next`` of h starts where the pair of h does. An edge has a face on one side at least.
- The half-edges of a face run round it once, past three corners or more.
- Those without a face run round a hole: a vertex on the border has just one of them leave it, and
  that is the vertex' own half-edge. An unreferenced vertex has -1.
- Dead: a face has half-edge -1, a half-edge has start -1 (so has its pair), a vertex no position.

Whoever steps around a vertex comes round even at the border, which takes no second direction. An
edge is named by its half-edge 2k. Bytes per vertex of a closed mesh of triangles, with 8-byte
references: 12 + 8 + 2 · 8 + 6 · 32 = 228, as many as those of the half-edge mesh.

The mesh itself stands in ``structures.plankton``, what is done with polygons in
``structures.polygons``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from hem.arrays import Array
from hem.authoring import (
    EDGE_END,
    FACE_END,
    LEFT,
    RIGHT,
    A,
    B,
    C,
    D,
    Kernel,
    append_face,
    distinct,
    kernel,
    steps,
    walks,
    without,
)

START, FACE, NEXT, PREVIOUS = range(4)  # the columns of a half-edge

OUTSIDE = -1
"""The face of a half-edge along a hole."""


class PlanktonRecords(NamedTuple):
    """One row per record; the two half-edges of an edge lie side by side."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_half_edge: Array  # (n_v,) one that leaves the vertex, along the border if it lies there
    face_half_edge: Array  # (n_f,) the first
    half_edge: Array  # (2 n_e, 4) start, face, next, previous
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Steps from a half-edge ---------------------------------------------------------------------------

# Outside the border a half-edge has no face, and next and previous run along it.
origin, face, following, previous = steps.columns(PlanktonRecords, "half_edge", 4)


@kernel
def twin(m: PlanktonRecords, h: int) -> int:
    """The other half-edge of the same edge."""
    return h ^ 1


@kernel
def edge_of(m: PlanktonRecords, h: int) -> int:
    """The name of h's edge."""
    return h - (h & 1)


@kernel
def counterclockwise(m: PlanktonRecords, h: int) -> int:
    """The half-edge that leaves the same vertex after h."""
    return m.half_edge[h, PREVIOUS] ^ 1


@kernel
def clockwise(m: PlanktonRecords, h: int, v: int) -> int:
    """The half-edge that leaves v before h."""
    return m.half_edge[h ^ 1, NEXT]


tip, across = steps.then(twin, origin), steps.then(twin, face)
leaving, within = steps.entries(PlanktonRecords, "vertex_half_edge", "face_half_edge")
ahead = steps.asking(PlanktonRecords, "half_edge")


# The nine queries: O(1), around a vertex O(n_ev), around a face O(n) for n corners ----------------


@kernel
def is_open(m: PlanktonRecords, v: int) -> bool:
    """Whether a vertex that has faces lies on the border: it leaves along the border then."""
    return bool(face(m, m.vertex_half_edge[v]) < 0)


def around_vertex(give: Kernel) -> Kernel:
    """Make a query: ``give(m, h)`` of every half-edge that leaves a vertex, counterclockwise.

    None is given where it is negative.
    """

    def visiting(way: walks.Way) -> Kernel:
        visit, asks = way.visit, way.asking(ahead)

        @kernel
        def visit_all(m: PlanktonRecords, v: int, state: Any, given: Any) -> tuple[Any, bool]:
            first = m.vertex_half_edge[v]
            h = first
            while h >= 0:
                h = counterclockwise(m, h)
                asks(m, h)
                found = give(m, h)
                if found >= 0:
                    state = visit(m, found, state, given)
                if h == first:
                    break
            return state, False

        return visit_all

    return walks.query_of(visiting, is_open)


def round_face(give: Kernel) -> Kernel:
    """Make a query: ``give(m, h)`` of every half-edge of a face, from its first."""

    def visiting(way: walks.Way) -> Kernel:
        visit, asks = way.visit, way.asking(ahead)

        @kernel
        def visit_all(m: PlanktonRecords, f: int, state: Any, given: Any) -> tuple[Any, bool]:
            first = m.face_half_edge[f]
            h = first
            asks(m, h)
            while True:
                state = visit(m, give(m, h), state, given)
                h = m.half_edge[h, NEXT]
                if h == first:
                    return state, False

        return visit_all

    return walks.query_of(visiting)


vertex_vertices, vertex_edges = around_vertex(tip), around_vertex(edge_of)
vertex_faces = around_vertex(face)
edge_vertices, edge_faces = steps.ends(origin, tip), steps.faces_beside(face, across)
face_vertices, face_edges = round_face(origin), round_face(edge_of)


@kernel
def edge_edges(m: PlanktonRecords, e: int, out: Array) -> int:
    """The edges at either end, without the edge itself. Cost O(n_ev)."""
    a, b = m.half_edge[e, START], tip(m, e)
    count = without(out, vertex_edges(m, a, out), edge_of(m, e))
    rest = out[count:]
    return count + without(rest, vertex_edges(m, b, rest), edge_of(m, e))


@kernel
def face_faces(m: PlanktonRecords, f: int, out: Array) -> int:
    """Those that share an edge with f, each once."""
    first = m.face_half_edge[f]
    h, count, sides = first, 0, 0
    while True:
        face = across(m, h)
        if face >= 0:
            count = append_face(out, count, face)
        sides += 1
        h = m.half_edge[h, NEXT]
        if h == first:
            # Polygons may share edges that do not follow each other; of a triangle just these two.
            if sides == 3:
                return count - (count == 3 and out[0] == out[2])
            return distinct(out, count)


# What operations need to know, and what they change (see hem.authoring.operations) --------------


@kernel
def sides(m: PlanktonRecords, f: int) -> int:
    """How many corners face f has."""
    first, count = m.face_half_edge[f], 0
    h = first
    while True:
        count += 1
        h = m.half_edge[h, NEXT]
        if h == first:
            return count


face_exists = steps.recorded(FACE_END, within)
edge_exists = steps.recorded(EDGE_END, origin)


@kernel
def from_smaller(m: PlanktonRecords, e: int) -> int:
    """The half-edge of e that runs from its smaller to its larger vertex."""
    return e if m.half_edge[e, START] < tip(m, e) else e ^ 1


@kernel
def is_triangle(m: PlanktonRecords, h: int) -> bool:
    """Whether the loop of h is one of three."""
    return m.half_edge[m.half_edge[h, PREVIOUS], PREVIOUS] == m.half_edge[h, NEXT]


@kernel
def apex(m: PlanktonRecords, h: int) -> int:
    """The corner across h in its face; -1 where there is no face, or one of more corners."""
    if m.half_edge[h, FACE] < 0 or not is_triangle(m, h):
        return -1
    return m.half_edge[m.half_edge[h, PREVIOUS], START]


@kernel
def diamond(m: PlanktonRecords, e: int, at: Array) -> int:
    """Cost O(1)."""
    h = from_smaller(m, e)
    at[A], at[B] = m.half_edge[h, START], tip(m, h)
    at[LEFT], at[RIGHT] = m.half_edge[h, FACE], m.half_edge[h ^ 1, FACE]
    at[C], at[D] = apex(m, h), apex(m, h ^ 1)
    return (at[LEFT] >= 0) + (at[RIGHT] >= 0)


@kernel
def find_half_edge(m: PlanktonRecords, a: int, b: int) -> int:
    """The half-edge that runs a → b, or -1. Cost O(n_ev)."""
    start = m.vertex_half_edge[a]
    h = start
    while h >= 0:
        if tip(m, h) == b:
            return h
        h = counterclockwise(m, h)
        if h == start:
            break
    return -1


ends_at = steps.ending_at(tip)
are_joined = walks.joined_by_steps(leaving, clockwise, ends_at, find_half_edge)
face_left_of = steps.left_face(find_half_edge, face)
edge_between = steps.between(find_half_edge, edge_of)
clear_vertex = steps.clear_vertex


@kernel
def link(m: PlanktonRecords, g: int, h: int) -> None:
    """Let h follow g."""
    m.half_edge[g, NEXT], m.half_edge[h, PREVIOUS] = h, g


@kernel
def new_pair(m: PlanktonRecords, a: int, b: int) -> int:
    """Append an edge that is not linked yet, with no faces -> its half-edge from a to b."""
    h = m.counts[EDGE_END]
    m.half_edge[h, START], m.half_edge[h, FACE] = a, OUTSIDE
    m.half_edge[h + 1, START], m.half_edge[h + 1, FACE] = b, OUTSIDE
    m.counts[EDGE_END] += 2
    return int(h)


@kernel
def kill(m: PlanktonRecords, h: int) -> None:
    """Make an edge dead."""
    m.half_edge[h, START], m.half_edge[h ^ 1, START] = -1, -1
    m.half_edge[h, FACE], m.half_edge[h ^ 1, FACE] = OUTSIDE, OUTSIDE


@kernel
def set_face(m: PlanktonRecords, f: int, g: int, h: int, i: int) -> None:
    """Make a triangle of three half-edges."""
    m.face_half_edge[f] = g
    link(m, g, h)
    link(m, h, i)
    link(m, i, g)
    m.half_edge[g, FACE], m.half_edge[h, FACE], m.half_edge[i, FACE] = f, f, f


@kernel
def insert(m: PlanktonRecords, h: int, v: int) -> int:
    """Put vertex v on the edge of h, which ends there then -> the half-edge from v on.

    Both faces have a corner more.
    """
    b, other = tip(m, h), h ^ 1
    onward = new_pair(m, v, b)
    back = onward ^ 1
    following, before = m.half_edge[h, NEXT], m.half_edge[other, PREVIOUS]
    m.half_edge[other, START] = v
    m.half_edge[onward, FACE] = m.half_edge[h, FACE]
    m.half_edge[back, FACE] = m.half_edge[other, FACE]
    link(m, onward, following)
    link(m, h, onward)
    link(m, before, back)
    link(m, back, other)
    if m.vertex_half_edge[b] == other:
        m.vertex_half_edge[b] = back
    m.vertex_half_edge[v] = other if m.half_edge[other, FACE] < 0 else onward
    return onward


@kernel
def split_edge_records(m: PlanktonRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1): a vertex on the edge, and in each face a diagonal from it."""
    left = from_smaller(m, e)
    right = left ^ 1
    onward = insert(m, left, v)
    for h in (left, onward ^ 1):
        face = m.half_edge[h, FACE]
        if face < 0:
            continue
        if h == left:  # a → v → b → c
            va, vb, bc, ca = left, onward, m.half_edge[onward, NEXT], m.half_edge[left, PREVIOUS]
            vc = new_pair(m, v, at[C])
            set_face(m, face, va, vc, ca)
            set_face(m, f, vb, bc, vc ^ 1)
        else:  # b → v → a → d
            ad, db = m.half_edge[right, NEXT], m.half_edge[h, PREVIOUS]
            vd = new_pair(m, v, at[D])
            set_face(m, face, right, ad, vd ^ 1)
            set_face(m, f, h, vd, db)
        f += 1


@kernel
def split_face_records(m: PlanktonRecords, face: int, v: int, f: int, corners: Array) -> None:
    """Cost O(1) for a triangle, O(n) for n corners: an edge from every corner to v."""
    smallest, count = m.face_half_edge[face], 1
    h = m.half_edge[smallest, NEXT]
    while h != m.face_half_edge[face]:
        if m.half_edge[h, START] < m.half_edge[smallest, START]:
            smallest = h
        h = m.half_edge[h, NEXT]
        count += 1
    spoke = m.counts[EDGE_END]
    h = smallest
    for i in range(count):
        corners[i] = m.half_edge[h, START]
        new_pair(m, corners[i], v)
        h = m.half_edge[h, NEXT]
    for i in range(count):
        inward = spoke + 2 * ((i + 1) % count)
        after = m.half_edge[h, NEXT]
        set_face(m, face if i == 0 else f + i - 1, h, inward, spoke + 2 * i + 1)
        h = after
    m.vertex_half_edge[v] = spoke + 1


@kernel
def take_place(m: PlanktonRecords, h: int, of: int) -> None:
    """Let h run in the loop of another half-edge instead of that one."""
    face = m.half_edge[of, FACE]
    m.half_edge[h, FACE] = face
    link(m, m.half_edge[of, PREVIOUS], h)
    link(m, h, m.half_edge[of, NEXT])
    if face >= 0 and m.face_half_edge[face] == of:
        m.face_half_edge[face] = h


@kernel
def leave_loop(m: PlanktonRecords, h: int) -> None:
    """Take h out of its loop, which closes behind it."""
    face = m.half_edge[h, FACE]
    if face >= 0 and m.face_half_edge[face] == h:
        m.face_half_edge[face] = m.half_edge[h, NEXT]
    link(m, m.half_edge[h, PREVIOUS], m.half_edge[h, NEXT])


@kernel
def settle(m: PlanktonRecords, v: int, leaving: int) -> None:
    """Give v its half-edge, given any that leaves it: along the border where it lies there."""
    m.vertex_half_edge[v] = leaving
    h = leaving
    while True:
        if m.half_edge[h, FACE] < 0:
            m.vertex_half_edge[v] = h
        h = counterclockwise(m, h)
        if h == leaving:
            return


@kernel
def collapse_records(
    m: PlanktonRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) for the half-edges that leave both ends."""
    inward = e if tip(m, e) == keep else e ^ 1  # drop → keep
    outward = inward ^ 1
    x_triangle, y_triangle = apex(m, inward) >= 0, apex(m, outward) >= 0
    start = m.vertex_half_edge[drop]
    h = start
    while True:
        m.half_edge[h, START] = keep
        h = counterclockwise(m, h)
        if h == start:
            break
    to_x, from_x = m.half_edge[inward, NEXT], m.half_edge[inward, PREVIOUS]
    to_y, from_y = m.half_edge[outward, NEXT], m.half_edge[outward, PREVIOUS]
    leave_loop(m, inward)
    leave_loop(m, outward)
    if x_triangle:  # the edge that keep has stays, the one that drop had goes
        m.face_half_edge[m.half_edge[to_x, FACE]] = -1
        x = m.half_edge[from_x, START]
        if m.vertex_half_edge[x] == from_x:
            m.vertex_half_edge[x] = to_x ^ 1
        take_place(m, to_x, from_x ^ 1)
        kill(m, from_x)
    if y_triangle:
        m.face_half_edge[m.half_edge[from_y, FACE]] = -1
        y = m.half_edge[from_y, START]
        if m.vertex_half_edge[y] == to_y ^ 1:
            m.vertex_half_edge[y] = from_y
        take_place(m, from_y, to_y ^ 1)
        kill(m, to_y)
    kill(m, inward)
    m.vertex_half_edge[drop] = -1
    settle(m, keep, to_x)


@kernel
def flip_records(m: PlanktonRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1)."""
    ab = from_smaller(m, e)
    ba = ab ^ 1
    bc, ca = m.half_edge[ab, NEXT], m.half_edge[ab, PREVIOUS]
    ad, db = m.half_edge[ba, NEXT], m.half_edge[ba, PREVIOUS]
    m.half_edge[ab, START], m.half_edge[ba, START] = at[D], at[C]
    set_face(m, one, ad, ab, ca)
    set_face(m, other, bc, ba, db)
    if m.vertex_half_edge[at[A]] == ab:
        m.vertex_half_edge[at[A]] = ad
    if m.vertex_half_edge[at[B]] == ba:
        m.vertex_half_edge[at[B]] = bc


@kernel
def add_records(m: PlanktonRecords, corners: Array, f: int) -> None:
    """Cost O(n_ev) per corner. Every corner is free or shares an edge with the surface."""
    n, old = len(corners), m.counts[EDGE_END]
    side = np.empty(n, np.int64)
    for i in range(n):
        a, b = corners[i], corners[(i + 1) % n]
        h = find_half_edge(m, a, b)
        side[i] = h if h >= 0 else new_pair(m, a, b)
    for i in range(n):  # around the outside, past each corner
        g, h = side[i], side[(i + 1) % n]
        v = corners[(i + 1) % n]
        if g >= old and h >= old:
            link(m, h ^ 1, g ^ 1)
        elif g >= old:
            link(m, m.half_edge[h, PREVIOUS], g ^ 1)
        elif h >= old:
            link(m, h ^ 1, m.half_edge[g, NEXT])
        if g >= old:
            m.vertex_half_edge[v] = g ^ 1
    for i in range(n):
        link(m, side[i], side[(i + 1) % n])
        m.half_edge[side[i], FACE] = f
    m.face_half_edge[f] = side[0]


@kernel
def remove_records(m: PlanktonRecords, f: int) -> None:
    """Cost O(1) for a triangle, O(n) for n corners."""
    begin = m.face_half_edge[f]
    m.face_half_edge[f] = -1
    h = begin
    while True:  # past the corner between h and the half-edge that follows
        following = m.half_edge[h, NEXT]
        v = m.half_edge[following, START]
        goes, next_goes = m.half_edge[h ^ 1, FACE] < 0, m.half_edge[following ^ 1, FACE] < 0
        if goes and next_goes:
            # Border ran into v on one side of the face and out of it on the other.
            into, out = m.half_edge[h ^ 1, PREVIOUS], m.half_edge[following ^ 1, NEXT]
            m.vertex_half_edge[v] = -1
            if into != following ^ 1:  # faces that meet this one in v alone
                link(m, into, out)
                m.vertex_half_edge[v] = out
        elif goes:
            link(m, m.half_edge[h ^ 1, PREVIOUS], following)
            m.vertex_half_edge[v] = following
        elif next_goes:
            link(m, h, m.half_edge[following ^ 1, NEXT])
        else:
            m.vertex_half_edge[v] = following
        m.half_edge[h, FACE] = OUTSIDE
        if goes and h != begin:
            kill(m, h)
        if following == begin:
            break
        h = following
    if m.half_edge[begin ^ 1, FACE] < 0:
        kill(m, begin)


@kernel
def set_vertex_face(m: PlanktonRecords, v: int, f: int) -> None:
    """It knows of it: also past holes its half-edges lead on to all of its faces."""


# Building ----------------------------------------------------------------------------------------


@njit(cache=True, nogil=True)
def keep_last(corner_vertex: Array, half: Array, vertex: Array) -> None:
    """Let every vertex keep the half-edge at its last corner.

    So does Plankton when it adds the faces in order.
    """
    for corner in range(len(half)):
        vertex[corner_vertex[corner]] = half[corner]


@njit(cache=True, nogil=True)
def fill(
    begin: int, end: int, part: int, corners: Array, half: Array, face: Array, half_edge: Array
) -> None:
    """Half-edges of triangles."""
    for f in range(begin, end):
        face[f] = half[3 * f]
        for i in range(3):
            row = half_edge[half[3 * f + i]]
            row[START] = corners[3 * f + i]
            row[FACE] = f
            row[NEXT] = half[3 * f + (i + 1) % 3]
            row[PREVIOUS] = half[3 * f + (i + 2) % 3]


@njit(cache=True, nogil=True)
def fill_polygons(
    begin: int,
    end: int,
    part: int,
    corners: Array,
    offsets: Array,
    half: Array,
    face: Array,
    half_edge: Array,
) -> None:
    """Half-edges of faces with any number of corners."""
    for f in range(begin, end):
        first, last = offsets[f], offsets[f + 1] - 1
        face[f] = half[first]
        for i in range(first, last + 1):
            row = half_edge[half[i]]
            row[START] = corners[i]
            row[FACE] = f
            row[NEXT] = half[i + 1 if i < last else first]
            row[PREVIOUS] = half[i - 1 if i > first else last]


@njit(cache=True, nogil=True)
def go_round_holes(inner: Array, vertex: Array, half_edge: Array) -> None:
    """Fill in the half-edges beyond those in ``inner``: they lie on the border."""
    for h in inner:
        border = h ^ 1
        half_edge[border, START] = half_edge[half_edge[h, NEXT], START]
        half_edge[border, FACE] = OUTSIDE
        vertex[half_edge[border, START]] = border
    for h in inner:
        border = h ^ 1
        following = vertex[half_edge[h, START]]
        half_edge[border, NEXT], half_edge[following, PREVIOUS] = following, border
