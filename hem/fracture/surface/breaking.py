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

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from hem.algorithms import cross, dot
from hem.arrays import Array
from hem.authoring import ALLOWED, FACE_END, FACES, NEEDS_ROOM, Kernel, kernel

NOWHERE, ON_VERTEX, ON_EDGE, IN_FACE = -1, 0, 1, 2
OUTCOMES = {
    "in a face": IN_FACE, "on an edge": ON_EDGE, "on a vertex": ON_VERTEX, "outside": NOWHERE,
}  # fmt: skip
"""What became of the break points, in words: the first two split, the others are dropped."""

JUMP = -1
"""Begin a walk where it is likely to be short."""

CROSSINGS_PER_ROOT = 16  # faces a walk may visit per root of their number; then it goes round


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


def make_plan(target: Array, tolerance: float, out: Array, log: Array, **given: Array) -> Plan:
    """A plan with scratch of its own."""
    k = len(given.get("offsets", ()))
    floats: dict[str, Any] = {
        "frame": (2, 3), "offsets": (k, 2), "landed_at": (k, 3),
        "xyz": (3, 3), "normal": 3, "heights": 3, "longest": 1,
    }  # fmt: skip
    integers = {"landed_on": k, "start": 1, "visited": 1, "corners": 3, "at": 6}
    own = {name: np.zeros(shape) for name, shape in floats.items()}
    own |= {name: np.zeros(n, np.int64) for name, n in integers.items()}
    own |= {"target": np.array(target, np.float64), "tolerance": np.array([tolerance])}
    own |= {"outcome": np.full(k, NOWHERE), "args": np.full(3, -1)}
    return Plan(**(own | given), point=np.zeros(3, np.float32), out=out, log=log)


@kernel
def minus(a: Array, b: Array) -> tuple[float, float, float]:
    """The vector from b to a."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def length(a: Array) -> float:
    """Of a vector."""
    return float(np.sqrt(dot(a, a)))


@kernel
def lowest_side(plan: Plan) -> int:
    """The side that the measured point lies farthest beyond, or the least inside."""
    side = 0
    for i in range(1, 3):
        if plan.heights[i] < plan.heights[side]:
            side = i
    return side


def measuring(k: Mapping[str, Kernel]) -> Kernel:
    """Make ``measure(m, f, p, plan)``: a face and a point above it -> whether it has an area."""
    face_vertices, coordinate = k["face_vertices"], k["coordinate"]

    @kernel
    def measure(m: Any, f: int, p: Array, plan: Plan) -> bool:
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

    return measure


def crossing(k: Mapping[str, Kernel]) -> Kernel:
    """Make ``across(m, f, a, b, out)``: the face beyond the side (a, b) of f, -1 at the border."""
    face_vertices, face_faces = k["face_vertices"], k["face_faces"]

    @kernel
    def across(m: Any, f: int, a: int, b: int, out: Array) -> int:
        count = face_faces(m, f, out)
        for i in range(count):
            g, has = out[i], 0
            face_vertices(m, g, out[count:])
            for j in range(3):
                has += out[count + j] == a or out[count + j] == b
            if has == 2:
                return int(g)
        return -1

    return across


def walking(measure: Kernel, across: Kernel) -> Kernel:
    """Make ``walk(m, f, p, plan)``: from face f toward a point -> the face where the walk ends.

    It ends above or below the point, at the border, and where it would turn back: the point is
    then nearest to the edge.
    """

    @kernel
    def walk(m: Any, f: int, p: Array, plan: Plan) -> int:
        most = CROSSINGS_PER_ROOT * int(np.sqrt(1.0 * m.counts[FACES])) + 64
        last = -1
        for _ in range(most):
            if not measure(m, f, p, plan):
                return f
            side = lowest_side(plan)
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

    return walk


def finding(k: Mapping[str, Kernel], operations: Mapping[str, Kernel]) -> Kernel:
    """Make ``find(m, plan) -> face``: walk toward the target from ``plan.start``, or ``JUMP``.

    -1 where there is no face to begin at, or the walk ends in one without area.
    """
    measure = measuring(k)
    walk = walking(measure, crossing(k))
    face_vertices, face_exists, coordinate = k["face_vertices"], k["face_exists"], k["coordinate"]

    @kernel
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


@kernel
def exit_side(plan: Plan, toward: Array, far: float, a: int, b: int) -> tuple[float, int]:
    """How far the way goes on in the measured face, and the side where it leaves; -1 for none.

    (a, b) is the side where it came in.
    """
    step, side = far, -1
    for i in range(3):
        c, d = plan.corners[i], plan.corners[(i + 1) % 3]
        if (c == a and d == b) or (c == b and d == a):
            continue
        along = minus(plan.xyz[(i + 1) % 3], plan.xyz[i])
        rate = dot(cross(plan.normal, along), toward) / length(along)
        if rate < 0 and max(plan.heights[i], 0.0) / -rate < step:
            step, side = max(plan.heights[i], 0.0) / -rate, i
    return step, side


def landing(measure: Kernel, across: Kernel) -> Kernel:
    """Make ``land(m, f, at, toward, far, plan) -> face``: go straight over the surface.

    From position ``at`` in face f, along the unit vector ``toward`` in its plane, ``far`` units on;
    at each edge the way is unfolded into the next face (Polthier & Schmies, Straightest geodesics
    on polyhedral surfaces, 1998), so that in a plane it is a straight line. ``at`` and ``toward``
    move along. -1: over the border, or into a face without area.
    """

    @kernel
    def land(m: Any, f: int, at: Array, toward: Array, far: float, plan: Plan) -> int:
        a, b = -1, -1
        most = CROSSINGS_PER_ROOT * int(np.sqrt(1.0 * m.counts[FACES])) + 64
        for _ in range(most):
            if not measure(m, f, at, plan):
                return -1
            step, side = exit_side(plan, toward, far, a, b)
            for j in range(3):
                at[j] += step * toward[j]
            if side < 0:
                return f
            far -= step
            a, b = plan.corners[side], plan.corners[(side + 1) % 3]
            along = minus(plan.xyz[(side + 1) % 3], plan.xyz[side])
            long = length(along)
            forth = dot(along, toward) / long
            over = -dot(cross(plan.normal, along), toward) / long
            f = across(m, f, a, b, plan.out)
            if f < 0 or not measure(m, f, at, plan):
                return -1
            # The next face has the side the other way round, and its inside beyond.
            inward = cross(along, plan.normal)
            for j in range(3):
                toward[j] = (forth * along[j] + over * inward[j]) / long
        return -1

    return land


def edge_finding(k: Mapping[str, Kernel]) -> Kernel:
    """Make ``edge_between(m, f, a, b, out)``: the edge of f that joins two of its corners."""
    face_edges, edge_vertices = k["face_edges"], k["edge_vertices"]

    @kernel
    def edge_between(m: Any, f: int, a: int, b: int, out: Array) -> int:
        count = face_edges(m, f, out)
        for i in range(count):
            e = out[i]
            edge_vertices(m, e, out[count:])
            low, high = min(out[count], out[count + 1]), max(out[count], out[count + 1])
            if min(a, b) == low and max(a, b) == high:
                return int(e)
        return -1

    return edge_between


def splitting(k: Mapping[str, Kernel], operations: Mapping[str, Kernel], measure: Kernel) -> Kernel:
    """Make ``split(m, f, p, plan) -> outcome``: split a face at a point of it, or its edge there.

    Within the tolerance of an edge, the edge is split where the point is nearest to it; within that
    of a vertex nothing is. ``plan.args[1]`` becomes the vertex in any case.
    """
    split_face, split_edge = operations["split_face"], operations["split_edge"]
    edge_between = edge_finding(k)

    @kernel
    def split(m: Any, f: int, p: Array, plan: Plan) -> int:
        tolerance, point, args = plan.tolerance[0], plan.point, plan.args
        if not measure(m, f, p, plan):
            return NOWHERE
        for i in range(3):
            if length(minus(p, plan.xyz[i])) < tolerance:
                args[1] = plan.corners[i]
                return ON_VERTEX
        side = lowest_side(plan)
        for j in range(3):
            point[j] = p[j]
        if plan.heights[side] >= tolerance:
            args[0] = f
            args[1] = split_face(m, args, point, plan.at, plan.out, plan.log, False)
            return IN_FACE
        a, b = plan.corners[side], plan.corners[(side + 1) % 3]
        start = plan.xyz[side]
        along = minus(plan.xyz[(side + 1) % 3], start)
        share = dot(minus(p, start), along) / dot(along, along)
        for j in range(3):
            point[j] = start[j] + share * along[j]
        args[0] = edge_between(m, f, a, b, plan.out)
        args[1] = split_edge(m, args, point, plan.at, plan.out, plan.log, False)
        return ON_EDGE

    return split


def sending(land: Kernel) -> Kernel:
    """Make ``send_out(m, f, plan, toward)``: carry the break points onto the surface, still whole.

    They come from the tangent plane of face f; ``toward`` (3,) is scratch.
    """

    @kernel
    def send_out(m: Any, f: int, plan: Plan, toward: Array) -> None:
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

    return send_out


def breaking(k: Mapping[str, Kernel], operations: Mapping[str, Kernel]) -> Kernel:
    """Make ``break_up(m, plan) -> result``: break the surface around the target (thesis 4.4).

    ``plan.start`` is the face under it. There must be room for everything beforehand. The
    result is negative if there was not.
    """
    measure, across = measuring(k), crossing(k)
    walk, send_out = walking(measure, across), sending(landing(measure, across))
    split = splitting(k, operations, measure)

    @kernel
    def split_near(m: Any, f: int, p: Array, plan: Plan) -> int:
        """Split what lies under a point not far from a face."""
        return split(m, walk(m, f, p, plan), p, plan)

    @kernel
    def break_up(m: Any, plan: Plan) -> int:
        face, toward = plan.start[0], np.zeros(3)
        send_out(m, face, plan, toward)
        if not measure(m, face, plan.target, plan):
            return NEEDS_ROOM
        middles = np.zeros((3, 3))
        for i in range(3):
            for j in range(3):
                plan.point[j] = (plan.xyz[i, j] + plan.xyz[(i + 1) % 3, j]) / 2
                middles[i, j] = plan.point[j]
        split(m, face, plan.target, plan)
        for i in range(3):
            split_near(m, face, middles[i], plan)
        for i in range(len(plan.offsets)):
            if plan.landed_on[i] >= 0:
                plan.outcome[i] = split_near(m, plan.landed_on[i], plan.landed_at[i], plan)
        return ALLOWED

    return break_up
