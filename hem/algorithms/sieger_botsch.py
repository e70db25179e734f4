"""The six algorithms by which Sieger & Botsch compare mesh libraries, each a function of a mesh.

Source: Design, Implementation, and Evaluation of the Surface_mesh Data Structure (2011), section 4.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_mesh, require_surface
from hem.algorithms.normals import face_normal
from hem.algorithms.parts import change, count_faces_at, doing, move, summing, unit
from hem.algorithms.smoothing import smooth
from hem.algorithms.sqrt3 import Plan, split_all_faces
from hem.algorithms.subdivision import subdivide
from hem.arrays import Array, Floats, Points
from hem.authoring import NEEDS_ROOM, VERTEX_END, Kernel, Kernels, kernel
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


def center(s: Structure) -> Floats:
    """Move a mesh so that the mean of all corners of all faces lies at the origin -> (3,) the mean.

    One edit. Cost O(n_v + n_t). MeshError for polygons.
    """
    require_mesh(s, "center")
    vertices, times = s.vertices(), count_faces_at(s)
    middle: Floats = times[vertices] @ s.points[vertices].astype(np.float64) / max(times.sum(), 1)
    places = np.empty_like(s.points, np.float32)
    move(s, "center", vertices, np.subtract(s.points, middle, places, casting="same_kind"))
    return middle


class Fans(NamedTuple):
    """Whose normals, and where they go."""

    vertices: Array
    faces: Array
    of_faces: Array  # (face_end, 3) float32: as long as twice the area
    found: Array  # (n, 3) float32
    out: Any


@kernel
def row(array: Floats, i: int) -> tuple[float, float, float]:
    """Three numbers of float32, in float64."""
    return np.float64(array[i, 0]), np.float64(array[i, 1]), np.float64(array[i, 2])


def adding_around(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add(m, plan) -> 0``: normals of faces, then their sums around each vertex."""
    vertex_faces, normal, sum_of = k["vertex_faces"], face_normal(k), summing(row)

    @kernel
    def add(m: Any, plan: Fans) -> int:
        found, of_faces, out = plan.found, plan.of_faces, plan.out
        for i in range(len(plan.faces)):
            f = plan.faces[i]
            of_faces[f, 0], of_faces[f, 1], of_faces[f, 2] = normal(m, f, out)
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            x, y, z = unit(*sum_of(of_faces, out, vertex_faces(m, v, out)))
            found[v, 0], found[v, 1], found[v, 2] = x, y, z
        return 0

    return add


def normals_around(s: Structure) -> Points:
    """What ``vertex_normals`` gives, (n, 3) float32, by walking around every vertex.

    Cost: ``vertex_faces`` of all. MeshError for polygons.
    """
    require_mesh(s, "normals_around")
    found = np.zeros((len(s.points), 3), np.float32)
    of_faces = np.empty((s.face_end, 3), np.float32)
    s.run(adding_around, Fans(s.vertices(), s.faces(), of_faces, found, s.scratch(0)[0]))
    return found


def collapsing(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``collapse_new(m, plan) -> 0``: every new vertex into the smallest of its neighbors."""
    vertex_edges, edge_vertices = k["vertex_edges"], k["edge_vertices"]
    collapse_edge = doing(operations["collapse_edge"])

    @kernel
    def collapse_new(m: Any, plan: Plan) -> int:
        out, at = plan.work.out, plan.work.at
        while plan.old[0] + plan.next[0] < m.counts[VERTEX_END]:
            v = plan.old[0] + plan.next[0]
            edge, least = -1, v
            for i in range(vertex_edges(m, v, out)):
                edge_vertices(m, out[i], at)
                if at[0] < least:
                    edge, least = out[i], at[0]
            if edge >= 0 and collapse_edge(m, edge, least, plan.work) == NEEDS_ROOM:
                return NEEDS_ROOM
            plan.next[0] += 1
        return 0

    return collapse_new


def split_and_collapse(s: Structure) -> None:
    """Put a vertex into every face, and collapse each into a corner again; then ``compact``.

    The mesh is what it was, but handles may have changed. Three edits. Cost: a split and a collapse
    per face. MeshError for polygons; TopologyError as ``subdivide``.
    """
    require_mesh(s, "split_and_collapse")
    require_surface(s, "split_and_collapse")
    change(s, "split_and_collapse", collapsing, split_all_faces(s, "split_and_collapse"))
    s.compact()


SIX: dict[str, Callable[[Structure], Any]] = {
    "circulator": circulate,
    "barycenter": center,
    "normals": normals_around,
    "smoothing": smooth,
    "subdivision": partial(subdivide, scheme="sqrt3"),
    "collapse": split_and_collapse,
}
"""By the names that they have there."""
