"""Where the answers to queries are written, and room for more elements.

Records and scratch are pinned in memory, so that compiled code finds them by one address. When one
of them is replaced by a larger one, all who have pinned it are told.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Array
from hem.authoring import (
    EDGE_END,
    EDGE_GROWTH,
    EDGE_ROOM,
    FACE_END,
    FACE_ROOM,
    QUERIES,
    SIDES,
    VALENCE,
    VERTEX_END,
    VERTEX_ROOM,
    WIDTH,
    grown,
    in_slices,
    slice_count,
)
from hem.contract.elements import HANDLE_TYPES, Elements
from hem.engine import Pinned, Uses, move
from hem.ragged import Ragged

TYPICAL_NEIGHBORS = {"vertex": 7, "edge": 11, "face": 3}
"""Room to begin with for the answers to a batch, per element; it grows where it is too small."""


class Scratch(Elements, abstract=True):
    """The room that queries and operations work in."""

    pinning: ClassVar[type[Any]] = Pinned
    """How records and scratch are handed to kernels time and again."""

    _uses: ClassVar[dict[str, Uses]]
    """The uses of the query kernels, by query."""

    def __init__(self, records: tuple[Any, ...]) -> None:
        super().__init__(records)
        # Whoever asks first, and in how many threads: all must find the same list.
        self._pins: list[tuple[Any, Callable[[], tuple[Any, ...]]]] = []
        self._valence_counted = 0

    def _pin(self, scratch: Callable[[], tuple[Any, ...]]) -> Any:
        pinned = self.pinning(*self.records, *scratch())
        self._pins.append((pinned, scratch))
        return pinned

    @cached_property
    def _out(self) -> dict[str, Array]:
        """Scratch for the answer to one query, by the kind of element in it."""
        known = int(self.records.counts[VALENCE])  # of what was copied or compacted
        return self._scratch(known if 0 < known <= self.n_faces // 8 else self._count_valence())

    def _count_valence(self) -> int:
        """The bound on the valence made exact: operations only ever raise it. Cost O(n_t)."""
        counts, times = self.records.counts, np.zeros(len(self.points), np.int32)
        corners = self._room(int(counts[SIDES]), HANDLE_TYPES["vertex"])
        self._uses["face_vertices"].tally(self.faces(), times, corners, *self.records)
        valence = max(int(times.max(initial=0)) + 1, int(counts[SIDES]))
        counts[VALENCE] = self._valence_counted = valence
        return valence

    def _scratch(self, valence: int) -> dict[str, Array]:
        """Room for the answer to any query at vertices of such a valence."""
        width = WIDTH * (valence + 1)
        return {element: self._room(width, dtype) for element, dtype in HANDLE_TYPES.items()}

    def _room(self, width: int, dtype: Any) -> Any:
        """Scratch for so many handles."""
        return np.empty(width, dtype)

    def _make_room(self, vertices: int, faces: int) -> None:
        """Make room for so many new elements."""
        counts = self.records.counts
        if (
            counts[VERTEX_END] + vertices > counts[VERTEX_ROOM]
            or counts[FACE_END] + faces > counts[FACE_ROOM]
            or counts[EDGE_END] + counts[EDGE_GROWTH] * faces > counts[EDGE_ROOM]
        ):
            self.records = grown(self.records, self.fields, vertices, faces)
            self._repin()

    def _widen(self, more: int = 0) -> None:
        """See that the answer to any query fits into the scratch, at a valence by so many larger.

        It doubles, so its bytes are in proportion to the operations done, and so is the time to
        count valences anew: O(1) per operation in the long run.
        """
        room, counts = len(self._out["edge"]), self.records.counts
        if WIDTH * (counts[VALENCE] + more + 1) > room:
            if counts[VALENCE] > self._valence_counted + self.n_faces // 8:
                self._count_valence()
            self._out.update(self._scratch(2 * (int(counts[VALENCE]) + more)))
            self._repin()

    def _repin(self) -> None:
        for pinned, scratch in self._pins:
            pinned.replace(*self.records, *scratch())

    def _ragged(self, query: str, handles: NDArray[Any], width: int) -> Ragged:
        """The answers for ``handles``, each of which has at most ``width`` neighbors."""
        source, target = QUERIES[query]
        n, typical = len(handles), TYPICAL_NEIGHBORS[source]
        offsets = np.empty(n + 1, np.int64)
        room = np.empty(typical * n + slice_count(n) * width, HANDLE_TYPES[target])

        def answer(begin: int, end: int, part: int) -> tuple[slice, NDArray[Any]]:
            mine, own = slice(begin, end), slice(typical * begin, typical * end)
            values = room[own.start + part * width : own.stop + (part + 1) * width]
            asked = handles[mine], offsets[mine], values, width
            return mine, self._uses[query].batch(*asked, *self.records)

        parts = in_slices(answer, n)
        if not all(np.may_share_memory(values, room) for _, values in parts if len(values)):
            room = np.empty(sum(len(values) for _, values in parts), room.dtype)
        end = 0
        for mine, values in parts:
            if end:
                offsets[mine] += end
            move(values, room, end)
            end += len(values)
        offsets[n] = end
        return Ragged(offsets, room[:end])
