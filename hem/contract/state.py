"""The state of one mesh: its records, and the scratch that queries and operations work in."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any

import numpy as np

from hem import authoring
from hem.arrays import Array, Bools, Indices
from hem.authoring import (
    BLOCK,
    FACES,
    QUERIES,
    SEEN,
    SIDES,
    VALENCE,
    WIDTH,
    in_slices,
    slice_count,
)
from hem.contract.description import Declared
from hem.contract.storage import HANDLE_TYPES
from hem.engine import move
from hem.ragged import Ragged

ENDS = [authoring.VERTEX_END, authoring.EDGE_END, authoring.FACE_END]
ROOMS = [authoring.VERTEX_ROOM, authoring.EDGE_ROOM, authoring.FACE_ROOM]

TYPICAL_NEIGHBORS = {"vertex": 7, "edge": 2, "edge_edges": 11, "face": 3}
"""Room to begin with for the answers to a batch, per element; it grows where it is too small."""

SPARE = 1 << 16
"""Bytes that an answer keeps alive beside itself, at most, where it fills less than half of them.

A vertex of many neighbors takes room for as many, and no other element has as many.
"""


class State:
    """Records and scratch of one mesh. Nobody else replaces any of them.

    ``records``  written by operations and by ``Storage.put_back``, in their place; replaced by
                 larger ones when there is no room (``make_room``), and by ``compact``
    ``out``      where the answer to one query is written, by the kind of element in it; replaced
                 when a valence outgrows it (``widen``)
    ``log``      what the operation under way has touched; replaced by a longer one (``make_way``)
    ``at``       the parts of a diamond
    bounds       ``VALENCE`` and ``SIDES`` among the counts: no vertex or face has more; operations
                 raise them, ``count_valence`` and ``compact`` make them exact
    pins         images of all these in memory, which compiled code finds by one address

    Whatever is replaced holds what was there before, and every pin is told at once. Threads may
    ask side by side: each pins for itself, in one list.
    """

    def __init__(self, declared: Declared, records: Any) -> None:
        self.declared, self.storage = declared, declared.storage
        self.storage.require_columns(records)
        self.records = records
        self._pins: list[tuple[Any, Callable[[State], tuple[Any, ...]]]] = []
        self._valence_counted = 0

    @cached_property
    def out(self) -> dict[str, Any]:
        """Scratch for the answer to one query, by the kind of element in it."""
        counts = self.records.counts
        known = int(counts[VALENCE])  # of what was copied or compacted
        exact = 0 < known <= counts[FACES] // 8
        return self._wide_enough(known if exact else self.count_valence())

    @cached_property
    def log(self) -> memoryview:
        """What the operation under way has touched. Views are faster to read than arrays."""
        return memoryview(np.zeros(1, np.int64).data)

    @cached_property
    def at(self) -> Any:
        """Scratch for the parts of a diamond."""
        return self.storage.row(6, np.int64)

    @cached_property
    def seen(self) -> Array:
        """Scratch for what is read ahead."""
        return np.empty((BLOCK, SEEN), np.int64)

    @property
    def scratch_bytes(self) -> int:
        """Bytes taken beside the records; few before the first question."""
        return self.log.nbytes + sum(it.nbytes for it in self.__dict__.get("out", {}).values())

    # What is there ---------------------------------------------------------------------------

    def live(self, element: str) -> Array:
        """The handles of all live elements of a kind that is recorded, ascending."""
        return self.storage.live(self.records, element)

    def alive(self, element: str, rows: Any) -> Bools:
        """Which of the ``rows`` of a kind of records are live."""
        return self.storage.alive(self.records, element, rows)

    def require(self, element: str, handles: Array) -> None:
        """Raise MeshError if any of ``handles`` (n,) names no live element of the mesh. O(n)."""
        self.storage.require(self.records, element, handles)

    def edge_names(self, edges: Indices) -> Indices:
        """(n,): the one name of each live edge, where an edge has two handles."""
        return self.storage.edge_names(self.records, edges)

    def prepare(self, kernels: Iterable[str]) -> None:
        """See ``Storage.prepare``."""
        self.storage.prepare(self.records, kernels)

    def answers(self, query: str, handles: Array, width: int) -> Ragged:
        """The answers for live ``handles``, each of which has at most ``width`` neighbors."""
        self.prepare([query])
        source, target = QUERIES[query]
        n, typical = len(handles), TYPICAL_NEIGHBORS.get(query) or TYPICAL_NEIGHBORS[source]
        offsets = np.empty(n + 1, np.int64)
        room = np.empty(typical * n + slice_count(n) * width, HANDLE_TYPES[target])
        batch, records = self.declared.queries[query].batch, self.records

        def answer(begin: int, end: int, part: int) -> tuple[slice, Array]:
            mine, own = slice(begin, end), slice(typical * begin, typical * end)
            values = room[own.start + part * width : own.stop + (part + 1) * width]
            return mine, batch(handles[mine], offsets[mine], values, width, *records)

        parts = in_slices(answer, n)
        first = room
        if not all(np.may_share_memory(values, room) for _, values in parts if len(values)):
            room = np.empty(sum(len(values) for _, values in parts), room.dtype)
        end = 0
        for part, (mine, values) in enumerate(parts):
            offsets[mine] += end
            if part or room is not first:  # the first part lies where it belongs
                move(values, room, end)
            end += len(values)
        offsets[n] = end
        values = room[:end]
        wasteful = room.nbytes > max(2 * values.nbytes, SPARE)
        return Ragged(offsets, values.copy() if wasteful else values)

    # What is replaced ------------------------------------------------------------------------

    def pin(self, scratch: Callable[[State], tuple[Any, ...]]) -> Any:
        """The records and some scratch at an address that stays valid, whatever is replaced."""
        pinned = self.pinned_now(*scratch(self))
        self._pins.append((pinned, scratch))
        return pinned

    def pinned_now(self, *scratch: Any) -> Any:
        """The records and some scratch at an address that is valid until they are replaced."""
        return self.storage.pinned(*self.records, *scratch)

    def make_room(self, vertices: int, faces: int) -> None:
        """Make room for so many new elements. O(1) each in the long run."""
        counts = self.records.counts
        edges = counts[authoring.EDGE_GROWTH] * faces
        wanted = np.array([vertices, edges, faces]) + counts[ENDS]
        if (wanted > counts[ROOMS]).any():
            self.replace(records=self.storage.with_room(self.records, vertices, faces))

    def widen(self, more: int = 0, most: int | None = None) -> None:
        """See that the answer to any query fits into the scratch, at a valence by so many larger.

        Or at the ``most`` that any vertex will have, where that is known. It doubles, so its bytes
        are in proportion to the operations done, and so is the time to count valences anew: O(1)
        per operation in the long run.
        """
        room, counts = len(self.out["edge"]), self.records.counts
        if most is not None:
            counts[VALENCE] = min(counts[VALENCE], most)
            more = most - int(counts[VALENCE])
        if WIDTH * (counts[VALENCE] + more + 1) > room:
            if counts[VALENCE] > self._valence_counted + counts[FACES] // 8:
                self.count_valence()
            self.replace(out=self._wide_enough(2 * (int(counts[VALENCE]) + more)))

    def lengthen(self, entries: int) -> None:
        """Have a log of at least so many entries."""
        if len(self.log) < entries:
            self.replace(log=memoryview(np.zeros(entries, np.int64).data))

    def compact(self) -> dict[str, Array]:
        """Drop dead records and room -> the new number of each old record, by kind. O(records)."""
        records, number = self.storage.compacted(self.records)
        self.replace(records=records)
        counts = records.counts
        if counts[SIDES] > 3:
            corners = self.answers("face_vertices", self.live("face"), int(counts[SIDES]))
            counts[SIDES] = corners.counts.max(initial=3)
        return number

    def replace(self, **parts: Any) -> None:
        """Have others of these parts, by name, and tell every pin, also where it is interrupted."""
        try:
            vars(self).update(parts)
            self._repin()
        except BaseException:  # kernels would write to what is nobody's any more
            self._repin()
            raise

    def count_valence(self) -> int:
        """The bound on the valence made exact: operations only ever raise it. Cost O(n_t)."""
        counts = self.records.counts
        times = np.zeros(counts[authoring.VERTEX_END], np.int32)
        corners = self.storage.row(int(counts[SIDES]), HANDLE_TYPES["vertex"])
        tally = self.declared.queries["face_vertices"].tally
        tally(self.live("face"), times, corners, *self.records)
        counts[VALENCE] = max(int(times.max(initial=0)) + 1, int(counts[SIDES]))
        self._valence_counted = int(counts[VALENCE])
        return self._valence_counted

    def _wide_enough(self, valence: int) -> dict[str, Any]:
        """Room for the answer to any query at vertices of such a valence."""
        width = WIDTH * (valence + 1)
        return {element: self.storage.row(width, it) for element, it in HANDLE_TYPES.items()}

    def _repin(self) -> None:
        for pinned, scratch in self._pins:
            pinned.replace(*self.records, *scratch(self))
