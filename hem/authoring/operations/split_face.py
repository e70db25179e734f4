"""Split a face at a new vertex, which is joined to all its corners.

::

           c                  c        a is the smallest corner. The face keeps its
         ╱   ╲              ╱ │ ╲      index at (a, b, v); (b, c, v) and (c, a, v)
       ╱       ╲          ╱   v   ╲    are new, in this order.
      a─────────b        a ──╱─╲── b

A structure gives ``split_face_records(m, face, v, f, corners)``: the first new face is ``f``, and
``corners`` is filled with those of the face.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import FACE_END, VALENCE, Kernel, Kernels, kernel
from hem.authoring.operations.parts import (
    ENTRIES,
    Operation,
    count_new,
    has_room,
    is_point,
    log_element,
    log_faces,
    log_parts,
    vertex_maker,
)
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.edit import CHANGED, CREATED, PARENT, VERTEX


def make(k: Kernels) -> Kernel:
    """The operation for one structure."""
    face_exists, sides_of = k["face_exists"], k["sides"]
    new_vertex, split_face_records = vertex_maker(k["set_point"]), k["split_face_records"]

    @kernel
    def split_face(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        face = args[0]
        if not face_exists(m, face):
            return Refusal.NO_FACE
        if not is_point(point):
            return Refusal.NOT_FINITE
        if dry:
            return ALLOWED
        sides = sides_of(m, face)
        if log[0] + 3 * sides + ENTRIES >= len(log) or sides > len(out):
            return NEEDS_ROOM
        if not has_room(m, 1, sides - 1, log):
            return NEEDS_ROOM
        f, v = m.counts[FACE_END], new_vertex(m, point)
        split_face_records(m, face, v, f, out)
        count_new(m, sides, sides - 1)
        m.counts[VALENCE] += 1
        end = log_element(log, log[0], VERTEX + CREATED, v)
        for i in range(sides):
            end = log_element(log, end, PARENT, out[i])
        end = log_faces(log, end, CHANGED, face, -1)
        log[0] = log_parts(log, end, f, sides - 1, face)
        return v

    return split_face


OPERATIONS = {
    "split_face": Operation(
        make, "face", takes_a_point=True, names_a_vertex=True, growth=(1, 2), grows_with_sides=True
    )
}
