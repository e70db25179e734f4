"""The six algorithms by which Sieger & Botsch compare mesh libraries, each a function of a mesh.

Source: Design, Implementation, and Evaluation of the Surface_mesh Data Structure (2011), section 4.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_mesh, require_surface
from hem.algorithms.normals import face_normal
from hem.algorithms.parts import (
    GROUP,
    adding,
    change,
    doing,
    gathering,
    living_face,
    living_vertex,
    most_faces_at_a_vertex,
    new_group,
    none_is_dead,
    not_finite,
    of_vertices,
    tell_moved,
    unit,
)
from hem.algorithms.smoothing import smooth
from hem.algorithms.sqrt3 import Plan, split_all_faces
from hem.algorithms.subdivision import subdivide
from hem.arrays import Array, Floats, Points
from hem.authoring import (
    FACE_END,
    NEEDS_ROOM,
    VERTEX_END,
    Kernel,
    Kernels,
    is_point,
    kernel,
    live_vertex,
    sums,
    visiting,
)
from hem.contract import Structure


class Visit(NamedTuple):
    """The scratch to visit with."""

    out: Any


@kernel
def count_others(m: Any, it: int, state: tuple[int, int], plan: Visit) -> tuple[int, int]:
    """Visit to count what is another than what it is visited from."""
    count, own = state
    return count + (it != own), own


def circulating(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``circulate(m, plan) -> count``."""
    vertex_lives, face_lives = living_vertex(k), living_face(k)
    neighbors = visiting(k["vertex_vertices"], count_others)
    corners = visiting(k["face_vertices"], count_others)

    @kernel
    def circulate(m: Any, plan: Visit) -> int:
        count = 0
        for v in range(m.counts[VERTEX_END]):
            if vertex_lives(m, v):
                count, _ = neighbors(m, v, (count, v), plan)
        for f in range(m.counts[FACE_END]):
            if face_lives(m, f):
                count, _ = corners(m, f, (count, -1), plan)
        return count

    return circulate


def circulate(s: Structure) -> int:
    """Visit the neighbors of every vertex and the corners of every face -> how many those are.

    Two for every edge and three for every face. Cost: ``vertex_vertices`` and ``face_vertices`` of
    all. MeshError for polygons. Source: Sieger & Botsch (2011).
    """
    require_mesh(s, "circulate")
    return s.run(circulating, Visit(s.scratch(0)[0]))


class Middle(NamedTuple):
    """What is summed up, and where the middle is then."""

    middle: Floats  # (3,)
    out: Any


def summing_corners(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add_corners(m, plan) -> 0``. Every structure has the faces in the same order."""
    lives = living_face(k)
    add_all = visiting(k["face_vertices"], adding(of_vertices(k["position"])))

    @kernel
    def add_corners(m: Any, plan: Middle) -> int:
        total = sums.nothing()
        for f in range(m.counts[FACE_END]):
            if lives(m, f):
                total = sums.plus(total, add_all(m, f, sums.nothing(), plan))
        x, y, z, n = sums.parts(total)
        if n > 0:
            plan.middle[0], plan.middle[1], plan.middle[2] = x / n, y / n, z / n
        return 0

    return add_corners


@cache
def shifted(coordinate: Kernel) -> Kernel:
    """Make ``shift(m, v, middle) -> x, y, z``, in float32: where a vertex comes to lie."""

    @kernel
    def shift(m: Any, v: int, middle: tuple[float, float, float]) -> tuple[Any, Any, Any]:
        x = np.float32(coordinate(m, v, 0) - middle[0])
        y = np.float32(coordinate(m, v, 1) - middle[1])
        return x, y, np.float32(coordinate(m, v, 2) - middle[2])

    return shift


def checking_shift(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``check(m, plan) -> count`` of the vertices that would not be finite any more.

    It goes on after the first, so that the compiler can look at several at once.
    """
    lives, shift = living_vertex(k), shifted(k["coordinate"])

    @kernel
    def check(m: Any, plan: Middle) -> int:
        count, middle = 0, (plan.middle[0], plan.middle[1], plan.middle[2])
        for v in range(m.counts[VERTEX_END]):
            count += int(lives(m, v) and not is_point(shift(m, v, middle)))
        return count

    return check


def shifting(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``shift_all(m, plan) -> 0``."""
    lives, set_point = live_vertex(k["coordinate"]), k["set_point"]
    shift = shifted(k["coordinate"])

    @kernel
    def shift_all(m: Any, plan: Middle) -> int:
        all_live, middle = none_is_dead(m), (plan.middle[0], plan.middle[1], plan.middle[2])
        for v in range(m.counts[VERTEX_END]):
            if all_live or lives(m, v):
                set_point(m, v, shift(m, v, middle))
        return 0

    return shift_all


def center(s: Structure) -> Floats:
    """Move a mesh so that the mean of all corners of all faces lies at the origin -> (3,) the mean.

    One edit. Cost: ``face_vertices`` of all, and O(n_v). MeshError for polygons.
    Source: Sieger & Botsch (2011).
    """
    require_mesh(s, "center")
    plan = Middle(np.zeros(3), np.zeros(3, np.int64))
    s.run(summing_corners, plan)
    with np.errstate(over="ignore"):
        if s.run(checking_shift, plan):
            raise not_finite(s, "center", (s.points - plan.middle).astype(np.float32))
    try:
        s.run(shifting, plan)
    finally:
        if s.followed:
            tell_moved(s, "center", s.vertices())
    return plan.middle


class Fans(NamedTuple):
    """Where the normals of faces go, and the directions of vertices."""

    of_faces: Array  # (face_end, 3) float32: as long as twice the area
    found: Array  # (n, 3) float32
    group: Array  # see `gathering`
    sums: Floats  # (GROUP, 3): of the normals around some vertices
    out: Any


def finding_normals(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``find(m, plan) -> 0``."""
    gather, normal = gathering(k), face_normal(k)

    @kernel
    def find(m: Any, plan: Fans) -> int:
        of_faces, group = plan.of_faces, plan.group
        for begin in range(0, m.counts[FACE_END], GROUP):
            for i in range(gather(m, begin, plan)):
                f, corners = group[i, 0], (group[i, 1], group[i, 2], group[i, 3])
                of_faces[f, 0], of_faces[f, 1], of_faces[f, 2] = normal(m, corners)
        return 0

    return find


@kernel
def normal_of(m: Any, f: int, plan: Fans) -> Any:
    """The normal of a face, to be added up."""
    return sums.position(plan.of_faces, f)


def adding_around(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add_around(m, plan) -> 0``."""
    lives, add_all = living_vertex(k), visiting(k["vertex_faces"], adding(normal_of))

    @kernel
    def add_around(m: Any, plan: Fans) -> int:
        found, total, end = plan.found, plan.sums, m.counts[VERTEX_END]
        for begin in range(0, end, GROUP):
            many = min(GROUP, end - begin)
            for i in range(many):
                x = y = z = 0.0
                if lives(m, begin + i):
                    x, y, z, _ = sums.parts(add_all(m, begin + i, sums.nothing(), plan))
                total[i, 0], total[i, 1], total[i, 2] = x, y, z
            for i in range(many):
                x, y, z = unit(total[i, 0], total[i, 1], total[i, 2])
                found[begin + i, 0], found[begin + i, 1], found[begin + i, 2] = x, y, z
        return 0

    return add_around


def normals_around(s: Structure) -> Points:
    """What ``vertex_normals`` gives, (n, 3) float32, by walking around every vertex.

    Twice the areas of faces are kept as float32: it holds where they are from 1e-37 to 1e38, as
    they are where edges are from 1e-18 to 1e19 long. Smaller faces count less than they should, or
    nothing; larger ones make zeros or NaN. ``vertex_normals`` has no such bounds.

    Cost: ``vertex_faces`` of all. MeshError for polygons.
    """
    require_mesh(s, "normals_around")
    of_faces, found = (np.zeros((n, 3), np.float32) for n in (s.face_end, len(s.points)))
    plan = Fans(of_faces, found, new_group(), np.zeros((GROUP, 3)), s.scratch(0)[0])
    s.run(finding_normals, plan)
    s.run(adding_around, plan)
    return plan.found


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
    Source: Sieger & Botsch (2011).
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
"""The six algorithms by the names that the paper gives them."""
