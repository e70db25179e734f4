"""The operations, compiled: what every structure does alike around its own surgery.

An operation checks the rules, sees to it that there is room, has the structure change its records,
counts, and logs what it touched. All structures number new elements alike, because it is told here
which index is whose::

    split_edge      c                  c        Vertex v is new. The face at a, the smaller end,
                  ╱   ╲              ╱ │ ╲      keeps its index; the one at b is new, the left
                 a─────b    ──▶     a──v──b     one before the right one. The record of the
                  ╲   ╱              ╲ │ ╱      edge stays with a and v.
                    d                  d

    split_face      c                  c        a is the smallest corner. The face keeps its
                  ╱   ╲              ╱ │ ╲      index at (a, b, v); (b, c, v) and (c, a, v)
                ╱       ╲          ╱   v   ╲    are new, in this order.
               a─────────b        a ──╱─╲── b

    collapse_edge   c                  c        keep is b: a and both faces are gone. The edges
                  ╱   ╲                │        that b had keep their records.
             ── a───────b ──  ──▶  ── ─b─ ──
                  ╲   ╱                │
                    d                  d

    flip_edge       c                  c        The face at the smaller of c and d becomes the
                  ╱   ╲              ╱ │ ╲      one at a, so that a second flip undoes the
                 a─────b    ──▶     a  │  b     first, indices and all.
                  ╲   ╱              ╲ │ ╱
                    d                  d

What a structure gives for it, beside its queries and the readings that
``hem.authoring.topology`` names:

- ``cut_edge(m, e, at, v, f)``, the diamond in ``at``, the first new face in ``f``;
- ``cut_face(m, face, v, f)``;
- ``contract(m, e, at, drop, keep, around, out)``, the first ``around`` elements of ``out``
  being the faces at ``drop``, and the rest of it free;
- ``turn(m, e, at, one, other)``, the faces that get (a, d, c) and (b, c, d);
- ``attach(m, corners, f)`` and ``detach(m, f)``;
- ``place(m, v, point)``, ``bury(m, v)`` and ``isolate(m, v)`` for one without
  faces; ``sides(m, f)``, the number of a face's corners.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from hem.authoring.kernels import (
    EDGE_END,
    EDGE_GROWTH,
    EDGE_ROOM,
    EDGES,
    FACE_END,
    FACE_ROOM,
    FACES,
    SIDES,
    VALENCE,
    VERTEX_END,
    VERTEX_ROOM,
    VERTICES,
    Array,
    Kernel,
    kernel,
    named,
)
from hem.authoring.topology import (
    ALLOWED,
    LEFT,
    NEEDS_ROOM,
    NO_FACE,
    NO_VERTEX,
    NOT_AN_END,
    NOT_FINITE,
    RIGHT,
    A,
    B,
    C,
    D,
    rules,
)
from hem.edit import CHANGED, CREATED, FACE, REMOVED, VERTEX


class Operation(NamedTuple):
    """What is asked of an operation, and what it may create."""

    element: str
    """The kind of its first handle."""

    takes_a_point: bool = False
    names_a_vertex: bool = False
    """Whether its result is the vertex that it is about."""

    growth: tuple[int, int] = (0, 0)
    """How many vertices and faces it may create, at triangles."""

    grows_with_sides: bool = False
    """Whether it creates one face more for every side that a face has beyond three."""


OPERATIONS = {
    "split_edge": Operation("edge", True, True, (1, 2)),
    "split_face": Operation("face", True, True, (1, 2), grows_with_sides=True),
    "collapse_edge": Operation("edge", names_a_vertex=True),
    "flip_edge": Operation("edge"),
    "add_face": Operation("vertex", growth=(0, 1)),
    "remove_face": Operation("face"),
    "move_vertex": Operation("vertex", True, True),
    "add_vertex": Operation("vertex", True, True, (1, 0)),
}
"""Every operation that is compiled, by name."""

ENTRIES = 8
"""Room in the log per operation; only a collapse may take more, two per face and these."""

WIDTH = 20
"""Room in ``out`` per neighbor: the neighbors of both ends of an edge, and a table to tell them.

A vertex in k faces has up to 2 k neighbors where fans meet in it, both ends of an edge have 4 k,
and the table is less than four times as large.
"""


@kernel
def note(log: Array, what: int, index: int) -> None:
    """Log what happened to a vertex or a face."""
    log[0] += 1
    log[log[0]] = (index << 3) | what


@kernel
def note_faces(log: Array, what: int, first: int, second: int) -> None:
    """Log what happened to one or two faces; -1 is none."""
    if first >= 0:
        note(log, FACE + what, first)
    if second >= 0:
        note(log, FACE + what, second)


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
def add_faces(m: Any, edges: int, faces: int) -> None:
    """Count new edges and faces."""
    m.counts[EDGES] += edges
    m.counts[FACES] += faces
    m.counts[FACE_END] += faces


def appending(place: Kernel) -> Kernel:
    """Make ``new_vertex(m, point) -> v``, which appends a vertex. No duplicate is searched for."""

    def new_vertex(m: Any, point: Array) -> int:
        v = m.counts[VERTEX_END]
        place(m, v, point)
        m.counts[VERTEX_END] += 1
        m.counts[VERTICES] += 1
        return int(v)

    compiled: Kernel = kernel(new_vertex)
    return compiled


def operations(k: Mapping[str, Kernel]) -> dict[str, Kernel]:
    """The operations of one structure by name: ``(m, args, point, at, out, log, dry) -> result``.

    ``args`` are the handles, ``point`` (3,) is a position where one is asked for, ``at`` (6,) and
    ``out`` are scratch. ``dry`` only checks. The result is the vertex that the operation is about,
    or the new face, else 0; or the negative code of a refusal, or ``NEEDS_ROOM``, and then nothing
    was changed.
    """
    rule = rules(k)
    triangle_edge, live_vertex = rule.triangle_edge, rule.live_vertex
    may_collapse, may_flip = rule.may_collapse, rule.may_flip
    may_add_face, may_remove_face = rule.may_add_face, rule.may_remove_face
    cut_edge, cut_face = k["cut_edge"], k["cut_face"]
    contract, turn, attach, detach = k["contract"], k["turn"], k["attach"], k["detach"]
    face_exists, vertex_faces = k["face_exists"], k["vertex_faces"]
    face_vertices, beside = k["face_vertices"], k["beside"]
    place, bury, sides_of, isolate = k["place"], k["bury"], k["sides"], k["isolate"]
    new_vertex = appending(place)

    @kernel
    def free_edges(m: Any, corners: Array, n: int) -> int:
        """How many edges of the face with these n corners have no face beyond them."""
        free = 0
        for i in range(n):
            free += beside(m, corners[(i + 1) % n], corners[i]) < 0
        return free

    @kernel
    def split_edge(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        refusal = triangle_edge(m, args[0], at)
        if refusal == ALLOWED and not is_point(point):
            refusal = NOT_FINITE
        if refusal != ALLOWED or dry:
            return refusal
        faces = 2 if at[LEFT] >= 0 and at[RIGHT] >= 0 else 1
        if not has_room(m, 1, faces, log):
            return NEEDS_ROOM
        f, v = m.counts[FACE_END], new_vertex(m, point)
        cut_edge(m, args[0], at, v, f)
        add_faces(m, 1 + faces, faces)
        m.counts[VALENCE] += 1
        note(log, VERTEX + CREATED, v)
        note_faces(log, CHANGED, at[LEFT], at[RIGHT])
        note_faces(log, CREATED, f, f + 1 if faces == 2 else -1)
        return v

    @kernel
    def split_face(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        face = args[0]
        if not face_exists(m, face):
            return NO_FACE
        if not is_point(point):
            return NOT_FINITE
        if dry:
            return ALLOWED
        sides = sides_of(m, face)
        if not has_room(m, 1, sides - 1, log) or log[0] + sides + ENTRIES >= len(log):
            return NEEDS_ROOM
        f, v = m.counts[FACE_END], new_vertex(m, point)
        cut_face(m, face, v, f)
        add_faces(m, sides, sides - 1)
        m.counts[VALENCE] += 1
        note(log, VERTEX + CREATED, v)
        note_faces(log, CHANGED, face, -1)
        for i in range(sides - 1):
            note(log, FACE + CREATED, f + i)
        return v

    @kernel
    def collapse_edge(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        if not has_scratch(m, out, log):
            return NEEDS_ROOM
        refusal = may_collapse(m, args[0], at, out)
        if refusal != ALLOWED:
            return refusal
        keep = args[1] if args[1] >= 0 else at[B]
        if keep != at[A] and keep != at[B]:
            return NOT_AN_END
        if dry:
            return ALLOWED
        drop = at[A] + at[B] - keep
        triangles = (at[C] >= 0) + (at[D] >= 0)  # which vanish; larger faces lose a corner
        stay = vertex_faces(m, keep, out)
        around = vertex_faces(m, drop, out)
        for i in range(around):
            gone = (out[i] == at[LEFT] and at[C] >= 0) or (out[i] == at[RIGHT] and at[D] >= 0)
            note(log, FACE + (REMOVED if gone else CHANGED), out[i])
        contract(m, args[0], at, drop, keep, around, out)
        bury(m, drop)
        m.counts[VERTICES] -= 1
        m.counts[EDGES] -= 1 + triangles
        m.counts[FACES] -= triangles
        m.counts[VALENCE] = max(m.counts[VALENCE], stay + around)
        note(log, VERTEX + REMOVED, drop)
        return int(keep)

    @kernel
    def flip_edge(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        refusal = may_flip(m, args[0], at)
        if refusal != ALLOWED or dry:
            return refusal
        if not has_room(m, 0, 0, log):
            return NEEDS_ROOM
        if at[C] < at[D]:
            turn(m, args[0], at, at[LEFT], at[RIGHT])
        else:
            turn(m, args[0], at, at[RIGHT], at[LEFT])
        m.counts[VALENCE] += 1
        note_faces(log, CHANGED, at[LEFT], at[RIGHT])
        return ALLOWED

    @kernel
    def add_face(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        n = len(args)
        if not has_room(m, 0, n - 2, log) or not has_scratch(m, out, log):
            return NEEDS_ROOM
        refusal = may_add_face(m, args, out)
        if refusal != ALLOWED or dry:
            return refusal
        edges = free_edges(m, args, n)
        f = m.counts[FACE_END]
        attach(m, args, f)
        add_faces(m, edges, 1)
        m.counts[SIDES] = max(m.counts[SIDES], n)
        m.counts[VALENCE] = max(m.counts[VALENCE] + 2, n)
        note_faces(log, CREATED, f, -1)
        return int(f)

    @kernel
    def remove_face(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        face = args[0]
        if not has_scratch(m, out, log):
            return NEEDS_ROOM
        refusal = may_remove_face(m, face, out)
        if refusal != ALLOWED or dry:
            return refusal
        n = face_vertices(m, face, out)
        m.counts[EDGES] -= free_edges(m, out, n)
        detach(m, face)
        m.counts[FACES] -= 1
        note_faces(log, REMOVED, face, -1)
        return ALLOWED

    @kernel
    def move_vertex(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        if not live_vertex(m, args[0]):
            return NO_VERTEX
        if not is_point(point):
            return NOT_FINITE
        if dry:
            return ALLOWED
        if not has_room(m, 0, 0, log):
            return NEEDS_ROOM
        place(m, args[0], point)
        note(log, VERTEX + CHANGED, args[0])
        return int(args[0])

    @kernel
    def add_vertex(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        if not is_point(point):
            return NOT_FINITE
        if dry:
            return ALLOWED
        if not has_room(m, 1, 0, log):
            return NEEDS_ROOM
        v = new_vertex(m, point)
        isolate(m, v)
        note(log, VERTEX + CREATED, v)
        return v

    changes = split_edge, split_face, collapse_edge, flip_edge, add_face, remove_face
    return named(*changes, move_vertex, add_vertex)
