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

Who walks must look at every edge which way round it lies. The kernels therefore walk *directed*
edges 2e + side: from tail to head with side 0, from head to tail with side 1; adding the side to a
left-hand column gives the column to read. Bytes per vertex with 8-byte references:
12 + 8 + 2 · 8 + 3 · 64 = 228 (thesis 7.3).
"""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hem.invariants import (
    require,
    require_distinct_edges,
    require_one_fan,
    require_points,
    require_references,
)
from hem.kernels import append_face, circulator, edges_at_both_ends, kernel, named
from hem.mesh import TriangleMesh
from hem.pairing import pair_half_edges
from hem.slices import in_slices
from hem.structure import REFERENCE_TYPES, Field, Structure

Array = NDArray[Any]

TAIL, HEAD, LEFT, RIGHT = range(4)
LEFT_PREVIOUS, RIGHT_PREVIOUS, LEFT_NEXT, RIGHT_NEXT = range(4, 8)
COLUMNS = (
    "tail",
    "head",
    "left",
    "right",
    "left_previous",
    "right_previous",
    "left_next",
    "right_next",
)


class WingedEdgeRecords(NamedTuple):
    """One row per record: two edges are one cache line."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_edge: Array  # (n_v,) one of the edges at the vertex
    face_edge: Array  # (n_t,) one of the edges of the face
    edge: Array  # (n_e, 8) the columns above


@kernel
def directed_from(m: WingedEdgeRecords, e: int, v: int) -> int:
    """Edge e as it leaves vertex v."""
    return 2 * e if m.edge[e, TAIL] == v else 2 * e + 1


@kernel
def counterclockwise(m: WingedEdgeRecords, d: int, v: int) -> int:
    """The directed edge that leaves v before d: it enters v in the face on the left hand of d."""
    e = m.edge[d >> 1, LEFT_PREVIOUS + (d & 1)]
    return directed_from(m, e, v) if e >= 0 else -1


@kernel
def clockwise(m: WingedEdgeRecords, d: int, v: int) -> int:
    """The directed edge that leaves v after d: next in the face on the right hand of d."""
    e = m.edge[d >> 1, RIGHT_NEXT - (d & 1)]
    return directed_from(m, e, v) if e >= 0 else -1


around = circulator(clockwise, counterclockwise)


@kernel
def leaving(m: WingedEdgeRecords, v: int, out: Array) -> tuple[int, bool]:
    """The directed edges that leave v, counterclockwise -> how many, and whether they close."""
    e = m.vertex_edge[v]
    if e < 0:
        return 0, True
    return around(m, directed_from(m, e, v), v, out)


@kernel
def vertex_vertices(m: WingedEdgeRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, _ = leaving(m, v, out)
    for i in range(count):
        out[i] = m.edge[out[i] >> 1, HEAD - (out[i] & 1)]
    return count


@kernel
def vertex_edges(m: WingedEdgeRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, _ = leaving(m, v, out)
    for i in range(count):
        out[i] >>= 1
    return count


@kernel
def vertex_faces(m: WingedEdgeRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, closed = leaving(m, v, out)
    faces = count if closed else count - 1  # beyond the last edge of an open fan lies none
    for i in range(faces):
        out[i] = m.edge[out[i] >> 1, LEFT + (out[i] & 1)]
    return faces


@kernel
def edge_vertices(m: WingedEdgeRecords, e: int, out: Array) -> int:
    """Cost O(1)."""
    out[0] = m.edge[e, TAIL]
    out[1] = m.edge[e, HEAD]
    return 2


edge_edges = edges_at_both_ends(edge_vertices, vertex_edges)


@kernel
def edge_faces(m: WingedEdgeRecords, e: int, out: Array) -> int:
    """Cost O(1)."""
    count = 0
    for side in range(2):
        face = m.edge[e, LEFT + side]
        if face >= 0:
            out[count] = face
            count += 1
    return count


@kernel
def side_of(m: WingedEdgeRecords, e: int, f: int) -> int:
    """On which side of edge e face f lies: 0 for the left, 1 for the right."""
    return 0 if m.edge[e, LEFT] == f else 1


@kernel
def face_vertices(m: WingedEdgeRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    e = m.face_edge[f]
    for i in range(3):
        side = side_of(m, e, f)
        out[i] = m.edge[e, TAIL + side]
        e = m.edge[e, LEFT_NEXT + side]
    return 3


@kernel
def face_edges(m: WingedEdgeRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    e = m.face_edge[f]
    for i in range(3):
        out[i] = e
        e = m.edge[e, LEFT_NEXT + side_of(m, e, f)]
    return 3


@kernel
def face_faces(m: WingedEdgeRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    e, count = m.face_edge[f], 0
    for _ in range(3):
        side = side_of(m, e, f)
        beyond = m.edge[e, RIGHT - side]
        if beyond >= 0:
            count = append_face(out, count, beyond)
        e = m.edge[e, LEFT_NEXT + side]
    return count


@njit(cache=True, nogil=True)
def _number_edges(twin: Array, edge_of: Array) -> None:
    """Number the edges in the order of the first of their half-edges."""
    n = 0
    for h in range(len(twin)):
        if twin[h] < 0 or h < twin[h]:
            edge_of[h] = n
            n += 1
        else:
            edge_of[h] = edge_of[twin[h]]


@njit(cache=True, nogil=True)
def _fill(
    begin: int, end: int, part: int, corners: Array, twin: Array, edge_of: Array, edge: Array
) -> None:
    """The first half-edge of an edge gives its direction and left side, the twin its right side."""
    for h in range(begin, end):
        if h > twin[h] >= 0:
            continue
        row, following = edge[edge_of[h]], h + 1 if h % 3 < 2 else h - 2
        row[TAIL], row[HEAD] = corners[h // 3, h % 3], corners[h // 3, following % 3]
        for side in range(2):
            g = h if side == 0 else twin[h]
            base = g - g % 3
            row[LEFT + side] = g // 3 if g >= 0 else -1
            row[LEFT_PREVIOUS + side] = edge_of[base + (g + 2) % 3] if g >= 0 else -1
            row[LEFT_NEXT + side] = edge_of[base + (g + 1) % 3] if g >= 0 else -1


class WingedEdge(Structure):
    """The winged-edge mesh."""

    name, title, abbreviation = "winged_edge", "Winged-Edge", "WEM"
    records_type = WingedEdgeRecords
    fields = (
        Field("vertex.point", "vertex_point", 3),
        Field("vertex.edge", "vertex_edge"),
        Field("face.edge", "face_edge"),
        *(Field(f"edge.{name}", "edge") for name in COLUMNS),
    )
    kernels = named(
        *(vertex_vertices, vertex_edges, vertex_faces),
        *(edge_vertices, edge_edges, edge_faces),
        *(face_vertices, face_edges, face_faces),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference, pairing = REFERENCE_TYPES[reference_bytes], pair_half_edges(mesh)
        edge_of = np.empty_like(pairing.twin)
        _number_edges(pairing.twin, edge_of)
        edge = np.empty((pairing.n_edges, 8), reference)
        in_slices(_fill, len(edge_of), mesh.triangles, pairing.twin, edge_of, edge)
        used = pairing.vertex_half_edge >= 0
        vertex_edge = np.full(len(used), -1, reference)
        vertex_edge[used] = edge_of[pairing.vertex_half_edge[used]]
        face_edge = edge_of[::3].astype(reference)
        return cls(WingedEdgeRecords(mesh.points.copy(), vertex_edge, face_edge, edge))

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.records.face_edge)

    @property
    def _edge_end(self) -> int:
        return len(self.records.edge)

    def edges(self) -> NDArray[np.int64]:
        """(n_edges,) int64: the index of every edge record."""
        return np.arange(len(self.records.edge), dtype=np.int64)

    def validate(self) -> None:
        """See ``Structure.validate``; the invariants stand at the top of this file."""
        m: WingedEdgeRecords = self.records
        n = len(m.edge)
        require_points(m.vertex_point)
        require_references(m.edge[:, [TAIL, HEAD]], self.n_vertices, "end", "edges")
        require_references(m.edge[:, [LEFT, RIGHT]], self.n_faces, "face", "edges", least=-1)
        require_references(m.edge[:, LEFT_PREVIOUS:], n, "wing", "edges", least=-1)
        require_references(m.vertex_edge, n, "edge", "vertices", least=-1)
        require_references(m.face_edge, n, "edge", "faces")

        # As directed edges 2e + side: one row each, whichever way round the edge lies.
        tail, head = m.edge[:, [TAIL, HEAD]].ravel(), m.edge[:, [HEAD, TAIL]].ravel()
        face = m.edge[:, [LEFT, RIGHT]].ravel()
        before = m.edge[:, [LEFT_PREVIOUS, RIGHT_PREVIOUS]].ravel()
        after = m.edge[:, [LEFT_NEXT, RIGHT_NEXT]].ravel()
        owner, inner = np.arange(2 * n) // 2, np.flatnonzero(face >= 0)

        missing = np.stack([face < 0, before < 0, after < 0], axis=1).sum(axis=1)
        winged = np.isin(missing, (0, 3))
        require(winged.reshape(n, 2), "an edge has the wings of its faces, and no others", "edges")
        require(face.reshape(n, 2).max(axis=1, initial=-1) >= 0, "an edge has a face", "edges")
        require_distinct_edges(m.edge[:, TAIL], m.edge[:, HEAD], "edges")

        follower = np.full(2 * n, -1)
        on_right = face[2 * after[inner]] != face[inner]
        follower[inner] = 2 * after[inner] + on_right
        joined = np.ones(2 * n, np.bool_)
        joined[inner] = (face[follower[inner]] == face[inner]) & (
            tail[follower[inner]] == head[inner]
        )
        require(joined.reshape(n, 2), "next lies in the same face and starts at the end", "edges")
        joined[inner] = before[follower[inner]] == owner[inner]
        require(joined.reshape(n, 2), "previous of next is the edge itself", "edges")
        joined[inner] = follower[follower[follower[inner]]] == inner
        require(joined.reshape(n, 2), "three times next comes round", "edges")

        require(
            np.bincount(face[inner], minlength=self.n_faces) == 3, "a face has three edges", "faces"
        )
        own = (m.edge[m.face_edge][:, [LEFT, RIGHT]] == np.arange(self.n_faces)[:, None]).any(
            axis=1
        )
        require(own, "the edge of a face borders it", "faces")
        used = np.bincount(tail, minlength=self.n_vertices) > 0
        require((m.vertex_edge >= 0) == used, "just the vertices with edges have one", "vertices")
        ends = m.edge[m.vertex_edge[used]][:, [TAIL, HEAD]] == np.flatnonzero(used)[:, None]
        require(ends.any(axis=1), "the edge of a vertex ends there", "vertices")
        # Around its tail, clockwise of a directed edge comes the follower of its other direction.
        require_one_fan(tail, follower[np.arange(2 * n) ^ 1])
