"""To the meshes of other libraries and back, where they are installed: the same points and faces."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from hem.errors import MeshError
from hem.meshes.polygons import PolygonMesh, require_triangles
from hem.meshes.triangles import TriangleMesh
from hem.ragged import Ragged


def to_trimesh(mesh: TriangleMesh) -> Any:
    """A ``trimesh.Trimesh``, in which nothing is merged or dropped. O(n + m)."""
    return _library("trimesh").Trimesh(mesh.points, mesh.triangles, process=False)


def from_trimesh(given: Any) -> TriangleMesh:
    """The mesh of a ``trimesh.Trimesh``. O(n + m)."""
    return TriangleMesh(np.asarray(given.vertices), np.asarray(given.faces))


def to_pyvista(mesh: TriangleMesh | PolygonMesh) -> Any:
    """A ``pyvista.PolyData``. O(n + m)."""
    faces = _rows(mesh)
    sizes = np.insert(faces.values, faces.offsets[:-1], faces.counts)
    return _library("pyvista").PolyData(mesh.points.copy(), sizes)


def from_pyvista(given: Any) -> TriangleMesh | PolygonMesh:
    """The mesh of a ``pyvista.PolyData``: of triangles if it has no other faces. O(n + m)."""
    values, sizes = np.asarray(given.faces), []
    at = 0
    while at < len(values):
        sizes.append(int(values[at]))
        at += 1 + sizes[-1]
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    corners = np.delete(values, offsets[:-1] + np.arange(len(sizes)))
    mesh = PolygonMesh(np.asarray(given.points), Ragged(offsets, corners.astype(np.int64)))
    return require_triangles(mesh) if mesh.most_corners == 3 else mesh


def to_meshio(mesh: TriangleMesh | PolygonMesh) -> Any:
    """A ``meshio.Mesh``, with a block of cells for every run of faces of the same size. O(n + m)."""
    faces = _rows(mesh)
    begins = np.flatnonzero(np.diff(faces.counts, prepend=-1))
    ends = [*begins[1:].tolist(), len(faces)]
    blocks = [
        (CELLS.get(int(faces.counts[begin]), "polygon"), np.stack(list(faces[begin:end])))
        for begin, end in zip(begins.tolist(), ends, strict=True)
    ]
    return _library("meshio").Mesh(mesh.points, blocks)


CELLS = {3: "triangle", 4: "quad"}
"""What meshio calls faces by their corners; the others are polygons."""


def from_meshio(given: Any) -> TriangleMesh | PolygonMesh:
    """The faces of a ``meshio.Mesh``: of triangles if it has no others. O(n + m).

    Raises MeshError for cells that are no faces, such as tetrahedra.
    """
    known = {*CELLS.values(), "polygon"}
    others = {block.type for block in given.cells} - known
    if others:
        raise MeshError(
            f"a surface has faces, and there are cells of other kinds: {sorted(others)}"
        )
    rows = [row for block in given.cells for row in np.asarray(block.data)]
    mesh = PolygonMesh(_in_space(np.asarray(given.points)), Ragged.from_lists(rows))
    return require_triangles(mesh) if mesh.most_corners == 3 else mesh


def plot(mesh: TriangleMesh | PolygonMesh, **options: Any) -> Any:
    """Show a mesh with PyVista, whose options these are; a picture in a notebook."""
    return to_pyvista(mesh).plot(**{"show_edges": True, "color": "lightgray", **options})


def _rows(mesh: TriangleMesh | PolygonMesh) -> Ragged:
    if isinstance(mesh, PolygonMesh):
        return mesh.faces
    return Ragged(np.arange(len(mesh.triangles) + 1, dtype=np.int64) * 3, mesh.triangles.ravel())


def _in_space(points: Any) -> Any:
    """Points in the plane as points of height 0."""
    return np.pad(points, ((0, 0), (0, 3 - points.shape[1]))) if points.ndim == 2 else points


def _library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError as missing:
        raise ImportError(f"{name} is not installed; pip install {name}") from missing
