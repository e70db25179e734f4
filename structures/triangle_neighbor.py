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

Who walks around a vertex must find it again among the corners of every triangle on the way. An edge
is named by its two vertices. Bytes per vertex with 8-byte references: 12 + 8 + 2 · 48 = 116
(thesis 7.2).
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
from hem.kernels import (
    append_face,
    circulator,
    edge_vertices,
    edges_at_both_ends,
    kernel,
    named,
    pack,
)
from hem.mesh import TriangleMesh
from hem.packed import PackedEdges
from hem.pairing import pair_half_edges
from hem.slices import in_slices
from hem.structure import REFERENCE_TYPES, Field

Array = NDArray[Any]

NEIGHBOR, CORNER = 0, 3  # the first of three columns each


class TriangleNeighborRecords(NamedTuple):
    """One row per record."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_triangle: Array  # (n_v,) one of the triangles at the vertex
    triangle: Array  # (n_t, 6) three neighbors, three corners


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


fan = circulator(clockwise, counterclockwise)


@kernel
def vertex_vertices(m: TriangleNeighborRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, closed = fan(m, m.vertex_triangle[v], v, out)
    last = out[count - 1]
    for k in range(count):
        out[k] = m.triangle[out[k], CORNER + (corner_of(m, out[k], v) + 1) % 3]
    if closed or count == 0:
        return count
    out[count] = m.triangle[last, CORNER + (corner_of(m, last, v) + 2) % 3]
    return count + 1


@kernel
def vertex_edges(m: TriangleNeighborRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count = vertex_vertices(m, v, out)
    for k in range(count):
        out[k] = pack(v, out[k])
    return count


@kernel
def vertex_faces(m: TriangleNeighborRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, _ = fan(m, m.vertex_triangle[v], v, out)
    return count


edge_edges = edges_at_both_ends(edge_vertices, vertex_edges)


@kernel
def edge_faces(m: TriangleNeighborRecords, e: int, out: Array) -> int:
    """Cost O(n_ev): the triangles at one end are searched for the other."""
    a, b = e >> 32, e & 0xFFFFFFFF
    around, _ = fan(m, m.vertex_triangle[a], a, out)
    count = 0
    for k in range(around):
        t = out[k]
        if b == m.triangle[t, CORNER + corner_of(m, t, b)]:
            out[count] = t
            count += 1
    return count


@kernel
def face_vertices(m: TriangleNeighborRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    for i in range(3):
        out[i] = m.triangle[f, CORNER + i]
    return 3


@kernel
def face_edges(m: TriangleNeighborRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    for i in range(3):
        out[i] = pack(m.triangle[f, CORNER + i], m.triangle[f, CORNER + (i + 1) % 3])
    return 3


@kernel
def face_faces(m: TriangleNeighborRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    count = 0
    for i in range(3):
        neighbor = m.triangle[f, NEIGHBOR + i]
        if neighbor >= 0:
            count = append_face(out, count, neighbor)
    return count


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
    records_type = TriangleNeighborRecords
    fields = (
        Field("vertex.point", "vertex_point", 3),
        Field("vertex.triangle", "vertex_triangle"),
        Field("triangle.neighbor", "triangle", 3),
        Field("triangle.vertex", "triangle", 3),
    )
    kernels = named(
        *(vertex_vertices, vertex_edges, vertex_faces),
        *(edge_vertices, edge_edges, edge_faces),
        *(face_vertices, face_edges, face_faces),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference = REFERENCE_TYPES[reference_bytes]
        triangle = np.empty((len(mesh.triangles), 6), reference)
        pairing = pair_half_edges(mesh, room=triangle)
        in_slices(_fill, len(triangle), mesh.triangles, pairing.twin, triangle)
        vertex_triangle = (pairing.vertex_half_edge // 3).astype(reference)  # -1 stays -1
        built = cls(TriangleNeighborRecords(mesh.points.copy(), vertex_triangle, triangle))
        built.n_edges = pairing.n_edges
        return built

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.records.triangle)

    def validate(self) -> None:
        """See ``Structure.validate``; the invariants stand at the top of this file."""
        m: TriangleNeighborRecords = self.records
        corner, beyond = m.triangle[:, CORNER:], m.triangle[:, NEIGHBOR:CORNER]
        require_points(m.vertex_point)
        require_references(corner, self.n_vertices, "corner", "faces")
        require_references(beyond, self.n_faces, "neighbor", "faces", least=-1)
        require_references(m.vertex_triangle, self.n_faces, "triangle", "vertices", least=-1)
        require(corner != np.roll(corner, 1, axis=1), "corners differ", "faces")

        used = np.bincount(corner.ravel(), minlength=self.n_vertices) > 0
        require((m.vertex_triangle >= 0) == used, "just vertices with faces have one", "vertices")
        at = corner[m.vertex_triangle[used]] == np.flatnonzero(used)[:, None]
        require(at.any(axis=1), "the triangle of a vertex has it as a corner", "vertices")

        # Edge i of t runs a → b; the neighbor must run b → a along its edge j, and know t there.
        t, i = np.nonzero(beyond >= 0)
        u, a, b = beyond[t, i], corner[t, i], corner[t, (i + 1) % 3]
        j = np.argmax(corner[u] == b[:, None], axis=1)
        met = (corner[u, j] == b) & (corner[u, (j + 1) % 3] == a) & (beyond[u, j] == t)
        paired = np.ones(self.n_faces, np.bool_)
        paired[t[~met]] = False
        require(paired, "neighbors name each other across one edge, run opposite ways", "faces")

        clockwise_corner = np.full(corner.size, -1)
        clockwise_corner[3 * t + i] = 3 * u + (j + 1) % 3
        require_one_fan(corner.ravel(), clockwise_corner)
        once = beyond < np.arange(self.n_faces)[:, None]  # border, or the later of the two
        require_distinct_edges(corner[once], np.roll(corner, -1, axis=1)[once], "edges")
