"""A render mesh: what a renderer is given, kept in step with a structure edit by edit.

Flat points, and flat indices clockwise as Unity wants them (thesis 3.3). Vertex v has its place at
3v and face f at 3f, whatever else is there, so that an edit changes its own entries and no others.
What is dead leaves a gap: a triangle of three times vertex 0, which renderers skip, and a vertex at
the origin that no triangle uses. ``Structure.compact`` closes the gaps here, too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from types import MappingProxyType
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Handles, Indices, Points
from hem.contract import Attribute, Structure, arguments
from hem.edit import CHANGED, FACE, PARENT, VERTEX, Edit
from hem.engine import kept
from hem.errors import MeshError
from hem.listeners import Listeners
from hem.meshes import TriangleMesh, clusters, repeated_corners, used_only
from hem.room import longer, rows

Ranges = Indices
NEARBY = 32  # elements a range may include without need, for fewer ranges to upload


class Upload(NamedTuple):
    """What a commit changed: ranges (k, 2) of vertices and of triangles, each begin and end.

    ``resized``: the arrays are others than before, for more elements or after ``compact``; then the
    ranges cover everything. Arrays that grow in their place (``hem.room``) are the same.
    ``attributes``: ranges of vertices for each that is uploaded, by name.
    """

    vertices: Ranges
    triangles: Ranges
    resized: bool
    attributes: Mapping[str, Ranges] = MappingProxyType({})


class RenderMesh:
    """Flat arrays for a renderer that follow the edits of a structure, each in O(edit).

    Every edit is committed at once: whoever subscribed is told what to upload. Within
    ``transaction()`` edits are gathered and committed once at its end. ``attributes`` of vertices
    are uploaded, too: their ``values`` have a row where ``points`` has three numbers, and what is
    written to them is committed like an edit, until they are removed from the mesh. Cost to begin
    with, after ``compact``, and now and then for more room: O(n_v + n_t). MeshError for a mesh with
    polygons, and when one arises: the edit is done, and from then on the arrays stay as they are.
    """

    def __init__(self, structure: Structure, attributes: Sequence[Attribute] = ()) -> None:
        if not isinstance(structure, Structure):
            raise MeshError(f"a render mesh follows a structure, not {type(structure)}; build one")
        self.structure = structure
        self.commits = 0
        if isinstance(attributes, str) or not isinstance(attributes, Iterable):
            raise MeshError(f"a render mesh takes a list of attributes, not {attributes!r}")
        self._attributes = list(attributes)
        for it in self._attributes:
            if not isinstance(it, Attribute) or it.element != "vertex" or it.mesh is not structure:
                raise MeshError(f"{it!r} is no attribute of vertices of this mesh")
        self._written: dict[str, list[ArrayLike]] = {it.name: [] for it in self._attributes}
        self._listeners = Listeners()
        self._pending: list[ArrayLike]
        self._following = ExitStack()
        self._rebuild()
        self._depth, self._resized = 0, False  # nobody listens yet
        self._following.callback(structure.subscribe(self._follow))
        for it in self._attributes:
            self._following.callback(it.subscribe(partial(self._rewrite, it.name)))

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy follows its own structure from then on; subscribers are not of the copy."""
        return _following_anew, (self.structure, list(self.attributes))

    @property
    def attributes(self) -> dict[str, Attribute]:
        """Those that are uploaded, by name. One that is removed from the mesh is no longer."""
        of_mesh = {id(it) for it in self.structure.attributes()}
        return {it.name: it for it in self._attributes if id(it) in of_mesh}

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
        return self._listeners.subscribe(callback)

    @contextmanager
    def transaction(self) -> Iterator[RenderMesh]:
        """Commit once at the end, whatever happens within; of nested ones the outermost does."""
        self._depth += 1
        try:
            yield self
        finally:
            self._depth -= 1
            if not self._depth and (self._pending or self._resized or any(self._written.values())):
                self._commit()

    def reserve(self, splits: int) -> None:
        """Make room for so many splits at once, so that none of them has to. A commit. O(n).

        The structure has a method of that name for its own arrays. MeshError for what is no count,
        or more than indices can name.
        """
        self._make_room(*arguments.grown(splits, self._n_vertices, self._n_triangles))
        if self._resized and not self._depth:
            self._commit()

    def close(self) -> None:
        """Follow no longer; the arrays stay as they are. A copy follows the mesh again."""
        self._following.close()

    def to_triangles(self) -> TriangleMesh:
        """The way back, see ``mesh_from_render``."""
        return mesh_from_render(self.points, self.indices)

    def _rebuild(self) -> None:
        s = self.structure
        faces = s.faces()
        _require_triangles(s, faces, f"and this {s.title} mesh has larger faces")
        self._n_vertices, self._n_triangles = len(s.points), s.face_end
        self._points = rows(self._n_vertices, 3, dtype=np.float32, zeros=True)
        self._points[:] = s.points
        np.nan_to_num(self._points, copy=False, nan=0.0)
        self._indices = rows(self._n_triangles, 3, dtype=np.int32, zeros=True)
        corners = s.face_vertices(faces).values.reshape(-1, 3)
        self._indices[faces] = corners[:, [0, 2, 1]]
        self._pending, self._resized = [], True

    def _follow(self, edit: Edit) -> None:
        if edit.remapping is None and self.structure.most_corners > 3:
            self._require_triangles_still(np.append(edit.created_faces, edit.changed_faces))
        try:
            if edit.remapping is not None:
                self._rebuild()
            else:
                self._pending.append(edit.touched)
                self._grow()
                self.structure.copy_touched(edit.touched, self._points, self._indices)
        except BaseException:  # an interrupt, say: the next commit has all
            self._rebuild()
            raise
        if not self._depth:
            self._commit()

    def _rewrite(self, name: str, vertices: Handles) -> None:
        if name in self.attributes:
            self._written[name].append(vertices << 3 | VERTEX + CHANGED)
            if not self._depth:
                self._commit()

    def _require_triangles_still(self, faces: Handles) -> None:
        """Follow no longer once one of the faces is a polygon."""
        try:
            title = self.structure.title
            words = f"and follows this {title} mesh no longer, which has larger faces now"
            _require_triangles(self.structure, faces, words)
        except MeshError:
            self._following.close()
            raise

    def _grow(self) -> None:
        vertices, triangles = self.structure.vertex_end, self.structure.face_end
        self._make_room(vertices, triangles)
        self._n_vertices, self._n_triangles = vertices, triangles

    def _make_room(self, vertices: int, triangles: int) -> None:
        if vertices > len(self._points) or triangles > len(self._indices):
            before = self._points.base, self._indices.base
            self._points = longer(self._points, self._n_vertices, vertices, zeros=True)
            self._indices = longer(self._indices, self._n_triangles, triangles, zeros=True)
            moved = self._points.base is not before[0] or self._indices.base is not before[1]
            self._resized = self._resized or moved

    def _commit(self) -> None:
        self.commits += 1
        if self._resized:
            ends = self._n_vertices, self._n_triangles
            parts = [np.array([(0, n)], np.int64)[: min(n, 1)] for n in ends]
            written = dict.fromkeys(self.attributes, parts[0])
        else:
            parts = list(dirty_ranges(self._pending, NEARBY))
            written = {
                name: dirty_ranges([*self._pending, *self._written[name]], NEARBY)[0]
                for name in self.attributes
            }
        upload = Upload(parts[0], parts[1], self._resized, written)
        self._pending, self._resized = [], False
        self._written = {name: [] for name in self._written}
        self._listeners.tell(upload)


def _require_triangles(s: Any, faces: Handles, words: str) -> None:
    larger = faces[s.face_vertices(faces).counts > 3] if s.most_corners > 3 else faces[:0]
    if len(larger):
        raise MeshError(
            f"what is rendered holds triangles only, {words}; take one built of to_triangles()",
            faces=larger,
        )


def _following_anew(structure: Structure, names: Sequence[str]) -> RenderMesh:
    return RenderMesh(structure, [structure.vertex_attribute(name) for name in names])


def split_at_seams(corners: Attribute) -> tuple[Points, Handles, Array]:
    """The arrays for a renderer of a mesh whose corners have values, such as texture coordinates.

    A vertex is repeated for each of the values that its corners have. -> points (3 n,) float32,
    indices (3 m,) int32, clockwise, and the values (n, …). MeshError for polygons, and for what is
    no attribute of corners. Cost O(m log m). ``mesh_from_render`` is the way back.
    """
    if not isinstance(corners, Attribute) or corners.element != "corner":
        raise MeshError(f"{corners!r} is no attribute of corners")
    s = corners.mesh
    _require_triangles(s, s.faces(), "and this mesh has larger faces")
    vertex, values = s.triangles().reshape(-1), corners[s.faces()]
    told_apart = values.reshape(len(vertex), math.prod(values.shape[1:]))
    told_apart = np.unique(told_apart, return_inverse=True)[1].reshape(told_apart.shape)  # nan too
    _, value = np.unique(told_apart, axis=0, return_inverse=True)
    pairs = np.stack([vertex, value.reshape(-1)], axis=1)
    _, first, place = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    indices = place.reshape(-1, 3)[:, [0, 2, 1]].astype(np.int32)
    return s.points[vertex[first]].reshape(-1), indices.reshape(-1), values[first]


@overload
def mesh_from_render(
    points: ArrayLike, indices: ArrayLike, tolerance: float = 0.0
) -> TriangleMesh: ...
@overload
def mesh_from_render(
    points: ArrayLike, indices: ArrayLike, tolerance: float = 0.0, *, values: ArrayLike
) -> tuple[TriangleMesh, Array]: ...
def mesh_from_render(
    points: ArrayLike, indices: ArrayLike, tolerance: float = 0.0, values: ArrayLike | None = None
) -> TriangleMesh | tuple[TriangleMesh, Array]:
    """The surface behind a render mesh, for any structure.

    ``points``: (3 n,) or (n, 3); ``indices``: (3 m,) or (m, 3), clockwise from outside. Positions
    that are repeated at seams become one vertex, ``tolerance`` as for ``TriangleMesh.welded``; the
    winding is turned; triangles without area of their own (a repeated corner) and vertices without
    triangles are left out. With ``values`` (n, …) of the repeated positions also theirs by corner
    (m, 3, …), for a ``corner_attribute``, so that seams are kept. Cost without a tolerance
    O(n log n + m). Raises MeshError for what is no such mesh. Source: thesis 3.3.2, where the
    search for repeated positions is quadratic.
    """
    corners = _rows(indices, "indices")
    raw = TriangleMesh(_rows(points, "points"), corners[~repeated_corners(corners)][:, [0, 2, 1]])
    mesh = raw.welded(tolerance)
    found = TriangleMesh(*used_only(mesh.points, mesh.triangles))
    if values is None:
        return found
    given = _array(values, "values")
    if given.ndim == 0 or len(given) != len(raw.points):
        count = f"{len(given):,} values" if given.ndim else "one value"
        raise MeshError(f"there are {count} for {len(raw.points):,} positions")
    _, cluster = clusters(raw.points, tolerance)
    return found, given[raw.triangles[~repeated_corners(cluster[raw.triangles])]]


def _array(values: ArrayLike, name: str) -> Array:
    try:
        return np.asarray(values)
    except ValueError as error:  # rows of several lengths
        raise MeshError(f"{name} are no array: {error}") from error


def _rows(values: ArrayLike, name: str) -> Array:
    given = _array(values, name)
    if given.size % 3 or given.ndim > 2 or (given.ndim == 2 and given.shape[1] != 3):
        raise MeshError(f"{name} come in threes, not in shape {given.shape}")
    return given.reshape(-1, 3)


def dirty_ranges(touched: Sequence[ArrayLike], nearby: int) -> tuple[Ranges, Ranges]:
    """The ranges (k, 2) of vertices and of triangles that logs of edits name, begin and end each.

    Elements at most ``nearby`` apart share a range. Cost O(k log k) for k entries.
    """
    log = np.concatenate([np.zeros(0, np.int64), *(np.asarray(it, np.int64) for it in touched)])
    log.sort()  # by index, as that is in the upper bits
    ranges = np.empty((2, len(log), 2), np.int64)
    vertices, triangles = _runs(log, nearby, ranges)
    return ranges[0, :vertices], ranges[1, :triangles]


@kept
def _runs(log: Array, nearby: int, ranges: Array) -> Array:
    count = np.zeros(2, np.int64)
    for entry in log:
        if entry & 7 == PARENT:
            continue
        kind, index = (1 if entry & 7 >= FACE else 0), entry >> 3
        last = count[kind] - 1
        if last >= 0 and index <= ranges[kind, last, 1] + nearby:
            ranges[kind, last, 1] = index + 1
        else:
            ranges[kind, last + 1, 0], ranges[kind, last + 1, 1] = index, index + 1
            count[kind] += 1
    return count
