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
from hem.algorithms.parts import (
    NOTHING,
    adding,
    change,
    cornering,
    doing,
    locating,
    most_faces_at_a_vertex,
    move,
    unit,
)
from hem.algorithms.smoothing import smooth
from hem.algorithms.sqrt3 import Plan, split_all_faces
from hem.algorithms.subdivision import subdivide
from hem.arrays import Array, Floats, Points
from hem.authoring import NEEDS_ROOM, VERTEX_END, Kernel, Kernels, kernel, visiting
from hem.contract import Structure


class Visit(NamedTuple):
    """What to visit, and the scratch for it."""

    vertices: Array
    faces: Array
    out: Any


@kernel
def count_others(m: Any, it: int, state: tuple[int, int], plan: Visit) -> tuple[int, int]:
    """Visit to count what is another than what it is visited from."""
    count, own = state
    return count + (it != own), own


def circulating(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``circulate(m, plan) -> count``."""
    neighbors = visiting(k["vertex_vertices"], count_others)
    corners = visiting(k["face_vertices"], count_others)

    @kernel
    def circulate(m: Any, plan: Visit) -> int:
        count = 0
        for i in range(len(plan.vertices)):
            count, _ = neighbors(m, plan.vertices[i], (count, int(plan.vertices[i])), plan)
        for i in range(len(plan.faces)):
            count, _ = corners(m, plan.faces[i], (count, -1), plan)
        return count

    return circulate


def circulate(s: Structure) -> int:
    """Visit the neighbors of every vertex and the corners of every face -> how many those are.

    Two for every edge and three for every face. Cost: ``vertex_vertices`` and ``face_vertices`` of
    all. MeshError for polygons.
    """
    require_mesh(s, "circulate")
    return s.run(circulating, Visit(s.vertices(), s.faces(), s.scratch(0)[0]))


class Sum(NamedTuple):
    """What is summed up."""

    faces: Array
    sums: Floats  # (3,)
    out: Any


def summing_corners(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add_corners(m, plan) -> 0``. Every structure has the faces in the same order."""
    add_all = visiting(k["face_vertices"], adding(locating(k["coordinate"])))

    @kernel
    def add_corners(m: Any, plan: Sum) -> int:
        x = y = z = 0.0
        for i in range(len(plan.faces)):
            _, a, b, c = add_all(m, plan.faces[i], NOTHING, plan)
            x, y, z = x + a, y + b, z + c
        plan.sums[0], plan.sums[1], plan.sums[2] = x, y, z
        return 0

    return add_corners


class Shift(NamedTuple):
    """Who is moved against what, and where to."""

    vertices: Array
    by: Floats  # (3,)
    places: Points


def shifting(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``shift(m, plan) -> 0``."""
    where = locating(k["coordinate"])

    @kernel
    def shift(m: Any, plan: Shift) -> int:
        places, a, b, c = plan.places, plan.by[0], plan.by[1], plan.by[2]
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            x, y, z = where(m, v)
            places[v, 0], places[v, 1], places[v, 2] = x - a, y - b, z - c
        return 0

    return shift


def center(s: Structure) -> Floats:
    """Move a mesh so that the mean of all corners of all faces lies at the origin -> (3,) the mean.

    One edit. Cost O(n_v + n_t). MeshError for polygons.
    """
    require_mesh(s, "center")
    middle = np.zeros(3)
    s.run(summing_corners, Sum(s.faces(), middle, s.scratch(0)[0]))
    middle /= max(3 * s.n_faces, 1)
    vertices, places = s.vertices(), np.zeros((len(s.points), 3), np.float32)
    s.run(shifting, Shift(vertices, middle, places))
    move(s, "center", vertices, places)
    return middle


class Faces(NamedTuple):
    """Whose normals, and where they go."""

    faces: Array
    of_faces: Array  # (face_end, 3) float32: as long as twice the area
    out: Any


def finding_normals(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``find(m, plan) -> 0``."""
    corners, normal = cornering(k["face_vertices"]), face_normal(k)

    @kernel
    def find(m: Any, plan: Faces) -> int:
        of_faces = plan.of_faces
        for i in range(len(plan.faces)):
            f = plan.faces[i]
            of_faces[f, 0], of_faces[f, 1], of_faces[f, 2] = normal(m, corners(m, f, plan))
        return 0

    return find


class Fans(NamedTuple):
    """Around which vertices what is summed up, and where the directions go."""

    vertices: Array
    of_faces: Array
    found: Array  # (n, 3) float32
    out: Any


@kernel
def normal_of(m: Any, f: int, plan: Fans) -> tuple[float, float, float]:
    """The normal of a face, in float64."""
    row = plan.of_faces
    return np.float64(row[f, 0]), np.float64(row[f, 1]), np.float64(row[f, 2])


def adding_around(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add_around(m, plan) -> 0``."""
    add_all = visiting(k["vertex_faces"], adding(normal_of))

    @kernel
    def add_around(m: Any, plan: Fans) -> int:
        found = plan.found
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            _, x, y, z = add_all(m, v, NOTHING, plan)
            found[v, 0], found[v, 1], found[v, 2] = unit(x, y, z)
        return 0

    return add_around


def normals_around(s: Structure) -> Points:
    """What ``vertex_normals`` gives, (n, 3) float32, by walking around every vertex.

    Cost: ``vertex_faces`` of all. MeshError for polygons.
    """
    require_mesh(s, "normals_around")
    found = np.zeros((len(s.points), 3), np.float32)
    of_faces = np.zeros((s.face_end, 3), np.float32)
    out = s.scratch(0)[0]
    s.run(finding_normals, Faces(s.faces(), of_faces, out))
    s.run(adding_around, Fans(s.vertices(), of_faces, found, out))
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
    split = split_all_faces(s, "split_and_collapse")
    change(s, "split_and_collapse", collapsing, split, 0, most_faces_at_a_vertex(s))
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
