"""From the meshes of other libraries; the way there is a method of every mesh."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from hem.errors import MeshError
from hem.meshes.convertible import CELLS
from hem.meshes.polygons import PolygonMesh, simplest
from hem.meshes.triangles import TriangleMesh
from hem.ragged import Ragged

_TAKEN = (
    "a TriangleMesh, a PolygonMesh, a structure, a path, a pair (points, faces), and whatever has "
    "points or vertices, and faces, triangles or cells, as the meshes of trimesh, PyVista, Open3D "
    "and meshio have"
)


def from_trimesh(given: Any, dtype: DTypeLike = np.float32) -> TriangleMesh:
    """The mesh of a ``trimesh.Trimesh``. O(n + m)."""
    return TriangleMesh(given.vertices, given.faces, dtype)


def from_pyvista(given: Any, dtype: DTypeLike = np.float32) -> TriangleMesh | PolygonMesh:
    """The mesh of a ``pyvista.PolyData``: of triangles if it has no other faces. O(n + m).

    Raises MeshError for strips, and for numbers that are no faces, each behind its count.
    """
    if getattr(given, "n_strips", 0):
        raise MeshError("triangle strips are no faces; take given.triangulate()")
    values, rows, at = np.asarray(given.faces), [], 0
    while at < len(values):
        if not 0 <= values[at] < len(values) - at:
            raise MeshError(
                f"faces in one row are corners behind their count, as PyVista has: number {at} "
                f"is {values[at]}; or give a row per face"
            )
        rows.append(values[at + 1 : at + 1 + values[at]])
        at += 1 + int(values[at])
    return _of_rows(given.points, rows, dtype)


def from_meshio(given: Any, dtype: DTypeLike = np.float32) -> TriangleMesh | PolygonMesh:
    """The faces of a ``meshio.Mesh``: of triangles if it has no others. O(n + m).

    Points in the plane come to lie at height 0. Raises MeshError for cells that are no faces, such
    as tetrahedra.
    """
    others = {block.type for block in given.cells} - {*CELLS.values(), "polygon"}
    if others:
        raise MeshError(f"a surface consists of faces; there are cells that are {sorted(others)}")
    points = given.points
    flat = np.shape(points)[1:] == (2,)
    rows = [row for block in given.cells for row in block.data]
    return _of_rows(np.pad(points, ((0, 0), (0, 1))) if flat else points, rows, dtype)


def from_any(given: Any) -> TriangleMesh | PolygonMesh:
    """What ``hem.as_mesh`` gives, but for paths."""
    if isinstance(given, TriangleMesh | PolygonMesh):
        return simplest(given)
    for way in ("to_polygons", "to_triangles"):  # a structure
        if callable(getattr(given, way, None)):
            return simplest(getattr(given, way)())
    if isinstance(getattr(given, "cells", None), list):
        return from_meshio(given)
    if isinstance(given, tuple | list) and len(given) == 2:
        return _of_rows(*given)
    points = _first_of(given, "points", "vertices")
    faces = None if points is None else _first_of(given, "faces", "triangles")
    if faces is None:
        raise MeshError(f"a mesh cannot be made of {type(given)}; taken are {_TAKEN}")
    if isinstance(faces, np.ndarray) and faces.ndim == 1:
        return from_pyvista(given)
    return _of_rows(points, faces)


def _first_of(given: Any, *names: str) -> Any:
    return next((getattr(given, name) for name in names if hasattr(given, name)), None)


def _of_rows(points: Any, rows: Any, dtype: DTypeLike = np.float32) -> TriangleMesh | PolygonMesh:
    try:
        size = () if isinstance(rows, Ragged) else np.shape(rows)[1:]
    except ValueError:  # rows of several lengths
        size = ()
    if size == (3,):
        return TriangleMesh(points, rows, dtype)
    return simplest(PolygonMesh(points, rows, dtype))
