"""Smoothing: every vertex toward the mean of its neighbors, again and again.

Sources: Sieger & Botsch (2011) for the pass; Taubin, A Signal Processing Approach to Fair Surface
Design (1995), for the one that does not shrink what it smooths.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_count, require_mesh
from hem.algorithms.parts import NOTHING, adding, count_faces_at, locating, move
from hem.arrays import Array, Floats, Points
from hem.authoring import Kernel, Kernels, kernel, visiting
from hem.contract import Structure
from hem.naming import look_up

METHODS = {"laplace": (1.0,), "taubin": (0.5, -0.53)}
"""How far vertices go toward the mean in the passes of one iteration; away from it is negative."""


class Plan(NamedTuple):
    """Who goes how far, and where to."""

    vertices: Array
    inside: Floats  # by number of neighbors: the part of the way to their mean
    border: float  # that to the mean of the two neighbors along the border
    faces_at: Array  # (n,) int32: how many faces a vertex has; none if there is no border
    places: Points  # (n, 3) float32: where vertices come to lie
    out: Any


def averaging(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``average(m, plan) -> 0``. A vertex on the border has more neighbors than faces."""
    vertex_vertices, face_left_of = k["vertex_vertices"], k["face_left_of"]
    where = locating(k["coordinate"])
    add = adding(where)
    add_all = visiting(vertex_vertices, add)

    @kernel
    def add_border(m: Any, v: int, plan: Plan) -> tuple[int, float, float, float]:
        """The sums of the neighbors that v has an edge of one face with."""
        sums, out = NOTHING, plan.out
        for i in range(vertex_vertices(m, v, out)):
            if face_left_of(m, v, out[i]) < 0 or face_left_of(m, out[i], v) < 0:
                sums = add(m, out[i], sums, plan)
        return sums

    @kernel
    def average(m: Any, plan: Plan) -> int:
        border, places = plan.border, plan.places
        for i in range(len(plan.vertices)):
            v = plan.vertices[i]
            n, a, b, c = add_all(m, v, NOTHING, plan)
            part = plan.inside[n]
            if len(plan.faces_at) > 0 and n > plan.faces_at[v]:
                part = border
                n, a, b, c = add_border(m, v, plan) if border != 0 else NOTHING
            x, y, z = where(m, v)
            if n > 0:
                x, y, z = x + part * (a / n - x), y + part * (b / n - y), z + part * (c / n - z)
            places[v, 0], places[v, 1], places[v, 2] = x, y, z
        return 0

    return average


def averages(s: Structure, inside: Callable[[Array], Array], border: float = 0.0) -> Points:
    """(n, 3) float32: vertices moved toward the mean of their neighbors; see ``Plan``."""
    n, (out, _) = len(s.points), s.scratch(0)
    neighbors = np.arange(1.0, len(out) // 2)  # more than any vertex has
    parts = np.append(0.0, inside(neighbors))
    closed = 2 * s.n_edges == 3 * s.n_faces
    faces_at = np.zeros(0, np.int32) if closed else count_faces_at(s)
    places = np.zeros((n, 3), np.float32)
    s.run(averaging, Plan(s.vertices(), parts, border, faces_at, places, out))
    return places


def smooth(s: Structure, iterations: int = 1, method: str = "laplace") -> None:
    """Smooth a mesh in place, all vertices at once; those on the border stay.

    ``laplace`` moves each to the mean of its neighbors, ``taubin`` half the way there and then as
    far back, by which the volume is kept. One edit per pass. Cost per iteration: one or two times
    ``vertex_vertices`` of all. MeshError for another method or number, and for polygons.
    """
    require_mesh(s, "smooth")
    passes = look_up(method, METHODS, "method")
    for _ in range(require_count("smooth", "iterations", iterations)):
        for part in passes:
            move(s, "smooth", s.vertices(), averages(s, partial(np.full_like, fill_value=part)))
