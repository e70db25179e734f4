"""What experiments ask of a structure beside the contract: loops that are timed, and work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array, Bools
from hem.authoring import ENTRIES, QUERIES, VALENCE, copied
from hem.contract import arguments
from hem.contract.editable import Editable
from hem.edit import Edit
from hem.engine import CHECK, MODE, PERSIST
from hem.errors import MeshError


class Prepared(NamedTuple):
    """Operations that only wait to be run."""

    perform: Callable[[int], int]
    pinned: Any
    task: Array
    results: Array
    """(n,): what became of each; a refusal is negative."""

    def check(self) -> Bools:
        """Change nothing -> (n,) which of them would be done."""
        try:
            self.task[MODE] = CHECK
            self.perform(self.pinned.address)
        finally:
            self.task[MODE] = PERSIST
        return self.results >= 0

    def run(self) -> None:
        """Do them all, but those that are refused; RuntimeError if not all could be tried."""
        if self.perform(self.pinned.address) < len(self.results):
            raise RuntimeError("there is no more room; prepare fewer operations at a time")


class Sweep(NamedTuple):
    """A query that only waits to be asked of many handles, which were checked."""

    loop: Callable[..., int]
    handles: Array
    out: Any
    mesh: Measuring
    counts: bytes
    """What the mesh counted when the handles were checked."""

    def some(self, places: Any) -> Sweep:
        """The same for the handles at some of their places."""
        return self._replace(handles=self.handles[places])

    def run(self) -> int:
        """Ask in one compiled loop, keeping nothing -> a checksum.

        MeshError where elements came or went since: then what was checked may be gone.
        """
        records = self.mesh.records
        if records.counts.tobytes() != self.counts:
            raise MeshError("the mesh was edited since the handles were checked")
        return int(self.loop(self.handles, self.out, *records))


class Snapshot(NamedTuple):
    """A mesh as it was."""

    records: Any
    attributes: dict[tuple[str, str], tuple[Array, ...]]


class Measuring(Editable, abstract=True):
    """For measuring; nobody else needs it."""

    def sweep(self, query: str, handles: NDArray[Any]) -> int:
        """Answer ``query`` for every handle in one compiled loop, keeping nothing -> a checksum.

        Raises MeshError for what names nothing, KeyError for no query.
        """
        return self.prepare_sweep(query, handles).run()

    def prepare_sweep(self, query: str, handles: NDArray[Any]) -> Sweep:
        """Check handles for a ``sweep``, which is run later: what the experiments time."""
        wanted = self._checked(QUERIES[query], handles)
        self._count_edges()
        self._widen()
        out, counts = self._out[QUERIES[query].target], self.records.counts
        return Sweep(self._uses[query].sweep, wanted, out, self, counts.tobytes())

    def work(self, query: str, handles: NDArray[Any]) -> NDArray[np.int64]:
        """(n,) int64: elements of the structure's arrays read to answer ``query``, per handle.

        Exact and the same on every machine; runs uncompiled. Raises as ``sweep``.
        """
        wanted = self._checked(QUERIES[query], handles)
        self._widen()
        out = self._out[QUERIES[query].target]
        return self._uses[query].work(wanted, out, self.records)

    def reserve(self, splits: int) -> None:
        """Make all room for so many splits at once, so that none of them has to. O(n_v + n_t)."""
        self._make_room(splits, 2 * splits)
        for operation in self._do:
            self._make_way(operation)

    def prepare(self, operation: str, args: ArrayLike, points: ArrayLike | None = None) -> Prepared:
        """Have operations ready to be run in one compiled loop, untold to anyone: for measuring.

        ``args``: (n,) first handles, or (n, 3) all of them. Refused ones are passed over. There is
        room for them all from here on; the arrays must stay the same until it is run. Raises
        KeyError for no operation.
        """
        rows = np.asarray(args, np.int64)
        rows = arguments.rows(rows) if rows.ndim == 1 else np.ascontiguousarray(rows)
        if rows.ndim != 2 or rows.shape[1] < 3:
            raise MeshError(f"{operation} takes (n,) or (n, 3) handles, not {rows.shape}")
        n, bound = len(rows), self._bound[operation]
        vertices, faces = self.operations[operation].growth
        self._make_room(vertices * n, faces * n)
        self._count_valence()
        self._widen(2 * n)  # an operation adds at most 2 to a valence
        positions = (
            arguments.NO_POINT if points is None else arguments.positions("prepare", points, n)
        )
        valence = int(self.records.counts[VALENCE])
        entries = n * (3 * valence + ENTRIES) + 2 * (valence + 2 * n + ENTRIES)
        results, log = np.zeros(n, np.int64), np.empty(entries, np.int64)
        task = np.array([PERSIST, 0, n])
        scratch = task, rows, positions, results, self._at, self._out["edge"], log
        return Prepared(bound.perform, self.pinning(*self.records, *scratch), task, results)

    def operation_work(self, operation: str, *args: int, point: ArrayLike = (0, 0, 0)) -> int:
        """Do one operation uncompiled -> the array elements it read and wrote, exactly.

        Arguments as for the method of that name, which says what it raises; KeyError for no
        operation.
        """
        if not 1 <= len(args) <= 3:
            raise MeshError(f"{operation} takes one to three handles, not {len(args)}")
        self._make_way(operation)
        self._log[0] = 0
        row, position = [*args, -1, -1][:3], np.asarray(point, np.float32)
        scratch = position, self._out["edge"], self._log
        work = self._operation_uses[operation].operation_work
        result, accesses = work(row, *scratch, self.records)
        if result < 0:
            raise self._refusal(operation, result, row)
        self._publish(Edit(operation, result, self._log[1 : self._log[0] + 1].tolist()))
        return accesses

    def snapshot(self) -> Snapshot:
        """What ``restore`` needs to make the mesh what it is now. Cost O(n_v + n_t)."""
        self._count_edges()  # what is not known yet would be unknown again, and then kept up
        self._widen()
        states = {key: it.state() for key, it in self._attributes.items()}
        return Snapshot(self._portable(), states)

    def restore(self, snapshot: Snapshot) -> None:
        """Make the mesh what it was, in the same place; there must be as much room. For measuring.

        Attributes that were made since become what they were made. Subscribers are not told. Cost
        O(n_v + n_t).
        """
        self._put_back(snapshot.records)
        for key, attribute in self._attributes.items():
            if key in snapshot.attributes:
                attribute.restore(snapshot.attributes[key])
            else:
                attribute.clear()

    def _portable(self) -> Any:
        """The records in arrays of their own."""
        return copied(self.records)

    @classmethod
    def _records_of(cls, portable: Any) -> Any:
        """The way back."""
        return portable

    def _put_back(self, portable: Any) -> None:
        """Have the records say what they said."""
        for array, fresh in zip(self.records, portable, strict=True):
            np.copyto(array, fresh)

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays of the records, room for more included, without the count of them."""
        *arrays, _ = self.records
        return tuple(arrays)
