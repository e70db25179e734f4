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

There is no previous (it is next of next) and no half-edge outside the border. An edge is named by
the smaller index of its two half-edges. Bytes per vertex with 8-byte references:
12 + 8 + 2 · 8 + 6 · 32 = 228 (thesis 7.4).
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

ORIGIN, FACE, NEXT, TWIN = range(4)  # the columns of a half-edge


class HalfEdgeRecords(NamedTuple):
    """One row per record, so that one half-edge is one cache line."""

    vertex_point: Array  # (n_v, 3) float32
    vertex_half_edge: Array  # (n_v,) one that leaves the vertex
    face_half_edge: Array  # (n_t,)
    half_edge: Array  # (3 n_t, 4) origin, face, next, twin


@kernel
def clockwise(m: HalfEdgeRecords, h: int, v: int) -> int:
    """The next half-edge that leaves v."""
    twin = m.half_edge[h, TWIN]
    return m.half_edge[twin, NEXT] if twin >= 0 else -1


@kernel
def previous(m: HalfEdgeRecords, h: int) -> int:
    """The half-edge before h in its face."""
    return m.half_edge[m.half_edge[h, NEXT], NEXT]


@kernel
def counterclockwise(m: HalfEdgeRecords, h: int, v: int) -> int:
    """The half-edge that leaves v before h."""
    return m.half_edge[previous(m, h), TWIN]


outgoing = circulator(clockwise, counterclockwise)


@kernel
def edge_of(m: HalfEdgeRecords, h: int) -> int:
    """The name of h's edge: the smaller of its two half-edges."""
    twin = m.half_edge[h, TWIN]
    return h if twin < 0 else min(h, twin)


@kernel
def vertex_vertices(m: HalfEdgeRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, closed = outgoing(m, m.vertex_half_edge[v], v, out)
    last = out[count - 1]
    for i in range(count):
        out[i] = m.half_edge[m.half_edge[out[i], NEXT], ORIGIN]
    if closed or count == 0:
        return count
    out[count] = m.half_edge[previous(m, last), ORIGIN]
    return count + 1


@kernel
def vertex_edges(m: HalfEdgeRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, closed = outgoing(m, m.vertex_half_edge[v], v, out)
    last = out[count - 1]
    for i in range(count):
        out[i] = edge_of(m, out[i])
    if closed or count == 0:
        return count
    out[count] = previous(m, last)
    return count + 1


@kernel
def vertex_faces(m: HalfEdgeRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    count, _ = outgoing(m, m.vertex_half_edge[v], v, out)
    for i in range(count):
        out[i] = m.half_edge[out[i], FACE]
    return count


@kernel
def edge_vertices(m: HalfEdgeRecords, e: int, out: Array) -> int:
    """Cost O(1)."""
    out[0] = m.half_edge[e, ORIGIN]
    out[1] = m.half_edge[m.half_edge[e, NEXT], ORIGIN]
    return 2


edge_edges = edges_at_both_ends(edge_vertices, vertex_edges)


@kernel
def edge_faces(m: HalfEdgeRecords, e: int, out: Array) -> int:
    """Cost O(1)."""
    out[0] = m.half_edge[e, FACE]
    twin = m.half_edge[e, TWIN]
    if twin < 0:
        return 1
    out[1] = m.half_edge[twin, FACE]
    return 2


@kernel
def face_vertices(m: HalfEdgeRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    h = m.face_half_edge[f]
    for i in range(3):
        out[i] = m.half_edge[h, ORIGIN]
        h = m.half_edge[h, NEXT]
    return 3


@kernel
def face_edges(m: HalfEdgeRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    h = m.face_half_edge[f]
    for i in range(3):
        out[i] = edge_of(m, h)
        h = m.half_edge[h, NEXT]
    return 3


@kernel
def face_faces(m: HalfEdgeRecords, f: int, out: Array) -> int:
    """Cost O(1)."""
    h, count = m.face_half_edge[f], 0
    for _ in range(3):
        twin = m.half_edge[h, TWIN]
        if twin >= 0:
            count = append_face(out, count, m.half_edge[twin, FACE])
        h = m.half_edge[h, NEXT]
    return count


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


class HalfEdge(Structure):
    """The half-edge mesh."""

    name, title, abbreviation = "half_edge", "Half-Edge", "HEM"
    records_type = HalfEdgeRecords
    fields = (
        Field("vertex.point", "vertex_point", 3),
        Field("vertex.half_edge", "vertex_half_edge"),
        Field("face.half_edge", "face_half_edge"),
        *(Field(f"half_edge.{name}", "half_edge") for name in ("origin", "face", "next", "twin")),
    )
    kernels = named(
        *(vertex_vertices, vertex_edges, vertex_faces),
        *(edge_vertices, edge_edges, edge_faces),
        *(face_vertices, face_edges, face_faces),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``."""
        reference, n = REFERENCE_TYPES[reference_bytes], len(mesh.triangles)
        face, half_edge = np.empty(n, reference), np.empty((3 * n, 4), reference)
        pairing = pair_half_edges(mesh, room=half_edge)
        in_slices(_fill, n, mesh.triangles, pairing.twin, face, half_edge)
        vertex = pairing.vertex_half_edge.astype(reference, copy=False)
        built = cls(HalfEdgeRecords(mesh.points.copy(), vertex, face, half_edge))
        built.n_edges = pairing.n_edges
        return built

    @property
    def n_faces(self) -> int:
        """Number of faces."""
        return len(self.records.face_half_edge)

    @property
    def _edge_end(self) -> int:
        return len(self.records.half_edge)

    def edges(self) -> NDArray[np.int64]:
        """(n_edges,) int64: of each pair of half-edges the smaller."""
        twin = self.records.half_edge[:, TWIN]
        return np.flatnonzero((twin < 0) | (np.arange(len(twin)) < twin))

    def validate(self) -> None:
        """See ``Structure.validate``; the invariants stand at the top of this file."""
        m: HalfEdgeRecords = self.records
        origin, face, following, twin = m.half_edge.T
        n, h = len(m.half_edge), np.arange(len(m.half_edge))
        require_points(m.vertex_point)
        require_references(origin, self.n_vertices, "origin", "half_edges")
        require_references(face, self.n_faces, "face", "half_edges")
        require_references(following, n, "next", "half_edges")
        require_references(twin, n, "twin", "half_edges", least=-1)
        require_references(m.vertex_half_edge, n, "half-edge", "vertices", least=-1)
        require_references(m.face_half_edge, n, "half-edge", "faces")

        require(following != h, "next is another half-edge", "half_edges")
        require(following[following[following]] == h, "three times next comes round", "half_edges")
        require(face[following] == face, "next lies in the same face", "half_edges")
        require(
            face[m.face_half_edge] == np.arange(self.n_faces),
            "a face's half-edge lies in it",
            "faces",
        )
        require(
            np.bincount(face, minlength=self.n_faces) == 3, "a face has three half-edges", "faces"
        )

        inner = np.flatnonzero(twin >= 0)
        paired, other = np.ones(n, np.bool_), twin[inner]
        paired[inner] = (other != inner) & (twin[other] == inner)
        require(paired, "twin of twin is the half-edge itself", "half_edges")
        paired[inner] = (origin[other] == origin[following[inner]]) & (
            origin[following[other]] == origin[inner]
        )
        require(paired, "twins run opposite ways between the same vertices", "half_edges")

        leaving, used = m.vertex_half_edge, np.bincount(origin, minlength=self.n_vertices) > 0
        require((leaving >= 0) == used, "just the vertices with faces have a half-edge", "vertices")
        require(
            origin[leaving[used]] == np.flatnonzero(used),
            "a vertex' half-edge starts at it",
            "vertices",
        )
        clockwise = np.full(n, -1)
        clockwise[inner] = following[other]
        require_one_fan(origin, clockwise)
        edges = self.edges()
        require_distinct_edges(origin[edges], origin[following[edges]], "edges")
