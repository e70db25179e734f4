"""Indexed mesh (thesis 2.2 and 2.3): points, and three of them for every triangle.

This is what a renderer is given and what Unity stores::

    vertex_point   0: (x, y, z)   1: (x, y, z)   2: …
    triangle       0: (0, 2, 4)   1: (4, 2, 3)   …        counterclockwise from outside

Invariants

- The corners of a triangle are three different vertices that exist.
- Dead: a triangle has corners -1, a vertex has no position (NaN).

Nothing is known about neighbors, so whoever asks for one searches all triangles, and nothing keeps
the mesh from being non-manifold. An edge is named by its two vertices. Bytes per vertex:
12 + 2 · 3 · 4 = 36 (thesis 7.1); an index takes 4 bytes, whatever a reference takes.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from hem.arrays import Array
from hem.authoring import (
    FACE_END,
    LEFT,
    RIGHT,
    UNKNOWN,
    A,
    B,
    C,
    D,
    Field,
    counted,
    kernel,
    packed,
    require,
    scans,
    steps,
    walks,
)
from hem.contract import Look, PackedEdges
from hem.meshes import TriangleMesh
from hem.room import roomy


class IndexedRecords(NamedTuple):
    """One row per record."""

    vertex_point: Array  # (n_v, 3) float32
    triangle: Array  # (n_t, 3) vertices
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Nothing is recorded of an edge.
edge_exists, edge_vertices, pack = packed.edge_exists, packed.edge_vertices, packed.pack


@kernel
def is_corner(m: IndexedRecords, t: int, i: int, v: int) -> bool:
    """Whether corner i of triangle t is vertex v."""
    return bool(m.triangle[t, i] == v)


# Every one of these looks at all triangles: O(n_t).
has_corner, follows = scans.has_corner(is_corner), scans.follows(is_corner)
vertex_vertices = scans.vertex_vertices(has_corner)
vertex_edges = packed.vertex_edges(vertex_vertices)
vertex_faces = scans.vertex_faces(has_corner)
edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges)
edge_faces = scans.edge_faces(has_corner)


@kernel
def corner(m: IndexedRecords, f: int, i: int) -> int:
    """Corner i of triangle f."""
    return m.triangle[f, i]


ahead = steps.asking(IndexedRecords, "triangle")
face_vertices, face_edges = packed.face_vertices(corner, ahead), packed.face_edges(corner)


@kernel
def face_faces(m: IndexedRecords, f: int, out: Array) -> int:
    """Cost O(n_t)."""
    a, b, c = m.triangle[f, 0], m.triangle[f, 1], m.triangle[f, 2]
    count = 0
    for t in range(m.counts[FACE_END]):
        shared = 0
        for i in range(3):
            v = m.triangle[t, i]
            shared += v == a or v == b or v == c
        if shared >= 2 and t != f:
            out[count] = t
            count += 1
    return count


# What operations need to know, and what they change (see hem.authoring.operations) --------------


face_exists = steps.recorded(FACE_END, steps.column(IndexedRecords, "triangle", 0))
diamond = scans.diamond(has_corner, follows)
face_left_of, are_joined = scans.face_left_of(follows), scans.are_joined(has_corner)
edge_between = packed.between(are_joined)


@kernel
def set_triangle(m: IndexedRecords, t: int, a: int, b: int, c: int) -> None:
    """Write the corners of triangle t."""
    m.triangle[t, 0], m.triangle[t, 1], m.triangle[t, 2] = a, b, c


@kernel
def replace(m: IndexedRecords, t: int, old: int, new: int) -> None:
    """Put another vertex into a corner of triangle t."""
    for i in range(3):
        if m.triangle[t, i] == old:
            m.triangle[t, i] = new


@kernel
def split_edge_records(m: IndexedRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1) when the triangles are known, which takes a scan."""
    for side in (LEFT, RIGHT):
        t = at[side]
        if t >= 0:
            set_triangle(m, f, m.triangle[t, 0], m.triangle[t, 1], m.triangle[t, 2])
            replace(m, f, at[A], v)
            replace(m, t, at[B], v)
            f += 1


@kernel
def split_face_records(m: IndexedRecords, face: int, v: int, f: int, corners: Array) -> None:
    """Cost O(1)."""
    i = 0
    for j in range(1, 3):
        if m.triangle[face, j] < m.triangle[face, i]:
            i = j
    a, b, c = m.triangle[face, i], m.triangle[face, (i + 1) % 3], m.triangle[face, (i + 2) % 3]
    corners[0], corners[1], corners[2] = a, b, c
    set_triangle(m, face, a, b, v)
    set_triangle(m, f, b, c, v)
    set_triangle(m, f + 1, c, a, v)


@kernel
def collapse_records(
    m: IndexedRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) when the triangles are known, which takes a scan."""
    for i in range(around):
        replace(m, out[i], drop, keep)
    for side in (LEFT, RIGHT):
        if at[side] >= 0:
            remove_records(m, at[side])


@kernel
def flip_records(m: IndexedRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1) when the triangles are known, which takes a scan."""
    set_triangle(m, one, at[A], at[D], at[C])
    set_triangle(m, other, at[B], at[C], at[D])


@kernel
def add_records(m: IndexedRecords, corners: Array, f: int) -> None:
    """Cost O(1)."""
    set_triangle(m, f, corners[0], corners[1], corners[2])


@kernel
def remove_records(m: IndexedRecords, f: int) -> None:
    """Cost O(1)."""
    set_triangle(m, f, -1, -1, -1)


class Indexed(PackedEdges):
    """The indexed mesh."""

    name, title, abbreviation = "indexed", "Indexed", "Indexed"
    look, thesis, order = Look("#111111", "s", "-"), True, 1
    searches = True
    records_type = IndexedRecords
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True),
        Field("triangle.vertex", "triangle", 3, target="vertex", marks=True),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``. Any mesh is accepted; the indices are 4 bytes in any case."""
        count = counted(len(mesh.points), UNKNOWN, len(mesh.triangles))
        return cls(IndexedRecords(roomy(mesh.points), roomy(mesh.triangles), count))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        faces = self.faces()
        corner = self.records.triangle[faces]
        require(corner != np.roll(corner, 1, axis=1), "corners differ", "faces", of=faces)
