"""A mesh as points and triangles: what every source gives and every structure is built from."""

import sys
import warnings
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from hem.arrays import Array, Bools, Floats, Points, Triangles
from hem.errors import MeshError, MeshWarning
from hem.meshes import measures
from hem.meshes.components import clusters
from hem.meshes.convertible import Convertible, library, position_type
from hem.meshes.edges import undirected_edges
from hem.ragged import Ragged

_MOST_ELEMENTS = np.iinfo(np.int32).max
_MIXED = np.sqrt([2.0, 3.0, 5.0])
_NOISE = 1e-12  # what float64 leaves between equal positions, of the largest coordinate


class TriangleMesh(Convertible):
    """Points and the triangles between them, validated once and read-only from then on.

    points     (n, 3) float32, or float64 if `dtype` says so; finite, in the units of the source
    triangles  (m, 3) int32, indices into `points`, counterclockwise from outside, three different
               corners each

    Vertices that no triangle uses are legal, and so is the empty mesh. Arrays that can be written
    to are copied; read-only ones of the right type and order are shared, and so is the memory
    behind a read-only view, which must stay as it is.

    >>> mesh = hem.TriangleMesh([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 2)])
    >>> mesh.area()
    0.5

    Cost: O(n + m), and O(n log n) where positions are rounded: a MeshWarning names the rows of
    different ones that become equal, as far from zero they do. Raises MeshError with the offending
    rows: wrong shapes, coordinates that are not finite (also: too large for float32), indices that
    are no integers, out of range or beyond int32, repeated corners.
    """

    points: Points
    triangles: Triangles

    def __init__(
        self, points: ArrayLike, triangles: ArrayLike, dtype: DTypeLike = np.float32
    ) -> None:
        self.points = read_only(validated_points(points, dtype))
        self.triangles = read_only(_validated_triangles(triangles, len(self.points)))

    def __repr__(self) -> str:
        return f"TriangleMesh({len(self.points):,} vertices, {len(self.triangles):,} faces)"

    def welded(self, tolerance: float = 0.0) -> "TriangleMesh":
        """One vertex per position: the first at a position stays, in the order they had.

        Faces that lose a corner are dropped; the others keep their order. Repeated faces and
        vertices without faces stay. With `tolerance` > 0 (in the units of the points) any two
        vertices at most that far apart become one, at the first one's position. It is transitive:
        a chain of close vertices becomes one vertex however long it is.

        Cost: O(n log n + m), and with a tolerance the pairs of vertices that close besides.
        Source: thesis, construction of the mesh (one vertex per position).
        """
        if not (isinstance(tolerance, Real) and 0 <= tolerance <= sys.float_info.max):
            raise MeshError(f"a weld tolerance is finite and not negative, not {tolerance!r:.60}")
        first, cluster = clusters(self.points, tolerance)
        triangles = cluster[self.triangles]
        triangles = triangles[~repeated_corners(triangles)]
        return TriangleMesh(self.points[first], triangles, self.points.dtype)

    def face_rows(self) -> Ragged:
        """The corners of every face."""
        return Ragged(np.arange(0, self.triangles.size + 1, 3), self.triangles.reshape(-1))

    def to_trimesh(self) -> Any:
        """A ``trimesh.Trimesh``, in which nothing is merged or dropped. O(n + m).

        ImportError where trimesh is not installed.
        """
        return library("trimesh").Trimesh(self.points, self.triangles, process=False)

    def flipped(self) -> "TriangleMesh":
        """The same faces seen from the other side: corners (a, b, c) become (a, c, b). O(m)."""
        return TriangleMesh(self.points, self.triangles[:, [0, 2, 1]], self.points.dtype)

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """The lower and the upper corner (3,) of the bounding box. O(n)."""
        return measures.bounds(self.points)

    def face_areas(self) -> Floats:
        """(m,) float64. O(m)."""
        return measures.areas(self._corners())

    def face_normals(self) -> Floats:
        """(m, 3) float64, outward and of length 1; zero for a face without area. O(m)."""
        return _unit_or_zero(measures.normals(self._corners()))

    def vertex_normals(self) -> Floats:
        """(n, 3) float64, of length 1: the faces at a vertex weigh by area. O(n + m).

        Zero without faces, and where they cancel out.
        """
        weighed = np.repeat(measures.normals(self._corners()), 3, axis=0)
        at = self.triangles.ravel()
        sums = [np.bincount(at, column, len(self.points)) for column in weighed.T]
        return _unit_or_zero(np.stack(sums, axis=1))

    def area(self) -> float:
        """Of all faces. O(m)."""
        return float(self.face_areas().sum())

    def volume(self) -> float:
        """What a closed surface encloses, positive where it is wound outward. O(m).

        Raises MeshError for a surface with a border.
        """
        _, faces = undirected_edges(self.triangles)
        if (faces == 1).any():
            raise MeshError("a mesh with borders encloses no volume; close its holes")
        return measures.volume(self._corners())

    def centroid(self) -> Floats:
        """(3,): the middle of the surface, faces weighing by area; NaN without area. O(m)."""
        areas, middles = self.face_areas(), self._corners().mean(axis=1)
        with np.errstate(invalid="ignore"):
            middle: Floats = (areas[:, None] * middles).sum(axis=0) / areas.sum()
        return middle

    def _corners(self) -> Floats:
        return measures.corners(self.points, self.triangles)


def repeated_corners(triangles: Triangles) -> Bools:
    """Which triangles use a vertex twice. (m,) bool, O(m)."""
    a, b, c = triangles.T
    return (a == b) | (b == c) | (c == a)


def validated_points(points: ArrayLike, dtype: DTypeLike) -> Points:
    """The positions (n, 3) as this type."""
    given = _rows_of_three(points, "points", kinds="fiu")
    kind = position_type(dtype)
    with np.errstate(over="ignore"):
        kept = own(given, kind)
    if not np.isfinite(kept).all():
        rows = np.flatnonzero(~np.isfinite(kept).all(axis=1))
        why = "not finite" if not np.isfinite(given[rows]).all() else f"too large for {kept.dtype}"
        raise MeshError(f"coordinates are {why}; remove or mend these points", rows=rows)
    if kept.dtype != given.dtype and not np.array_equal(given, kept):
        _tell_of_equal(given, kept)
    return kept


def _tell_of_equal(given: Array, kept: Points) -> None:
    """Warn of different positions that have become equal: the first of them, and each other."""
    sums = np.sort(measures.dot(kept.astype(np.float64), _MIXED))
    if (sums[1:] != sums[:-1]).all():  # equal positions have equal sums, and others seldom
        return
    first, cluster = clusters(kept, 0.0)
    same = first[cluster]
    apart = np.abs(given.astype(np.float64) - given[same]).max(axis=1)
    rows = np.flatnonzero(apart > _NOISE * np.abs(kept).max())
    if len(rows):
        pairs = np.stack([same[rows], rows], axis=1)
        told = MeshError(f"different positions are equal as {kept.dtype}", rows=pairs)
        hint = "keep them apart with dtype=np.float64, or move the mesh to the origin"
        warnings.warn(f"{told}; {hint}", MeshWarning, stacklevel=4)


def _validated_triangles(triangles: ArrayLike, n: int) -> Triangles:
    given = _rows_of_three(triangles, "triangles", kinds="iuf")
    if given.dtype.kind == "f":
        refuse(not_whole(given), NOT_WHOLE)
    if given.size and (given.min() < 0 or given.max() >= n):
        refuse((given < 0) | (given >= n), out_of_range(given, n))
    kept = own(given, np.int32)
    refuse(repeated_corners(kept), "triangles use a vertex twice; drop them, or see welded()")
    return kept


NOT_WHOLE = "vertex indices are not whole numbers"


def not_whole(given: Array) -> Bools:
    """Which of these floats are no integers."""
    return ~np.isfinite(given) | (given != np.floor(given))


def _unit_or_zero(vectors: Floats) -> Floats:
    lengths = measures.length(vectors)[:, None]
    return np.divide(vectors, lengths, out=np.zeros(vectors.shape), where=lengths > 0)


def own(given: Array, dtype: DTypeLike) -> Array:
    """The array as this type: a copy of it, unless it is read-only and of that type already.

    Then it is shared. Whoever has a writable array behind a read-only view can still write to it.
    """
    kept = np.ascontiguousarray(given, dtype)
    return kept.copy() if given.flags.writeable and np.shares_memory(kept, given) else kept


def _rows_of_three(values: ArrayLike, name: str, kinds: str) -> Array:
    refuse_masked(values, name)
    try:
        rows = np.asarray(values)
    except ValueError as error:
        raise MeshError(f"{name} must form rows of three numbers: {error}") from error
    if rows.size == 0 and rows.shape in ((0,), (0, 3)):
        return np.zeros((0, 3), np.int32)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise MeshError(f"{name} must have shape (k, 3), not {rows.shape}")
    if rows.dtype.kind not in kinds:
        raise MeshError(f"{name} must be numbers of at most 64 bits, not {rows.dtype}")
    if len(rows) > _MOST_ELEMENTS:
        raise MeshError(f"{len(rows):,} {name} are more than int32 indices can name")
    return rows


def refuse_masked(values: object, name: str) -> None:
    """Raise a MeshError for a masked array that lacks some of its values, as any stand behind."""
    if np.ma.is_masked(values):
        raise MeshError(f"some of the {name} are masked; leave out what has none, or fill them")


def out_of_range(given: Array, n: int) -> str:
    """What to say of vertex indices of which some name no vertex of n."""
    if n == 0:
        return "there are faces, but no points"
    beyond = ", some beyond int32" if given.max() > _MOST_ELEMENTS else ""
    hint = "; do the indices count from 1?" if given.min() == 1 and given.max() == n else ""
    first = int(given[(given < 0) | (given >= n)][0])
    return f"vertex indices are out of the range 0 … {n - 1:,}, such as {first}{beyond}{hint}"


def refuse(bad: Bools, message: str, kind: str = "rows") -> None:
    """Raise the MeshError for elements of a kind, if any (k,) or a part (k, n) of any is bad."""
    if bad.any():
        raise MeshError(message, **{kind: np.flatnonzero(bad.reshape(len(bad), -1).any(axis=1))})


def read_only(array: Array) -> Array:
    """A view that cannot be written to."""
    view = array.view()
    view.flags.writeable = False
    return view
