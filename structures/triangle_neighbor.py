"""Triangle-neighbor structure (TNS; thesis 2.4.1): every triangle knows the three beyond its edges.

::

              v2                  v0, v1, v2   the corners, counterclockwise from outside
             ╱  ╲                 n0           the triangle beyond edge v0 → v1
        n2  ╱    ╲  n1            n1           beyond v1 → v2
           ╱      ╲               n2           beyond v2 → v0
         v0 ────── v1
              n0

Invariants

- If u is beyond edge a → b of t, then t is beyond edge b → a of u. At the border there is -1.
- The triangle of a vertex has it as a corner. An unreferenced vertex has -1.
- Dead: a triangle has corners -1, a vertex has no position (NaN).

Who walks around a vertex must find it again among the corners of every triangle on the way. An edge
is named by its two vertices. Bytes per vertex with 8-byte references: 12 + 8 + 2 · 48 = 116
(thesis 7.2). Source: Shirley & Marschner, Fundamentals of Computer Graphics (2010), p. 269.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
from numba import njit

from hem.arrays import Array
from hem.authoring import (
    FACE_END,
    LEFT,
    REFERENCE_TYPES,
    RIGHT,
    A,
    B,
    C,
    D,
    Field,
    Kernel,
    append_face,
    counted,
    in_slices,
    kernel,
    live,
    packed,
    pair_half_edges,
    require,
    require_edges,
    require_of_vertices,
    require_one_fan,
    steps,
    walks,
)
from hem.contract import Look, PackedEdges
from hem.meshes import TriangleMesh
from hem.room import roomy, rows

NEIGHBOR, CORNER = 0, 3  # the first of three columns each


class TriangleNeighborRecords(NamedTuple):
    """One row per record."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_triangle: Array  # (n_v,) one of the triangles at the vertex
    triangle: Array  # (n_t, 6) three neighbors, three corners
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Nothing is recorded of an edge.
edge_exists, edge_vertices, pack = packed.edge_exists, packed.edge_vertices, packed.pack


@kernel
def corner_of(m: TriangleNeighborRecords, t: int, v: int) -> int:
    """Which corner of triangle t vertex v is: 0, 1 or 2."""
    if m.triangle[t, CORNER] == v:
        return 0
    return 1 if m.triangle[t, CORNER + 1] == v else 2


@kernel
def clockwise(m: TriangleNeighborRecords, t: int, v: int) -> int:
    """The next triangle at v: beyond the edge that leaves v."""
    return m.triangle[t, NEIGHBOR + corner_of(m, t, v)]


@kernel
def counterclockwise(m: TriangleNeighborRecords, t: int, v: int) -> int:
    """The triangle at v before t: beyond the edge that enters v."""
    return m.triangle[t, NEIGHBOR + (corner_of(m, t, v) + 2) % 3]


(first,) = steps.entries(TriangleNeighborRecords, "vertex_triangle")
ahead = steps.asking(TriangleNeighborRecords, "triangle")
around = walks.circulator(clockwise, counterclockwise, ahead)


@kernel
def corner_after(m: TriangleNeighborRecords, t: int, v: int) -> int:
    """The corner of triangle t after v."""
    return m.triangle[t, CORNER + (corner_of(m, t, v) + 1) % 3]


def neighbors(way: walks.Way) -> Kernel:
    """Make the circulator of the vertices around one; an open fan has one more than triangles."""
    circulate, visit = around(corner_after, way), way.visit

    @kernel
    def visit_all(m: TriangleNeighborRecords, v: int, state: Any, given: Any) -> tuple[Any, bool]:
        state, last = circulate(m, m.vertex_triangle[v], v, state, given)
        if last >= 0:
            before = m.triangle[last, CORNER + (corner_of(m, last, v) + 2) % 3]
            state = visit(m, before, state, given)
        return state, last >= 0

    return visit_all


vertex_vertices = walks.query_of(neighbors)  # cost O(n_ev), as the next two
vertex_edges = packed.vertex_edges(vertex_vertices)
vertex_faces = walks.each(walks.from_vertex(first, around), walks.as_named)
edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges)


@kernel
def edge_faces(m: TriangleNeighborRecords, e: int, out: Array) -> int:
    """Cost O(n_ev): the triangles at one end are searched for the other."""
    a, b = e >> 32, e & 0xFFFFFFFF
    count = 0
    for k in range(vertex_faces(m, a, out)):
        t = out[k]
        if b == m.triangle[t, CORNER + corner_of(m, t, b)]:
            out[count] = t
            count += 1
    return count


@kernel
def corner(m: TriangleNeighborRecords, f: int, i: int) -> int:
    """Corner i of triangle f."""
    return m.triangle[f, CORNER + i]


face_vertices, face_edges = packed.face_vertices(corner, ahead), packed.face_edges(corner)


@kernel
def face_faces(m: TriangleNeighborRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    count = 0
    for i in range(3):
        neighbor = m.triangle[f, NEIGHBOR + i]
        if neighbor >= 0:
            count = append_face(out, count, neighbor)
    return count


# What operations need to know, and what they change (see hem.authoring.operations) --------------


face_exists = steps.recorded(FACE_END, steps.column(TriangleNeighborRecords, "triangle", CORNER))


@kernel
def in_triangle(m: TriangleNeighborRecords, t: int, v: int, w: int) -> bool:
    """Whether w is a corner of t."""
    return m.triangle[t, CORNER + corner_of(m, t, w)] == w


@kernel
def leaves_for(m: TriangleNeighborRecords, t: int, v: int, w: int) -> bool:
    """Whether w comes right after v in t."""
    return m.triangle[t, CORNER + (corner_of(m, t, v) + 1) % 3] == w


# A triangle that has edge a – b, or -1.
with_edge = walks.found_by_steps(first, clockwise, in_triangle, counterclockwise)
are_joined = walks.joined_by_steps(first, clockwise, leaves_for, with_edge)
edge_between = packed.between(are_joined)


@kernel
def face_left_of(m: TriangleNeighborRecords, a: int, b: int) -> int:
    """The triangle that runs a → b, or -1. Cost O(n_ev)."""
    t = with_edge(m, a, b)
    if t < 0:
        return -1
    i = corner_of(m, t, a)
    if m.triangle[t, CORNER + (i + 1) % 3] == b:
        return t
    return m.triangle[t, NEIGHBOR + (i + 2) % 3]


@kernel
def diamond(m: TriangleNeighborRecords, e: int, at: Array) -> int:
    """Cost O(n_ev)."""
    edge_vertices(m, e, at)
    at[LEFT], at[RIGHT] = face_left_of(m, at[A], at[B]), -1
    at[C], at[D] = -1, -1
    if at[LEFT] >= 0:
        i = corner_of(m, at[LEFT], at[A])
        at[C] = m.triangle[at[LEFT], CORNER + (i + 2) % 3]
        at[RIGHT] = m.triangle[at[LEFT], NEIGHBOR + i]
    else:
        at[RIGHT] = face_left_of(m, at[B], at[A])
    if at[RIGHT] >= 0:
        i = corner_of(m, at[RIGHT], at[B])
        at[D] = m.triangle[at[RIGHT], CORNER + (i + 2) % 3]
    return (at[LEFT] >= 0) + (at[RIGHT] >= 0)


@kernel
def beyond(m: TriangleNeighborRecords, t: int, a: int) -> int:
    """The triangle beyond the edge of t that leaves a, or -1."""
    return m.triangle[t, NEIGHBOR + corner_of(m, t, a)]


@kernel
def set_beyond(m: TriangleNeighborRecords, t: int, a: int, u: int) -> None:
    """Let u lie beyond the edge of t that leaves a, if there is a t."""
    if t >= 0:
        m.triangle[t, NEIGHBOR + corner_of(m, t, a)] = u


@kernel
def set_triangle(m: TriangleNeighborRecords, t: int, a: int, b: int, c: int) -> None:
    """Write the corners of triangle t, which becomes theirs."""
    m.triangle[t, CORNER], m.triangle[t, CORNER + 1], m.triangle[t, CORNER + 2] = a, b, c
    m.vertex_triangle[a] = m.vertex_triangle[b] = m.vertex_triangle[c] = t


@kernel
def set_neighbors(m: TriangleNeighborRecords, t: int, ab: int, bc: int, ca: int) -> None:
    """Join triangle t with those beyond its edges, in the order of its corners."""
    a, b, c = m.triangle[t, CORNER], m.triangle[t, CORNER + 1], m.triangle[t, CORNER + 2]
    m.triangle[t, NEIGHBOR], m.triangle[t, NEIGHBOR + 1], m.triangle[t, NEIGHBOR + 2] = ab, bc, ca
    set_beyond(m, ab, b, t)
    set_beyond(m, bc, c, t)
    set_beyond(m, ca, a, t)


@kernel
def clear_vertex(m: TriangleNeighborRecords, v: int) -> None:
    """See to it that vertex v has no faces."""
    m.vertex_triangle[v] = -1


@kernel
def split_edge_records(m: TriangleNeighborRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1) when the triangles are known, which takes O(n_ev)."""
    a, b, left, right = at[A], at[B], at[LEFT], at[RIGHT]
    bc, ca, ad, db, new_left, new_right = -1, -1, -1, -1, -1, -1
    if left >= 0:
        bc, ca = beyond(m, left, b), beyond(m, left, at[C])
    if right >= 0:
        ad, db = beyond(m, right, a), beyond(m, right, at[D])
    if left >= 0:
        new_left = f
        set_triangle(m, left, a, v, at[C])
        set_triangle(m, new_left, v, b, at[C])
        set_neighbors(m, new_left, -1, bc, left)
        set_neighbors(m, left, right, new_left, ca)
        f += 1
    if right >= 0:
        new_right = f
        set_triangle(m, right, v, a, at[D])
        set_triangle(m, new_right, b, v, at[D])
        set_neighbors(m, new_right, new_left, right, db)
        set_neighbors(m, right, left, ad, new_right)


@kernel
def split_face_records(
    m: TriangleNeighborRecords, face: int, v: int, f: int, corners: Array
) -> None:
    """Cost O(1)."""
    i = 0
    for j in range(1, 3):
        if m.triangle[face, CORNER + j] < m.triangle[face, CORNER + i]:
            i = j
    j, k = (i + 1) % 3, (i + 2) % 3
    a, b = m.triangle[face, CORNER + i], m.triangle[face, CORNER + j]
    c = m.triangle[face, CORNER + k]
    ab, bc = m.triangle[face, NEIGHBOR + i], m.triangle[face, NEIGHBOR + j]
    ca = m.triangle[face, NEIGHBOR + k]
    corners[0], corners[1], corners[2] = a, b, c
    set_triangle(m, face, a, b, v)
    set_triangle(m, f, b, c, v)
    set_triangle(m, f + 1, c, a, v)
    set_neighbors(m, f, bc, f + 1, face)
    set_neighbors(m, f + 1, ca, face, f)
    set_neighbors(m, face, ab, f, f + 1)


@kernel
def replace(m: TriangleNeighborRecords, t: int, old: int, new: int) -> None:
    """Put another vertex into a corner of triangle t."""
    m.triangle[t, CORNER + corner_of(m, t, old)] = new


@kernel
def take_out(m: TriangleNeighborRecords, t: int, drop: int, keep: int) -> None:
    """Join what lies beyond the other two edges of a triangle at the edge that vanishes."""
    i = corner_of(m, t, drop)
    leaving = m.triangle[t, CORNER + (i + 1) % 3] == keep
    c = m.triangle[t, CORNER + (i + (2 if leaving else 1)) % 3]
    at_keep = beyond(m, t, keep if leaving else c)
    at_drop = beyond(m, t, c if leaving else drop)
    # Seen from beyond, the edge runs the other way: it leaves c if it left keep here.
    set_beyond(m, at_keep, c if leaving else keep, at_drop)
    set_beyond(m, at_drop, drop if leaving else c, at_keep)
    stays = at_keep if at_keep >= 0 else at_drop
    m.vertex_triangle[keep] = m.vertex_triangle[c] = stays
    m.triangle[t, CORNER], m.triangle[t, CORNER + 1], m.triangle[t, CORNER + 2] = -1, -1, -1


@kernel
def collapse_records(
    m: TriangleNeighborRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) for the triangles at ``drop``."""
    for side in (LEFT, RIGHT):
        if at[side] >= 0:
            take_out(m, at[side], drop, keep)
    for i in range(around):
        if out[i] != at[LEFT] and out[i] != at[RIGHT]:
            replace(m, out[i], drop, keep)
    m.vertex_triangle[drop] = -1


@kernel
def flip_records(m: TriangleNeighborRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1) when the triangles are known, which takes O(n_ev)."""
    a, b, c, d = at[A], at[B], at[C], at[D]
    bc, ca = beyond(m, at[LEFT], b), beyond(m, at[LEFT], c)
    ad, db = beyond(m, at[RIGHT], a), beyond(m, at[RIGHT], d)
    set_triangle(m, one, a, d, c)
    set_triangle(m, other, b, c, d)
    set_neighbors(m, other, bc, one, db)
    set_neighbors(m, one, ad, other, ca)


@kernel
def add_records(m: TriangleNeighborRecords, corners: Array, f: int) -> None:
    """Cost O(n_ev)."""
    a, b, c = corners[0], corners[1], corners[2]
    ab, bc, ca = face_left_of(m, b, a), face_left_of(m, c, b), face_left_of(m, a, c)
    set_triangle(m, f, a, b, c)
    set_neighbors(m, f, ab, bc, ca)


@kernel
def remove_records(m: TriangleNeighborRecords, f: int) -> None:
    """Cost O(1)."""
    for i in range(3):
        m.vertex_triangle[m.triangle[f, CORNER + i]] = -1
    for i in range(3):
        a, b = m.triangle[f, CORNER + i], m.triangle[f, CORNER + (i + 1) % 3]
        t = m.triangle[f, NEIGHBOR + i]
        if t >= 0:
            set_beyond(m, t, b, -1)
            m.vertex_triangle[a] = m.vertex_triangle[b] = t
    for i in range(3):
        m.triangle[f, CORNER + i] = -1


@kernel
def set_vertex_face(m: TriangleNeighborRecords, v: int, f: int) -> None:
    """Let v know of the face f at it. Cost O(1)."""
    m.vertex_triangle[v] = f


@njit(cache=True, nogil=True)
def _fill(begin: int, end: int, part: int, corners: Array, twin: Array, triangle: Array) -> None:
    for t in range(begin, end):
        for i in range(3):
            beyond = twin[3 * t + i]
            triangle[t, NEIGHBOR + i] = beyond // 3 if beyond >= 0 else -1
            triangle[t, CORNER + i] = corners[t, i]


class TriangleNeighbor(PackedEdges):
    """The triangle-neighbor structure."""

    name, title, abbreviation = "triangle_neighbor", "Triangle-Neighbor", "TNS"
    look, thesis, order = Look("#a8325e", "^", "--"), True, 2
    records_type = TriangleNeighborRecords
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True),
        Field("vertex.triangle", "vertex_triangle", target="triangle", optional=True),
        Field("triangle.neighbor", "triangle", 3, target="triangle", optional=True),
        Field("triangle.vertex", "triangle", 3, target="vertex", marks=True),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference = REFERENCE_TYPES[reference_bytes]
        triangle = rows(len(mesh.triangles), 6, dtype=reference)
        pairing = pair_half_edges(mesh, room=triangle)
        in_slices(_fill, len(triangle), mesh.triangles, pairing.twin, triangle)
        vertex_triangle = roomy(pairing.vertex_half_edge // 3, reference)  # -1 stays -1
        count = counted(len(mesh.points), pairing.n_edges, len(triangle), valence=pairing.valence)
        return cls(TriangleNeighborRecords(roomy(mesh.points), vertex_triangle, triangle, count))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, faces = self.records, live(self.records, self.fields, "triangle")
        f, of_vertex = np.flatnonzero(faces), m.vertex_triangle[: len(self.points)]
        corner = m.triangle[: len(faces), CORNER:]
        beyond = np.full_like(corner, -1)
        beyond[f] = m.triangle[f, NEIGHBOR:CORNER]
        once = (beyond < np.arange(len(faces))[:, None]) & faces[:, None]  # of two the later one
        require_edges(m, corner[once], np.roll(corner, -1, axis=1)[once])
        require(corner[f] != np.roll(corner[f], 1, axis=1), "corners differ", "faces", f)

        just, has = (
            "just vertices with faces have one",
            "the triangle of a vertex has it as a corner",
        )
        require_of_vertices(of_vertex, corner, f, just, has)

        # Edge i of t runs a → b; the neighbor must run b → a along its edge j, and know t there.
        t, i = np.nonzero(beyond >= 0)
        u, a, b = beyond[t, i], corner[t, i], corner[t, (i + 1) % 3]
        j = np.argmax(corner[u] == b[:, None], axis=1)
        met = (corner[u, j] == b) & (corner[u, (j + 1) % 3] == a) & (beyond[u, j] == t)
        words = "neighbors name each other across one edge, run opposite ways"
        require(met, words, "faces", t)

        clockwise_corner = np.full(corner.size, -1)
        clockwise_corner[3 * t + i] = 3 * u + (j + 1) % 3
        corners = np.flatnonzero(np.repeat(faces, 3))
        require_one_fan(corner.ravel(), clockwise_corner, corners)
