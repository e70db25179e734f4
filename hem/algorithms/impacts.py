"""Impacts, as in a game that breaks things: a face is hit, split, and what is around is asked for.

::

         c                  c           The face gets a vertex in its middle, v. The faces around
       ╱   ╲              ╱ │ ╲         each neighbor of v are asked for. The edge from v to the
     ╱       ╲    ──▶   ╱   v   ╲       smallest corner a is split at m, and the faces beside what
    a─────────b        a──m───────b     is left of the face are asked for.

Source: the destruction of thesis 4.4, at its smallest.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_mesh
from hem.algorithms.parts import NO_WORK, Work, change, doing
from hem.arrays import Array
from hem.authoring import NEEDS_ROOM, Kernel, Kernels, kernel
from hem.contract import Structure, arguments


class Plan(NamedTuple):
    """Which faces are hit, and how far that is."""

    faces: Array
    corners: Array  # (3,) int64: of the face that is hit
    next: Array  # (1,) int64: the place of the next face
    middle: Array  # (1,) int64: the vertex in its middle, -1 before it is split
    found: Array  # (1,) int64: how many faces were found around
    work: Work


def hitting(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``hit(m, plan) -> 0``."""
    face_vertices, face_faces, coordinate = k["face_vertices"], k["face_faces"], k["coordinate"]
    vertex_faces = k["vertex_faces"]
    split_face, split_edge = doing(operations["split_face"]), doing(operations["split_edge"])
    edge_between = k["edge_between"]

    @kernel
    def hit(m: Any, plan: Plan) -> int:
        corners, out, point = plan.corners, plan.work.out, plan.work.point
        while plan.next[0] < len(plan.faces):
            f = plan.faces[plan.next[0]]
            if plan.middle[0] < 0:
                face_vertices(m, f, out)
                for i in range(3):
                    corners[i] = out[i]
                for j in range(3):
                    total = 0.0
                    for i in range(3):
                        total += coordinate(m, corners[i], j)
                    point[j] = total / 3
                v = split_face(m, f, -1, plan.work)
                if v == NEEDS_ROOM:
                    return NEEDS_ROOM
                plan.middle[0] = v
                for i in range(3):
                    plan.found[0] += vertex_faces(m, corners[i], out)
            v, a = plan.middle[0], min(corners[0], corners[1], corners[2])
            for j in range(3):
                point[j] = 0.5 * coordinate(m, v, j) + 0.5 * coordinate(m, a, j)
            if split_edge(m, edge_between(m, v, a), -1, plan.work) == NEEDS_ROOM:
                return NEEDS_ROOM
            plan.found[0] += face_faces(m, f, out)
            plan.middle[0] = -1
            plan.next[0] += 1
        return 0

    return hit


def impacts(s: Structure, faces: Array | list[int]) -> int:
    """Hit faces one after the other -> how many faces were found around. One edit.

    Each makes two vertices and four faces more; a face may be hit again. Cost per impact: a split
    of a face, a split of an edge, and six queries. MeshError for what is no face, before anything
    changes, and for polygons. Source: thesis 4.4.
    """
    require_mesh(s, "impacts")
    hit = arguments.handles("impacts", faces)
    s.face_vertices(hit)  # refuses what is no face
    state = np.zeros(3, np.int64), np.zeros(1, np.int64), np.full(1, -1), np.zeros(1, np.int64)
    plan = Plan(hit, *state, NO_WORK)
    change(s, "impacts", hitting, plan, 2 * len(hit))
    return int(plan.found[0])
