"""Plankton's half-edge mesh: pairs of half-edges, with borders and polygons.

The data structure itself, its invariants and kernels, stands in ``structures.pairs``; operations of
polygons in ``structures.polygons``. This is the mesh that users hold: they ask it as any structure,
and for what polygons need beside::

    mesh = structures.build("plankton", "house.obj")     # quads and n-gons stay
    h = mesh.split_face(mesh.face_half_edges(0)[0], mesh.face_half_edges(0)[2])
    mesh.merge_faces(h)                                            # as it was

Half-edges are named by their index, an edge by the first of its two. Where an operation of the
contract meets a polygon: ``split_face`` with a point joins all corners to it, ``collapse_edge``
takes a corner from it, ``remove_face`` and ``add_face`` take it as it is; ``flip_edge`` and
``split_edge`` are refused, but for the split's form that only puts a vertex on the edge.
"""

from __future__ import annotations

from functools import partial
from numbers import Real
from operator import attrgetter
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array
from hem.authoring import (
    EDGE_END,
    OPERATIONS,
    REFERENCE_TYPES,
    SIDES,
    Field,
    counted,
    in_slices,
    kernels_of,
    live,
    number_edges,
    pair_half_edges,
    pair_polygons,
    require,
    require_edges,
    require_of_vertices,
    require_one_fan,
    require_one_loop,
)
from hem.contract import Claims, Look, Navigable, arguments, centroids
from hem.edit import Edit
from hem.errors import MeshError, TopologyError
from hem.meshes import PolygonMesh, TriangleMesh
from hem.ragged import Ragged
from hem.room import roomy, rows
from structures import pairs
from structures.pairs import FACE, NEXT, PREVIOUS, START, PlanktonRecords
from structures.polygons import POLYGON_OPERATIONS

INTEGERS = int, np.integer  # made once: to make a union of types takes as long as to split a face


def _known_as(step: str) -> Any:
    """A step under the name that the article gives it. See ``Navigable``."""
    return property(attrgetter(step), doc=getattr(Navigable, step).__doc__)


class Plankton(Navigable):
    """The half-edge mesh of Plankton."""

    name, title, abbreviation = "plankton", "Plankton", "Plankton"
    look, order = Look("#1b7f5c", "P", ":"), 6
    claims = Claims("the article on Plankton: a half-edge mesh", like="half_edge")
    holds_polygons = True
    records_type = PlanktonRecords
    fields = (
        Field("vertex.point", "vertex_point", 3, marks=True),
        Field("vertex.half_edge", "vertex_half_edge", target="half_edge", optional=True),
        Field("face.half_edge", "face_half_edge", target="half_edge", marks=True),
        Field("half_edge.start", "half_edge", target="vertex", marks=True),
        Field("half_edge.face", "half_edge", target="face", optional=True),
        Field("half_edge.next", "half_edge", target="half_edge"),
        Field("half_edge.previous", "half_edge", target="half_edge"),
    )
    kernels = kernels_of(pairs.__name__)
    operations = OPERATIONS | POLYGON_OPERATIONS

    @classmethod
    def build(cls, mesh: TriangleMesh | PolygonMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``; faces may have any number of corners."""
        reference = REFERENCE_TYPES[reference_bytes]
        if isinstance(mesh, PolygonMesh):
            corners, offsets = mesh.faces.values, mesh.faces.offsets
            n, most, room = len(mesh.faces), mesh.most_corners, None
            pairing = pair_polygons(mesh)
        else:
            corners, offsets = mesh.triangles.reshape(-1), None
            n, most = len(mesh.triangles), 3
            room = rows(3 * n, 4, dtype=reference)
            pairing = pair_half_edges(mesh, room=room)
        n_half_edges = 2 * pairing.n_edges
        if room is None or n_half_edges > len(room):
            room = rows(n_half_edges, 4, dtype=reference)
        half, face = np.empty(len(corners), np.int32), rows(n, dtype=reference)
        vertex = rows(len(mesh.points), dtype=reference)
        vertex[:] = -1
        number_edges(pairing.twin, half)
        pairs.keep_last(corners, half, vertex)
        if offsets is None:
            in_slices(pairs.fill, n, corners, half, face, room)
        else:
            in_slices(pairs.fill_polygons, n, corners, offsets, half, face, room)
        if n_half_edges > len(corners):
            pairs.go_round_holes(half[pairing.twin < 0], vertex, room)
        own = n_half_edges, 6, most, pairing.valence
        count = counted(len(mesh.points), pairing.n_edges, n, *own)
        return cls(PlanktonRecords(roomy(mesh.points), vertex, face, room, count))

    # Elements --------------------------------------------------------------------------------

    @property
    def n_half_edges(self) -> int:
        """Number of live half-edges, two per edge."""
        return 2 * self.n_edges

    start_vertex, end_vertex = _known_as("origin"), _known_as("tip")
    adjacent_face, pair = _known_as("face"), _known_as("twin")
    next_half_edge, previous_half_edge = _known_as("next"), _known_as("previous")
    outgoing_half_edge, first_half_edge = _known_as("vertex_half_edge"), _known_as("face_half_edge")

    def find_half_edge(self, a: int, b: int) -> int | None:
        """The half-edge that runs from vertex a to vertex b, or None. Cost O(n_ev)."""
        e = self.find_edge(a, b)
        if e is None:
            return None
        return e if self.start_vertex(e) == a else e ^ 1

    def vertex_half_edges(self, vertex: int) -> NDArray[np.int64]:
        """(valence,) the half-edges that leave a vertex, counterclockwise, of any valence."""
        edges = self.vertex_edges(arguments.integer("vertex_half_edges", "vertex", vertex))
        starts = self.records.half_edge[edges, START]
        return edges + (starts != vertex)

    def face_half_edges(self, face: int) -> NDArray[np.int64]:
        """(corners,) the half-edges round a face, from its first."""
        face = arguments.integer("face_half_edges", "face", face)
        edges, corners = self.face_edges(face), self.face_vertices(face)
        return edges + (self.records.half_edge[edges, START] != corners)

    # What the mesh is like ----------------------------------------------------------------------

    def vertex_naked_edges(self, vertex: int) -> int:
        """How many edges at a vertex lie on the border: 0 or 2. Cost O(1)."""
        h = self.outgoing_half_edge(arguments.integer("vertex_naked_edges", "vertex", vertex))
        return 2 if h >= 0 and self.records.half_edge[h, FACE] < 0 else 0

    def face_naked_edges(self, face: int) -> int:
        """How many edges of a face lie on the border. Cost O(corners)."""
        return int((self.records.half_edge[self.face_half_edges(face) ^ 1, FACE] < 0).sum())

    def face_normals(self) -> NDArray[np.float64]:
        """(n_faces, 3) by Newell's sum over the corners of each face, as long as its area. O(n)."""
        face, here, there = self._sides()
        summed = np.zeros((self.n_faces, 3))
        np.add.at(summed, face, np.cross(here, there) / 2)
        return summed

    def vertex_normals(self) -> NDArray[np.float64]:
        """(n_vertices, 3) unit normals, faces weighing by area; zero without faces. O(n)."""
        rows = self.face_vertices(self.faces())
        summed = np.zeros((len(self.points), 3))
        np.add.at(summed, rows.values, np.repeat(self.face_normals(), rows.counts, axis=0))
        lengths = np.linalg.norm(summed, axis=1, keepdims=True)
        return np.divide(summed, lengths, out=summed, where=lengths > 0)[self.vertices()]

    def volume(self) -> float:
        """The enclosed volume, positive where faces are counterclockwise from outside. O(n).

        Faces that are not flat count as their fans. MeshError for a mesh that is not closed.
        """
        outside = self._outside()
        if len(outside):
            raise MeshError(
                "a mesh with borders encloses no volume; close its holes", half_edges=outside
            )
        return self.to_triangles().volume()

    def to_polygons(self) -> PolygonMesh:
        """The same mesh as points and faces of any number of corners. Cost O(n)."""
        rows, alive = self.face_vertices(self.faces()), self.vertices()
        number = np.zeros(len(self.points), np.int32)
        number[alive] = np.arange(len(alive), dtype=np.int32)
        return PolygonMesh(self.points[alive], Ragged(rows.offsets, number[rows.values]))

    def to_triangles(self) -> TriangleMesh:
        """As ``Structure.to_triangles``; a larger face becomes the fan of its first corner."""
        return self.to_polygons().triangulated()

    def dual(self) -> Plankton:
        """A vertex in the middle of every face, a face around every vertex inside. Cost O(n).

        A closed mesh has as many edges as its dual, whose dual has the same faces again. Around a
        vertex on the border there is none. TopologyError if a vertex inside has fewer than three
        edges.
        """
        faces, inner = self.faces(), self._inner_vertices()
        rings = self.vertex_faces(inner)
        if (rings.counts < 3).any():
            few = inner[rings.counts < 3]
            raise TopologyError("a face of the dual would have two corners", vertices=few)
        number = np.zeros(self.face_end, np.int32)
        number[faces] = np.arange(len(faces), dtype=np.int32)
        dual = Ragged(rings.offsets, number[rings.values])
        mesh = PolygonMesh(centroids(self, faces), dual)
        return type(self).build(mesh, self._half_edges.itemsize)

    # What can be done with polygons -------------------------------------------------------------

    def add_face(self, *corners: int) -> Edit:
        """Make a face of three vertices or more, counterclockwise. 1 face and 0 to n edges more.

        Every corner must be without faces or share an edge with the surface. Cost O(n · n_ev).
        """
        if len(corners) == 3:
            return super().add_face(*corners)
        if len(corners) < 3:
            raise MeshError(f"add_face takes three corners or more, not {len(corners)}")
        return self._polygonal("add_face", "add_face", *corners)[1]

    def split_edge(self, edge: int, point: ArrayLike, triangles: bool = True) -> Edit:
        """Put a new vertex on an edge; each face there becomes two.

        With ``triangles=False`` the faces stay whole and have a corner more, whatever they have:
        1 vertex and 1 edge more.
        """
        if triangles:
            return self._do["split_edge"](edge, point)
        return self._polygonal("split_edge", "insert_vertex", edge, point=point)[1]

    def split_face(self, face: int, point: Any) -> Any:
        """Split a face: at a point into triangles -> Edit, or along a diagonal -> its half-edge.

        ``split_face(face, point)``: a new vertex, joined to all n corners. 1 vertex, n edges and
        n - 1 faces more. ``split_face(a, b)`` with two half-edges of one face: an edge between the
        vertices where they start. 1 edge and 1 face more; what is returned is the half-edge of it
        in the face that keeps its index, and ``merge_faces`` of it undoes the split. Refused where
        both corners are joined already. Cost O(n).
        """
        if isinstance(point, INTEGERS):
            return self._polygonal("split_face", "cut_across", face, point)[0]
        return self._do["split_face"](face, point)

    def stellate(self, face: int, point: ArrayLike | None = None) -> Edit:
        """Join all corners of a face to a new vertex, in their middle unless a point is given."""
        self._operations.require_different("stellate", "face", [face])
        middle = self.points[self.face_vertices(face)].mean(axis=0, dtype=np.float64)
        place = middle if point is None else point
        return self._polygonal("stellate", "split_face", face, point=place)[1]

    def merge_faces(self, half_edge: int) -> int:
        """Make one face of the two at an edge: that of the half-edge takes in the other -> it.

        1 edge and 1 face fewer. Refused at the border, and where the faces meet at other corners
        than the ends of the edge. Cost O(corners).
        """
        return self._polygonal("merge_faces", "merge_faces", half_edge)[0]

    def split_vertex(self, first: int, second: int, point: ArrayLike | None = None) -> Edit:
        """Split the vertex that two half-edges leave in two that an edge joins.

        The new one takes the half-edges from ``first``, counterclockwise, to before ``second``. The
        two faces at the new edge have a corner more. 1 vertex and 1 edge more; undone by collapsing
        the edge. Without a point the new vertex lies where the old one does. Cost O(n_ev).
        """
        if point is None:
            self._operations.require_different("split_vertex", "half_edge", [first])
            point = self.points[self.start_vertex(first)]
        return self._polygonal("split_vertex", "split_vertex", first, second, point=point)[1]

    def erase_center_vertex(self, vertex: int) -> int:
        """Take a vertex inside the surface away; its faces become one -> that.

        1 vertex, n edges and n - 1 faces fewer. Refused at the border, and where the faces meet at
        other corners than the neighbors of the vertex. Cost O(corners).
        """
        return self._polygonal("erase_center_vertex", "erase_vertex", vertex)[0]

    def truncate_vertex(self, vertex: int, fraction: float = 1 / 3) -> int:
        """Cut a corner off: a face of n corners takes the place of a vertex of n edges -> it.

        The new vertices lie at a fraction of the way along the edges. n - 1 vertices, n edges and 1
        face more. Refused at the border, and for fewer than three edges. One edit. O(corners).
        """
        if not (isinstance(fraction, Real) and 0 < fraction < 1):
            words = f"a vertex is truncated at a fraction between 0 and 1, not {fraction!r}"
            raise MeshError(words)
        self._operations.require_different("truncate_vertex", "vertex", [vertex])
        spokes = self.vertex_half_edges(vertex)
        if len(spokes) < 3 or self.vertex_naked_edges(vertex):
            raise TopologyError(
                "cannot truncate_vertex: the vertex lies on the border, or has fewer than three "
                "edges",
                vertices=[vertex],
            )
        ends = self.points[self._half_edges[spokes ^ 1, START]]
        points = (1 - fraction) * self.points[vertex] + fraction * ends
        logs, told = [np.zeros(0, np.int64)], 0
        followers, run = self._followers, partial(self._operations.run, logs=logs)
        try:
            run("insert_vertex", arguments.rows(spokes), points.astype(np.float32))
            before = self._half_edges[spokes, PREVIOUS]  # from the next new vertex to this one
            ends = np.stack([self._half_edges[spokes, NEXT], before, before], axis=1)
            run("cut_across", ends.astype(np.int64))
            told = len(logs)
            followers.carry(Edit("", -1, np.concatenate(logs)))  # from a vertex still there
            found = run("erase_vertex", arguments.rows([vertex]))
        finally:  # an interrupt comes as soon as compiled code has ended
            if logs[1:]:
                followers.carry(Edit("", -1, np.concatenate([logs[0], *logs[told:]])))
                followers.subscribers.tell(Edit("truncate_vertex", -1, np.concatenate(logs)))
        return int(found[0])

    # Behind the contract ---------------------------------------------------------------------

    @property
    def _half_edges(self) -> Array:
        used: Array = self.records.half_edge[: self.records.counts[EDGE_END]]
        return used

    def _outside(self) -> Array:
        rows = self._half_edges
        return np.flatnonzero((rows[:, START] >= 0) & (rows[:, FACE] < 0))

    def _inner_vertices(self) -> Array:
        """The vertices with faces all around."""
        vertices = self.vertices()
        leaving = self.records.vertex_half_edge[vertices]
        used = leaving >= 0
        return vertices[used][self._half_edges[leaving[used], FACE] >= 0]

    def _sides(self) -> tuple[Array, Array, Array]:
        """Of every side of every face: which face, and the points where it starts and ends."""
        rows = self.face_vertices(self.faces())
        face = np.repeat(np.arange(len(rows)), rows.counts)
        points = self.points.astype(np.float64)[rows.values]
        return face, points, points[rows.following]

    def _polygonal(
        self, called: str, operation: str, *handles: Any, point: Any = None
    ) -> tuple[int, Edit]:
        """Do one operation -> its result and its edit, of which the subscribers are told."""
        _, element, takes_a_point, *_ = self.operations[operation]
        points = arguments.positions(called, [point], 1) if takes_a_point else arguments.NO_POINT
        row = [arguments.integer(called, element, it) for it in handles]
        args = np.array([[*row, -1, -1][: max(3, len(row))]])
        logs: list[Array] = []
        result = int(self._operations.run(operation, args, points, logs=logs)[0])
        if result < 0:
            raise self._operations.refusal(operation, result, args[0].tolist(), called)
        edit = self._operations.edit(called, operation, result, np.concatenate(logs))
        self._followers.publish(edit)
        return result, edit

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, half_edges = self.records, live(self.records, self.fields, "half_edge")
        start, face, following, previous = self._half_edges.T
        paired = half_edges[0::2] == half_edges[1::2]
        require(np.repeat(paired, 2), "both half-edges of an edge are live or dead", "half_edges")
        h = np.flatnonzero(half_edges)
        edges, after = h[0::2], following[h]
        require_edges(m, start[edges], start[edges ^ 1], edges)
        require(previous[after] == h, "previous of next is the half-edge itself", "half_edges", h)
        require(start[after] == start[h ^ 1], "next starts where the pair does", "half_edges", h)
        require(face[after] == face[h], "next lies in the same face", "half_edges", h)
        inhabited = (face[edges] >= 0) | (face[edges ^ 1] >= 0)
        require(inhabited, "an edge has a face on one side at least", "half_edges", edges)
        require(face[edges] != face[edges ^ 1], "an edge has two faces", "half_edges", edges)
        self._require_faces(h[face[h] >= 0])
        self._require_fans(h)

    def _require_faces(self, inner: Array) -> None:
        """What holds of the half-edges ``inner`` in faces."""
        m, f, (start, face, following, _) = self.records, self.faces(), self._half_edges.T
        require(face[m.face_half_edge[f]] == f, "a face's half-edge lies in it", "faces", f)
        corners = np.bincount(face[inner], minlength=self.face_end)[f]
        require(corners >= 3, "a face has three corners or more", "faces", f)
        require(corners <= m.counts[SIDES], "no face has more corners than the most", "faces", f)
        require_one_loop(face, following, inner)
        at_corner = face[inner].astype(np.int64) << 32 | start[inner]
        once = np.unique(at_corner, return_counts=True)
        require(once[1] == 1, "a face comes past a vertex once", "faces", once[0] >> 32)

    def _require_fans(self, h: Array) -> None:
        """What holds around vertices, of the live half-edges ``h``."""
        leaving, n = self.records.vertex_half_edge[: len(self.points)], len(self.points)
        start, face, following, _ = self._half_edges.T
        just = "just the vertices with faces have a half-edge"
        require_of_vertices(leaving, start[:, None], h, just, "a vertex' half-edge starts at it")
        holes = np.bincount(start[h[face[h] < 0]], minlength=n)
        require(holes < 2, "one hole at most lies at a vertex", "vertices")
        border = np.flatnonzero(holes)
        words = "the half-edge of a vertex on the border runs along it"
        require(face[leaving[border]] < 0, words, "vertices", border)
        around = np.full(len(start), -1)
        around[h] = following[h ^ 1]
        require_one_fan(start, around, h)
