"""What is asked of a whole mesh, or of every element at once: derived from the nine queries."""

from __future__ import annotations

from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array, Bools, Handles
from hem.contract.queryable import Queryable
from hem.errors import MeshError
from hem.meshes import components


class Surveying(Queryable, abstract=True):
    """Questions about the surface as a whole."""

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
    def valence(self, vertices: ArrayLike | None = None) -> NDArray[np.int64]: ...
    def valence(self, vertices: Any = None) -> Any:
        """How many edges a vertex has, or each of (n,), or of all. Cost: ``vertex_vertices``."""
        return _each(self.vertex_vertices, vertices)

    @overload
    def is_border(self, vertices: int) -> bool: ...
    @overload
    def is_border(self, vertices: ArrayLike | None = None) -> Bools: ...
    def is_border(self, vertices: Any = None) -> Any:
        """Whether a vertex lies on the border, or each of (n,), or of all.

        It has an edge more than faces there; one without faces lies on none. Cost:
        ``vertex_vertices`` and ``vertex_faces``.
        """
        on_border = self.valence(vertices) > _each(self.vertex_faces, vertices)
        return on_border if isinstance(on_border, np.ndarray) else bool(on_border)

    def find_face(self, a: int, b: int, c: int) -> int | None:
        """The face of three vertices, whichever way it runs, or None. Cost: ``vertex_faces``."""
        faces = self.vertex_faces(a)
        for face, row in zip(faces.tolist(), self.face_vertices(faces), strict=True):
            if sorted(row.tolist()) == sorted((a, b, c)):
                return face
        return None

    def is_closed(self) -> bool:
        """Whether every edge has two faces. Cost O(n_t)."""
        return not len(self._border())

    def border_loops(self) -> list[Handles]:
        """The vertices along every border, with the surface on the left, each from its smallest.

        Loops come in the order of their smallest vertices. Cost O(n_t log n_t).
        """
        border = self._border()
        following = dict(border.tolist())
        loops = []
        for start in sorted(following):
            loop, v = [], start
            while v in following:
                loop.append(v)
                v = following.pop(v)
            if loop:
                loops.append(np.array(loop, np.int32))
        return loops

    def components(self) -> list[Handles]:
        """The faces of every connected part, ascending; parts in the order of their first faces.

        Faces are connected that share a vertex; vertices without faces are in no part. Cost
        O(n_t).
        """
        faces, corners = self.faces(), self.face_vertices()
        first = corners.values[corners.offsets[:-1]]
        joined = np.stack([np.repeat(first, corners.counts), corners.values], axis=1)
        part = components(len(self.points), joined)[1][first]
        names, places = np.unique(part, return_index=True)
        return [faces[part == name] for name in names[np.argsort(places)]]

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
