"""All neighbors visited, and the middle of a mesh: the two simplest passes over it.

Source: Sieger & Botsch, Design, Implementation, and Evaluation of the Surface_mesh Data Structure
(2011), who time them on several libraries.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.parts import move, plus, require_mesh
from hem.arrays import Array, Floats
from hem.authoring import Kernel, Kernels, kernel
from hem.contract import Structure


class Visit(NamedTuple):
    """What to visit, and the scratch for it."""

    vertices: Array
    faces: Array
    out: Any


def circulating(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``circulate(m, plan) -> count``."""
    vertex_vertices, face_vertices = k["vertex_vertices"], k["face_vertices"]

    @kernel
    def circulate(m: Any, plan: Visit) -> int:
        count, out = 0, plan.out
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            for j in range(vertex_vertices(m, v, out)):
                count += out[j] != v
        for i in range(len(plan.faces)):
            for j in range(face_vertices(m, plan.faces[i], out)):
                count += out[j] >= 0
        return count

    return circulate


def circulate(s: Structure) -> int:
    """Visit the neighbors of every vertex and the corners of every face -> how many those are.

    Two for every edge and three for every face. Cost: ``vertex_vertices`` and ``face_vertices`` of
    all. MeshError for polygons.
    """
    require_mesh(s, "circulate")
    return s.run(circulating, Visit(s.vertices(), s.faces(), s.scratch(0)[0]))


class Corners(NamedTuple):
    """Whose corners, and what they add up to."""

    faces: Array
    total: Array  # (3,) float64
    out: Any


def adding(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add(m, plan) -> 0``."""
    face_vertices, coordinate = k["face_vertices"], k["coordinate"]

    @kernel
    def add(m: Any, plan: Corners) -> int:
        x = y = z = x_rest = y_rest = z_rest = 0.0
        out = plan.out
        for i in range(len(plan.faces)):
            for j in range(face_vertices(m, plan.faces[i], out)):
                x, x_rest = plus(x, x_rest, coordinate(m, out[j], 0))
                y, y_rest = plus(y, y_rest, coordinate(m, out[j], 1))
                z, z_rest = plus(z, z_rest, coordinate(m, out[j], 2))
        plan.total[0], plan.total[1], plan.total[2] = x + x_rest, y + y_rest, z + z_rest
        return 0

    return add


def center(s: Structure) -> Floats:
    """Move a mesh so that the mean of all corners of all faces lies at the origin -> (3,) the mean.

    One edit. Cost O(n_v + n_t). MeshError for polygons.
    """
    require_mesh(s, "center")
    faces, total = s.faces(), np.zeros(3)
    s.run(adding, Corners(faces, total, s.scratch(0)[0]))
    middle: Floats = total / max(3 * len(faces), 1)
    move(s, "center", s.vertices(), (s.points - middle).astype(np.float32))
    return middle
