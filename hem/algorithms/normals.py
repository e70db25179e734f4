"""Vertex normals: the normals of the faces around a vertex, weighted by their areas."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.parts import locating, plus, require_mesh
from hem.arrays import Array, Points
from hem.authoring import Kernel, Kernels, kernel
from hem.contract import Structure


class Plan(NamedTuple):
    """What is asked, and where the answers go."""

    vertices: Array
    faces: Array
    of_faces: Array  # (face_end, 3) float32: as long as twice the area
    of_vertices: Array  # (n, 3) float32
    out: Any


def face_normal(k: Kernels) -> Kernel:
    """Make ``normal(m, f, out) -> x, y, z``, as long as twice the area.

    From the smallest corner on, so that it is the same to the last bit on every structure.
    """
    face_vertices, where = k["face_vertices"], locating(k["coordinate"])

    @kernel
    def normal(m: Any, f: int, out: Any) -> tuple[float, float, float]:
        face_vertices(m, f, out)
        a, b, c = out[0], out[1], out[2]
        if b < a and b < c:
            a, b, c = b, c, a
        elif c < a and c < b:
            a, b, c = c, a, b
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = where(m, a), where(m, b), where(m, c)
        bx, by, bz, cx, cy, cz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        return by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx

    return normal


def normals(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``find_normals(m, plan) -> 0``."""
    vertex_faces, normal = k["vertex_faces"], face_normal(k)

    @kernel
    def find_normals(m: Any, plan: Plan) -> int:
        found, of_faces, out = plan.of_vertices, plan.of_faces, plan.out
        for i in range(len(plan.faces)):
            f = plan.faces[i]
            of_faces[f, 0], of_faces[f, 1], of_faces[f, 2] = normal(m, f, out)
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            x = y = z = x_rest = y_rest = z_rest = 0.0
            for j in range(vertex_faces(m, v, out)):
                f = out[j]
                x, x_rest = plus(x, x_rest, of_faces[f, 0])
                y, y_rest = plus(y, y_rest, of_faces[f, 1])
                z, z_rest = plus(z, z_rest, of_faces[f, 2])
            x, y, z = x + x_rest, y + y_rest, z + z_rest
            size = np.sqrt(x * x + y * y + z * z)
            if size > 0:
                found[v, 0], found[v, 1], found[v, 2] = x / size, y / size, z / size
        return 0

    return find_normals


def vertex_normals(s: Structure) -> Points:
    """(n, 3) float32: the unit normal of every vertex, by handle.

    It is the sum of those of its faces, weighted by their areas. Zeros for what is dead, and where
    there is no face or they cancel out. Cost: ``vertex_faces`` of all. MeshError for polygons.
    """
    require_mesh(s, "vertex_normals")
    found = np.zeros((len(s.points), 3), np.float32)
    of_faces = np.empty((s.face_end, 3), np.float32)
    s.run(normals, Plan(s.vertices(), s.faces(), of_faces, found, s.scratch(0)[0]))
    return found
