"""The cheapest edge is collapsed, again and again: the compiled part of simplification."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.heap import Heap, pop, purge, push
from hem.algorithms.parts import Work, doing, finding_edge
from hem.algorithms.quadrics import WIDTH, best_point, value
from hem.arrays import Bools, Floats, Indices
from hem.authoring import (
    FACES,
    NEEDS_ROOM,
    VERTICES,
    Kernel,
    Kernels,
    Refusal,
    kernel,
    log_element,
    part,
)
from hem.edit import CHANGED, VERTEX

QUADRICS, SHORTEST_EDGE, SHORTEST_TO_PLANES = range(3)
"""What an edge costs; its vertex comes to lie where planes say, or at an end of it."""

FLAT = 0.1**2
"""How far from its planes a short edge may be collapsed: a part of its squared length."""

LENGTH_WEIGHT = 1e-5
"""How much the length of an edge counts, so that the short ones go first where all is flat."""

PASSED_OVER = int(Refusal.NO_EDGE)
"""The result where a collapse is not even tried."""

DEAD = -(1 << 40)
"""The version of what was collapsed: no stamp is like it."""


class Plan(NamedTuple):
    """What to stop at, and what is known of every vertex and edge."""

    most: Indices  # (2,): of vertices, and of faces, to be left
    error: Floats  # (1,): squared
    longest: Floats  # (1,): squared: no collapse may leave a longer edge
    cosine: Floats  # (1,): how far the normal of a face may turn
    measure: Indices  # (1,): QUADRICS, SHORTEST_EDGE or SHORTEST_TO_PLANES
    edges: Indices  # (k,): smaller end << 32 | larger end
    next: Indices  # (1,): which of them is not on the heap yet
    middle: Floats  # (3,): of the bounding box
    xyz: Floats  # (n, 3): positions, seen from the middle
    quadric: Floats  # (n, 11)
    on_border: Bools  # (n,)
    version: Indices  # (n,): how often a vertex was moved
    target: Floats  # (3,): where the vertex of a collapse comes to lie
    sum: Floats  # (11,): the quadric of an edge
    heap: Heap
    work: Work


@part
def cost_of(plan: Plan, edge: int) -> float:
    """What it costs to collapse an edge; infinite if it must not be. Finds the target as well."""
    a, b = edge >> 32, edge & 0xFFFFFFFF
    xyz, target, total = plan.xyz, plan.target, plan.sum
    stays = b if plan.on_border[b] and not plan.on_border[a] else a
    long = 0.0
    for j in range(3):
        long += (xyz[a, j] - xyz[b, j]) ** 2
        target[j] = xyz[stays, j]
    if plan.measure[0] != QUADRICS:
        if long > plan.error[0] or (plan.on_border[a] and plan.on_border[b]):
            return np.inf
        if plan.measure[0] == SHORTEST_EDGE or plan.on_border[stays]:
            return long
    for j in range(WIDTH):
        total[j] = plan.quadric[a, j] + plan.quadric[b, j]
    x, y, z = xyz[a, 0] + xyz[b, 0], xyz[a, 1] + xyz[b, 1], xyz[a, 2] + xyz[b, 2]
    target[0], target[1], target[2] = best_point(total, x / 2, y / 2, z / 2)
    error = value(total, target[0], target[1], target[2])
    if plan.measure[0] == SHORTEST_TO_PLANES:
        return long if error <= FLAT * long * total[10] else np.inf
    if error > plan.error[0] * total[10]:
        return np.inf
    return error + LENGTH_WEIGHT * long * total[10]


@part
def offer(plan: Plan, edge: int) -> None:
    """Put an edge on the heap, unless it must not be collapsed."""
    cost = cost_of(plan, edge)
    if cost < np.inf:
        if plan.heap.size[0] == len(plan.heap.cost):
            purge(plan.heap, plan.version)
        stamp = plan.version[edge >> 32] + plan.version[edge & 0xFFFFFFFF]
        push(plan.heap, cost, edge, stamp)


def keeping_sides(k: Kernels) -> Kernel:
    """Make ``keeps_sides(m, v, other, plan) -> bool``: if v went to the target, no face at v turns.

    Those at the other end of the edge vanish.
    """
    vertex_faces, face_vertices = k["vertex_faces"], k["face_vertices"]

    @part
    def keeps_sides(m: Any, v: int, other: int, plan: Plan) -> bool:
        out, xyz, target = plan.work.out, plan.xyz, plan.target
        count = vertex_faces(m, v, out)
        for i in range(count):
            corners = out[count : count + 3]
            face_vertices(m, out[i], corners)
            a, b = corners[1], corners[2]
            if corners[1] == v:
                a, b = corners[2], corners[0]
            elif corners[2] == v:
                a, b = corners[0], corners[1]
            if a == other or b == other:
                continue
            side = xyz[b, 0] - xyz[a, 0], xyz[b, 1] - xyz[a, 1], xyz[b, 2] - xyz[a, 2]
            was, new, both = 0.0, 0.0, 0.0
            for j in range(3):
                p, q = (j + 1) % 3, (j + 2) % 3
                before = side[p] * (xyz[v, q] - xyz[a, q]) - side[q] * (xyz[v, p] - xyz[a, p])
                after = side[p] * (target[q] - xyz[a, q]) - side[q] * (target[p] - xyz[a, p])
                was, new, both = was + before**2, new + after**2, both + before * after
            if was > 0 and not both > plan.cosine[0] * np.sqrt(was * new):
                return False
        return True

    return keeps_sides


def simplifying(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``simplify_mesh(m, plan) -> 0``."""
    edge_between = finding_edge(k["vertex_edges"], k["edge_vertices"])
    keeps_sides, collapse_edge = keeping_sides(k), doing(operations["collapse_edge"])
    vertex_vertices, set_point, coordinate = k["vertex_vertices"], k["set_point"], k["coordinate"]

    @part
    def keeps_short(m: Any, v: int, plan: Plan) -> bool:
        """Whether all neighbors of v lie near enough to the target."""
        for i in range(vertex_vertices(m, v, plan.work.out)):
            long = 0.0
            for j in range(3):
                long += (plan.xyz[plan.work.out[i], j] - plan.target[j]) ** 2
            if long > plan.longest[0]:
                return False
        return True

    @part
    def collapse(m: Any, a: int, b: int, plan: Plan) -> int:
        """Collapse an edge into its target -> the vertex, or why not."""
        if not (keeps_sides(m, a, b, plan) and keeps_sides(m, b, a, plan)):
            return PASSED_OVER
        if not (keeps_short(m, a, plan) and keeps_short(m, b, plan)):
            return PASSED_OVER
        stays = b if plan.on_border[b] and not plan.on_border[a] else a
        done = collapse_edge(m, edge_between(m, a, b, plan.work), stays, plan.work)
        if done < 0:
            return done
        for j in range(3):
            plan.work.point[j] = plan.target[j] + plan.middle[j]
        set_point(m, stays, plan.work.point)
        plan.work.log[0] = log_element(plan.work.log, plan.work.log[0], VERTEX + CHANGED, stays)
        for j in range(3):
            plan.xyz[stays, j] = np.float64(coordinate(m, stays, j)) - plan.middle[j]
        for j in range(WIDTH):
            plan.quadric[stays, j] = plan.sum[j]
        plan.on_border[stays] = plan.on_border[a] or plan.on_border[b]
        plan.version[stays] += 1
        plan.version[a + b - stays] = DEAD
        return stays

    @kernel
    def simplify_mesh(m: Any, plan: Plan) -> int:
        heap, version, out = plan.heap, plan.version, plan.work.out
        while plan.next[0] < len(plan.edges):
            offer(plan, plan.edges[plan.next[0]])
            plan.next[0] += 1
        while m.counts[VERTICES] > plan.most[0] and m.counts[FACES] > plan.most[1]:
            if heap.size[0] == 0:
                break
            edge, stamp = heap.edge[0], heap.stamp[0]
            a, b = edge >> 32, edge & 0xFFFFFFFF
            if version[a] + version[b] == stamp:
                cost_of(plan, edge)
                stays = collapse(m, a, b, plan)
                if stays == NEEDS_ROOM:
                    return NEEDS_ROOM
                pop(heap)
                for i in range(vertex_vertices(m, stays, out) if stays >= 0 else 0):
                    offer(plan, min(stays, out[i]) << 32 | max(stays, out[i]))
            else:
                pop(heap)
        return 0

    return simplify_mesh
