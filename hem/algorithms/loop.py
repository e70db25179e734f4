"""Loop subdivision: a vertex on every edge, a face becomes four.

::

        c                 c           New vertices take 3/8 of both ends and 1/8 of both corners
       ╱ ╲               ╱ ╲          beside the edge, half of each end on the border. Old ones
      ╱   ╲      ──▶    •───•         move toward the mean of their n neighbors, by 5/8 - (3/8 +
     ╱     ╲           ╱ ╲ ╱ ╲        cos(2 π / n) / 4)² of the way, on the border by a fourth
    a───────b         a───•───b       toward that of the two along it.

Edges are split one after the other; then one edge in each old face, from the first new vertex
across to the old one, is turned.

Source: Loop, Smooth Subdivision Surfaces Based on Triangles (1987).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.parts import (
    NO_WORK,
    Work,
    change,
    doing,
    move,
    side_keys,
    turning,
)
from hem.algorithms.smoothing import averages
from hem.arrays import Array, Points
from hem.authoring import LEFT, NEEDS_ROOM, RIGHT, C, D, Kernel, Kernels, kernel
from hem.contract import Structure

BORDER = 0.25


class Plan(NamedTuple):
    """What is split or turned, and how far that is."""

    edges: Array  # (k, 2) int64: the ends of each
    points: Points  # (k, 3) float32: of the new vertices
    old: Array  # (1,) int64: how many vertices there were
    next: Array  # (1,) int64: the place of the next edge, or face
    work: Work


def placing_on_edges(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``find(m, plan) -> 0``: 3/8 of both ends, 1/8 of both corners beside; on borders 1/2."""
    coordinate, diamond = k["coordinate"], k["diamond"]
    edge_between = k["edge_between"]

    @kernel
    def find(m: Any, plan: Plan) -> int:
        at = plan.work.at
        for i in range(len(plan.edges)):
            a, b = plan.edges[i, 0], plan.edges[i, 1]
            diamond(m, edge_between(m, a, b), at)
            for j in range(3):
                middle = 0.5 * coordinate(m, a, j) + 0.5 * coordinate(m, b, j)
                if at[LEFT] >= 0 and at[RIGHT] >= 0:
                    beside = 0.5 * coordinate(m, at[C], j) + 0.5 * coordinate(m, at[D], j)
                    middle = 0.75 * middle + 0.25 * beside
                plan.points[i, j] = middle
        return 0

    return find


def splitting(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``split_all(m, plan) -> 0``: every edge of the plan at its point."""
    split_edge = doing(operations["split_edge"])
    edge_between = k["edge_between"]

    @kernel
    def split_all(m: Any, plan: Plan) -> int:
        while plan.next[0] < len(plan.edges):
            i = plan.next[0]
            for j in range(3):
                plan.work.point[j] = plan.points[i, j]
            e = edge_between(m, plan.edges[i, 0], plan.edges[i, 1])
            if split_edge(m, e, -1, plan.work) == NEEDS_ROOM:
                return NEEDS_ROOM
            plan.next[0] += 1
        return 0

    return split_all


@kernel
def is_turned(plan: Plan, a: int, b: int) -> bool:
    """Whether an edge runs from a new vertex to an old one across a face.

    The first split of a face leaves one. An old vertex and a new one are joined along an old edge,
    too, but then the old one is an end of it.
    """
    old = plan.old[0]
    if not a < old <= b:
        return False
    return bool(plan.edges[b - old, 0] != a and plan.edges[b - old, 1] != a)


def loop(s: Structure) -> None:
    """Three edits. Cost: ``face_vertices`` of all, a split per edge, a flip per face.

    Besides, ``vertex_vertices`` along the border, O(n_t log n_t) for the order of the edges, which
    is the same on every structure, and O(n_v n_t) where moving a vertex searches.
    """
    keys, _ = side_keys(s)
    edges = np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1)
    points, old = np.zeros((len(keys), 3), np.float32), np.array([len(s.points)])
    places = averages(
        s, "subdivide", lambda n: 5 / 8 - (3 / 8 + np.cos(2 * np.pi / n) / 4) ** 2, BORDER
    )

    def plan() -> Plan:
        return Plan(edges, points, old, np.zeros(1, np.int64), NO_WORK)

    change(s, "subdivide", placing_on_edges, plan())
    change(s, "subdivide", splitting, plan(), len(keys))
    change(s, "subdivide", turning(is_turned), plan())
    move(s, "subdivide", places)
