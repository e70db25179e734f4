"""Vertex normals: the normals of the faces around a vertex, weighted by their areas."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_mesh
from hem.algorithms.parts import cornering, cross, locating, unit
from hem.arrays import Array, Floats, Points
from hem.authoring import Kernel, Kernels, kernel
from hem.contract import Structure


class Plan(NamedTuple):
    """The faces to pass over, and where the answers go."""

    faces: Array
    vertices: Array
    found: Floats  # (n, 3): sums at first, then unit normals
    out: Any


def face_normal(k: Kernels) -> Kernel:
    """Make ``normal(m, corners) -> x, y, z`` of a triangle, as long as twice the area.

    From the smallest corner on, so that it is the same to the last bit on every structure.
    """
    where = locating(k["coordinate"])

    @kernel
    def normal(m: Any, corners: tuple[int, int, int]) -> tuple[float, float, float]:
        a, b, c = corners
        if b < a and b < c:
            a, b, c = b, c, a
        elif c < a and c < b:
            a, b, c = c, a, b
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = where(m, a), where(m, b), where(m, c)
        return cross((bx - ax, by - ay, bz - az), (cx - ax, cy - ay, cz - az))

    return normal


def normals(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``find_normals(m, plan) -> 0``. Every structure has the faces in the same order."""
    corners, normal = cornering(k["face_vertices"]), face_normal(k)

    @kernel
    def find_normals(m: Any, plan: Plan) -> int:
        found = plan.found
        for i in range(len(plan.faces)):
            at = corners(m, plan.faces[i], plan)
            x, y, z = normal(m, at)
            for v in at:
                found[v, 0] += x
                found[v, 1] += y
                found[v, 2] += z
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            found[v, 0], found[v, 1], found[v, 2] = unit(found[v, 0], found[v, 1], found[v, 2])
        return 0

    return find_normals


def vertex_normals(s: Structure) -> Points:
    """(n, 3) float32: the unit normal of every vertex, by handle, weighted by areas of faces.

    Zeros for what is dead, and where there is no face or they cancel out. A pass over the faces,
    which asks for no neighbors. Cost O(n_v + n_t). MeshError for polygons.
    """
    require_mesh(s, "vertex_normals")
    found = np.zeros((len(s.points), 3))
    s.run(normals, Plan(s.faces(), s.vertices(), found, s.scratch(0)[0]))
    return found.astype(np.float32)
