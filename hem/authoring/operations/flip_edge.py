"""Turn an edge inside the two faces at it, so that it joins their other two corners.

::

         c                  c        The face at the smaller of c and d becomes the
       ╱   ╲              ╱ │ ╲      one at a, so that a second flip undoes the
      a─────b    ──▶     a  │  b     first, indices and all.
       ╲   ╱              ╲ │ ╱
         d                  d

A structure gives ``flip_records(m, e, at, one, other)``: the diamond is in ``at``, and the faces
get the corners (a, d, c) and (b, c, d).
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import VALENCE, Kernel, Kernels, kernel
from hem.authoring.operations.parts import Operation, has_room, log_faces
from hem.authoring.operations.rules import LEFT, RIGHT, C, D, triangle_edge
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.edit import CHANGED


def rule(k: Kernels) -> Kernel:
    """Make ``may_flip_edge(m, e, at) -> refusal``.

    Cost: that of finding the edge, and O(the smaller valence of the opposite corners).
    """
    is_triangle_edge = triangle_edge(k["edge_exists"], k["diamond"])
    are_joined = k["are_joined"]

    @kernel
    def may_flip_edge(m: Any, e: int, at: Array) -> int:
        refusal = is_triangle_edge(m, e, at)
        if refusal != ALLOWED:
            return refusal
        if at[LEFT] < 0 or at[RIGHT] < 0:
            return Refusal.BORDER_EDGE
        if at[C] == at[D]:
            return Refusal.SAME_CORNER
        return Refusal.JOINED if are_joined(m, at[C], at[D]) else ALLOWED

    return may_flip_edge


def make(k: Kernels) -> Kernel:
    """The operation for one structure."""
    may_flip_edge, flip_records = rule(k), k["flip_records"]

    @kernel
    def flip_edge(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        refusal = may_flip_edge(m, args[0], at)
        if refusal != ALLOWED or dry:
            return refusal
        if not has_room(m, 0, 0, log):
            return NEEDS_ROOM
        if at[C] < at[D]:
            flip_records(m, args[0], at, at[LEFT], at[RIGHT])
        else:
            flip_records(m, args[0], at, at[RIGHT], at[LEFT])
        m.counts[VALENCE] += 1
        log[0] = log_faces(log, log[0], CHANGED, at[LEFT], at[RIGHT])
        return ALLOWED

    return flip_edge


OPERATIONS = {"flip_edge": Operation(make, "edge")}
