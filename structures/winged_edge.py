"""Winged-edge mesh (WEM; thesis 2.4.2): an edge knows its ends, its faces and four wings.

::

              head
         ╲     ▲     ╱
     left next │ right previous      left     the face on the left hand from tail to head
           ╲   │   ╱                 right    the face on the right hand
       left    │    right            next     the edge that follows in that face, counterclockwise
           ╱   │   ╲                 previous the edge before
 left previous │ right next
         ╱     │     ╲
              tail

Invariants

- The left face runs tail → head along the edge, the right face head → tail. A face that is missing
  at the border is -1, and so are its two wings.
- Previous of next within the same face is the edge itself; three times next comes round.
- The edge of a vertex ends there; that of a face borders it. An unreferenced vertex has -1.
- Dead: a face has edge -1, an edge has tail -1, a vertex has no position (NaN).

Who walks must look at every edge which way round it lies. The kernels therefore walk *directed*
edges 2e + side: from tail to head with side 0, from head to tail with side 1; adding the side to a
left-hand column gives the column to read. Bytes per vertex with 8-byte references:
12 + 8 + 2 · 8 + 3 · 64 = 228 (thesis 7.3). Source: Shirley & Marschner (2010), p. 273.
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
    Kernel,
    counted,
    in_slices,
    kernel,
    number_edges,
    pair_half_edges,
    require,
    require_edges,
    require_of_vertices,
    require_one_fan,
    require_triangles,
    steps,
    walks,
)
from hem.contract import Look, Structure
from hem.meshes import TriangleMesh
from hem.room import roomy, rows

TAIL, HEAD, LEFT_FACE, RIGHT_FACE = range(4)
LEFT_PREVIOUS, RIGHT_PREVIOUS, LEFT_NEXT, RIGHT_NEXT = range(4, 8)


class WingedEdgeRecords(NamedTuple):
    """One row per record: two edges are one cache line."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_edge: Array  # (n_v,) one of the edges at the vertex
    face_edge: Array  # (n_t,) one of the edges of the face
    edge: Array  # (n_e, 8) the eight columns above
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Steps from a directed edge -----------------------------------------------------------------------


def by_side(left: int, right: int) -> Kernel:
    """Make ``read(m, d)``: one column if d runs from tail to head, another if it runs back."""

    @kernel
    def read(m: WingedEdgeRecords, d: int) -> int:
        return m.edge[d >> 1, left + (right - left) * (d & 1)]

    return read


tail, head, left_face, right_face = steps.columns(WingedEdgeRecords, "edge", 4)
origin, tip = by_side(TAIL, HEAD), by_side(HEAD, TAIL)
left_of, right_of = by_side(LEFT_FACE, RIGHT_FACE), by_side(RIGHT_FACE, LEFT_FACE)
previous_edge, next_edge = by_side(LEFT_PREVIOUS, RIGHT_PREVIOUS), by_side(LEFT_NEXT, RIGHT_NEXT)
next_beyond = by_side(RIGHT_NEXT, LEFT_NEXT)  # in the face on the right hand
edge_ending_at, edge_at = steps.entries(WingedEdgeRecords, "vertex_edge", "face_edge")
ahead, ahead_of = (steps.asking(WingedEdgeRecords, "edge", each) for each in (1, 2))


@kernel
def edge_of(m: WingedEdgeRecords, d: int) -> int:
    """The edge of directed edge d."""
    return d >> 1


@kernel
def directed_from(m: WingedEdgeRecords, e: int, v: int) -> int:
    """Edge e as it leaves vertex v."""
    return 2 * e if m.edge[e, TAIL] == v else 2 * e + 1


@kernel
def directed_along(m: WingedEdgeRecords, e: int, f: int) -> int:
    """Edge e as it runs round face f, which lies on its left hand then."""
    return 2 * e if m.edge[e, LEFT_FACE] == f else 2 * e + 1


@kernel
def following(m: WingedEdgeRecords, d: int) -> int:
    """The directed edge after d in the face on its left hand."""
    return directed_from(m, next_edge(m, d), tip(m, d))


# The two after d in the triangle on its left hand.
others = steps.others_of_triangle(following)
# The directed edge that leaves v before d enters v in the face on the left hand of d; the one after
# d is next in the face on its right hand.
counterclockwise = steps.entering(previous_edge, directed_from)
clockwise = steps.entering(next_beyond, directed_from)


# The nine queries: O(1), those of a vertex and edge_edges O(n_ev) ---------------------------------

around = walks.circulator(clockwise, counterclockwise, ahead_of)
outgoing = walks.from_vertex(edge_ending_at, around, directed_from)

vertex_vertices, vertex_edges = walks.each(outgoing, tip), walks.each(outgoing, edge_of)
vertex_faces = walks.each_but_last(outgoing, left_of)  # beyond the last edge of an open fan is none
edge_vertices, edge_faces = steps.ends(tail, head), steps.faces_beside(left_face, right_face)
edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges)
face_vertices = walks.each_side(edge_at, next_edge, origin, directed_along, ahead)
face_edges = walks.each_side(edge_at, next_edge, edge_of, directed_along)
face_faces = walks.faces_across(edge_at, next_edge, right_of, directed_along)


# What operations need to know, and what they change (see hem.authoring.operations) --------------


@kernel
def diamond(m: WingedEdgeRecords, e: int, at: Array) -> int:
    """Cost O(1)."""
    edge_vertices(m, e, at)
    left = directed_from(m, e, at[A])
    at[LEFT], at[RIGHT], at[C], at[D] = left_of(m, left), right_of(m, left), -1, -1
    if at[LEFT] >= 0:
        at[C] = tip(m, following(m, left))
    if at[RIGHT] >= 0:
        at[D] = tip(m, following(m, left ^ 1))
    return (at[LEFT] >= 0) + (at[RIGHT] >= 0)


@kernel
def first(m: WingedEdgeRecords, v: int) -> int:
    """A directed edge that leaves v, or a negative number."""
    return directed_from(m, m.vertex_edge[v], v) if m.vertex_edge[v] >= 0 else -1


@kernel
def first_side(m: WingedEdgeRecords, f: int) -> int:
    """A directed edge that runs round f."""
    return directed_along(m, m.face_edge[f], f)


face_exists = steps.recorded(FACE_END, edge_at)
edge_exists = steps.recorded(EDGE_END, tail)
ends_at = steps.ending_at(tip)

# The directed edge a → b, or -1.
find_directed_edge = walks.found_by_steps(first, clockwise, ends_at, counterclockwise)
are_joined = walks.joined_by_steps(first, clockwise, ends_at, find_directed_edge)
face_left_of = steps.left_face(find_directed_edge, left_of)
edge_between = steps.between(find_directed_edge, edge_of)
leaves_smallest = steps.from_smallest(following, origin)


@kernel
def set_side(m: WingedEdgeRecords, d: int, f: int, before: int, after: int) -> None:
    """Write the face on the left hand of directed edge d, and the wings there."""
    e, side = d >> 1, d & 1
    m.edge[e, LEFT_FACE + side] = f
    m.edge[e, LEFT_PREVIOUS + side] = before
    m.edge[e, LEFT_NEXT + side] = after


@kernel
def set_face(m: WingedEdgeRecords, f: int, d: int, e: int, g: int) -> None:
    """Make a face of three directed edges that follow each other."""
    m.face_edge[f] = d >> 1
    set_side(m, d, f, g >> 1, e >> 1)
    set_side(m, e, f, d >> 1, g >> 1)
    set_side(m, g, f, e >> 1, d >> 1)


@kernel
def set_ends(m: WingedEdgeRecords, d: int, tail: int, head: int) -> None:
    """Write both ends of directed edge d, which becomes theirs."""
    m.edge[d >> 1, TAIL + (d & 1)], m.edge[d >> 1, HEAD - (d & 1)] = tail, head
    m.vertex_edge[tail] = m.vertex_edge[head] = d >> 1


@kernel
def new_edge(m: WingedEdgeRecords, tail: int, head: int) -> int:
    """Append an edge without faces -> the directed edge tail → head."""
    d = 2 * m.counts[EDGE_END]
    m.counts[EDGE_END] += 1
    set_ends(m, d, tail, head)
    set_side(m, d, -1, -1, -1)
    set_side(m, d + 1, -1, -1, -1)
    return d


@kernel
def clear_vertex(m: WingedEdgeRecords, v: int) -> None:
    """See to it that vertex v has no faces."""
    m.vertex_edge[v] = -1


@kernel
def split_edge_records(m: WingedEdgeRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1): the edge stays with a and v, and one edge is new on each side and beyond v."""
    a, b = at[A], at[B]
    av = directed_from(m, e, a)
    bc, ad = -1, -1
    if at[LEFT] >= 0:
        bc = following(m, av)
    if at[RIGHT] >= 0:
        ad = following(m, av ^ 1)
    set_ends(m, av, a, v)
    vb = new_edge(m, v, b)
    if at[LEFT] >= 0:
        ca, vc = following(m, bc), new_edge(m, v, at[C])
        set_face(m, at[LEFT], av, vc, ca)
        set_face(m, f, vb, bc, vc ^ 1)
        f += 1
    if at[RIGHT] >= 0:
        db, vd = following(m, ad), new_edge(m, v, at[D])
        set_face(m, at[RIGHT], av ^ 1, ad, vd ^ 1)
        set_face(m, f, vb ^ 1, vd, db)


@kernel
def split_face_records(m: WingedEdgeRecords, face: int, v: int, f: int, corners: Array) -> None:
    """Cost O(1)."""
    ab = leaves_smallest(m, first_side(m, face))
    bc, ca = others(m, ab)
    a, b, c = tip(m, ca), tip(m, ab), tip(m, bc)
    corners[0], corners[1], corners[2] = a, b, c
    av, bv, cv = new_edge(m, a, v), new_edge(m, b, v), new_edge(m, c, v)
    set_face(m, face, ab, bv, av ^ 1)
    set_face(m, f, bc, cv, bv ^ 1)
    set_face(m, f + 1, ca, av, cv ^ 1)


@kernel
def unite(m: WingedEdgeRecords, gone: int, stays: int) -> None:
    """Let directed edge ``stays`` take the place that the other side of ``gone`` has in its face.

    Both are sides of a triangle that vanishes, and so does the edge of ``gone``.
    """
    beyond = gone ^ 1
    face = left_of(m, beyond)
    if face >= 0:
        begin, (after, before) = m.face_edge[face], others(m, beyond)
        set_face(m, face, stays, after, before)
        m.face_edge[face] = begin if begin != gone >> 1 else stays >> 1
    else:
        set_side(m, stays, -1, -1, -1)
    m.edge[gone >> 1, TAIL] = -1
    e = stays >> 1
    m.vertex_edge[m.edge[e, TAIL]] = m.vertex_edge[m.edge[e, HEAD]] = e


@kernel
def collapse_records(
    m: WingedEdgeRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) for the edges at ``drop``."""
    edges = vertex_edges(m, drop, out)
    inward = directed_from(m, e, drop)  # ends at keep
    to_c, from_c, to_d, from_d = -1, -1, -1, -1
    if left_of(m, inward) >= 0:
        to_c, from_c = others(m, inward)
        m.face_edge[left_of(m, inward)] = -1
    if left_of(m, inward ^ 1) >= 0:
        to_d, from_d = others(m, inward ^ 1)
        m.face_edge[left_of(m, inward ^ 1)] = -1
    for i in range(edges):
        for end in (TAIL, HEAD):
            if m.edge[out[i], end] == drop:
                m.edge[out[i], end] = keep
    if to_c >= 0:
        unite(m, from_c, to_c)
    if to_d >= 0:
        unite(m, to_d, from_d)
    m.edge[e, TAIL] = -1
    m.vertex_edge[drop] = -1


@kernel
def flip_records(m: WingedEdgeRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1)."""
    ab = directed_from(m, e, at[A])
    (bc, ca), (ad, db) = others(m, ab), others(m, ab ^ 1)
    set_ends(m, ab, at[D], at[C])
    set_face(m, one, ad, ab, ca)
    set_face(m, other, bc, ab ^ 1, db)
    m.vertex_edge[at[A]], m.vertex_edge[at[B]] = ad >> 1, bc >> 1


@kernel
def add_records(m: WingedEdgeRecords, corners: Array, f: int) -> None:
    """Cost O(n_ev)."""
    a, b, c = corners[0], corners[1], corners[2]
    ab, bc = find_directed_edge(m, a, b), find_directed_edge(m, b, c)
    ca = find_directed_edge(m, c, a)
    ab = ab if ab >= 0 else new_edge(m, a, b)
    bc = bc if bc >= 0 else new_edge(m, b, c)
    ca = ca if ca >= 0 else new_edge(m, c, a)
    set_face(m, f, ab, bc, ca)


@kernel
def remove_records(m: WingedEdgeRecords, f: int) -> None:
    """Cost O(1)."""
    ab = first_side(m, f)
    bc, ca = others(m, ab)
    a, b, c = tip(m, ca), tip(m, ab), tip(m, bc)
    m.face_edge[f] = -1
    m.vertex_edge[a] = m.vertex_edge[b] = m.vertex_edge[c] = -1
    for d in (ab, bc, ca):
        set_side(m, d, -1, -1, -1)
        if left_of(m, d ^ 1) >= 0:
            m.vertex_edge[tip(m, d)] = m.vertex_edge[tip(m, d ^ 1)] = d >> 1
        else:
            m.edge[d >> 1, TAIL] = -1


@kernel
def set_vertex_face(m: WingedEdgeRecords, v: int, f: int) -> None:
    """Let v know of the face f at it. Cost O(1)."""
    d = first_side(m, f)
    for _ in range(3):
        if tip(m, d) == v:
            m.vertex_edge[v] = d >> 1
        d = following(m, d)


@njit(cache=True, nogil=True)
def _fill(
    begin: int, end: int, part: int, corners: Array, twin: Array, directed: Array, edge: Array
) -> None:
    """The first half-edge of an edge gives its direction and left side, the twin its right side."""
    for h in range(begin, end):
        if directed[h] & 1:
            continue
        row, following = edge[directed[h] >> 1], h + 1 if h % 3 < 2 else h - 2
        row[TAIL], row[HEAD] = corners[h // 3, h % 3], corners[h // 3, following % 3]
        for side in range(2):
            g = h if side == 0 else twin[h]
            base = g - g % 3
            row[LEFT_FACE + side] = g // 3 if g >= 0 else -1
            row[LEFT_PREVIOUS + side] = directed[base + (g + 2) % 3] >> 1 if g >= 0 else -1
            row[LEFT_NEXT + side] = directed[base + (g + 1) % 3] >> 1 if g >= 0 else -1


class WingedEdge(Structure):
    """The winged-edge mesh."""

    name, title, abbreviation = "winged_edge", "Winged-Edge", "WEM"
    look, thesis, order = Look("#2f7fc1", "o", "-"), True, 3
    records_type = WingedEdgeRecords
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True),
        Field("vertex.edge", "vertex_edge", target="edge", optional=True),
        Field("face.edge", "face_edge", target="edge", marks=True),
        Field("edge.tail", "edge", target="vertex", marks=True),
        Field("edge.head", "edge", target="vertex"),
        Field("edge.left", "edge", target="face", optional=True),
        Field("edge.right", "edge", target="face", optional=True),
        Field("edge.left_previous", "edge", target="edge", optional=True),
        Field("edge.right_previous", "edge", target="edge", optional=True),
        Field("edge.left_next", "edge", target="edge", optional=True),
        Field("edge.right_next", "edge", target="edge", optional=True),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference, pairing = REFERENCE_TYPES[reference_bytes], pair_half_edges(mesh)
        n_edges, n_faces = pairing.n_edges, len(mesh.triangles)
        directed = np.empty_like(pairing.twin)
        number_edges(pairing.twin, directed)
        edge = rows(n_edges, 8, dtype=reference)
        in_slices(_fill, len(directed), mesh.triangles, pairing.twin, directed, edge)
        used = pairing.vertex_half_edge >= 0
        vertex_edge = rows(len(used), dtype=reference)
        vertex_edge[~used] = -1
        vertex_edge[used] = directed[pairing.vertex_half_edge[used]] >> 1
        face_edge = roomy(directed[::3] >> 1, reference)
        count = counted(len(mesh.points), n_edges, n_faces, n_edges, valence=pairing.valence)
        return cls(WingedEdgeRecords(roomy(mesh.points), vertex_edge, face_edge, edge, count))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, e, f = self.records, self.edges(), self.faces()
        record = m.edge[: m.counts[EDGE_END]]
        require_edges(m, record[e, TAIL], record[e, HEAD], e)
        faces = record[e][:, [LEFT_FACE, RIGHT_FACE]].max(axis=1, initial=-1)
        require(faces >= 0, "an edge has a face", "edges", e)
        own = (record[m.face_edge[f]][:, [LEFT_FACE, RIGHT_FACE]] == f[:, None]).any(axis=1)
        require(own, "the edge of a face borders it", "faces", f)

        of_vertex = m.vertex_edge[: len(self.points)]
        just, there = "just the vertices with edges have one", "the edge of a vertex ends there"
        require_of_vertices(of_vertex, record[:, [TAIL, HEAD]], e, just, there)
        self._require_wings(record, e)

    def _require_wings(self, record: Array, e: Array) -> None:
        """As directed edges 2e + side: one row each, whichever way round the edge lies."""
        columns = record.reshape(-1, 4, 2).swapaxes(0, 1)  # they come in pairs, one for each side
        tail, face, before, after = columns.reshape(4, -1)
        head = record[:, [HEAD, TAIL]].ravel()
        d = np.stack([2 * e, 2 * e + 1], axis=1).ravel()
        inner = d[face[d] >= 0]
        owner = inner // 2

        missing = np.stack([face[d] < 0, before[d] < 0, after[d] < 0], axis=1).sum(axis=1)
        words = "an edge has the wings of its faces, and no others"
        require(np.isin(missing, (0, 3)), words, "edges", d // 2)
        follower = np.full(len(face), -1)
        on_right = face[2 * after[inner]] != face[inner]
        follower[inner] = 2 * after[inner] + on_right
        then = follower[inner]
        require_triangles(face, follower, inner, "edges", owner)
        require(tail[then] == head[inner], "next starts at the end", "edges", owner)
        require(before[then] == owner, "previous of next is the edge itself", "edges", owner)
        # Around its tail, clockwise of a directed edge comes the follower of its other direction.
        require_one_fan(tail, follower[np.arange(len(face)) ^ 1], d)
