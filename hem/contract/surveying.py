"""What is asked of a whole mesh, or of every element at once: from its records and queries."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Bools, Floats, Handles, Indices, Points
from hem.authoring import FACE_END, FACES, SIDES, VERTEX_END, VERTICES
from hem.contract.arguments import integer
from hem.contract.queries import QueryMethod
from hem.errors import MeshError
from hem.meshes import components
from hem.ragged import Ragged


class Surveying(ABC):
    """Questions about the surface as a whole, to whatever answers those about its elements."""

    vertex_vertices: QueryMethod
    vertex_faces: QueryMethod
    edge_vertices: QueryMethod
    face_vertices: QueryMethod

    @property
    @abstractmethod
    def records(self) -> Any:
        """The `NamedTuple` of the structure's arrays; after an operation it may be another."""

    @abstractmethod
    def faces(self) -> Handles:
        """(n_faces,) int32: the handles of all live faces, ascending."""

    @property
    def n_vertices(self) -> int:
        """Number of live vertices, unreferenced ones included."""
        return int(self.records.counts[VERTICES])

    @property
    def n_faces(self) -> int:
        """Number of live faces."""
        return int(self.records.counts[FACES])

    @property
    def n_half_edges(self) -> int:
        """Number of live half-edges, one for each corner of a face; recorded or not."""
        return 3 * self.n_faces

    @property
    def points(self) -> Points:
        """(n, 3) float32: positions by vertex; those of dead ones are NaN.

        A view: ``move_vertex`` tells subscribers of a new position, writing here does not. It
        cannot be written to where positions stand elsewhere as well: in triangles, or in objects.
        """
        points: Points = self.records.vertex_point
        return points[: self.records.counts[VERTEX_END]]

    def positions(self, vertices: ArrayLike) -> Points:
        """(k, 3) float32: of some vertices; those of dead ones are NaN. Cost O(k), also where
        ``points`` are gathered anew. Handles are not checked: they index as NumPy's do.
        """
        found: Points = self.points[np.asarray(vertices)]
        return found

    @property
    def vertex_end(self) -> int:
        """One past the largest vertex handle there ever was."""
        return int(self.records.counts[VERTEX_END])

    @property
    def face_end(self) -> int:
        """One past the largest face handle there ever was."""
        return int(self.records.counts[FACE_END])

    @property
    def most_corners(self) -> int:
        """A bound on the corners of any face there ever was: 3 where all are triangles."""
        return int(self.records.counts[SIDES])

    def triangles(self) -> Handles:
        """(n_faces, 3) int32: the corners of every live face, counterclockwise. Cost O(n_t).

        MeshError for a mesh with larger faces, which ``face_vertices()`` names.
        """
        corners = self.face_vertices()
        larger = np.flatnonzero(corners.counts != 3)
        if len(larger):
            raise MeshError("there are faces of more corners", faces=self.faces()[larger])
        return corners.values.reshape(-1, 3)

    def edge_array(self) -> Handles:
        """(n_edges, 2) int32: the ends of every live edge, the smaller first, as ``edges()``."""
        return self.edge_vertices().values.reshape(-1, 2)

    @overload
    def valence(self, vertices: int) -> int: ...
    @overload
    def valence(self, vertices: ArrayLike | None = None) -> Indices: ...
    def valence(self, vertices: Any = None) -> Any:
        """How many edges a vertex has, or each of (n,), or of all. Cost: ``vertex_vertices``."""
        return _each(self.vertex_vertices, vertices)

    @overload
    def is_border(self, vertices: int) -> bool: ...
    @overload
    def is_border(self, vertices: ArrayLike | None = None) -> Bools: ...
    def is_border(self, vertices: Any = None) -> Any:
        """Whether a vertex lies on the border, or each of (n,), or of all.

        It has an edge more than faces there; one without faces lies on none. So it is on a surface:
        at an edge of three faces, as others than surfaces have, it may be missed. Cost:
        ``vertex_vertices`` and ``vertex_faces``.
        """
        on_border = self.valence(vertices) > _each(self.vertex_faces, vertices)
        return on_border if isinstance(on_border, np.ndarray) else bool(on_border)

    def find_face(self, a: int, b: int, c: int) -> int | None:
        """The face of three vertices, whichever way it runs, or None. Cost: ``vertex_faces``.

        Raises MeshError if one of them is no vertex.
        """
        a, b, c = (integer("find_face", "vertex", v) for v in (a, b, c))
        faces = self.vertex_faces(a)
        for face, row in zip(faces.tolist(), self.face_vertices(faces), strict=True):
            if sorted(row.tolist()) == sorted((a, b, c)):
                return face
        self.vertex_faces([b, c])  # refuses what is no vertex; a corner of a face is one
        return None

    def is_closed(self) -> bool:
        """Whether every edge has two faces. Cost O(n_t log n_t)."""
        return not len(self._border())

    def border_loops(self) -> list[Handles]:
        """The vertices along every border, with the surface on the left, each from its smallest.

        Loops come in the order of their smallest vertices; one ends as soon as it is back at its
        first vertex, also where fans of faces meet. MeshError names the vertices where a border
        ends, as it may at an edge with three faces. Cost O(n_t log n_t).
        """
        border = self._border()
        if not np.array_equal(*np.sort(border.T)):
            leaving, arriving = (np.bincount(it, minlength=self.vertex_end) for it in border.T)
            ends = np.flatnonzero(leaving != arriving)
            raise MeshError("a border does not come round, but ends", vertices=ends)
        following: dict[int, list[int]] = {}
        for here, there in border.tolist():
            following.setdefault(here, []).append(there)
        loops = []
        for start in sorted(following):
            while following[start]:
                loop, v = [start], following[start].pop(0)
                while v != start:
                    loop.append(v)
                    v = following[v].pop(0)
                loops.append(np.array(loop, np.int32))
        return loops

    def components(self) -> list[Handles]:
        """The faces of every connected part, ascending; parts in the order of their first faces.

        Faces are connected that share a vertex; vertices without faces are in no part. Cost
        O(n_t log n_t).
        """
        faces, corners = self.faces(), self.face_vertices()
        first = corners.values[corners.offsets[:-1]]
        joined = np.stack([np.repeat(first, corners.counts), corners.values], axis=1)
        part = components(len(self.points), joined)[1][first]
        order = np.argsort(part, kind="stable")
        begin = np.flatnonzero(np.diff(part[order], prepend=-1))
        found = [faces[it] for it in np.split(order, begin[1:])] if len(faces) else []
        return sorted(found, key=lambda it: int(it[0]))

    def same_as(self, other: Surveying) -> bool:
        """Whether another structure holds the same mesh: positions and faces by the same handles.

        Whatever corner a face begins at. Cost O(n_v + n_t).
        """
        return (
            np.array_equal(self.points, other.points, equal_nan=True)
            and np.array_equal(self.faces(), other.faces())
            and _from_smallest(self.face_vertices()) == _from_smallest(other.face_vertices())
        )

    def _border(self) -> Array:
        """(k, 2): the sides of faces that have no face beyond them, along the face."""
        corners = self.face_vertices()
        here = corners.values.astype(np.int64)
        there = here[corners.following]
        sides, beyond = here << 32 | there, there << 32 | here
        return np.stack([here, there], axis=1)[~np.isin(sides, beyond)]


def _each(query: Any, handles: Any) -> Any:
    """How many neighbors a query finds: of one handle a number, of many an array."""
    found = query(handles) if handles is not None else query()
    return len(found) if isinstance(found, np.ndarray) else found.counts


def _from_smallest(rows: Ragged) -> list[list[int]]:
    """The corners of every face, from the smallest on."""
    found = [row.tolist() for row in rows]
    return [row[(k := row.index(min(row))) :] + row[:k] for row in found]


def centroids(mesh: Surveying, faces: Handles) -> Floats:
    """(n, 3): the middle of the corners of each face, the same on every structure."""
    corners = mesh.face_vertices(faces)
    values = corners.values
    if mesh.most_corners == 3:  # each structure has its own first corner, and sums are rounded
        values = np.sort(values.reshape(-1, 3)).reshape(-1)
    sums = np.add.reduceat(mesh.points[values], corners.offsets[:-1], 0, np.float64)
    return sums / corners.counts[:, None]
