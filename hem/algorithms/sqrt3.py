"""√3 subdivision: a vertex in every face, the old edges flipped.

::

         c               c            Three times as many faces, turned by a right angle. Old
       ╱   ╲           ╱ │ ╲          vertices move toward the mean of their n neighbors, by
     ╱   •   ╲   ──▶  •──│──•         (4 - 2 cos(2 π / n)) / 9 of the way. Borders stay.
   ╱           ╲       ╲ │ ╱
  a─────────────b        •

Source: Kobbelt, √3-Subdivision (2000), as timed by Sieger & Botsch (2011).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_mesh
from hem.algorithms.parts import (
    NO_WORK,
    Work,
    change,
    doing,
    locating,
    move,
    summing,
    turning,
)
from hem.algorithms.smoothing import averages
from hem.arrays import Array
from hem.authoring import NEEDS_ROOM, Kernel, Kernels, kernel, part
from hem.contract import Structure


class Plan(NamedTuple):
    """What is split or turned, and how far that is."""

    faces: Array
    old: Array  # (1,) int64: how many vertices there were
    next: Array  # (1,) int64: the place of the next face
    work: Work


def splitting(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``split_all(m, plan) -> 0``: every face at the mean of its corners."""
    face_vertices, sum_of = k["face_vertices"], summing(locating(k["coordinate"]))
    split_face = doing(operations["split_face"])

    @kernel
    def split_all(m: Any, plan: Plan) -> int:
        out, point = plan.work.out, plan.work.point
        while plan.next[0] < len(plan.faces):
            f = plan.faces[plan.next[0]]
            x, y, z = sum_of(m, out, face_vertices(m, f, out))
            point[0], point[1], point[2] = x / 3, y / 3, z / 3
            if split_face(m, f, -1, plan.work) == NEEDS_ROOM:
                return NEEDS_ROOM
            plan.next[0] += 1
        return 0

    return split_all


@part
def is_turned(plan: Plan, a: int, b: int) -> bool:
    """Whether an edge joins two old vertices. Each new face has one; the border is not flipped."""
    return bool(a < plan.old[0] and b < plan.old[0])


def split_all_faces(s: Structure, kind: str) -> Plan:
    """Put a vertex into the middle of every face. One edit -> the plan of what follows."""
    old, faces = np.array([len(s.points)]), s.faces()
    change(s, kind, splitting, Plan(faces, old, np.zeros(1, np.int64), NO_WORK), len(faces))
    return Plan(faces, old, np.zeros(1, np.int64), NO_WORK)


def sqrt3(s: Structure) -> None:
    """One step, in three edits. Cost: ``vertex_vertices`` of all, a split and a flip per face."""
    require_mesh(s, "subdivide")
    places = averages(s, lambda n: (4 - 2 * np.cos(2 * np.pi / n)) / 9)
    vertices = s.vertices()
    change(s, "subdivide", turning(is_turned), split_all_faces(s, "subdivide"))
    move(s, "subdivide", vertices, places)
