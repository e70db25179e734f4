"""Split an edge at a new vertex; each face there becomes two.

::

      c                  c        Vertex v is new. The face at a, the smaller end,
    ╱   ╲              ╱ │ ╲      keeps its index; the one at b is new, the left
   a─────b    ──▶     a──v──b     one before the right one. The record of the
    ╲   ╱              ╲ │ ╱      edge stays with a and v.
      d                  d

A structure gives ``split_edge_records(m, e, at, v, f)``: the diamond is in ``at``, the first new
face is ``f``.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import FACE_END, VALENCE, Kernel, Kernels, kernel
from hem.authoring.operations.parts import (
    Operation,
    count_new,
    has_room,
    is_point,
    log_element,
    log_faces,
    log_parts,
    vertex_maker,
)
from hem.authoring.operations.rules import LEFT, RIGHT, A, B, C, D, triangle_edge
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.edit import CHANGED, CREATED, PARENT, VERTEX


def make(k: Kernels) -> Kernel:
    """The operation for one structure."""
    may_split_edge = triangle_edge(k["edge_exists"], k["diamond"])
    new_vertex, split_edge_records = vertex_maker(k["set_point"]), k["split_edge_records"]

    @kernel
    def split_edge(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        refusal = may_split_edge(m, args[0], at)
        if refusal == ALLOWED and at[C] == at[D]:  # two edges would join it to the new vertex
            refusal = Refusal.SAME_CORNER
        if refusal == ALLOWED and not is_point(point):
            refusal = Refusal.NOT_FINITE
        if refusal != ALLOWED or dry:
            return refusal
        faces = 2 if at[LEFT] >= 0 and at[RIGHT] >= 0 else 1
        if not has_room(m, 1, faces, log):
            return NEEDS_ROOM
        f, v = m.counts[FACE_END], new_vertex(m, point)
        split_edge_records(m, args[0], at, v, f)
        count_new(m, 1 + faces, faces)
        m.counts[VALENCE] += 1
        end = log_element(log, log[0], VERTEX + CREATED, v)
        end = log_element(log, end, PARENT, at[A])
        end = log_element(log, end, PARENT, at[B])
        end = log_faces(log, end, CHANGED, at[LEFT], at[RIGHT])
        end = log_parts(log, end, f, 1, at[LEFT] if at[LEFT] >= 0 else at[RIGHT])
        log[0] = log_parts(log, end, f + 1, faces - 1, at[RIGHT])
        return v

    return split_edge


OPERATIONS = {
    "split_edge": Operation(make, "edge", takes_a_point=True, names_a_vertex=True, growth=(1, 2))
}
