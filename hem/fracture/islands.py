"""Parts that nothing holds together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hem.meshes.triangles import TriangleMesh

Array = NDArray[Any]


def islands(mesh: TriangleMesh) -> list[TriangleMesh]:
    """The connected parts of a mesh, the largest by area first, without vertices no face uses.

    Faces are connected that share a vertex. Vertices and faces keep their order. Cost O(n + m).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    triangles, n = mesh.triangles, len(mesh.points)
    if not len(triangles):
        return []
    sides = np.concatenate([triangles[:, :2], triangles[:, 1:]])
    graph = coo_array((np.ones(len(sides), bool), (sides[:, 0], sides[:, 1])), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    part = label[triangles[:, 0]]
    area = np.bincount(part, areas(mesh))
    largest_first = np.argsort(-area, kind="stable")
    return [used(mesh, part == it) for it in largest_first if area[it] > 0 or (part == it).any()]


def used(mesh: TriangleMesh, chosen: NDArray[np.bool_]) -> TriangleMesh:
    """Some of the faces (m,) bool, and the vertices that they use. Cost O(n + m)."""
    triangles = mesh.triangles[chosen]
    vertices, renumbered = np.unique(triangles, return_inverse=True)
    return TriangleMesh(mesh.points[vertices], renumbered.reshape(-1, 3))


def areas(mesh: TriangleMesh) -> NDArray[np.float64]:
    """(m,) float64: of the faces."""
    return triangle_areas(mesh.points[mesh.triangles])


def triangle_areas(corners: Array) -> NDArray[np.float64]:
    """(k,) float64: of triangles (k, 3, 3)."""
    a, b, c = (corners[:, i].astype(np.float64) for i in range(3))
    normal = np.cross(b - a, c - a)
    return np.asarray(np.sqrt((normal * normal).sum(axis=1)) / 2)
