"""What operations share: what is declared of them, room, counts, and the log of what they touch."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring.kernels import (
    EDGE_END,
    EDGE_GROWTH,
    EDGE_ROOM,
    EDGES,
    FACE_END,
    FACE_ROOM,
    FACES,
    VALENCE,
    VERTEX_END,
    VERTEX_ROOM,
    VERTICES,
    Kernel,
    Kernels,
    kernel,
)
from hem.edit import CREATED, FACE, PARENT


class Operation(NamedTuple):
    """What is asked of an operation, what it may create, and how it is made."""

    make: Callable[[Kernels], Kernel]
    """The operation of one structure, made of its kernels."""

    element: str
    """The kind of its first handle."""

    takes_a_point: bool = False
    names_a_vertex: bool = False
    """Whether its result is the vertex that it is about."""

    growth: tuple[int, int] = (0, 0)
    """How many vertices and faces it may create, at triangles."""

    grows_with_sides: bool = False
    """Whether it creates one face more for every side that a face has beyond three."""

    asks_neighbors: bool = False
    """Whether it asks for the neighbors of both ends of an edge."""


ENTRIES = 12
"""Room in the log per operation at triangles; a collapse takes two per face beside."""

WIDTH = 20
"""Room in ``out`` per neighbor: the neighbors of both ends of an edge, and a table to tell them.

A vertex in k faces has up to 2 k neighbors where fans meet in it, both ends of an edge have 4 k,
and the table is less than four times as large.
"""


@kernel
def log_element(log: Array, end: int, what: int, index: int) -> int:
    """Log what happened to a vertex or a face -> the new end of the log.

    Who logs writes the end to ``log[0]`` once: to read it back each time takes longer.
    """
    log[np.uint64(end + 1)] = (index << 3) | what
    return end + 1


@kernel
def log_faces(log: Array, end: int, what: int, first: int, second: int) -> int:
    """Log what happened to one or two faces, of which -1 is none -> the new end."""
    if first >= 0:
        end = log_element(log, end, FACE + what, first)
    if second >= 0:
        end = log_element(log, end, FACE + what, second)
    return end


@kernel
def log_parts(log: Array, end: int, first: int, count: int, face: int) -> int:
    """Log so many new faces, which were parts of one that there was -> the new end."""
    for i in range(count):
        end = log_element(log, end, FACE + CREATED, first + i)
        end = log_element(log, end, PARENT, face)
    return end


@kernel
def has_room(m: Any, vertices: int, faces: int, log: Array) -> bool:
    """Whether so many new elements and the log of them will fit."""
    counts = m.counts
    return bool(
        counts[VERTEX_END] + vertices <= counts[VERTEX_ROOM]
        and counts[FACE_END] + faces <= counts[FACE_ROOM]
        and counts[EDGE_END] + counts[EDGE_GROWTH] * faces <= counts[EDGE_ROOM]
        and log[0] + ENTRIES < len(log)
    )


@kernel
def has_scratch(m: Any, out: Array, log: Array) -> bool:
    """Whether the answer to any query, and a log of all faces at both ends of an edge, will fit."""
    valence = m.counts[VALENCE] + 1
    return bool(WIDTH * valence <= len(out) and log[0] + 2 * valence + ENTRIES < len(log))


@kernel
def is_point(point: Array) -> bool:
    """Whether a row of three float32 is a position."""
    return bool(np.isfinite(point[0]) and np.isfinite(point[1]) and np.isfinite(point[2]))


@kernel
def count_new(m: Any, edges: int, faces: int) -> None:
    """Count new edges and faces."""
    m.counts[EDGES] += edges
    m.counts[FACES] += faces
    m.counts[FACE_END] += faces


@cache
def vertex_maker(set_point: Kernel) -> Kernel:
    """Make ``new_vertex(m, point) -> v``, which appends a vertex. No duplicate is searched for."""

    @kernel
    def new_vertex(m: Any, point: Array) -> int:
        v = m.counts[VERTEX_END]
        set_point(m, v, point)
        m.counts[VERTEX_END] += 1
        m.counts[VERTICES] += 1
        return int(v)

    return new_vertex
