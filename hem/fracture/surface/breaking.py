"""Walking over a surface and breaking it, compiled: what ``hem.fracture.surface`` runs.

Each kernel is made of the queries and operations of one structure, takes its records ``m`` and a
``Plan``, and so runs alike on every structure. All decisions are made in float64 from positions and
vertex indices alone, with nothing but + - * / and square roots, in one order: they are the same on
every structure and machine.

A face is measured in its own plane, its corners taken from the smallest one on::

              c          heights[0] of a point above a → b, [1] above b → c, [2] above c → a,
            ╱   ╲        positive inside; normal: of length 1, outward; longest: the longest side.
          ╱   p   ╲      A face without area has no normal: longest is 0, and nothing lands there.
         a─────────b
"""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring import ALLOWED, FACE_END, FACES, NEEDS_ROOM, Kernel, kernel, part

NOWHERE, ON_VERTEX, ON_EDGE, IN_FACE = -1, 0, 1, 2
"""What became of a break point: off the surface, on a vertex (no split), or splits of either."""

JUMP = -1
"""Begin a walk where it is likely to be short."""

CROSSINGS_PER_ROOT = 16
"""Faces that a walk may visit per square root of their number; who needs more is going round."""


class Plan(NamedTuple):
    """What the kernels are told, what they answer, and their scratch."""

    target: Array  # (3,) float64: the impact; on the surface once it was found
    tolerance: Array  # (1,) float64: what is nearer to a vertex or an edge lies on it
    frame: Array  # (2, 3) float64: the axes of the tangent plane
    offsets: Array  # (k, 2) float64: break points in these axes, around the impact
    landed_at: Array  # (k, 3) float64: where they came to lie on the surface
    landed_on: Array  # (k,) int64: in which face before anything was broken, -1 for outside
    outcome: Array  # (k,) int64: NOWHERE … IN_FACE
    start: Array  # (1,) int64: the face to begin at
    visited: Array  # (1,) int64: how many faces were looked at
    corners: Array  # (3,) int64: of the face that was measured last
    xyz: Array  # (3, 3) float64: where they are
    normal: Array  # (3,) float64
    heights: Array  # (3,) float64: of the point that was measured
    longest: Array  # (1,) float64
    at: Array  # (6,) int64: scratch for operations
    args: Array  # (3,) int64
    point: Array  # (3,) float32
    out: Array  # scratch for queries
    log: Array  # what was touched


def plan(target: Array, tolerance: float, out: Array, log: Array, **told: Array) -> Plan:
    """A plan with scratch of its own."""
    k = len(told.get("offsets", ()))
    own = {
        "target": np.array(target, np.float64),
        "tolerance": np.array([tolerance]),
        "frame": np.zeros((2, 3)),
        "offsets": np.zeros((k, 2)),
        "landed_at": np.zeros((k, 3)),
        "landed_on": np.zeros(k, np.int64),
        "outcome": np.full(k, NOWHERE),
        "start": np.zeros(1, np.int64),
        "visited": np.zeros(1, np.int64),
        "corners": np.zeros(3, np.int64),
        "xyz": np.zeros((3, 3)),
        "normal": np.zeros(3),
        "heights": np.zeros(3),
        "longest": np.zeros(1),
        "at": np.zeros(6, np.int64),
        "args": np.full(3, -1),
        "point": np.zeros(3, np.float32),
    }
    return Plan(**(own | told), out=out, log=log)


@kernel
def dot(a: Array, b: Array) -> float:
    """The scalar product."""
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@kernel
def minus(a: Array, b: Array) -> tuple[float, float, float]:
    """The vector from b to a."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def cross(a: Array, b: Array) -> tuple[float, float, float]:
    """The vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@kernel
def length(a: Array) -> float:
    """Of a vector."""
    return float(np.sqrt(dot(a, a)))


def surveying(k: Mapping[str, Kernel]) -> Any:
    """What all of it takes: ``measure``, ``across`` and ``lowest``, for one structure."""
    face_vertices, face_faces, coordinate = k["face_vertices"], k["face_faces"], k["coordinate"]

    @part
    def measure(m: Any, f: int, p: Array, plan: Plan) -> bool:
        """Measure a face and a point above it -> whether the face has an area."""
        out, corners = plan.out, plan.corners
        face_vertices(m, f, out)
        first = 0
        for i in range(1, 3):
            if out[i] < out[first]:
                first = i
        for i in range(3):
            corners[i] = out[(first + i) % 3]
            for j in range(3):
                plan.xyz[i, j] = coordinate(m, corners[i], j)
        plan.visited[0] += 1
        a = plan.xyz[0]
        normal = cross(minus(plan.xyz[1], a), minus(plan.xyz[2], a))
        size = length(normal)
        plan.longest[0] = 0.0
        if not size > 0:
            return False
        for j in range(3):
            plan.normal[j] = normal[j] / size
        for i in range(3):
            side = minus(plan.xyz[(i + 1) % 3], plan.xyz[i])
            long = length(side)
            plan.heights[i] = dot(cross(side, minus(p, plan.xyz[i])), plan.normal) / long
            plan.longest[0] = max(plan.longest[0], long)
        return True

    @part
    def across(m: Any, f: int, a: int, b: int, out: Array) -> int:
        """The face beyond the side (a, b) of a face, or -1 at the border."""
        count = face_faces(m, f, out)
        for i in range(count):
            g, has = out[i], 0
            face_vertices(m, g, out[count:])
            for j in range(3):
                has += out[count + j] == a or out[count + j] == b
            if has == 2:
                return int(g)
        return -1

    @kernel
    def lowest(plan: Plan) -> int:
        """The side that the point lies farthest beyond, or the least inside."""
        side = 0
        for i in range(1, 3):
            if plan.heights[i] < plan.heights[side]:
                side = i
        return side

    @part
    def walk(m: Any, f: int, p: Array, plan: Plan) -> int:
        """From face to face toward a point -> the face it lies above, or where the walk ends.

        It ends at the border, and where it would turn back: the point is then nearest to the edge.
        """
        most = CROSSINGS_PER_ROOT * int(np.sqrt(1.0 * m.counts[FACES])) + 64
        last = -1
        for _ in range(most):
            if not measure(m, f, p, plan):
                return f
            side = lowest(plan)
            if plan.heights[side] >= 0:
                return f
            g = across(m, f, plan.corners[side], plan.corners[(side + 1) % 3], plan.out)
            if g < 0:
                # The border is in the way here; perhaps there is a way around.
                other = (side + 1) % 3 if plan.heights[(side + 1) % 3] < 0 else (side + 2) % 3
                if plan.heights[other] >= 0:
                    return f
                g = across(m, f, plan.corners[other], plan.corners[(other + 1) % 3], plan.out)
            if g < 0 or g == last:
                return f
            last, f = f, g
        return f

    return SimpleNamespace(measure=measure, across=across, lowest=lowest, walk=walk)


def finding(k: Mapping[str, Kernel], operations: Mapping[str, Kernel]) -> Kernel:
    """Make ``find(m, plan) -> face``: walk toward the target from ``plan.start``, or ``JUMP``.

    -1 where there is no face to begin at, or the walk ends in one without area.
    """
    survey = surveying(k)
    walk, measure = survey.walk, survey.measure
    face_vertices, face_exists, coordinate = k["face_vertices"], k["face_exists"], k["coordinate"]

    @part
    def jump(m: Any, plan: Plan) -> int:
        """Of about n_t^(1/3) faces, evenly spread over the handles, the one nearest by a corner."""
        best, least = -1, np.inf
        step = max(1, int(m.counts[FACE_END] ** (2 / 3)))
        for f in range(0, m.counts[FACE_END], step):
            if face_exists(m, f):
                face_vertices(m, f, plan.out)
                v, far = min(plan.out[0], plan.out[1], plan.out[2]), 0.0
                for j in range(3):
                    far += (coordinate(m, v, j) - plan.target[j]) ** 2
                if far < least:
                    best, least = f, far
        return best

    @kernel
    def find(m: Any, plan: Plan) -> int:
        plan.visited[0] = 0
        f = plan.start[0]
        if f == JUMP:
            f = jump(m, plan)
        if f < 0:
            return -1
        f = walk(m, f, plan.target, plan)
        return f if measure(m, f, plan.target, plan) else -1

    return find


def landing(k: Mapping[str, Kernel]) -> Kernel:
    """Make ``land(m, f, at, toward, far, plan) -> face``: go straight over the surface.

    From position ``at`` in face f, along the unit vector ``toward`` in its plane, ``far`` units on;
    at each edge the way is unfolded into the next face (Polthier & Schmies, Straightest geodesics
    on polyhedral surfaces, 1998), so that in a plane it is a straight line. ``at`` and ``toward``
    move along. -1: over the border, or into a face without area.
    """
    survey = surveying(k)
    measure, across = survey.measure, survey.across

    @part
    def land(m: Any, f: int, at: Array, toward: Array, far: float, plan: Plan) -> int:
        entered_a, entered_b = -1, -1
        most = CROSSINGS_PER_ROOT * int(np.sqrt(1.0 * m.counts[FACES])) + 64
        for _ in range(most):
            if not measure(m, f, at, plan):
                return -1
            step, side = far, -1
            for i in range(3):
                a, b = plan.corners[i], plan.corners[(i + 1) % 3]
                if (a == entered_a and b == entered_b) or (a == entered_b and b == entered_a):
                    continue
                along = minus(plan.xyz[(i + 1) % 3], plan.xyz[i])
                rate = dot(cross(plan.normal, along), toward) / length(along)
                if rate < 0 and max(plan.heights[i], 0.0) / -rate < step:
                    step, side = max(plan.heights[i], 0.0) / -rate, i
            for j in range(3):
                at[j] += step * toward[j]
            if side < 0:
                return f
            far -= step
            entered_a, entered_b = plan.corners[side], plan.corners[(side + 1) % 3]
            along = minus(plan.xyz[(side + 1) % 3], plan.xyz[side])
            long = length(along)
            forth = dot(along, toward) / long
            over = -dot(cross(plan.normal, along), toward) / long
            g = across(m, f, entered_a, entered_b, plan.out)
            if g < 0 or not measure(m, g, at, plan):
                return -1
            # The next face has the side the other way round, and its inside beyond.
            inward = cross(along, plan.normal)
            for j in range(3):
                toward[j] = (forth * along[j] + over * inward[j]) / long
            f = g
        return -1

    return land


def splitting(k: Mapping[str, Kernel], operations: Mapping[str, Kernel]) -> Kernel:
    """Make ``split(m, f, p, plan) -> outcome``: split a face at a point of it, or its edge there.

    Within the tolerance of an edge, the edge is split where the point is nearest to it; within that
    of a vertex nothing is. ``plan.args[1]`` becomes the vertex in any case.
    """
    survey = surveying(k)
    measure, lowest = survey.measure, survey.lowest
    split_face, split_edge = operations["split_face"], operations["split_edge"]
    face_edges, edge_vertices = k["face_edges"], k["edge_vertices"]

    @kernel
    def edge_between(m: Any, f: int, a: int, b: int, out: Array) -> int:
        """The edge of a face that joins two of its corners."""
        count = face_edges(m, f, out)
        for i in range(count):
            e = out[i]
            edge_vertices(m, e, out[count:])
            if min(a, b) == min(out[count], out[count + 1]) and max(a, b) == max(
                out[count], out[count + 1]
            ):
                return int(e)
        return -1

    @part
    def split(m: Any, f: int, p: Array, plan: Plan) -> int:
        tolerance, point, args = plan.tolerance[0], plan.point, plan.args
        if not measure(m, f, p, plan):
            return NOWHERE
        for i in range(3):
            if length(minus(p, plan.xyz[i])) < tolerance:
                args[1] = plan.corners[i]
                return ON_VERTEX
        side = lowest(plan)
        for j in range(3):
            point[j] = p[j]
        if plan.heights[side] >= tolerance:
            args[0] = f
            args[1] = split_face(m, args, point, plan.at, plan.out, plan.log, False)
            return IN_FACE
        a, b = plan.corners[side], plan.corners[(side + 1) % 3]
        start = plan.xyz[side]
        along = minus(plan.xyz[(side + 1) % 3], start)
        part = dot(minus(p, start), along) / dot(along, along)
        for j in range(3):
            point[j] = start[j] + part * along[j]
        args[0] = edge_between(m, f, a, b, plan.out)
        args[1] = split_edge(m, args, point, plan.at, plan.out, plan.log, False)
        return ON_EDGE

    return split


def breaking(k: Mapping[str, Kernel], operations: Mapping[str, Kernel]) -> Kernel:
    """Make ``break_up(m, plan) -> result``: break the surface around the target (thesis 4.4).

    ``plan.start`` is the face under it. There must be room for everything beforehand. The
    result is negative if there was not.
    """
    survey, land, split = surveying(k), landing(k), splitting(k, operations)
    measure, walk = survey.measure, survey.walk

    @kernel
    def send_out(m: Any, f: int, plan: Plan, toward: Array) -> None:
        """Carry every break point from the tangent plane onto the surface, still whole."""
        for i in range(len(plan.offsets)):
            far = np.sqrt(plan.offsets[i, 0] ** 2 + plan.offsets[i, 1] ** 2)
            for j in range(3):
                plan.landed_at[i, j] = plan.target[j]
                toward[j] = (
                    plan.offsets[i, 0] * plan.frame[0, j] + plan.offsets[i, 1] * plan.frame[1, j]
                )
                if far > 0:
                    toward[j] /= far
            plan.landed_on[i] = land(m, f, plan.landed_at[i], toward, far, plan)
            for j in range(3):  # what the structure holds is float32
                plan.point[j] = plan.landed_at[i, j]
                plan.landed_at[i, j] = plan.point[j]

    @kernel
    def split_middle(m: Any, f: int, a: int, b: int, middle: Array, plan: Plan) -> int:
        """Split the side (a, b) of a face, if the face still has it."""
        for j in range(3):
            plan.point[j] = middle[j]
            middle[j] = plan.point[j]
        return split(m, walk(m, f, middle, plan), middle, plan)

    @kernel
    def break_up(m: Any, plan: Plan) -> int:
        face, toward = plan.start[0], np.zeros(3)
        send_out(m, face, plan, toward)
        if not measure(m, face, plan.target, plan):
            return NEEDS_ROOM
        ends, middles = plan.corners.copy(), np.zeros((3, 3))
        for i in range(3):
            for j in range(3):
                middles[i, j] = (plan.xyz[i, j] + plan.xyz[(i + 1) % 3, j]) / 2
        split(m, face, plan.target, plan)
        for i in range(3):
            split_middle(m, face, ends[i], ends[(i + 1) % 3], middles[i], plan)
        for i in range(len(plan.offsets)):
            if plan.landed_on[i] >= 0:
                f = walk(m, plan.landed_on[i], plan.landed_at[i], plan)
                plan.outcome[i] = split(m, f, plan.landed_at[i], plan)
        return ALLOWED

    return break_up
