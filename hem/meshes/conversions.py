"""From the meshes of other libraries; the way there is a method of every mesh."""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.errors import MeshError
from hem.meshes.convertible import CELLS
from hem.meshes.polygons import PolygonMesh, require_triangles
from hem.meshes.triangles import TriangleMesh
from hem.ragged import Ragged


def from_trimesh(given: Any) -> TriangleMesh:
    """The mesh of a ``trimesh.Trimesh``. O(n + m)."""
    return TriangleMesh(np.asarray(given.vertices), np.asarray(given.faces))


def from_pyvista(given: Any) -> TriangleMesh | PolygonMesh:
    """The mesh of a ``pyvista.PolyData``: of triangles if it has no other faces. O(n + m)."""
    values, rows, at = np.asarray(given.faces), [], 0
    while at < len(values):
        rows.append(values[at + 1 : at + 1 + values[at]])
        at += 1 + int(values[at])
    return _of_rows(given.points, rows)


def from_meshio(given: Any) -> TriangleMesh | PolygonMesh:
    """The faces of a ``meshio.Mesh``: of triangles if it has no others. O(n + m).

    Points in the plane come to lie at height 0. Raises MeshError for cells that are no faces, such
    as tetrahedra.
    """
    others = {block.type for block in given.cells} - {*CELLS.values(), "polygon"}
    if others:
        raise MeshError(f"a surface consists of faces; there are cells that are {sorted(others)}")
    points = np.asarray(given.points)
    flat = points.ndim == 2 and points.shape[1] == 2
    rows = [np.asarray(row) for block in given.cells for row in block.data]
    return _of_rows(np.pad(points, ((0, 0), (0, 1))) if flat else points, rows)


def _of_rows(points: Any, rows: list[Any]) -> TriangleMesh | PolygonMesh:
    mesh = PolygonMesh(np.asarray(points), Ragged.from_lists(rows))
    return require_triangles(mesh) if mesh.most_corners == 3 else mesh
