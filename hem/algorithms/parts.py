"""What algorithms share: operations inside compiled code, positions, sums, the order of edges."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring import (
    FACE_END,
    NEEDS_ROOM,
    VALENCE,
    Kernel,
    Kernels,
    Refusal,
    kernel,
    part,
    visiting,
)
from hem.contract import Algorithm, Structure
from hem.edit import CHANGED, VERTEX
from hem.errors import MeshError

STEP = 16_384
"""The most operations per call of compiled code; between two calls an interrupt gets through."""

AT_ONCE = 8
"""Calls that the same scratch serves: no operation adds more than 2 to a valence, of WIDTH."""


class Work(NamedTuple):
    """What operations are done with, a part of the plan of an algorithm that does some."""

    args: Any  # (3,) int64: the handles
    point: Any  # (3,) float32
    at: Any  # (6,) int64: the diamond of an edge
    out: Any  # scratch for queries
    log: Any  # what was touched
    left: Any  # (1,) int64: how many more operations may be done before others are told


NO_WORK = Work(*(np.zeros(n, np.int64) for n in (3, 3, 6, 0, 0, 0)))
"""Stands in a plan until ``change`` puts something there."""


@cache
def doing(operation: Kernel) -> Kernel:
    """Make ``do(m, first, second, work) -> result`` of an operation, with its point in ``work``.

    The result is that of the operation: at least 0, ``NEEDS_ROOM`` or a ``Refusal``.
    """

    @part
    def do(m: Any, first: int, second: int, work: Work) -> int:
        if work.left[0] == 0:
            return NEEDS_ROOM
        work.args[0], work.args[1], work.args[2] = first, second, -1
        result = operation(m, work.args, work.point, work.at, work.out, work.log, False)
        if result >= 0:
            work.left[0] -= 1
        return int(result)

    return do


def change(
    s: Structure,
    kind: str,
    make: Algorithm,
    plan: Any,
    splits: int = 0,
    valence: int | None = None,
) -> int:
    """Run an algorithm that operates, in steps, until it is done -> its result. One edit.

    ``plan.work`` is put in. The algorithm answers ``NEEDS_ROOM`` as soon as an operation does, and
    goes on by its plan when it is called again. There is room for so many ``splits``; MeshError if
    it wants more. ``valence``: as ``Structure.scratch`` has it. Every operation is an edit of its
    own where ``told_one_by_one`` says so. An interrupt leaves what was done so far, and told.
    """
    operations = min(splits or STEP, s.n_faces + 64, STEP)
    logs: list[Array] = []  # copies, as the log is written over
    result, steps, idle = NEEDS_ROOM, 0, 0
    out, log = s.scratch(splits, operations, valence)
    try:
        while result == NEEDS_ROOM:
            if idle == 2:  # more scratch was no help
                raise MeshError(f"{kind}: there is room for {splits} splits, and more are done")
            if steps == AT_ONCE:
                steps, (out, log) = 0, s.scratch(0, operations, valence)
            try:
                result = step(s, make, plan, out, log, 1 if s.told_one_by_one else operations)
            finally:
                if s.followed:
                    logs.append(log[1 : log[0] + 1].copy())
            steps, idle = steps + 1, 0 if log[0] else idle + 1
            if idle:  # there was not enough for one operation
                operations, steps = 2 * operations, AT_ONCE
            if s.told_one_by_one:
                tell(s, kind, logs)
    finally:
        s.scratch(0, 0, valence)
        tell(s, kind, logs)
    return result


def most_faces_at_a_vertex(s: Structure) -> int:
    """A bound on them. O(1), or O(n_t) if nobody has counted them yet."""
    s.scratch(0)
    return int(s.records.counts[VALENCE])


def step(s: Structure, make: Algorithm, plan: Any, out: Any, log: Array, left: int) -> int:
    """Run an algorithm for so many operations -> its result. What is interrupted is not done."""
    before = None if s.compiled else s.snapshot()
    args, point, at = np.full(3, -1), np.zeros(3, np.float32), np.zeros(6, np.int64)
    own: tuple[Any, ...] = args, point, at, out, log, np.array([left])
    # True and True are 2 to Python's own numbers, as they are to compiled code.
    work = Work(*(it if s.compiled else memoryview(it) for it in own))
    log[0] = 0
    try:
        return s.run(make, plan._replace(work=work))
    except BaseException:
        if before is not None:  # Python may stop in the midst of an operation
            log[0] = 0
            s.restore(before)
        raise


def tell(s: Structure, kind: str, logs: list[Array]) -> None:
    """Tell followers of one edit by its logs, which are forgotten."""
    touched = np.concatenate([np.zeros(0, np.int64), *logs])
    logs.clear()
    if len(touched):
        s.tell(kind, touched)


@cache
def locating(coordinate: Kernel) -> Kernel:
    """Make ``where(m, v) -> x, y, z``, in float64 on every structure.

    What is asked of one plan may be handed in besides, see ``adding``.
    """

    @kernel
    def where(m: Any, v: int, plan: Any = None) -> tuple[float, float, float]:
        x, y, z = coordinate(m, v, 0), coordinate(m, v, 1), coordinate(m, v, 2)
        return np.float64(x), np.float64(y), np.float64(z)

    return where


@kernel
def cross(u: Any, v: Any) -> tuple[float, float, float]:
    """The vector product."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@kernel
def unit(x: float, y: float, z: float) -> tuple[float, float, float]:
    """The vector of length 1 in that direction; 0 stays 0."""
    size = np.sqrt(x * x + y * y + z * z)
    return (x / size, y / size, z / size) if size > 0 else (0.0, 0.0, 0.0)


@cache
def adding(read: Kernel) -> Kernel:
    """Make ``add(m, it, sums, plan) -> sums`` to visit with: ``read(m, it, plan) -> x, y, z``.

    The sums are how many there are, and theirs of x, y and z in float64. A structure tells the
    neighbors in an order of its own, and sums of float32 are exact in any, where the largest is
    below 2²⁶ times the smallest. Else one of some 10⁸ may differ by the last bit as float32.
    """

    @kernel
    def add(m: Any, it: int, sums: Any, plan: Any) -> Any:
        x, y, z = read(m, it, plan)
        n, a, b, c = sums
        return n + 1, a + x, b + y, c + z

    return add


NOTHING = 0, 0.0, 0.0, 0.0
"""Sums to begin with."""


@kernel
def next_corner(m: Any, v: int, corners: Any, plan: Any) -> tuple[Any, Any, Any]:
    """Visit the corners of a triangle for all three of them."""
    return corners[1], corners[2], np.int64(v)


@cache
def cornering(face_vertices: Kernel) -> Kernel:
    """Make ``corners(m, f, plan) -> a, b, c``. The plan has scratch, ``out``."""
    visit_all = visiting(face_vertices, next_corner)

    @kernel
    def corners(m: Any, f: int, plan: Any) -> tuple[int, int, int]:
        found: tuple[int, int, int] = visit_all(m, f, (-1, -1, -1), plan)
        return found

    return corners


class Counted(NamedTuple):
    """Whose corners are counted, and where."""

    faces: Array
    faces_at: Array
    out: Any


def counting_corners(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``count_corners(m, plan) -> 0``."""
    corners = cornering(k["face_vertices"])

    @kernel
    def count_corners(m: Any, plan: Counted) -> int:
        for i in range(len(plan.faces)):
            for v in corners(m, plan.faces[i], plan):
                plan.faces_at[v] += 1
        return 0

    return count_corners


def count_faces_at(s: Structure) -> Array:
    """(n,) int32: how many faces each vertex is a corner of. Cost: ``face_vertices`` of all."""
    faces_at = np.zeros(len(s.points), np.int32)
    s.run(counting_corners, Counted(s.faces(), faces_at, s.scratch(0)[0]))
    return faces_at


@cache
def finding_edge(vertex_edges: Kernel, edge_vertices: Kernel) -> Kernel:
    """Make ``edge_between(m, a, b, work) -> edge``, or -1. Cost: ``vertex_edges`` of a.

    Edges are named by their ends and looked up when they are needed: an operation beside them may
    give them another handle.
    """

    @part
    def edge_between(m: Any, a: int, b: int, work: Work) -> int:
        for i in range(vertex_edges(m, a, work.out)):
            edge_vertices(m, work.out[i], work.at)
            if work.at[0] == b or work.at[1] == b:
                return int(work.out[i])
        return -1

    return edge_between


@cache
def turning(is_turned: Kernel) -> Algorithm:
    """Make an algorithm that flips in every face the first edge that ``is_turned(plan, a, b)``.

    The plan has ``next``: (1,) int64, the next face. One that was reached from the other side of
    its edge has none to turn any more.
    """

    def turning_in_faces(k: Kernels, operations: Kernels) -> Kernel:
        face_exists, face_edges = k["face_exists"], k["face_edges"]
        edge_vertices, flip_edge = k["edge_vertices"], doing(operations["flip_edge"])

        @kernel
        def turn(m: Any, plan: Any) -> int:
            out, at = plan.work.out, plan.work.at
            while plan.next[0] < m.counts[FACE_END]:
                f = plan.next[0]
                for i in range(face_edges(m, f, out) if face_exists(m, f) else 0):
                    edge_vertices(m, out[i], at)
                    if is_turned(plan, at[0], at[1]):
                        if flip_edge(m, out[i], -1, plan.work) == NEEDS_ROOM:
                            return NEEDS_ROOM
                        break
                plan.next[0] += 1
            return 0

        return turn

    return turning_in_faces


def side_keys(s: Structure) -> tuple[Array, Array]:
    """The edges as ``smaller end << 32 | larger end``, ascending, and how many faces each has.

    The same on every structure. Cost O(n_t log n_t).
    """
    a = s.triangles().astype(np.int64)
    b = np.roll(a, -1, axis=1)
    keys = np.sort(np.minimum(a, b) << 32 | np.maximum(a, b), axis=None)
    first = np.flatnonzero(np.append(True, keys[1:] != keys[:-1])[: len(keys)])
    return keys[first], np.diff(np.append(first, len(keys)))


def from_smallest(triangles: Array) -> Array:
    """(n, 3) int64: the corners of each from the smallest on, as on every structure."""
    turned = (triangles.argmin(axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles, turned, axis=1).astype(np.int64)


class Placing(NamedTuple):
    """Which vertices are moved, and where to."""

    vertices: Array
    places: Array  # (n, 3) float32: a row for every handle


def placing(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``place(m, plan) -> 0``."""
    set_point = k["set_point"]

    @kernel
    def place(m: Any, plan: Placing) -> int:
        for i in range(len(plan.vertices)):
            set_point(m, plan.vertices[i], plan.places[plan.vertices[i]])
        return 0

    return place


def move(s: Structure, kind: str, vertices: Array, places: Array) -> None:
    """Move vertices to their rows of ``places``: all, or none if one is not finite. One edit."""
    if not np.isfinite(places).all():
        wrong = ~np.isfinite(places[vertices]).all(axis=1)
        if wrong.any():
            raise MeshError(f"{kind}: {Refusal.NOT_FINITE.words}", vertices=vertices[wrong])
    try:
        s.run(placing, Placing(vertices, places))
    finally:
        if s.followed:
            s.tell(kind, vertices.astype(np.int64) << 3 | VERTEX + CHANGED)
