"""What algorithms share: operations inside compiled code, positions, sums, the order of edges."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array, Handles, Points
from hem.authoring import (
    FACE_END,
    FACES,
    NEEDS_ROOM,
    OPERATIONS,
    VALENCE,
    VERTEX_END,
    VERTICES,
    Kernel,
    Kernels,
    Refusal,
    Sum,
    kernel,
    live_vertex,
    sums,
    visiting,
)
from hem.contract import Algorithm, Structure
from hem.edit import CHANGED, VERTEX
from hem.engine import kept
from hem.errors import MeshError

STEP = 16_384
"""The most operations per call of compiled code; between two calls an interrupt gets through."""

GAPS = 701, 301, 132, 57, 23, 10, 4, 1
"""Of the sort of a few values (Ciura, Best Increments for the Average Case of Shellsort, 2001)."""

GROUP = 256
"""Faces or vertices that are looked up before anything is calculated of what was found.

A calculation waits in the processor for its numbers. Where memory is slow there soon is no room for
the loads that come after it: with 1,000,000 vertices, normals took twice the time.
"""

MADE = [VERTICES, VERTEX_END, FACES, FACE_END]
"""Of the counts: what differs once anything was made or removed. To ask changes none of them."""

AT_ONCE = 8
"""Calls that the same scratch serves: no operation adds more than 2 to a valence, of WIDTH."""


class Work(NamedTuple):
    """What operations are done with, a part of the plan of an algorithm that does some."""

    args: Any  # (3,) int64: the handles
    point: Any  # (3,) float32
    at: Any  # (6,) int64: the diamond of an edge
    out: Any  # scratch for queries
    log: Any  # what was touched, by the last operation alone where nobody follows
    left: Any  # (1,) int64: how many more operations may be done before others are told
    forgets: Any  # (1,) int64: whether nobody follows


NO_WORK = Work(*(np.zeros(n, np.int64) for n in (3, 3, 6, 0, 0, 0, 0)))
"""Stands in a plan until ``change`` puts something there."""


@cache
def doing(operation: Kernel) -> Kernel:
    """Make ``do(m, first, second, work) -> result`` of an operation, with its point in ``work``.

    The result is that of the operation: at least 0, ``NEEDS_ROOM`` or a ``Refusal``.
    """

    @kernel
    def do(m: Any, first: int, second: int, work: Work) -> int:
        if work.left[0] == 0:
            return NEEDS_ROOM
        if work.forgets[0]:
            work.log[0] = 0
        work.args[0], work.args[1], work.args[2] = first, second, -1
        result = operation(m, work.args, work.point, work.at, work.out, work.log, False)
        if result >= 0:
            work.left[0] -= 1
        return int(result)

    return do


def change(
    s: Structure, kind: str, make: Algorithm, plan: Any, splits: int = 0, valence: int | None = None
) -> int:
    """Run an algorithm that operates, in steps, until it is done -> its result. One edit.

    ``plan.work`` is put in. The algorithm answers ``NEEDS_ROOM`` as soon as an operation does, and
    goes on by its plan when it is called again. There is room for so many ``splits``; MeshError if
    it wants more. ``valence``: as ``Structure.scratch`` has it. Every operation is an edit of its
    own where ``told_one_by_one`` says so. An interrupt leaves what was done so far, and told.
    """
    operations = min(splits or STEP, s.n_faces + 64, STEP)
    logs: list[Array] = []  # copies but for the last, as the log is written over
    result, steps, idle = NEEDS_ROOM, 0, 0
    out, log = s.scratch(splits, operations, valence)
    try:
        while result == NEEDS_ROOM:
            if idle > 1 and operations > s.n_faces:  # more scratch was no help
                raise MeshError(f"{kind}: there is room for {splits} splits, and more are done")
            if steps == AT_ONCE:
                steps, (out, log) = 0, s.scratch(0, operations, valence)
            log[0] = 0
            logs.append(log)  # itself, as an interrupt may come before it is copied
            result = step(s, make, plan, out, log, 1 if s.told_one_by_one else operations)
            logs[-1] = log[: log[0] + 1].copy()
            steps, idle = steps + 1, 0 if log[0] else idle + 1
            if idle:  # there was not enough for one operation
                operations, steps = 2 * operations, AT_ONCE
            if s.told_one_by_one:
                tell(s, kind, logs)
    finally:
        try:
            s.scratch(0, 0, valence)
            tell(s, kind, logs)
        except BaseException:  # an interrupt, say, before anybody was told
            tell(s, kind, logs)
            raise
    return result


def most_faces_at_a_vertex(s: Structure) -> int:
    """A bound on them. O(1), or O(n_t) if nobody has counted them yet."""
    s.scratch(0)
    return int(s.records.counts[VALENCE])


def step(s: Structure, make: Algorithm, plan: Any, out: Any, log: Any, left: int) -> int:
    """Run an algorithm for so many operations -> its result. What is interrupted is not done."""
    before = None if s.compiled else s.snapshot()
    args, point, at = np.full(3, -1), np.zeros(3, np.float32), np.zeros(6, np.int64)
    count, forgets = np.array([left]), np.array([int(not s.followed)])
    own: tuple[Any, ...] = args, point, at, out, log, count, forgets
    # True and True are 2 to Python's own numbers, as they are to compiled code.
    work = Work(*(it if s.compiled else memoryview(it) for it in own))
    try:
        return s.run(make, plan._replace(work=work))
    except BaseException:
        if before is not None:  # Python may stop in the midst of an operation
            log[0] = 0
            s.restore(before)
        raise


def tell(s: Structure, kind: str, logs: list[Array]) -> None:
    """Tell followers of one edit by its logs, which are forgotten as soon as anybody is told.

    MeshError if one of them edits: a plan would name what is gone. What was done stays, and whole.
    """
    held = [*logs]  # freed when all are told, as that takes time to be interrupted in
    touched = np.concatenate([np.zeros(0, np.int64), *(it[1 : it[0] + 1] for it in held)])
    before = s.records.counts[MADE].tolist()
    logs.clear()
    if len(touched):
        s.tell(kind, touched)
        if s.records.counts[MADE].tolist() != before:
            raise MeshError(f"{kind}: a subscriber edited the mesh meanwhile")


@cache
def locating(coordinate: Kernel) -> Kernel:
    """Make ``where(m, v) -> x, y, z``, in float64 on every structure."""

    @kernel
    def where(m: Any, v: int) -> tuple[float, float, float]:
        x, y, z = coordinate(m, v, 0), coordinate(m, v, 1), coordinate(m, v, 2)
        return np.float64(x), np.float64(y), np.float64(z)

    return where


@kernel
def none_is_dead(m: Any) -> bool:
    """Whether all vertices live.

    Who writes positions asks before, and once: the compiler cannot know that these change nothing
    of it, and would write one at a time.
    """
    return bool(m.counts[VERTICES] == m.counts[VERTEX_END])


def living_vertex(k: Kernels) -> Kernel:
    """Make ``lives(m, v) -> bool``, for the vertices before the end."""
    return _living(live_vertex(k["coordinate"]), VERTICES, VERTEX_END)


def living_face(k: Kernels) -> Kernel:
    """Make ``lives(m, f) -> bool``, for the faces before the end."""
    return _living(k["face_exists"], FACES, FACE_END)


@cache
def _living(exists: Kernel, alive: int, end: int) -> Kernel:
    """None is looked at where none is dead."""

    @kernel
    def lives(m: Any, it: int) -> bool:
        return bool(m.counts[alive] == m.counts[end] or exists(m, it))

    return lives


@kernel
def cross(u: Any, v: Any) -> tuple[float, float, float]:
    """The vector product."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@kernel
def dot(u: Any, v: Any) -> float:
    """The scalar product."""
    return float(u[0] * v[0] + u[1] * v[1] + u[2] * v[2])


@kernel
def unit(x: float, y: float, z: float) -> tuple[float, float, float]:
    """The vector of length 1 in that direction; 0 stays 0."""
    size = np.sqrt(x * x + y * y + z * z)
    return (x / size, y / size, z / size) if size > 0 else (0.0, 0.0, 0.0)


@cache
def adding(position: Kernel) -> Kernel:
    """Make ``add(m, it, total, plan) -> total`` to visit with, of ``position(m, it, plan)``.

    A structure tells the neighbors in an order of its own, and float64 sums of float32 are exact in
    any, where the largest is below 2²⁶ times the smallest. Else one of some 10⁸ may differ by the
    last bit as float32. See ``hem.authoring.sums``.
    """

    @kernel
    def add(m: Any, it: int, total: Sum, plan: Any) -> Sum:
        return sums.plus(total, position(m, it, plan))

    return add


@cache
def of_vertices(position: Kernel) -> Kernel:
    """Make ``place(m, v, plan) -> position``, whatever the plan."""

    @kernel
    def place(m: Any, v: int, plan: Any) -> Sum:
        return position(m, v)

    return place


@kernel
def next_of_three(m: Any, it: int, known: Any, plan: Any) -> tuple[Any, Any, Any]:
    """Visit the corners or the edges of a triangle for all three of them."""
    return known[1], known[2], np.int64(it)


@cache
def cornering(face_vertices: Kernel) -> Kernel:
    """Make ``corners(m, f, plan) -> a, b, c``, or of ``face_edges`` ab, bc, ca.

    The plan has scratch, ``out``.
    """
    visit_all = visiting(face_vertices, next_of_three)

    @kernel
    def corners(m: Any, f: int, plan: Any) -> tuple[int, int, int]:
        found: tuple[int, int, int] = visit_all(m, f, (-1, -1, -1), plan)
        return found

    return corners


def gathering(k: Kernels) -> Kernel:
    """Make ``gather(m, begin, plan) -> count``, of the living among the next ``GROUP`` faces.

    ``plan.group`` (GROUP, 4) int64 gets each with its corners. The plan has scratch, ``out``.
    """
    lives, corners = living_face(k), cornering(k["face_vertices"])

    @kernel
    def gather(m: Any, begin: int, plan: Any) -> int:
        group, count = plan.group, 0
        for f in range(begin, min(begin + GROUP, m.counts[FACE_END])):
            if lives(m, f):
                a, b, c = corners(m, f, plan)
                group[count, 0], group[count, 1], group[count, 2], group[count, 3] = f, a, b, c
                count += 1
        return count

    return gather


def new_group() -> Array:
    """(GROUP, 4) int64: room for what is gathered."""
    return np.zeros((GROUP, 4), np.int64)


@kernel
def known_to_be_apart(m: Any, a: int, b: int) -> bool:
    """Stands for ``are_joined`` where an algorithm knows that vertices are not."""
    return False


@cache
def turning(is_turned: Kernel) -> Algorithm:
    """Make an algorithm that flips in every face the first edge that ``is_turned(plan, a, b)``.

    The plan has ``next``: (1,) int64, the next face. One that was reached from the other side of
    its edge has none to turn any more. What comes to be joined must not be joined already: nobody
    looks, which would take longer than all the rest.
    """

    def turning_in_faces(k: Kernels, operations: Kernels) -> Kernel:
        corners, sides = cornering(k["face_vertices"]), cornering(k["face_edges"])
        lives = living_face(k)
        flip_edge = doing(OPERATIONS["flip_edge"].make({**k, "are_joined": known_to_be_apart}))

        @kernel
        def turn(m: Any, plan: Any) -> int:
            while plan.next[0] < m.counts[FACE_END]:
                f = plan.next[0]
                if lives(m, f):
                    a, b, c = corners(m, f, plan.work)
                    if is_turned(plan, a, b) or is_turned(plan, b, c) or is_turned(plan, c, a):
                        ab, bc, ca = sides(m, f, plan.work)
                        edge = ca
                        if is_turned(plan, a, b):
                            edge = ab
                        elif is_turned(plan, b, c):
                            edge = bc
                        if flip_edge(m, edge, -1, plan.work) == NEEDS_ROOM:
                            return NEEDS_ROOM
                plan.next[0] += 1
            return 0

        return turn

    return turning_in_faces


def side_keys(s: Structure) -> tuple[Array, Array]:
    """The edges as ``smaller end << 32 | larger end``, ascending, and how many faces each has.

    The same on every structure. Cost O(n_v + n_t) for bounded valence.
    """
    edges, faces, _ = sides_of(s.triangles(), len(s.points))
    return edges[:, 0].astype(np.int64) << 32 | edges[:, 1], faces


@kept
def sides_of(triangles: Array, n: int) -> tuple[Array, Array, Array]:
    """The edges (k, 2) int32, the smaller end first, ascending, and how many faces each has.

    And (n_t, 3) whether side i of a triangle, from its corner i, is alone.
    """
    end = np.zeros(n + 1, np.int64)  # of the sides of which a vertex is the smaller end
    for f in range(len(triangles)):
        for i in range(3):
            end[min(triangles[f, i], triangles[f, (i + 1) % 3]) + 1] += 1
    for v in range(n):
        end[v + 1] += end[v]
    larger, side = np.empty(end[n], np.int32), np.empty(end[n], np.int32)
    for f in range(len(triangles)):
        for i in range(3):
            a, b = triangles[f, i], triangles[f, (i + 1) % 3]
            place = end[min(a, b)]
            larger[place], side[place] = max(a, b), 3 * f + i
            end[min(a, b)] += 1
    edges, faces = np.empty((len(larger), 2), np.int32), np.empty(len(larger), np.int32)
    alone, count, begin = np.zeros(len(larger), np.bool_), 0, 0
    for v in range(n):
        put_in_order(larger[begin : end[v]], side[begin : end[v]])
        while begin < end[v]:
            first = begin
            while begin < end[v] and larger[begin] == larger[first]:
                begin += 1
            edges[count, 0], edges[count, 1], faces[count] = v, larger[first], begin - first
            alone[side[first]] = begin - first == 1
            count += 1
    return edges[:count], faces[:count], alone.reshape(-1, 3)


@kernel
def put_in_order(values: Array, beside: Array) -> None:
    """Sort some values in place, ascending, and what stands beside them with them.

    Most often they are a few; of n it takes some n^1.3 steps (Shell, with Ciura's gaps).
    """
    for gap in GAPS:
        for i in range(gap, len(values)):
            value, other, place = values[i], beside[i], i
            while place >= gap and values[place - gap] > value:
                values[place], beside[place] = values[place - gap], beside[place - gap]
                place -= gap
            values[place], beside[place] = value, other


@kept
def from_smallest(triangles: Array) -> Array:
    """(n, 3): the corners of each from the smallest on, as on every structure."""
    turned = np.empty_like(triangles)
    for f in range(len(triangles)):
        first = 0
        for i in range(1, 3):
            if triangles[f, i] < triangles[f, first]:
                first = i
        for i in range(3):
            turned[f, i] = triangles[f, (first + i) % 3]
    return turned


class Placing(NamedTuple):
    """Where vertices are moved to."""

    places: Points  # (k, 3) float32: a row for every vertex before some


def placing(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``place(m, plan) -> 0``."""
    lives, set_point = live_vertex(k["coordinate"]), k["set_point"]

    @kernel
    def place(m: Any, plan: Placing) -> int:
        all_live = none_is_dead(m)
        for v in range(len(plan.places)):
            if all_live or lives(m, v):
                set_point(m, v, plan.places[v])
        return 0

    return place


def move(s: Structure, kind: str, places: Points, told: Array | None = None) -> None:
    """Move vertices to their rows of ``places``, which are finite. One edit.

    Those beyond the last row stay. ``told``: which are said to be moved, all of them for None.
    """
    try:
        s.run(placing, Placing(places))
    finally:
        if s.followed:
            tell_moved(s, kind, _placed(s, places) if told is None else told)


def _placed(s: Structure, places: Points) -> Handles:
    """The vertices that have a row there."""
    vertices = s.vertices()
    return vertices[: np.searchsorted(vertices, len(places))]


def not_finite(s: Structure, kind: str, places: Points) -> MeshError:
    """The error for vertices whose row of ``places`` is no position."""
    wrong = _placed(s, places)
    wrong = wrong[~np.isfinite(places[wrong]).all(axis=1)]
    return MeshError(f"{kind}: {Refusal.NOT_FINITE.words}", vertices=wrong)


def tell_moved(s: Structure, kind: str, vertices: Array) -> None:
    """Tell followers of one edit that moved vertices."""
    s.tell(kind, vertices.astype(np.int64) << 3 | VERTEX + CHANGED)
