"""Directed edges: half-edges that lie three by three in their faces, so most steps are arithmetic.

Half-edge i of triangle t is 3 t + i. What follows it, what comes before it, and its face are not
recorded but computed::

              c                     a, b, c  counterclockwise from outside
            ╱   ╲                   h        3 t + i, the half-edge from a to b
     h + 2 ╱     ╲ h + 1            face     t = h // 3
          ╱   t   ╲                 next     3 t + (i + 1) % 3
         a ───h──▶ b                origin   a, recorded
           ◀─twin──                 twin     recorded: the half-edge from b to a

Invariants

- The three half-edges of a face start at three different vertices.
- ``twin`` of twin of h is h; it starts where ``next`` of h starts. At the border it is -1.
- The half-edge of a vertex starts at it. An unreferenced vertex has -1.
- Dead: the half-edges of a face have origin -1, a vertex has no position (NaN).

A face that an operation changes has others of its edges at another place. So an edge is named by
the smaller of its half-edges and a mark of its two ends, see ``hem.authoring.marked``: a handle is
valid as long as that half-edge joins them, and names nothing while it joins others. Who keeps an
edge through edits keeps its two vertices, and asks ``find_edge``: ``stable_edge_handles`` is False.

Bytes per vertex with 8-byte references: 12 + 8 + 6 · 16 = 116. Source: Campagna, Kobbelt & Seidel,
Directed Edges: A Scalable Representation for Triangle Meshes (1998). Rossignac's corner table
(2001) records the same of corners.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numba import njit

from hem.arrays import Array
from hem.authoring import (
    EDGE_END,
    ENDLESS,
    FACE_END,
    FACE_ROOM,
    FACES,
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
    marked,
    pair_half_edges,
    require,
    require_count,
    require_edges,
    require_of_vertices,
    require_one_fan,
    steps,
    walks,
)
from hem.contract import Claims, Look, MarkedEdges
from hem.meshes import TriangleMesh
from hem.room import roomy, rows

ORIGIN, TWIN = range(2)  # the columns of a half-edge


class DirectedEdgeRecords(NamedTuple):
    """One row per record, so that one triangle lies within 24 bytes."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_half_edge: Array  # (n_v,) one that leaves the vertex
    half_edge: Array  # (3 n_t, 2) origin, twin
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Steps from a half-edge: two are recorded, the others are computed --------------------------------

origin, twin = steps.columns(DirectedEdgeRecords, "half_edge", 2)
(leaving,) = steps.entries(DirectedEdgeRecords, "vertex_half_edge")
ahead = steps.asking(DirectedEdgeRecords, "half_edge")


@kernel
def following(m: DirectedEdgeRecords, h: int) -> int:
    """The half-edge after h in its face."""
    return h + 1 - 3 * (h % 3 == 2)


@kernel
def previous(m: DirectedEdgeRecords, h: int) -> int:
    """The half-edge before h in its face."""
    return h - 1 + 3 * (h % 3 == 0)


@kernel
def face(m: DirectedEdgeRecords, h: int) -> int:
    """The face that h lies in."""
    return h // 3


@kernel
def within(m: DirectedEdgeRecords, f: int) -> int:
    """The first half-edge of face f."""
    return 3 * f


tip, apex = steps.then(following, origin), steps.then(previous, origin)
others = steps.others_of_triangle(following)


@kernel
def clockwise(m: DirectedEdgeRecords, h: int, v: int) -> int:
    """The next half-edge that leaves v."""
    beyond = m.half_edge[h, TWIN]
    return following(m, beyond) if beyond >= 0 else -1


@kernel
def counterclockwise(m: DirectedEdgeRecords, h: int, v: int) -> int:
    """The half-edge that leaves v before h."""
    return m.half_edge[previous(m, h), TWIN]


@kernel
def across(m: DirectedEdgeRecords, h: int) -> int:
    """The face beyond h, or -1."""
    beyond = m.half_edge[h, TWIN]
    return beyond // 3 if beyond >= 0 else -1


half_edge_exists = steps.recorded(EDGE_END, origin)
mark = marked.mark_of(origin, tip)
edge_exists = marked.marked(half_edge_exists, mark)
names = marked.smaller_of_twins(origin, twin, mark)
edge_of = names.here


# The nine queries: O(1), those of a vertex and edge_edges O(n_ev) ---------------------------------

outgoing = walks.by_twins(leaving, twin, following, previous, ahead)

vertex_vertices = walks.each_and_last(outgoing, steps.ending(origin, tip), apex)
vertex_edges = walks.each_and_last(outgoing, names, steps.then(previous, edge_of))
vertex_faces = walks.each(outgoing, steps.of_its_own(face))
edge_vertices = steps.ends(marked.of_edge(origin), marked.of_edge(tip))
edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges, marked.of_edge(edge_of))
edge_faces = steps.faces_beside(marked.of_edge(face), marked.of_edge(across))
face_vertices = walks.each_side(within, following, origin, ahead=ahead)
face_edges = walks.each_side(within, following, edge_of)
face_faces = walks.faces_across(within, following, across)


# What operations need to know, and what they change (see hem.authoring.operations) --------------

face_exists = steps.recorded(FACE_END, steps.then(within, origin))
left_and_right = marked.left_first(steps.left_first(twin, origin, tip))
diamond = steps.diamond_of(edge_vertices, left_and_right, face, apex)
ends_at, in_triangle = steps.ending_at(tip), steps.within_triangle(tip, apex)

# The half-edge that runs a → b, or -1; and one at a whose face has b.
find_half_edge = walks.found_by_steps(leaving, clockwise, ends_at, counterclockwise)
with_edge = walks.found_by_steps(leaving, clockwise, in_triangle, counterclockwise)
are_joined = walks.joined_by_steps(leaving, clockwise, ends_at, with_edge)
face_left_of = steps.left_face(find_half_edge, face)
leaves_smallest = steps.from_smallest(following, origin)
clear_vertex = steps.clear_vertex
edge_between = steps.between(find_half_edge, edge_of)


@kernel
def set_corners(m: DirectedEdgeRecords, h: int, a: int, b: int, c: int) -> None:
    """Have h leave a, the next one b and the last one c. A new face is in use from here on."""
    g, i = others(m, h)
    m.half_edge[h, ORIGIN], m.half_edge[g, ORIGIN], m.half_edge[i, ORIGIN] = a, b, c
    m.vertex_half_edge[a], m.vertex_half_edge[b], m.vertex_half_edge[c] = h, g, i
    m.counts[EDGE_END] = max(m.counts[EDGE_END], h + 3 - h % 3)


@kernel
def join(m: DirectedEdgeRecords, g: int, h: int) -> None:
    """Make an edge of two half-edges; -1 is none."""
    if g >= 0:
        m.half_edge[g, TWIN] = h
    if h >= 0:
        m.half_edge[h, TWIN] = g


@kernel
def set_vertices(m: DirectedEdgeRecords, h: int) -> None:
    """Let both ends of h have half-edges in its face."""
    m.vertex_half_edge[origin(m, h)] = h
    m.vertex_half_edge[tip(m, h)] = following(m, h)


@kernel
def split_edge_records(m: DirectedEdgeRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1): of each face one half-edge moves on, and its place is that of a new one."""
    left, right = left_and_right(m, e)  # they stay with a and v
    on_left, on_right = -1, -1  # the halves of the edge from v to b
    if left >= 0:
        bc = following(m, left)
        on_left = 3 * f
        set_corners(m, on_left, v, at[B], at[C])
        join(m, on_left + 1, twin(m, bc))
        join(m, on_left + 2, bc)
        set_corners(m, left, at[A], v, at[C])
        f += 1
    if right >= 0:
        db = previous(m, right)
        on_right = 3 * f
        set_corners(m, on_right, at[B], v, at[D])
        join(m, on_right + 2, twin(m, db))
        join(m, on_right + 1, db)
        set_corners(m, right, v, at[A], at[D])
    join(m, on_left, on_right)


@kernel
def split_face_records(m: DirectedEdgeRecords, face: int, v: int, f: int, corners: Array) -> None:
    """Cost O(1): each face has one half-edge of the old one."""
    ab = leaves_smallest(m, within(m, face))
    bc, ca = others(m, ab)
    a, b, c = origin(m, ab), origin(m, bc), origin(m, ca)
    corners[0], corners[1], corners[2] = a, b, c
    second, third = within(m, f), within(m, f + 1)
    set_corners(m, second, b, c, v)
    set_corners(m, third, c, a, v)
    join(m, second, twin(m, bc))
    join(m, third, twin(m, ca))
    set_corners(m, ab, a, b, v)
    join(m, bc, second + 2)
    join(m, second + 1, third + 2)
    join(m, third + 1, ca)


@kernel
def take_out(m: DirectedEdgeRecords, h: int) -> None:
    """Take away the face of an edge that vanishes; what lies beyond its other sides meets."""
    after, last = others(m, h)
    beyond, stays = twin(m, after), twin(m, last)
    join(m, beyond, stays)
    set_vertices(m, stays if stays >= 0 else beyond)
    for i in (h, after, last):
        m.half_edge[i, ORIGIN] = -1


@kernel
def collapse_records(
    m: DirectedEdgeRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) for the half-edges that leave ``drop``."""
    left, right = left_and_right(m, e)
    for i in range(around):
        h = within(m, out[i])
        while m.half_edge[h, ORIGIN] != drop:
            h += 1
        m.half_edge[h, ORIGIN] = keep
    m.vertex_half_edge[drop] = -1
    for h in (left, right):
        if h >= 0:
            take_out(m, h)


@kernel
def flip_records(m: DirectedEdgeRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1): each face keeps one half-edge and gets one of the other's."""
    ab, ba = left_and_right(m, e)
    (bc, ca), (ad, db) = others(m, ab), others(m, ba)
    at_a, at_b = (twin(m, ca), twin(m, ad)), (twin(m, db), twin(m, bc))
    if one == at[RIGHT]:
        ca, db = ba, ab
    (ad, dc), (bc, cd) = others(m, ca), others(m, db)
    set_corners(m, ca, at[C], at[A], at[D])
    set_corners(m, db, at[D], at[B], at[C])
    join(m, ca, at_a[0])
    join(m, ad, at_a[1])
    join(m, db, at_b[0])
    join(m, bc, at_b[1])
    join(m, dc, cd)


@kernel
def add_records(m: DirectedEdgeRecords, corners: Array, f: int) -> None:
    """Cost O(n_ev)."""
    a, b, c = corners[0], corners[1], corners[2]
    ab, bc, ca = find_half_edge(m, b, a), find_half_edge(m, c, b), find_half_edge(m, a, c)
    h = within(m, f)
    set_corners(m, h, a, b, c)
    join(m, h, ab)
    join(m, h + 1, bc)
    join(m, h + 2, ca)


@kernel
def remove_records(m: DirectedEdgeRecords, f: int) -> None:
    """Cost O(1)."""
    first = within(m, f)
    for h in range(first, first + 3):
        m.vertex_half_edge[m.half_edge[h, ORIGIN]] = -1
    for h in range(first, first + 3):
        beyond = twin(m, h)
        if beyond >= 0:
            m.half_edge[beyond, TWIN] = -1
            set_vertices(m, beyond)
        m.half_edge[h, ORIGIN] = -1


@kernel
def set_vertex_face(m: DirectedEdgeRecords, v: int, f: int) -> None:
    """Let v know of the face f at it. Cost O(1)."""
    for h in range(within(m, f), within(m, f) + 3):
        if m.half_edge[h, ORIGIN] == v:
            m.vertex_half_edge[v] = h


@njit(cache=True, nogil=True)
def _fill(begin: int, end: int, part: int, triangles: Array, twin: Array, half_edge: Array) -> None:
    for f in range(begin, end):
        for i in range(3):
            half_edge[3 * f + i, ORIGIN] = triangles[f, i]
            half_edge[3 * f + i, TWIN] = twin[3 * f + i]


class DirectedEdge(MarkedEdges):
    """The mesh of directed edges."""

    name, title, abbreviation = "directed_edge", "Directed-Edge", "DE"
    look, order = Look("#2497d6", "*", "-."), 7
    claims = Claims("no document says what it costs; what is found is shown")
    records_type = DirectedEdgeRecords
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True),
        Field("vertex.half_edge", "vertex_half_edge", target="half_edge", optional=True),
        Field("half_edge.origin", "half_edge", target="vertex", marks=True),
        Field("half_edge.twin", "half_edge", target="half_edge", optional=True),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference, n = REFERENCE_TYPES[reference_bytes], len(mesh.triangles)
        half_edge = rows(3 * n, 2, dtype=reference)
        pairing = pair_half_edges(mesh, room=half_edge)
        in_slices(_fill, n, mesh.triangles, pairing.twin, half_edge)
        vertex = pairing.leaving(reference)
        count = counted(len(mesh.points), pairing.n_edges, n, 3 * n, valence=pairing.valence)
        count[FACE_ROOM] = ENDLESS  # faces have no records of their own
        return cls(DirectedEdgeRecords(roomy(mesh.points), vertex, half_edge, count))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, half_edges = self.records, live(self.records, self.fields, "half_edge")
        whole = half_edges.reshape(-1, 3)
        require((whole == whole[:, :1]), "half-edges live and die by three", "faces")
        require_count("face", int(whole[:, 0].sum()), int(m.counts[FACES]))
        h, slots = np.flatnonzero(half_edges), np.arange(len(half_edges))
        following = np.where(slots % 3 < 2, slots + 1, slots - 2)
        origin, twin = m.half_edge[: len(half_edges)].T
        once = h[(twin[h] < 0) | (h < twin[h])]
        require_edges(m, origin[once], origin[following[once]], once)
        require(origin[following[h]] != origin[h], "corners differ", "half_edges", h)

        inner = h[twin[h] >= 0]
        other = twin[inner]
        paired = (other != inner) & (twin[other] == inner)
        require(paired, "twin of twin is the half-edge itself", "half_edges", inner)
        opposite = origin[other] == origin[following[inner]]
        words = "a twin starts where next starts"
        require(opposite, words, "half_edges", inner)

        just = "just the vertices with faces have a half-edge"
        leaving, has = m.vertex_half_edge[: len(self.points)], "a vertex' half-edge starts at it"
        require_of_vertices(leaving, origin[:, None], h, just, has)
        clockwise = np.full(len(half_edges), -1)
        clockwise[inner] = following[other]
        require_one_fan(origin, clockwise, h)
