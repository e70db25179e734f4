"""Merge one end of an edge into the other.

::

         c                  c        keep is b: a and both faces are gone. The edges
       ╱   ╲                │        that b had keep their records.
  ── a───────b ──  ──▶  ── ─b─ ──
       ╲   ╱                │
         d                  d

The rule is the link condition (Dey et al., Topology preserving edge contraction, 1999).

A structure gives ``collapse_records(m, e, at, drop, keep, around, out)``: the diamond is in ``at``,
the first ``around`` elements of ``out`` are the faces at ``drop``, the rest of it is free.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import (
    EDGES,
    FACES,
    SIDES,
    VALENCE,
    VERTICES,
    Kernel,
    Kernels,
    count_shared,
    kernel,
)
from hem.authoring.operations.parts import Operation, has_scratch, log_element
from hem.authoring.operations.rules import LEFT, RIGHT, A, B, C, D, holds_polygons, surface_edge
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.authoring.walks import ring
from hem.edit import CHANGED, FACE, REMOVED, VERTEX


def rule(k: Kernels) -> Kernel:
    """Make ``may_collapse_edge(m, e, at, out) -> refusal, most``; it overwrites ``out``.

    ``most``: what is at both ends together bounds what is at the one that stays, neighbors or
    faces. Cost: that of ``vertex_vertices`` at both ends.
    """
    is_surface_edge = surface_edge(k["edge_exists"], k["diamond"])
    vertex_faces, is_alone, are_triangles = k["vertex_faces"], *_parts(k)
    neighbors, polygons = ring(k["vertex_vertices"], vertex_faces), holds_polygons(k)

    @kernel
    def may_collapse_edge(m: Any, e: int, at: Array, out: Array) -> tuple[int, int]:
        refusal = is_surface_edge(m, e, at)
        if refusal != ALLOWED:
            return refusal, 0
        others = 1 if at[LEFT] >= 0 and at[RIGHT] >= 0 else 0  # faces at the edge, but one
        triangles = (at[C] >= 0) + (at[D] >= 0)
        if triangles == 2 and at[C] == at[D]:
            return Refusal.SAME_CORNER, 0
        if is_alone(m, at[LEFT], at[A], at[B], at[C], others, out):
            return Refusal.LONE_FACE, 0
        if is_alone(m, at[RIGHT], at[B], at[A], at[D], others, out):
            return Refusal.LONE_FACE, 0
        around_a, border_a, most_a = neighbors(m, at[A], out)
        around_b, border_b, most_b = neighbors(m, at[B], out[around_a:])
        if others == 1 and border_a and border_b:
            return Refusal.TWO_BORDERS, 0
        closed = around_a == 3 and around_b == 3 and not border_a and not border_b
        if closed and triangles == 2 and are_triangles(m, at[A], at[C], at[C], at[B]):
            return Refusal.TETRAHEDRON, 0
        # Where one end has no neighbors but the other and the corners beside, there are no more.
        alike = min(around_a, around_b) <= triangles + 1
        if not alike and count_shared(out, around_a, around_b) != triangles:
            return Refusal.COMMON_NEIGHBOR, 0
        if polygons and m.counts[SIDES] > 3:
            around_a = vertex_faces(m, at[A], out)
            around_b = vertex_faces(m, at[B], out[around_a:])
            if count_shared(out, around_a, around_b) != others + 1:
                return Refusal.SHARED_FACE, 0
        return ALLOWED, most_a + most_b

    return may_collapse_edge


def _parts(k: Kernels) -> tuple[Kernel, Kernel]:
    face_faces, face_left_of, sides = k["face_faces"], k["face_left_of"], k["sides"]
    polygons = holds_polygons(k)

    @kernel
    def is_alone(m: Any, face: int, a: int, b: int, c: int, others: int, out: Array) -> bool:
        """Whether a triangle that runs a → b → c has no face beyond its edges at c."""
        if c < 0 or face_faces(m, face, out) != others:
            return False
        if not polygons or m.counts[SIDES] == 3:
            return True
        # What lies beyond the edge from a to b may be a polygon that lies beyond another, too.
        return face_left_of(m, c, b) < 0 and face_left_of(m, a, c) < 0

    @kernel
    def are_triangles(m: Any, a: int, b: int, c: int, d: int) -> bool:
        """Whether the faces that run a → b and c → d are triangles."""
        if not polygons or m.counts[SIDES] == 3:
            return True
        return sides(m, face_left_of(m, a, b)) == 3 and sides(m, face_left_of(m, c, d)) == 3

    return is_alone, are_triangles


def make(k: Kernels) -> Kernel:
    """The operation for one structure."""
    may_collapse_edge, vertex_faces = rule(k), k["vertex_faces"]
    collapse_records, kill_vertex = k["collapse_records"], k["kill_vertex"]

    @kernel
    def collapse_edge(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        if not has_scratch(m, out, log):
            return NEEDS_ROOM
        refusal, most = may_collapse_edge(m, args[0], at, out)
        if refusal != ALLOWED:
            return refusal
        keep = args[1] if args[1] != -1 else at[B]
        if keep != at[A] and keep != at[B]:
            return Refusal.NOT_AN_END
        if dry:
            return ALLOWED
        drop = at[A] + at[B] - keep
        triangles = (at[C] >= 0) + (at[D] >= 0)  # which vanish; larger faces lose a corner
        around, end = vertex_faces(m, drop, out), log[0]
        for i in range(around):
            gone = (out[i] == at[LEFT] and at[C] >= 0) or (out[i] == at[RIGHT] and at[D] >= 0)
            end = log_element(log, end, FACE + (REMOVED if gone else CHANGED), out[i])
        collapse_records(m, args[0], at, drop, keep, around, out)
        kill_vertex(m, drop)
        m.counts[VERTICES] -= 1
        m.counts[EDGES] -= 1 + triangles
        m.counts[FACES] -= triangles
        m.counts[VALENCE] = max(m.counts[VALENCE], most)
        log[0] = log_element(log, end, VERTEX + REMOVED, drop)
        return int(keep)

    return collapse_edge


OPERATIONS = {
    "collapse_edge": Operation(make, "edge", names_a_vertex=True, asks_neighbors=True),
}
