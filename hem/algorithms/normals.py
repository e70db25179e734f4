"""Vertex normals: the normals of the faces around a vertex, weighted by their areas."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_mesh
from hem.algorithms.parts import GROUP, cross, gathering, locating, new_group, unit
from hem.arrays import Array, Floats, Points
from hem.authoring import FACE_END, VERTEX_END, Kernel, Kernels, kernel
from hem.contract import Structure


class Plan(NamedTuple):
    """Where the answers go."""

    found: Floats  # (n, 3): sums at first, then unit normals
    group: Array  # see `gathering`
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
    gather, normal = gathering(k), face_normal(k)

    @kernel
    def find_normals(m: Any, plan: Plan) -> int:
        found, group = plan.found, plan.group
        for begin in range(0, m.counts[FACE_END], GROUP):
            for i in range(gather(m, begin, plan)):
                at = group[i, 1], group[i, 2], group[i, 3]
                x, y, z = normal(m, at)
                for v in at:
                    found[v, 0] += x
                    found[v, 1] += y
                    found[v, 2] += z
        for v in range(m.counts[VERTEX_END]):
            found[v, 0], found[v, 1], found[v, 2] = unit(found[v, 0], found[v, 1], found[v, 2])
        return 0

    return find_normals


def vertex_normals(s: Structure) -> Points:
    """(n, 3) float32: the unit normal of every vertex, by handle, weighted by areas of faces.

    Zeros for what is dead, and where there is no face or they cancel out. A pass over the faces,
    which asks for no neighbors. Cost O(n_v + n_t). MeshError for polygons.
    Source: Botsch et al., Polygon Mesh Processing (2010), chapter 3.
    """
    require_mesh(s, "vertex_normals")
    found = np.zeros((len(s.points), 3))
    s.run(normals, Plan(found, new_group(), s.scratch(0)[0]))
    return found.astype(np.float32)
