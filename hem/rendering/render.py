"""A render mesh: what a renderer is given, kept in step with a structure edit by edit.

Flat points, and flat indices clockwise as Unity wants them (thesis 3.3). Vertex v has its place at
3v and face f at 3f, whatever else is there, so that an edit changes its own entries and no others.
What is dead leaves a gap: a triangle of three times vertex 0, which renderers skip, and a vertex at
the origin that no triangle uses. ``Structure.compact`` closes the gaps here, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Handles, Points
from hem.contract import Structure, tell_all
from hem.edit import Edit
from hem.errors import MeshError
from hem.meshes import TriangleMesh, repeated_corners, used_only
from hem.rendering.ranges import Ranges, dirty_ranges

NEARBY = 32
"""Elements that a range may include without need, so that there are fewer ranges to upload."""


class Upload(NamedTuple):
    """What a commit changed: ranges (k, 2) of vertices and of triangles, each begin and end.

    ``resized``: the arrays are others than before, for more elements or after ``compact``; then the
    ranges cover everything.
    """

    vertices: Ranges
    triangles: Ranges
    resized: bool


class RenderMesh:
    """Flat arrays for a renderer that follow the edits of a structure, each in O(edit).

    Every edit is committed at once: whoever subscribed is told what to upload. Within
    ``transaction()`` edits are gathered and committed once at its end. Cost to begin with, after
    ``compact``, and now and then for more room: O(n_v + n_t). MeshError for a mesh with polygons,
    and when one arises: the edit is done, and from then on the arrays stay as they are.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.commits = 0
        self._listeners: list[Callable[[Upload], Any]] = []
        self._pending: list[ArrayLike] = []
        self._depth, self._resized = 0, False
        self._end: Callable[[], None] = lambda: None
        self._rebuild()
        self._end = structure.subscribe(self._follow)

    @property
    def points(self) -> Points:
        """(3 n,) float32: x, y, z of every vertex. A view that later edits change."""
        return self._points[: self._n_vertices].reshape(-1)

    @property
    def indices(self) -> Handles:
        """(3 m,) int32: the corners of every triangle, clockwise from outside. A view."""
        return self._indices[: self._n_triangles].reshape(-1)

    def subscribe(self, callback: Callable[[Upload], Any]) -> Callable[[], None]:
        """Have ``callback`` called with the ``Upload`` of every commit -> a way to end that."""
        self._listeners.append(callback)

        def unsubscribe() -> None:
            if callback in self._listeners:
                self._listeners.remove(callback)

        return unsubscribe

    @contextmanager
    def transaction(self) -> Iterator[RenderMesh]:
        """Commit once at the end, whatever happens within; of nested ones the outermost does."""
        self._depth += 1
        try:
            yield self
        finally:
            self._depth -= 1
            if not self._depth and (self._pending or self._resized):
                self._commit()

    def close(self) -> None:
        """Follow no longer; the arrays stay as they are."""
        self._end()

    def to_triangles(self) -> TriangleMesh:
        """The way back, see ``mesh_from_render``."""
        return mesh_from_render(self.points, self.indices)

    def _rebuild(self) -> None:
        s = self.structure
        faces = s.faces()
        self._require_triangles(faces)
        self._n_vertices, self._n_triangles = len(s.points), s.face_end
        self._points = np.nan_to_num(s.points, nan=0.0)
        self._indices = np.zeros((self._n_triangles, 3), np.int32)
        corners = s.face_vertices(faces).values.reshape(-1, 3)
        self._indices[faces] = corners[:, [0, 2, 1]]

    def _follow(self, edit: Edit) -> None:
        if edit.remapping is not None:
            self._rebuild()
            self._pending, self._resized = [], True
        else:
            if self.structure.most_corners > 3:
                self._require_triangles(np.append(edit.created_faces, edit.changed_faces))
            self._pending.append(edit.touched)
            self._grow()
            self.structure.copy_touched(edit.touched, self._points, self._indices)
        if not self._depth:
            self._commit()

    def _require_triangles(self, faces: Handles) -> None:
        """Follow no longer once one of the faces is a polygon."""
        s = self.structure
        larger = faces[s.face_vertices(faces).counts > 3] if s.most_corners > 3 else faces[:0]
        if len(larger):
            self._end()
            raise MeshError(
                f"a render mesh holds triangles only, and follows this {s.title} mesh no longer, "
                "which has larger faces now; follow one built of to_triangles() instead",
                faces=larger,
            )

    def _grow(self) -> None:
        s = self.structure
        vertices, triangles = len(s.points), s.face_end
        if vertices > len(self._points) or triangles > len(self._indices):
            self._points = _with_room(self._points, self._n_vertices, vertices)
            self._indices = _with_room(self._indices, self._n_triangles, triangles)
            self._resized = True
        self._n_vertices, self._n_triangles = vertices, triangles

    def _commit(self) -> None:
        self.commits += 1
        if self._resized:
            everything = ([(0, n)] if n else [] for n in (self._n_vertices, self._n_triangles))
            parts = [np.array(it, np.int64).reshape(-1, 2) for it in everything]
        else:
            parts = list(dirty_ranges(self._pending, NEARBY))
        upload = Upload(parts[0], parts[1], self._resized)
        self._pending, self._resized = [], False
        tell_all(self._listeners, upload)


def _with_room(array: Array, used: int, wanted: int) -> Array:
    """The array, or a larger one with the same first rows and zeros behind them."""
    if wanted <= len(array):
        return array
    larger = np.zeros((max(wanted, 2 * used), 3), array.dtype)
    larger[:used] = array[:used]
    return larger


def mesh_from_render(points: ArrayLike, indices: ArrayLike, tolerance: float = 0.0) -> TriangleMesh:
    """The surface behind a render mesh, for any structure.

    ``points``: (3 n,) or (n, 3); ``indices``: (3 m,) or (m, 3), clockwise from outside. Positions
    that are repeated at seams become one vertex, ``tolerance`` as for ``TriangleMesh.welded``; the
    winding is turned; triangles without area of their own (a repeated corner) and vertices without
    triangles are left out. Cost O(n + m) without a tolerance. Raises MeshError for what is no such
    mesh. Source: thesis 3.3.2, where the search for repeated positions is quadratic.
    """
    corners = _rows(indices, "indices")
    used = corners[~repeated_corners(corners)]
    mesh = TriangleMesh(_rows(points, "points"), used[:, [0, 2, 1]]).welded(tolerance)
    return TriangleMesh(*used_only(mesh.points, mesh.triangles))


def _rows(values: ArrayLike, name: str) -> Array:
    given = np.asarray(values)
    if given.size % 3 or given.ndim > 2 or (given.ndim == 2 and given.shape[1] != 3):
        raise MeshError(f"{name} come in threes, not in shape {given.shape}")
    return given.reshape(-1, 3)
