"""Half-edge mesh (HEM; thesis 2.4 and 3).

Every edge is split into two half-edges that run opposite ways, one in each of its faces::

              c                     a, b, c  counterclockwise from outside
            ╱   ╲                   h        the half-edge from a to b
      next ╱     ╲ next of next     origin   a
          ╱   f   ╲                 face     f
         b ◀───h── a                next     the half-edge from b to c
           ──twin─▶                 twin     the half-edge from b to a, in the face beyond

Invariants

- ``next`` of next of next of h is h, and all three have the same face.
- ``twin`` of twin of h is h; it starts where ``next`` of h starts. At the border it is -1.
- The half-edge of a vertex starts at it; that of a face lies in it. An unreferenced vertex has -1.
- Dead: a face has half-edge -1, a half-edge has face -1, a vertex has no position (NaN).

There is no previous (it is next of next) and no half-edge outside the border. An edge is named by
the smaller index of its two half-edges. Bytes per vertex with 8-byte references:
12 + 8 + 2 · 8 + 6 · 32 = 228 (thesis 7.4).
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numba import njit

from hem.arrays import Array
from hem.authoring import (
    EDGE_END,
    FACE_END,
    LEFT,
    REFERENCE_TYPES,
    RIGHT,
    A,
    B,
    C,
    D,
    Field,
    counted,
    in_slices,
    kernel,
    live,
    pair_half_edges,
    require,
    require_edges,
    require_of_vertices,
    require_one_fan,
    require_triangles,
    steps,
    walks,
)
from hem.contract import Look, Navigable
from hem.meshes import TriangleMesh
from hem.room import roomy, rows

ORIGIN, FACE, NEXT, TWIN = range(4)  # the columns of a half-edge


class HalfEdgeRecords(NamedTuple):
    """One row per record, so that one half-edge is one cache line."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_half_edge: Array  # (n_v,) one that leaves the vertex
    face_half_edge: Array  # (n_t,)
    half_edge: Array  # (3 n_t, 4) origin, face, next, twin
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Steps from a half-edge: four are recorded, the others follow ------------------------------------

origin, face, following, twin = steps.columns(HalfEdgeRecords, "half_edge", 4)
previous = steps.then(following, following)
tip, apex = steps.then(following, origin), steps.then(previous, origin)
names, others = steps.smaller_of_twins(twin), steps.others_of_triangle(following)
edge_of = names.here
leaving, within = steps.entries(HalfEdgeRecords, "vertex_half_edge", "face_half_edge")
ahead = steps.asking(HalfEdgeRecords, "half_edge")


@kernel
def clockwise(m: HalfEdgeRecords, h: int, v: int) -> int:
    """The next half-edge that leaves v."""
    twin = m.half_edge[np.uint64(h), TWIN]
    return m.half_edge[np.uint64(twin), NEXT] if twin >= 0 else -1


@kernel
def counterclockwise(m: HalfEdgeRecords, h: int, v: int) -> int:
    """The half-edge that leaves v before h."""
    return m.half_edge[previous(m, h), TWIN]


@kernel
def across(m: HalfEdgeRecords, h: int) -> int:
    """The face beyond h, or -1."""
    twin = m.half_edge[h, TWIN]
    return m.half_edge[twin, FACE] if twin >= 0 else -1


# The nine queries: O(1), those of a vertex and edge_edges O(n_ev) ---------------------------------

outgoing = walks.by_twins(leaving, twin, following, previous, ahead)

vertex_vertices = walks.each_and_last(outgoing, steps.ending(origin, tip), apex)
vertex_edges = walks.each_and_last(outgoing, names, previous)  # at the border it is the name
vertex_faces = walks.each(outgoing, steps.of_its_own(face))
edge_vertices = steps.ends(origin, tip)
edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges, edge_of)
edge_faces = steps.faces_beside(face, across)
face_vertices = walks.each_side(within, following, origin, ahead=ahead)
face_edges = walks.each_side(within, following, edge_of)
face_faces = walks.faces_across(within, following, across)


# What operations need to know, and what they change (see hem.authoring.operations) --------------

face_exists = steps.recorded(FACE_END, within)
edge_exists = steps.recorded(EDGE_END, face)
left_and_right = steps.left_first(twin, origin, tip)
diamond = steps.diamond_of(edge_vertices, left_and_right, face, apex)
ends_at, in_triangle = steps.ending_at(tip), steps.within_triangle(tip, apex)

# The half-edge that runs a → b, or -1; and one at a whose face has b.
find_half_edge = walks.found_by_steps(leaving, clockwise, ends_at, counterclockwise)
with_edge = walks.found_by_steps(leaving, clockwise, in_triangle, counterclockwise)
are_joined = walks.joined_by_steps(leaving, clockwise, ends_at, with_edge)
face_left_of = steps.left_face(find_half_edge, face)
edge_between = steps.between(find_half_edge, edge_of)
leaves_smallest = steps.from_smallest(following, origin)
clear_vertex = steps.clear_vertex


@kernel
def set_face(m: HalfEdgeRecords, f: int, g: int, h: int, i: int) -> None:
    """Make a face of three half-edges that follow each other."""
    m.face_half_edge[f] = g
    m.half_edge[g, FACE], m.half_edge[g, NEXT] = f, h
    m.half_edge[h, FACE], m.half_edge[h, NEXT] = f, i
    m.half_edge[i, FACE], m.half_edge[i, NEXT] = f, g


@kernel
def new_half_edges(m: HalfEdgeRecords, count: int) -> int:
    """Append so many half-edges, of which nothing is recorded yet -> the first."""
    first = m.counts[EDGE_END]
    m.counts[EDGE_END] = first + count
    return int(first)


@kernel
def set_half_edge(
    m: HalfEdgeRecords, h: int, origin: int, face: int, following: int, twin: int
) -> None:
    """Record all of a half-edge."""
    m.half_edge[h, ORIGIN], m.half_edge[h, FACE] = origin, face
    m.half_edge[h, NEXT], m.half_edge[h, TWIN] = following, twin


@kernel
def set_vertices(m: HalfEdgeRecords, h: int) -> None:
    """Let both ends of h have half-edges in its face."""
    m.vertex_half_edge[m.half_edge[h, ORIGIN]] = h
    m.vertex_half_edge[tip(m, h)] = m.half_edge[h, NEXT]


@kernel
def split_edge_records(m: HalfEdgeRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1): two half-edges of each face stay, one moves on, and three are new."""
    left, right = left_and_right(m, e)  # they stay with a and v
    on_left = -1  # the half of the edge from v to b
    if left >= 0:
        bc, ca = others(m, left)
        on_left = new_half_edges(m, 3)
        cv, vc = on_left + 1, on_left + 2
        set_half_edge(m, on_left, v, f, bc, -1)
        set_half_edge(m, cv, at[C], f, on_left, vc)
        set_half_edge(m, vc, v, at[LEFT], ca, cv)
        m.half_edge[left, NEXT] = vc
        m.half_edge[bc, FACE], m.half_edge[bc, NEXT] = f, cv
        m.face_half_edge[at[LEFT]], m.face_half_edge[f] = left, on_left
        m.vertex_half_edge[v], m.vertex_half_edge[at[B]] = on_left, bc
        f += 1
    if right >= 0:
        ad, db = others(m, right)
        on_right = new_half_edges(m, 3)
        vd, dv = on_right + 1, on_right + 2
        set_half_edge(m, on_right, at[B], f, vd, on_left)
        set_half_edge(m, vd, v, f, db, dv)
        set_half_edge(m, dv, at[D], at[RIGHT], right, vd)
        m.half_edge[right, ORIGIN], m.half_edge[ad, NEXT] = v, dv
        m.half_edge[db, FACE], m.half_edge[db, NEXT] = f, on_right
        m.face_half_edge[at[RIGHT]], m.face_half_edge[f] = right, on_right
        m.vertex_half_edge[at[B]], m.vertex_half_edge[v] = on_right, vd
        if on_left >= 0:
            m.half_edge[on_left, TWIN] = on_right


@kernel
def split_face_records(m: HalfEdgeRecords, face: int, v: int, f: int, corners: Array) -> None:
    """Cost O(1): each face keeps one half-edge of the old one and gets two."""
    ab = leaves_smallest(m, m.face_half_edge[face])
    bc, ca = others(m, ab)
    a, b, c = m.half_edge[ab, ORIGIN], m.half_edge[bc, ORIGIN], m.half_edge[ca, ORIGIN]
    corners[0], corners[1], corners[2] = a, b, c
    av = new_half_edges(m, 6)
    va, bv, vb, cv, vc = av + 1, av + 2, av + 3, av + 4, av + 5
    set_half_edge(m, av, a, f + 1, vc, va)
    set_half_edge(m, va, v, face, ab, av)
    set_half_edge(m, bv, b, face, va, vb)
    set_half_edge(m, vb, v, f, bc, bv)
    set_half_edge(m, cv, c, f, vb, vc)
    set_half_edge(m, vc, v, f + 1, ca, cv)
    m.half_edge[ab, NEXT] = bv
    m.half_edge[bc, FACE], m.half_edge[bc, NEXT] = f, cv
    m.half_edge[ca, FACE], m.half_edge[ca, NEXT] = f + 1, av
    m.face_half_edge[face], m.face_half_edge[f], m.face_half_edge[f + 1] = ab, bc, ca
    m.vertex_half_edge[v] = va


@kernel
def put(m: HalfEdgeRecords, h: int, into: int) -> None:
    """Move half-edge h, but not its twin, into another record."""
    v, face, before = m.half_edge[h, ORIGIN], m.half_edge[h, FACE], previous(m, h)
    for i in range(3):
        m.half_edge[into, i] = m.half_edge[h, i]
    m.half_edge[h, FACE] = -1
    m.half_edge[before, NEXT] = into
    if m.face_half_edge[face] == h:
        m.face_half_edge[face] = into
    if m.vertex_half_edge[v] == h:
        m.vertex_half_edge[v] = into


@kernel
def leave(m: HalfEdgeRecords, h: int) -> int:
    """Take h out of its edge, whose name stays -> the half-edge that is left of it, or -1."""
    twin = m.half_edge[h, TWIN]
    m.half_edge[h, FACE] = -1
    if twin < 0:
        return -1
    m.half_edge[twin, TWIN] = -1
    if twin < h:
        return twin
    put(m, twin, h)
    m.half_edge[h, TWIN] = -1
    return h


@kernel
def unite(m: HalfEdgeRecords, gone: int, stays: int) -> None:
    """Make one edge of two sides of a triangle that vanishes; what is beyond them meets there."""
    beyond = m.half_edge[gone, TWIN]
    m.half_edge[gone, FACE] = -1
    if beyond >= 0:
        put(m, beyond, stays)
    else:
        stays = leave(m, stays)
    set_vertices(m, stays)


@kernel
def collapse_records(
    m: HalfEdgeRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) for the half-edges that leave ``drop``."""
    left, right = left_and_right(m, e)
    inward, outward = (left, right) if drop == at[A] else (right, left)  # inward ends at keep
    for i in range(around):
        h = m.face_half_edge[out[i]]
        while m.half_edge[h, ORIGIN] != drop:
            h = m.half_edge[h, NEXT]
        m.half_edge[h, ORIGIN] = keep
    m.vertex_half_edge[drop] = -1
    for i in range(2):
        h = inward if i == 0 else outward
        if h < 0:
            continue
        after, last = others(m, h)
        m.half_edge[h, FACE] = -1
        m.face_half_edge[at[LEFT] if h == left else at[RIGHT]] = -1
        if i == 0:
            unite(m, last, after)
        else:
            unite(m, after, last)


@kernel
def flip_records(m: HalfEdgeRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1)."""
    ab, ba = left_and_right(m, e)
    (bc, ca), (ad, db) = others(m, ab), others(m, ba)
    m.half_edge[ab, ORIGIN], m.half_edge[ba, ORIGIN] = at[D], at[C]
    set_face(m, one, ad, ab, ca)
    set_face(m, other, bc, ba, db)
    m.vertex_half_edge[at[A]], m.vertex_half_edge[at[B]] = ad, bc


@kernel
def add_records(m: HalfEdgeRecords, corners: Array, f: int) -> None:
    """Cost O(n_ev)."""
    a, b, c = corners[0], corners[1], corners[2]
    ab, bc, ca = find_half_edge(m, b, a), find_half_edge(m, c, b), find_half_edge(m, a, c)
    g = new_half_edges(m, 3)
    h, i = g + 1, g + 2
    set_half_edge(m, g, a, f, h, ab)
    set_half_edge(m, h, b, f, i, bc)
    set_half_edge(m, i, c, f, g, ca)
    if ab >= 0:
        m.half_edge[ab, TWIN] = g
    if bc >= 0:
        m.half_edge[bc, TWIN] = h
    if ca >= 0:
        m.half_edge[ca, TWIN] = i
    m.face_half_edge[f] = g
    m.vertex_half_edge[a], m.vertex_half_edge[b], m.vertex_half_edge[c] = g, h, i


@kernel
def remove_records(m: HalfEdgeRecords, f: int) -> None:
    """Cost O(1)."""
    g = m.face_half_edge[f]
    h, i = others(m, g)
    for j in (g, h, i):
        m.vertex_half_edge[m.half_edge[j, ORIGIN]] = -1
    m.face_half_edge[f] = -1
    for j in (g, h, i):
        left = leave(m, j)
        if left >= 0:
            set_vertices(m, left)


@kernel
def set_vertex_face(m: HalfEdgeRecords, v: int, f: int) -> None:
    """Let v know of the face f at it. Cost O(1)."""
    h = m.face_half_edge[f]
    for _ in range(3):
        if m.half_edge[h, ORIGIN] == v:
            m.vertex_half_edge[v] = h
        h = m.half_edge[h, NEXT]


@njit(cache=True, nogil=True)
def _fill(
    begin: int, end: int, part: int, triangles: Array, twin: Array, face: Array, half_edge: Array
) -> None:
    """Half-edge 3f + i starts at corner i of triangle f."""
    for f in range(begin, end):
        face[f] = 3 * f
        for i in range(3):
            row = half_edge[3 * f + i]
            row[ORIGIN] = triangles[f, i]
            row[FACE] = f
            row[NEXT] = 3 * f + (i + 1) % 3
            row[TWIN] = twin[3 * f + i]


class HalfEdge(Navigable):
    """The half-edge mesh."""

    name, title, abbreviation = "half_edge", "Half-Edge", "HEM"
    look, thesis, order = Look("#c77f00", "D", "-"), True, 4
    records_type = HalfEdgeRecords
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True),
        Field("vertex.half_edge", "vertex_half_edge", target="half_edge", optional=True),
        Field("face.half_edge", "face_half_edge", target="half_edge", marks=True),
        Field("half_edge.origin", "half_edge", target="vertex"),
        Field("half_edge.face", "half_edge", target="face", marks=True),
        Field("half_edge.next", "half_edge", target="half_edge"),
        Field("half_edge.twin", "half_edge", target="half_edge", optional=True),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference, n = REFERENCE_TYPES[reference_bytes], len(mesh.triangles)
        face, half_edge = rows(n, dtype=reference), rows(3 * n, 4, dtype=reference)
        pairing = pair_half_edges(mesh, room=half_edge)
        in_slices(_fill, n, mesh.triangles, pairing.twin, face, half_edge)
        vertex = pairing.leaving(reference)
        count = counted(len(mesh.points), pairing.n_edges, n, 3 * n, valence=pairing.valence)
        return cls(HalfEdgeRecords(roomy(mesh.points), vertex, face, half_edge, count))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, half_edges = self.records, live(self.records, self.fields, "half_edge")
        leaving, f = m.vertex_half_edge[: len(self.points)], self.faces()
        origin, face, following, twin = m.half_edge[: len(half_edges)].T
        h, after = np.flatnonzero(half_edges), following[half_edges]
        edges = h[(twin[h] < 0) | (h < twin[h])]
        require_edges(m, origin[edges], origin[following[edges]], edges)
        require(after != h, "next is another half-edge", "half_edges", h)
        require_triangles(face, following, h, "half_edges", h)
        require(face[m.face_half_edge[f]] == f, "a face's half-edge lies in it", "faces", f)

        inner = h[twin[h] >= 0]
        other = twin[inner]
        paired = (other != inner) & (twin[other] == inner)
        require(paired, "twin of twin is the half-edge itself", "half_edges", inner)
        opposite = origin[other] == origin[following[inner]]
        opposite &= origin[following[other]] == origin[inner]
        words = "twins run opposite ways between the same vertices"
        require(opposite, words, "half_edges", inner)

        just = "just the vertices with faces have a half-edge"
        require_of_vertices(leaving, origin[:, None], h, just, "a vertex' half-edge starts at it")
        clockwise = np.full(len(half_edges), -1)
        clockwise[inner] = following[other]
        require_one_fan(origin, clockwise, h)
