"""Add a face between vertices that are free or lie on the border.

A structure gives ``add_records(m, corners, f)``.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import FACE_END, SIDES, VALENCE, Kernel, Kernels, kernel
from hem.authoring.operations.parts import Operation, count_new, has_room, has_scratch, log_faces
from hem.authoring.operations.rules import live_vertex
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.edit import CREATED


def rule(k: Kernels) -> Kernel:
    """Make ``may_add_face(m, corners, out) -> refusal``.

    Cost: that of ``vertex_faces`` at the corners.
    """
    is_live_vertex = live_vertex(k["coordinate"])
    face_left_of, vertex_faces = k["face_left_of"], k["vertex_faces"]

    @kernel
    def may_add_face(m: Any, corners: Array, out: Array) -> int:
        n = len(corners)
        for i in range(n):
            if not is_live_vertex(m, corners[i]):
                return Refusal.NO_VERTEX
            for j in range(i):
                if corners[i] == corners[j]:
                    return Refusal.SAME_VERTEX
        alike, last = True, face_left_of(m, corners[0], corners[n - 1])
        for i in range(n):
            a, b = corners[i], corners[(i + 1) % n]
            if face_left_of(m, a, b) >= 0:
                return Refusal.TAKEN
            beyond = face_left_of(m, b, a)
            alike = alike and beyond >= 0 and beyond == last
            if beyond < 0 and last < 0 and vertex_faces(m, a, out) > 0:
                return Refusal.SECOND_FAN
            last = beyond
        return Refusal.COINCIDENT if alike else ALLOWED

    return may_add_face


def make(k: Kernels) -> Kernel:
    """The operation for one structure."""
    may_add_face, add_records, face_left_of = rule(k), k["add_records"], k["face_left_of"]

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
        edges = 0  # that are new: nothing lies beyond them
        for i in range(n):
            edges += face_left_of(m, args[(i + 1) % n], args[i]) < 0
        f = m.counts[FACE_END]
        add_records(m, args, f)
        count_new(m, edges, 1)
        m.counts[SIDES] = max(m.counts[SIDES], n)
        m.counts[VALENCE] = max(m.counts[VALENCE] + 2, n)
        log[0] = log_faces(log, log[0], CREATED, f, -1)
        return int(f)

    return add_face


OPERATIONS = {"add_face": Operation(make, "vertex", growth=(0, 1))}
