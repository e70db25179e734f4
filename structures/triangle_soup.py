"""Triangle soup (thesis 2.2): every triangle has three points of its own, and that is all.

This is what an STL file holds::

    triangle_point   0: (x, y, z) (x, y, z) (x, y, z)   1: …        counterclockwise from outside

A point is stored once in each triangle around it. So nothing says that two triangles meet but that
their points are the same, and whoever asks for neighbors compares positions, of all triangles.

A soup knows no vertices, and queries and operations are asked of vertices. So there are names
beside it::

    vertex_point     0: (x, y, z)   1: …    the position that a vertex stands for
    triangle         0: (0, 2, 4)   1: …    what the points of a triangle are called

To ask for the faces around vertex 4 is to look up its position, and to search the soup for that.
Names tell what points are called, and keep two vertices apart that lie at the same position. No
search is the shorter for them.

Invariants

- The corners of a triangle are three different vertices that exist.
- A point of a triangle is the position of the vertex that it is called by.
- Dead: a triangle has corners -1 and no points (NaN), a vertex has no position (NaN).

Nothing keeps the mesh from being non-manifold, and an edge is named by its two vertices. To split a
face takes O(1), to move a vertex a search for all its points. Bytes per vertex: 2 · 3 · 12 = 72,
without the names: 36 more, which ``memory(names=True)`` tells. Nothing in it is a reference.
"""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Self

import numpy as np

from hem.arrays import Array, Points
from hem.authoring import (
    FACE_END,
    LEFT,
    RIGHT,
    VERTEX_END,
    Field,
    Kernels,
    kernel,
    kernels_of,
    packed,
    require,
    scans,
    walks,
)
from hem.contract import Claims, Look, PackedEdges
from hem.meshes import TriangleMesh, read_only
from hem.room import rows
from structures import indexed
from structures.indexed import Indexed, edge_vertices


class SoupRecords(NamedTuple):
    """The names, and the soup."""

    vertex_point: Array  # (n_v, 3) float32
    triangle: Array  # (n_t, 3) vertices
    triangle_point: Array  # (n_t, 9) float32: x, y and z of each corner
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Every search compares positions ------------------------------------------------------------------


@kernel
def is_corner(m: SoupRecords, t: int, i: int, v: int) -> bool:
    """Whether corner i of triangle t lies where vertex v does, and is called v."""
    return bool(
        m.triangle_point[t, 3 * i] == m.vertex_point[v, 0]
        and m.triangle_point[t, 3 * i + 1] == m.vertex_point[v, 1]
        and m.triangle_point[t, 3 * i + 2] == m.vertex_point[v, 2]
        and m.triangle[t, i] == v
    )


has_corner, follows = scans.has_corner(is_corner), scans.follows(is_corner)
vertex_vertices = scans.vertex_vertices(has_corner)
vertex_edges = packed.vertex_edges(vertex_vertices)
vertex_faces = scans.vertex_faces(has_corner)
edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges)
edge_faces = scans.edge_faces(has_corner)
diamond = scans.diamond(has_corner, follows)
face_left_of, are_joined = scans.face_left_of(follows), scans.are_joined(has_corner)
edge_between = packed.between(are_joined)


@kernel
def face_faces(m: SoupRecords, f: int, out: Array) -> int:
    """Cost O(n_t)."""
    count = 0
    for t in range(m.counts[FACE_END]):
        shared = 0
        for i in range(3):
            shared += has_corner(m, t, m.triangle[f, i])
        if shared >= 2 and t != f:
            out[count] = t
            count += 1
    return count


# What is changed of an indexed mesh, and the points with it ---------------------------------------


@kernel
def write_points(m: SoupRecords, t: int) -> None:
    """Give triangle t the positions of its vertices, or none if it is dead."""
    for i in range(3):
        for j in range(3):
            v = m.triangle[t, i]
            m.triangle_point[t, 3 * i + j] = m.vertex_point[v, j] if v >= 0 else np.nan


@kernel
def set_point(m: SoupRecords, v: int, point: Array) -> None:
    """Cost O(n_t) for a vertex that there is, as each triangle around it has the point."""
    if v < m.counts[VERTEX_END]:
        for t in range(m.counts[FACE_END]):
            for i in range(3):
                if is_corner(m, t, i, v):
                    for j in range(3):
                        m.triangle_point[t, 3 * i + j] = point[j]
    for j in range(3):
        m.vertex_point[v, j] = point[j]


@kernel
def split_edge_records(m: SoupRecords, e: int, at: Array, v: int, f: int) -> None:
    """Cost O(1) when the triangles are known, which takes a scan."""
    indexed.split_edge_records(m, e, at, v, f)
    for side in (LEFT, RIGHT):
        if at[side] >= 0:
            write_points(m, at[side])
            write_points(m, f)
            f += 1


@kernel
def split_face_records(m: SoupRecords, face: int, v: int, f: int, corners: Array) -> None:
    """Cost O(1)."""
    indexed.split_face_records(m, face, v, f, corners)
    write_points(m, face)
    write_points(m, f)
    write_points(m, f + 1)


@kernel
def collapse_records(
    m: SoupRecords, e: int, at: Array, drop: int, keep: int, around: int, out: Array
) -> None:
    """Cost O(n_ev) when the triangles are known, which takes a scan."""
    indexed.collapse_records(m, e, at, drop, keep, around, out)
    for i in range(around):
        write_points(m, out[i])


@kernel
def flip_records(m: SoupRecords, e: int, at: Array, one: int, other: int) -> None:
    """Cost O(1) when the triangles are known, which takes a scan."""
    indexed.flip_records(m, e, at, one, other)
    write_points(m, one)
    write_points(m, other)


@kernel
def add_records(m: SoupRecords, corners: Array, f: int) -> None:
    """Cost O(1)."""
    indexed.add_records(m, corners, f)
    write_points(m, f)


@kernel
def remove_records(m: SoupRecords, f: int) -> None:
    """Cost O(1)."""
    indexed.remove_records(m, f)
    write_points(m, f)


class TriangleSoup(PackedEdges):
    """The triangle soup."""

    name, title, abbreviation = "triangle_soup", "Triangle Soup", "Soup"
    look, order = Look("#aa4499", "X", ":"), 9
    claims = Claims("no document says what it costs; what is found is shown")
    searches = searches_to_move = True
    records_type = SoupRecords
    kernels: ClassVar[Kernels] = {**Indexed.kernels, **kernels_of(__name__)}
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True, names=True),
        Field("triangle.vertex", "triangle", 3, target="vertex", marks=True, names=True),
        Field("triangle.point", "triangle_point", 9),
    )

    @property
    def points(self) -> Points:
        """See ``Surveying.points``; read-only, as the triangles would not follow."""
        return read_only(super().points)

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``. Any mesh is accepted; there are no references in it."""
        m = Indexed.build(mesh).records
        points = rows(len(mesh.triangles), 9, dtype=np.float32)
        mesh.points.take(mesh.triangles, axis=0, out=points.reshape(-1, 3, 3), mode="clip")
        return cls(SoupRecords(m.vertex_point, m.triangle, points, m.counts))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, faces = self.records, self.faces()
        corner = m.triangle[faces]
        require(corner != np.roll(corner, 1, axis=1), "corners differ", "faces", of=faces)
        told = m.vertex_point[corner].reshape(-1, 9) == m.triangle_point[faces]
        require(told.all(axis=1), "points are where their vertices lie", "faces", of=faces)
        end = m.counts[FACE_END]
        gone = (m.triangle[:end, 0] >= 0) | np.isnan(m.triangle_point[:end]).all(axis=1)
        require(gone, "a dead triangle has no points", "faces")
