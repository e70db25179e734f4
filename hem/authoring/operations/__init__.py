"""The operations, compiled: what every structure does alike around its own surgery.

One module per operation, found in this folder: what it does to the faces, its rule
(``may_flip_edge``), and the operation itself (``flip_edge``), which checks the rule, sees to it
that there is room, has the structure change its records (``flip_records``), counts, and logs what
it touched. All structures number new elements alike, because each module says which index is whose.

An operation is a kernel ``(m, args, point, at, out, log, dry) -> result``. ``args`` are the
handles, ``point`` (3,) is a position where one is asked for, ``at`` (6,) and ``out`` are scratch.
``dry`` only checks. The result is the vertex that the operation is about, or the new face, else 0;
or a ``Refusal``, or ``NEEDS_ROOM``, and then nothing was changed.

What a structure gives for it, beside its queries:

- ``edge_exists(m, e)`` and ``face_exists(m, f)``, whether they are live;
- ``diamond(m, e, at) -> faces``, which fills the diamond of a live edge (see ``rules``) and tells
  the number of its faces: 0 for no edge, 3 for more than a surface has;
- ``are_joined(m, a, b)``, whether an edge joins two vertices; ``edge_between(m, a, b)``, which one
  does, or -1; ``face_left_of(m, a, b)``, the face that runs a → b, or -1;
- the changes of its records that the modules name: ``split_edge_records``, ``split_face_records``,
  ``collapse_records``, ``flip_records``, ``add_records``, ``remove_records``;
- and what ``hem.authoring.defaults`` has, where that does not fit.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from hem.authoring.operations.parts import (
    ENTRIES,
    WIDTH,
    Operation,
    count_new,
    has_room,
    has_scratch,
    is_point,
    log_element,
    log_faces,
    log_parts,
    vertex_maker,
)
from hem.authoring.operations.prefetching import BLOCK, SEEN, nothing, prefetching
from hem.authoring.operations.rules import LEFT, RIGHT, A, B, C, D, live_vertex

SHARED = "parts", "prefetching", "rules"  # what operations are made of
OPERATIONS: dict[str, Operation] = {
    name: operation
    for module in iter_modules(__path__)
    if module.name not in SHARED
    for name, operation in import_module(f"{__name__}.{module.name}").OPERATIONS.items()
}
"""Every operation of the contract by name: what the other modules of this folder declare."""

__all__ = [
    "BLOCK", "ENTRIES", "LEFT", "OPERATIONS", "RIGHT", "SEEN", "WIDTH", "A", "B", "C", "D",
    "Operation", "count_new", "has_room", "has_scratch", "is_point", "live_vertex", "log_element",
    "log_faces", "log_parts", "nothing", "prefetching", "vertex_maker",
]  # fmt: skip
