"""Where a mesh is struck unless it is said: where the camera sees it."""

import numpy as np

from hem.arrays import Array
from hem.fracture.show.picture import AXES, view_direction
from hem.meshes import TriangleMesh


def default_impact(mesh: TriangleMesh, up: str = "y") -> tuple[Array, Array]:
    """A point that the camera sees, to the left of the middle, and the way into it: two (3,)."""
    used = mesh.points[np.unique(mesh.triangles)].astype(float)
    middle = (used.max(axis=0) + used.min(axis=0)) / 2
    way = -view_direction(AXES[up], -5.0, 22.0)
    return first_hit(mesh, middle - float(np.ptp(used, axis=0).sum()) * way, way), way


def first_hit(mesh: TriangleMesh, start: Array, way: Array) -> Array:
    """Where a ray first meets a mesh, or else the vertex nearest to its way: (3,). O(m)."""
    a, b, c = (mesh.points[mesh.triangles].astype(float) - start).transpose(1, 0, 2)
    sides = np.stack([np.cross(a, b) @ way, np.cross(b, c) @ way, np.cross(c, a) @ way])
    normal = np.cross(b - a, c - a)
    slope = normal @ way
    met = ((sides >= 0).all(axis=0) | (sides <= 0).all(axis=0)) & (slope != 0)
    far = np.einsum("ij,ij->i", normal[met], a[met]) / slope[met]
    if (far > 0).any():
        return np.asarray(start + far[far > 0].min() * way)
    off = mesh.points[np.unique(mesh.triangles)].astype(float) - start
    return np.asarray(start + off[np.linalg.norm(np.cross(off, way), axis=1).argmin()])
