"""A mesh as points and polygons: what files with quads and n-gons hold."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from hem.arrays import Bools
from hem.errors import MeshError
from hem.meshes.convertible import Convertible
from hem.meshes.triangles import (
    NOT_WHOLE,
    TriangleMesh,
    not_whole,
    out_of_range,
    own,
    read_only,
    refuse,
    refuse_masked,
    validated_points,
)
from hem.ragged import Ragged

Faces = Ragged | Sequence[Sequence[int]]


class PolygonMesh(Convertible):
    """Points and faces of any number of corners between them, validated once.

    points   (n, 3) as those of a `TriangleMesh`
    faces    a row of corners per face: indices into `points`, counterclockwise from outside, three
             or more, all different

    Cost: O(n + corners). Raises MeshError with the offending rows: what `TriangleMesh` refuses of
    points, faces of fewer than three corners, corners out of range or repeated.
    """

    faces: Ragged

    def __init__(self, points: ArrayLike, faces: Faces, dtype: DTypeLike = np.float32) -> None:
        self.points = read_only(validated_points(points, dtype))
        self.faces = _validated(faces, len(self.points))

    def __repr__(self) -> str:
        return (
            f"PolygonMesh({len(self.points):,} vertices, {len(self.faces):,} faces of up to "
            f"{self.most_corners} corners)"
        )

    @property
    def most_corners(self) -> int:
        """The corners of the face that has the most; 3 for no faces."""
        return int(self.faces.counts.max(initial=3))

    def face_rows(self) -> Ragged:
        """The corners of every face."""
        return self.faces

    def triangulated(self) -> TriangleMesh:
        """Every face as the fan of its first corner, in order; exact for flat convex ones. O(n)."""
        offsets, corners = self.faces.offsets, self.faces.values
        cuts = self.faces.counts - 2
        first = np.repeat(offsets[:-1], cuts)
        step = np.arange(len(first)) - np.repeat(np.cumsum(cuts) - cuts, cuts)
        rows = np.stack([first, first + step + 1, first + step + 2], axis=1)
        return TriangleMesh(self.points, corners[rows], self.points.dtype)


def simplest(mesh: TriangleMesh | PolygonMesh) -> TriangleMesh | PolygonMesh:
    """The mesh as triangles, if it has no other faces. O(n + m)."""
    if isinstance(mesh, TriangleMesh) or mesh.most_corners > 3:
        return mesh
    return mesh.triangulated()


def require_triangles(mesh: TriangleMesh | PolygonMesh, or_else: str) -> TriangleMesh:
    """The mesh as triangles, if it has no other faces; else a MeshError that says what to do.

    `or_else`: what takes the other faces as they are.
    """
    mesh = simplest(mesh)
    if isinstance(mesh, TriangleMesh):
        return mesh
    larger = np.flatnonzero(mesh.faces.counts > 3)
    raise MeshError(
        f"only triangles can be held, and {len(larger):,} of {len(mesh.faces):,} faces have more "
        f"corners; {or_else}, or cut them: hem.load(path, triangulate=True), or "
        "mesh.triangulated()",
        faces=larger,
    )


def repeats_a_corner(faces: Ragged) -> Bools:
    """(m,): which faces come past a vertex twice. O(corners log corners)."""
    face = np.repeat(np.arange(len(faces)), faces.counts)
    order = np.lexsort((faces.values, face))
    alike = (np.diff(faces.values[order]) == 0) & (np.diff(face[order]) == 0)
    return np.bincount(face[order][1:][alike], minlength=len(faces)) > 0


def _validated(faces: Faces, n: int) -> Ragged:
    if not isinstance(faces, Ragged):
        refuse_masked(faces, "faces")
        faces = _ragged(faces)
    offsets, corners = np.asarray(faces.offsets), np.asarray(faces.values)
    legal = offsets.ndim == corners.ndim == 1 and len(offsets) > 0 and offsets.dtype.kind in "iu"
    if not legal or offsets[0] or offsets[-1] != len(corners):
        raise MeshError(
            f"offsets of faces, {offsets.shape}, run from 0 to the number of their corners, "
            f"{corners.shape}"
        )
    faces = Ragged(offsets.astype(np.int64, copy=False), corners)
    counts = faces.counts
    refuse(counts < 3, "faces have three corners or more", "faces")
    if corners.dtype.kind not in "iuf":
        raise MeshError(f"corners are vertex indices, integers, not {corners.dtype}")
    if corners.dtype.kind == "f":
        refuse(_with_any(not_whole(corners), faces), NOT_WHOLE, "faces")
    outside = (corners < 0) | (corners >= n)
    if outside.any():
        refuse(_with_any(outside, faces), out_of_range(corners, n), "faces")
    refuse(repeats_a_corner(faces), "faces come past a vertex twice; split or drop them", "faces")
    return Ragged(read_only(own(offsets, np.int64)), read_only(own(corners, np.int32)))


def _with_any(corners: Bools, faces: Ragged) -> Bools:
    """(m,): which faces have any of these ``corners``."""
    face = np.repeat(np.arange(len(faces)), faces.counts)
    return np.bincount(face[corners], minlength=len(faces)) > 0


def _ragged(faces: Sequence[Sequence[int]]) -> Ragged:
    try:
        rows = [np.asarray(face) for face in faces]
    except (TypeError, ValueError) as error:
        raise MeshError(f"faces are rows of vertex indices: {error}") from error
    wrong = [i for i, row in enumerate(rows) if row.ndim != 1]
    if wrong:
        raise MeshError("faces are rows of vertex indices", rows=wrong)
    return Ragged.from_lists(rows, None if rows else np.int32)
