"""Indexed mesh (thesis 2.2 and 2.3): points, and three of them for every triangle.

This is what a renderer is given and what Unity stores::

    vertex_point   0: (x, y, z)   1: (x, y, z)   2: …
    triangle       0: (0, 2, 4)   1: (4, 2, 3)   …        counterclockwise from outside

Invariants

- The corners of a triangle are three different vertices that exist.

Nothing is known about neighbors, so whoever asks for one searches all triangles, and nothing keeps
the mesh from being non-manifold. An edge is named by its two vertices. Bytes per vertex:
12 + 2 · 3 · 4 = 36 (thesis 7.1); an index takes 4 bytes, whatever a reference takes.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from hem.invariants import require, require_points, require_references
from hem.kernels import distinct, edge_vertices, edges_at_both_ends, kernel, named, pack
from hem.mesh import TriangleMesh
from hem.packed import PackedEdges
from hem.structure import Field

Array = NDArray[Any]


class IndexedRecords(NamedTuple):
    """One row per record."""

    vertex_point: Array  # (n_v, 3) float32
    triangle: Array  # (n_t, 3) vertices


@kernel
def has_corner(m: IndexedRecords, t: int, v: int) -> bool:
    """Whether v is a corner of triangle t."""
    return m.triangle[t, 0] == v or m.triangle[t, 1] == v or m.triangle[t, 2] == v


@kernel
def vertex_vertices(m: IndexedRecords, v: int, out: Array) -> int:
    """Cost O(n_t)."""
    count = 0
    for t in range(len(m.triangle)):
        if has_corner(m, t, v):
            for i in range(3):
                if m.triangle[t, i] != v:
                    out[count] = m.triangle[t, i]
                    count += 1
    return distinct(out, count)


@kernel
def vertex_edges(m: IndexedRecords, v: int, out: Array) -> int:
    """Cost O(n_t)."""
    count = vertex_vertices(m, v, out)
    for i in range(count):
        out[i] = pack(v, out[i])
    return count


@kernel
def vertex_faces(m: IndexedRecords, v: int, out: Array) -> int:
    """Cost O(n_t)."""
    count = 0
    for t in range(len(m.triangle)):
        if has_corner(m, t, v):
            out[count] = t
            count += 1
    return count


edge_edges = edges_at_both_ends(edge_vertices, vertex_edges)


@kernel
def edge_faces(m: IndexedRecords, e: int, out: Array) -> int:
    """Cost O(n_t): the search of thesis chapter 5."""
    a, b = e >> 32, e & 0xFFFFFFFF
    count = 0
    for t in range(len(m.triangle)):
        if has_corner(m, t, a) and has_corner(m, t, b):
            out[count] = t
            count += 1
    return count


@kernel
def face_vertices(m: IndexedRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    for i in range(3):
        out[i] = m.triangle[f, i]
    return 3


@kernel
def face_edges(m: IndexedRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    for i in range(3):
        out[i] = pack(m.triangle[f, i], m.triangle[f, (i + 1) % 3])
    return 3


@kernel
def face_faces(m: IndexedRecords, f: int, out: Array) -> int:
    """Cost O(n_t)."""
    a, b, c = m.triangle[f, 0], m.triangle[f, 1], m.triangle[f, 2]
    count = 0
    for t in range(len(m.triangle)):
        shared = 0
        for i in range(3):
            v = m.triangle[t, i]
            shared += v == a or v == b or v == c
        if shared >= 2 and t != f:
            out[count] = t
            count += 1
    return count


class Indexed(PackedEdges):
    """The indexed mesh."""

    name, title, abbreviation = "indexed", "Indexed", "Indexed"
    records_type = IndexedRecords
    fields = (Field("vertex.point", "vertex_point", 3), Field("triangle.vertex", "triangle", 3))
    kernels = named(
        *(vertex_vertices, vertex_edges, vertex_faces),
        *(edge_vertices, edge_edges, edge_faces),
        *(face_vertices, face_edges, face_faces),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``. Any mesh is accepted; the indices are 4 bytes in any case."""
        return cls(IndexedRecords(mesh.points.copy(), mesh.triangles.copy()))

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.records.triangle)

    def validate(self) -> None:
        """See ``Structure.validate``; the invariants stand at the top of this file."""
        m: IndexedRecords = self.records
        require_points(m.vertex_point)
        require_references(m.triangle, self.n_vertices, "corner", "faces")
        require(m.triangle != np.roll(m.triangle, 1, axis=1), "corners differ", "faces")
