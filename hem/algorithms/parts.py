"""What algorithms share: operations done inside compiled code, positions, what they refuse."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring import NEEDS_ROOM, Kernel, Kernels, Refusal, kernel, part
from hem.contract import Algorithm, Structure
from hem.edit import CHANGED, VERTEX
from hem.errors import MeshError

STEP = 4096
"""Operations per call of compiled code; between two calls an interrupt gets through."""


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


def work_of(s: Structure, *scratch: Any) -> Work:
    """Scratch for a structure; where it is interpreted, of Python's own numbers.

    True and True are 2 then, as they are when compiled.
    """
    return Work(*(it if s.compiled else memoryview(it) for it in scratch))


def change(s: Structure, kind: str, make: Algorithm, plan: Any, splits: int = 0) -> int:
    """Run an algorithm that operates, in steps, until it is done -> its result. One edit.

    ``plan.work`` is put in. The algorithm answers ``NEEDS_ROOM`` as soon as an operation does, and
    goes on where it was, by its plan, when it is called again. There is room for so many ``splits``
    from the start. Where corners have attributes every operation is an edit of its own, so that no
    seam is torn. An interrupt leaves what was done so far and told.
    """
    one_by_one = any(it.element == "corner" for it in s.attributes())
    logs: list[Array] = []
    room, operations = splits, min(splits or STEP, STEP)
    try:
        while True:
            before = None if s.compiled else s.snapshot()
            out, log = s.scratch(room, operations)
            logs.append(log)
            left = np.array([1 if one_by_one else operations])
            scratch = np.full(3, -1), np.zeros(3, np.float32), np.zeros(6, np.int64)
            try:
                result = s.run(make, plan._replace(work=work_of(s, *scratch, out, log, left)))
            except BaseException:
                if before is not None:  # Python may stop in the midst of an operation
                    log[0] = 0
                    s.restore(before)
                raise
            if result != NEEDS_ROOM:
                return result
            room = min(max(splits, 1), STEP) if splits else 0
            operations = operations if log[0] else 2 * operations
            if one_by_one or not s.followed:
                tell(s, kind, logs)
    finally:
        tell(s, kind, logs)


def tell(s: Structure, kind: str, logs: list[Array]) -> None:
    """Tell followers of one edit by its logs, which are emptied."""
    touched = np.concatenate([np.zeros(0, np.int64), *(log[1 : log[0] + 1] for log in logs)])
    logs.clear()
    if len(touched):
        s.tell(kind, touched)


@cache
def locating(coordinate: Kernel) -> Kernel:
    """Make ``where(m, v) -> x, y, z``, in float64 on every structure."""

    @kernel
    def where(m: Any, v: int) -> tuple[float, float, float]:
        x, y, z = coordinate(m, v, 0), coordinate(m, v, 1), coordinate(m, v, 2)
        return np.float64(x), np.float64(y), np.float64(z)

    return where


@kernel
def plus(total: float, rest: float, x: float) -> tuple[float, float]:
    """Add x to a sum and what rounding has cost it so far -> both (Neumaier's summation).

    Both together are exact for numbers of float32, so a sum does not depend on the order in which a
    structure tells the neighbors.
    """
    added = np.float64(x)
    more = total + added
    taken = more - total
    return more, rest + ((total - (more - taken)) + (added - taken))


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


def side_keys(s: Structure) -> tuple[Array, Array]:
    """The edges as ``smaller end << 32 | larger end``, ascending, and how many faces each has.

    The same on every structure. Cost O(n_t log n_t).
    """
    a = s.triangles().astype(np.int64)
    b = np.roll(a, -1, axis=1)
    keys = np.sort(np.minimum(a, b) << 32 | np.maximum(a, b), axis=None)
    first = np.flatnonzero(np.append(True, keys[1:] != keys[:-1])[: len(keys)])
    return keys[first], np.diff(np.append(first, len(keys)))


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
    wrong = ~np.isfinite(places[vertices]).all(axis=1)
    if wrong.any():
        raise MeshError(f"{kind}: {Refusal.NOT_FINITE.words}", vertices=vertices[wrong])
    try:
        s.run(placing, Placing(vertices, places))
    finally:
        s.tell(kind, vertices.astype(np.int64) << 3 | VERTEX + CHANGED)


def require_mesh(s: Any, called: str) -> None:
    """Raise MeshError for what is no structure, or holds larger faces than triangles."""
    if not isinstance(s, Structure):
        raise MeshError(
            f"{called} takes a structure, such as structures.build('half_edge', mesh), "
            f"not {type(s).__name__}"
        )
    if s.most_corners > 3:
        faces = s.faces()
        larger = faces[s.face_vertices(faces).counts > 3]
        if len(larger):
            raise MeshError(
                f"{called} takes triangles only; build one of to_triangles() or triangulated()",
                faces=larger,
            )


def require_count(called: str, name: str, value: Any, least: int = 0) -> int:
    """The value, if it is an integer of at least so much; else MeshError."""
    if isinstance(value, int | np.integer) and not isinstance(value, bool) and value >= least:
        return int(value)
    raise MeshError(f"{called} takes {name} as an integer from {least} on, not {value!r}")
