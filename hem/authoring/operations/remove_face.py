"""Take a face away; its vertices stay.

A structure gives ``remove_records(m, f)``.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import EDGES, FACES, Kernel, Kernels, kernel
from hem.authoring.operations.parts import Operation, has_scratch, log_faces
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.authoring.walks import ring
from hem.edit import REMOVED


def rule(k: Kernels) -> Kernel:
    """Make ``may_remove_face(m, f, out) -> refusal``.

    Cost: that of ``vertex_vertices`` at the corners.
    """
    face_exists, face_vertices = k["face_exists"], k["face_vertices"]
    face_left_of, neighbors = k["face_left_of"], ring(k["vertex_vertices"], k["vertex_faces"])

    @kernel
    def lies_between(m: Any, v: int, before: int, after: int, out: Array) -> bool:
        """Whether the face lies inside the open fan of v: with faces on both sides there."""
        if before < 0 or after < 0:
            return False
        _, on_border, _ = neighbors(m, v, out)
        return bool(on_border)

    @kernel
    def may_remove_face(m: Any, f: int, out: Array) -> int:
        if not face_exists(m, f):
            return Refusal.NO_FACE
        n = face_vertices(m, f, out)
        before = face_left_of(m, out[0], out[n - 1])
        for i in range(n):
            v = out[i]
            after = face_left_of(m, out[(i + 1) % n], v)
            if lies_between(m, v, before, after, out[n:]):
                return Refusal.BETWEEN
            before = after
        return ALLOWED

    return may_remove_face


def make(k: Kernels) -> Kernel:
    """The operation for one structure."""
    may_remove_face, remove_records, edge_faces = rule(k), k["remove_records"], k["edge_faces"]
    face_vertices, face_left_of, edge_between = (
        k[it] for it in ("face_vertices", "face_left_of", "edge_between")
    )

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
        n, lone = face_vertices(m, face, out), 0
        for i in range(n):
            a, b = out[i], out[(i + 1) % n]
            if face_left_of(m, b, a) < 0:  # but another may run the same way
                lone += edge_faces(m, edge_between(m, a, b), out[n:]) == 1
        m.counts[EDGES] -= lone
        remove_records(m, face)
        m.counts[FACES] -= 1
        log[0] = log_faces(log, log[0], REMOVED, face, -1)
        return ALLOWED

    return remove_face


OPERATIONS = {"remove_face": Operation(make, "face")}
