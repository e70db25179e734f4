"""√3 subdivision: a vertex in every face, the old edges flipped.

::

         c               c            Three times as many faces, turned by a right angle. Old
       ╱   ╲           ╱ │ ╲          vertices move toward the mean of their n neighbors, by
     ╱   •   ╲   ──▶  •──│──•         (4 - 2 cos(2 π / n)) / 9 of the way. Borders stay.
   ╱           ╲       ╲ │ ╱
  a─────────────b        •

Source: Kobbelt, √3-Subdivision (2000), as timed by Sieger & Botsch (2011), whose program leaves
borders as they are, too. Kobbelt has a rule for them: every second step parts their edges in three.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.parts import (
    NO_WORK,
    Work,
    adding,
    change,
    doing,
    most_faces_at_a_vertex,
    move,
    of_vertices,
    turning,
)
from hem.algorithms.smoothing import averages
from hem.arrays import Array
from hem.authoring import NEEDS_ROOM, Kernel, Kernels, kernel, sums, visiting
from hem.contract import Structure


class Plan(NamedTuple):
    """What is split or turned, and how far that is."""

    faces: Array
    out: Any
    old: Array  # (1,) int64: how many vertices there were
    next: Array  # (1,) int64: the place of the next face
    work: Work


def splitting(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``split_all(m, plan) -> 0``: every face at the mean of its corners."""
    add_all = visiting(k["face_vertices"], adding(of_vertices(k["position"])))
    split_face = doing(operations["split_face"])

    @kernel
    def split_all(m: Any, plan: Plan) -> int:
        point = plan.work.point
        while plan.next[0] < len(plan.faces):
            f = plan.faces[plan.next[0]]
            x, y, z, _ = sums.parts(add_all(m, f, sums.nothing(), plan))
            point[0], point[1], point[2] = x / 3, y / 3, z / 3
            if split_face(m, f, -1, plan.work) == NEEDS_ROOM:
                return NEEDS_ROOM
            plan.next[0] += 1
        return 0

    return split_all


@kernel
def is_turned(plan: Plan, a: int, b: int) -> bool:
    """Whether an edge joins two old vertices. Each new face has one; the border is not flipped."""
    return bool(a < plan.old[0] and b < plan.old[0])


def split_all_faces(s: Structure, kind: str) -> Plan:
    """Put a vertex into the middle of every face. One edit -> the plan of what follows.

    No vertex has more than twice as many faces as it had.
    """
    old, faces, out = np.array([len(s.points)]), s.faces(), s.scratch(0)[0]
    plan = Plan(faces, out, old, np.zeros(1, np.int64), NO_WORK)
    change(s, kind, splitting, plan, len(faces), 2 * most_faces_at_a_vertex(s))
    plan.next[0] = 0
    return plan


def sqrt3(s: Structure) -> None:
    """One step, in three edits. Cost: ``face_vertices`` of all, a split and a flip per face.

    Besides, O(n_v n_t) where moving a vertex searches.
    """
    places = averages(s, "subdivide", lambda n: (4 - 2 * np.cos(2 * np.pi / n)) / 9)
    split = split_all_faces(s, "subdivide")
    change(s, "subdivide", turning(is_turned), split, 0, most_faces_at_a_vertex(s))
    move(s, "subdivide", places)
