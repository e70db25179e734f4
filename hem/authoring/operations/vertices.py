"""Move a vertex, or add one that no face uses yet.

A structure gives ``set_point(m, v, point)``, and ``clear_vertex(m, v)`` for one without faces.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import Kernel, Kernels, kernel
from hem.authoring.operations.parts import (
    Operation,
    has_room,
    is_point,
    log_element,
    vertex_maker,
)
from hem.authoring.operations.rules import live_vertex
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, Refusal
from hem.edit import CHANGED, CREATED, VERTEX


def make_move_vertex(k: Kernels) -> Kernel:
    """The operation for one structure."""
    is_live_vertex, set_point = live_vertex(k["coordinate"]), k["set_point"]

    @kernel
    def move_vertex(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        if not is_live_vertex(m, args[0]):
            return Refusal.NO_VERTEX
        if not is_point(point):
            return Refusal.NOT_FINITE
        if dry:
            return ALLOWED
        if not has_room(m, 0, 0, log):
            return NEEDS_ROOM
        set_point(m, args[0], point)
        log[0] = log_element(log, log[0], VERTEX + CHANGED, args[0])
        return int(args[0])

    return move_vertex


def make_add_vertex(k: Kernels) -> Kernel:
    """The operation for one structure. No vertex is searched for, so the cost is O(1)."""
    new_vertex, clear_vertex = vertex_maker(k["set_point"]), k["clear_vertex"]

    @kernel
    def add_vertex(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        if not is_point(point):
            return Refusal.NOT_FINITE
        if dry:
            return ALLOWED
        if not has_room(m, 1, 0, log):
            return NEEDS_ROOM
        v = new_vertex(m, point)
        clear_vertex(m, v)
        log[0] = log_element(log, log[0], VERTEX + CREATED, v)
        return v

    return add_vertex


OPERATIONS = {
    "move_vertex": Operation(make_move_vertex, "vertex", takes_a_point=True, names_a_vertex=True),
    "add_vertex": Operation(
        make_add_vertex, "vertex", takes_a_point=True, names_a_vertex=True, growth=(1, 0)
    ),
}
