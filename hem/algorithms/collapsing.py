"""The cheapest edge is collapsed, again and again: the compiled part of simplification.

Planes are only added up, so an edge only ever costs more than it did. What it cost says when to
look at it again: then it is put where it belongs by now, or collapsed. No edge is looked at because
another was collapsed beside it; one that becomes shorter by that comes as late as it would have.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.buckets import (
    COUNT,
    HIGHEST,
    PER_DOUBLING,
    PLACE,
    Queue,
    bucket_of,
    drop,
    peek,
    put,
    put_off,
)
from hem.algorithms.parts import Work, doing
from hem.algorithms.quadrics import WIDTH, best_point, value
from hem.arrays import Array, Floats, Handles, Indices
from hem.authoring import (
    FACES,
    NEEDS_ROOM,
    VERTICES,
    Kernel,
    Kernels,
    Refusal,
    is_point,
    kernel,
    log_element,
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

REFUSED = 1 << 30
"""Added to the stamp of an edge that could not be collapsed: it is tried again once it changed."""

FAR = 2
"""How many times as many as are wanted must be left for the order not to matter yet."""

AHEAD = 16
"""Edges whose ends are fetched from memory together."""

INTO, VERSION = range(2)
"""Columns of what became of a vertex."""

QUADRIC, BORDER, ROW = 3, 3 + WIDTH, 16
"""Columns of what is known of a vertex: its quadric, whether it lies on the border, and how many.

Position and quadric stand side by side, so that who asks for both waits for memory once.
"""


class Plan(NamedTuple):
    """What to stop at, and what is known of every vertex and edge."""

    most: Indices  # (2,): of vertices, and of faces, to be left
    error: Floats  # (1,): squared
    longest: Floats  # (1,): squared: no collapse may leave a longer edge
    cosine: Floats  # (1,): how far the normal of a face may turn
    measure: Indices  # (1,): QUADRICS, SHORTEST_EDGE or SHORTEST_TO_PLANES
    edges: Array  # (k, 2) int32: the ends of every edge, the smaller first
    stamp: Handles  # (k,): their versions when it was looked at
    next: Indices  # (1,): which of them is not in the queue yet
    middle: Floats  # (3,): of the bounding box
    rows: Floats  # (n, ROW): positions, seen from the middle, and more
    become: Array  # (n, 2) int32: what a vertex is part of by now, and how often it moved
    target: Floats  # (3,): where the vertex of a collapse comes to lie
    sum: Floats  # (11,): the quadric of an edge
    queue: Queue
    work: Work


@kernel
def which_stays(plan: Plan, a: int, b: int) -> int:
    """The end of an edge that stays: the smaller, but one on the border before one that is not."""
    return b if plan.rows[b, BORDER] > plan.rows[a, BORDER] else a


@kernel
def cost_of(plan: Plan, a: int, b: int) -> float:
    """What it costs to collapse an edge; infinite if it must not be. Finds the target as well."""
    rows, target, total = plan.rows, plan.target, plan.sum
    stays = which_stays(plan, a, b)
    long = 0.0
    for j in range(3):
        long += (rows[a, j] - rows[b, j]) ** 2
        target[j] = rows[stays, j]
    if plan.measure[0] != QUADRICS:
        if long > plan.error[0] or rows[a, BORDER] + rows[b, BORDER] == 2:
            return np.inf
        if plan.measure[0] == SHORTEST_EDGE or rows[stays, BORDER] > 0:
            return long
    for j in range(WIDTH):
        total[j] = rows[a, QUADRIC + j] + rows[b, QUADRIC + j]
    x, y, z = rows[a, 0] + rows[b, 0], rows[a, 1] + rows[b, 1], rows[a, 2] + rows[b, 2]
    target[0], target[1], target[2] = best_point(total, x / 2, y / 2, z / 2)
    error = value(total, target[0], target[1], target[2])
    if plan.measure[0] == SHORTEST_TO_PLANES:
        return long if error <= FLAT * long * total[10] else np.inf
    if error > 0 and error > plan.error[0] * total[10]:  # no weight and no bound make NaN
        return np.inf
    return error + LENGTH_WEIGHT * long * total[10]


@kernel
def left_of(plan: Plan, v: int) -> int:
    """The vertex that v has become part of; the way there is halved."""
    become = plan.become
    while become[v, INTO] != v:
        become[v, INTO] = become[become[v, INTO], INTO]
        v = become[v, INTO]
    return v


@kernel
def width_of(m: Any, plan: Plan) -> int:
    """How many buckets do not differ yet, as what is cheap in them is all collapsed in the end."""
    vertices, faces = FAR * plan.most[0], FAR * plan.most[1]
    told = plan.most[0] + plan.most[1] > 0
    far = m.counts[VERTICES] > vertices and m.counts[FACES] > faces
    return 4 * PER_DOUBLING if told and far else 1


@kernel
def fetch(plan: Plan) -> None:
    """Have what comes next brought from memory, all at once: none waits for another."""
    queue, rows, fetched = plan.queue, plan.rows, 0.0
    begin = queue.state[PLACE]
    for i in range(begin, min(begin + AHEAD, queue.state[COUNT])):
        for j in range(2):
            v = plan.become[plan.edges[queue.lowest[i], j], INTO]
            fetched += rows[v, 0] + rows[v, ROW // 2]
    plan.target[0] = fetched  # or the compiler would see that nobody needs it


def keeping_sides(k: Kernels) -> Kernel:
    """Make ``keeps_sides(m, v, other, plan) -> bool``: if v went to the target, no face at v turns.

    Those at the other end of the edge vanish.
    """
    vertex_faces, face_vertices = k["vertex_faces"], k["face_vertices"]

    @kernel
    def keeps_sides(m: Any, v: int, other: int, plan: Plan) -> bool:
        out, xyz, target = plan.work.out, plan.rows, plan.target
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
            if was > 0 and not both > plan.cosine[0] * np.sqrt(was) * np.sqrt(new):
                return False
        return True

    return keeps_sides


def keeping_short(k: Kernels) -> Kernel:
    """Make ``keeps_short(m, v, plan)``: whether all neighbors of v lie near the target."""
    vertex_vertices = k["vertex_vertices"]

    @kernel
    def keeps_short(m: Any, v: int, plan: Plan) -> bool:
        if plan.longest[0] == np.inf:
            return True
        for i in range(vertex_vertices(m, v, plan.work.out)):
            long = 0.0
            for j in range(3):
                long += (plan.rows[plan.work.out[i], j] - plan.target[j]) ** 2
            if long > plan.longest[0]:
                return False
        return True

    return keeps_short


def collapsing(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``collapse(m, a, b, plan) -> vertex``: an edge into its target, or why not."""
    edge_between, set_point, coordinate = k["edge_between"], k["set_point"], k["coordinate"]
    keeps_sides, keeps_short = keeping_sides(k), keeping_short(k)
    collapse_edge = doing(operations["collapse_edge"])

    @kernel
    def collapse(m: Any, a: int, b: int, plan: Plan) -> int:
        stays = which_stays(plan, a, b)
        for j in range(3):
            plan.work.point[j] = plan.target[j] + plan.middle[j]
            if plan.target[j] == plan.rows[stays, j]:  # small numbers would lose digits on the way
                plan.work.point[j] = coordinate(m, stays, j)
        if not is_point(plan.work.point):
            return PASSED_OVER
        for v in (a, b):
            if not (keeps_sides(m, v, a + b - v, plan) and keeps_short(m, v, plan)):
                return PASSED_OVER
        done = collapse_edge(m, edge_between(m, a, b), stays, plan.work)
        if done < 0:
            return done
        rows = plan.rows
        set_point(m, stays, plan.work.point)
        plan.work.log[0] = log_element(plan.work.log, plan.work.log[0], VERTEX + CHANGED, stays)
        for j in range(3):
            rows[stays, j] = np.float64(coordinate(m, stays, j)) - plan.middle[j]
        for j in range(WIDTH):
            rows[stays, QUADRIC + j] = plan.sum[j]
        plan.become[stays, VERSION] += 1
        plan.become[a + b - stays, INTO] = stays
        return stays

    return collapse


def simplifying(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``simplify_mesh(m, plan) -> 0``."""
    collapse = collapsing(k, operations)

    @kernel
    def simplify_mesh(m: Any, plan: Plan) -> int:
        queue, edges, stamp, become = plan.queue, plan.edges, plan.stamp, plan.become
        while plan.next[0] < len(edges):
            cost = cost_of(plan, edges[plan.next[0], 0], edges[plan.next[0], 1])
            if cost < np.inf:
                put(queue, bucket_of(queue, cost), plan.next[0])
            plan.next[0] += 1
        while m.counts[VERTICES] > plan.most[0] and m.counts[FACES] > plan.most[1]:
            edge = peek(queue, width_of(m, plan))
            if edge < 0:
                break
            if queue.state[PLACE] % AHEAD == 0:
                fetch(plan)
            one, other = left_of(plan, edges[edge, 0]), left_of(plan, edges[edge, 1])
            a, b = min(one, other), max(one, other)
            now = become[a, VERSION] + become[b, VERSION]
            if a == b:
                drop(queue)
                continue
            known_as = edges[edge, 0], edges[edge, 1], stamp[edge]
            if known_as == (a, b, REFUSED + now):
                drop(queue)
                put_off(queue, queue.state[HIGHEST], edge)
                continue
            cost = cost_of(plan, a, b)
            edges[edge, 0], edges[edge, 1], stamp[edge] = a, b, now
            bucket = bucket_of(queue, cost)
            if known_as != (a, b, now) and (cost == np.inf or bucket > queue.state[HIGHEST]):
                drop(queue)
                if cost < np.inf:
                    put(queue, bucket, edge)
                continue
            stays = collapse(m, a, b, plan)
            if stays == NEEDS_ROOM:
                return NEEDS_ROOM
            drop(queue)
            if stays < 0:
                stamp[edge] = REFUSED + now
                put_off(queue, bucket, edge)
        return 0

    return simplify_mesh
