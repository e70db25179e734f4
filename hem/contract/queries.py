"""The queries of the contract, derived from a structure's kernels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple, Protocol, overload

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Handles, Indices, Points, each_once
from hem.authoring import (
    EDGES,
    ELEMENTS,
    QUERIES,
    SIDES,
    UNKNOWN,
    VALENCE,
    WIDTH,
    Field,
    in_slices,
)
from hem.contract import arguments
from hem.contract.arguments import MOST, integer
from hem.contract.state import State
from hem.contract.storage import HANDLE_TYPES, Storage, UncompiledStorage, refuse_handles
from hem.edit import FACE
from hem.engine import Read
from hem.errors import MeshError
from hem.ragged import Ragged

ALL: Any = object()  # stands for the handles of all live elements
NUMPY_INTEGERS = frozenset(np.dtype(it).type for it in np.typecodes["AllInteger"])
"""What a loop over an array of handles gives."""


class QueryMethod(Protocol):
    """A query as a method: one handle -> 1-D array; an array of handles, or all -> ``Ragged``."""

    @overload
    def __call__(self, handles: int) -> Array: ...
    @overload
    def __call__(self, handles: Array | list[int] = ...) -> Ragged: ...


class Sweep(NamedTuple):
    """A query that only waits to be asked of many handles, which were checked."""

    loop: Callable[..., int]
    handles: Array
    out: Any
    state: State
    counts: bytes  # what the mesh counted when the handles were checked

    def successive(self, begin: int, many: int) -> Sweep:
        """The same for so many handles from a place on; after the last comes the first again."""
        begin %= len(self.handles)
        end = begin + many
        around = self.handles[begin:end].copy()  # just written, it is in the cache
        if len(around) < many:
            around = np.tile(self.handles, -(-end // len(self.handles)))[begin:end]
        return self._replace(handles=around)

    def run(self) -> int:
        """Ask in one compiled loop, keeping nothing -> a checksum.

        MeshError where elements came or went since: then what was checked may be gone.
        """
        records = self.state.records
        if records.counts.tobytes() != self.counts:
            raise MeshError("the mesh was edited since the handles were checked")
        return int(self.loop(self.handles, self.out, *records))


class Queries:
    """The nine queries on one mesh, by name, and what is read with them.

    Any number of threads may ask at once, as long as none operates on the mesh.
    """

    def __init__(self, state: State) -> None:
        self._state, self._declared = state, state.declared

    def method(self, name: str) -> Any:
        """The ``QueryMethod`` of a query, for whoever keeps it; kept here it would be a cycle."""
        state, (source, target) = self._state, QUERIES[name]
        pinned = state.pin(lambda its: (its.out[target],))
        exists = self._declared.exists(source)
        single = self._prepared(name, self._declared.queries[name].single(pinned, exists))
        address = pinned.address

        def ask(handles: Any = ALL) -> Any:
            # One integer is the way that programs take a million times: no detours here.
            kind = type(handles)
            if kind is int or kind in NUMPY_INTEGERS:
                handle = handles if kind is int else int(handles)
                if 0 <= handle < MOST and len(answer := single(handle, address)):
                    return answer
            return self.ask(name, handles)

        return ask

    def _prepared(self, name: str, ask: Any) -> Any:
        """A single question, before which Python finds what compiled code finds within it.

        Compiled code makes other threads wait meanwhile, and Python does not.
        """
        state, kind = self._state, type(self._state.storage)
        if not issubclass(kind, UncompiledStorage) or kind.prepare is Storage.prepare:
            return ask

        def prepared(*asked: Any) -> Any:
            state.prepare([name])
            return ask(*asked)

        return prepared

    def ask(self, name: str, handles: Any = ALL) -> Any:
        """As the method of a query, for any handles; checked."""
        source = QUERIES[name].source
        if handles is ALL:
            handles = self.handles(source)
        if isinstance(handles, list | tuple) or np.ndim(handles):
            return self._ask_many(name, handles)
        return self._ask_many(name, [integer(name, source, handles)])[0].copy()

    def _ask_many(self, name: str, handles: ArrayLike) -> Ragged:
        wanted = self._checked(name, handles)
        self._state.widen()
        fixed = name in ("face_vertices", "face_edges")
        counts = self._state.records.counts
        width = int(counts[SIDES]) if fixed else WIDTH * int(counts[VALENCE] + 1)
        answers = self._state.answers(name, wanted, width)
        if QUERIES[name].source == "edge" and not answers.counts.all():
            refuse_handles("edge", wanted[answers.counts == 0])
        return answers

    def _checked(self, name: str, handles: ArrayLike) -> Array:
        """(n,) handles for a query; MeshError unless they all name elements of this mesh."""
        source, wanted = QUERIES[name].source, arguments.integers(name, handles, (1,))
        self._state.require(source, wanted)
        return np.ascontiguousarray(wanted, HANDLE_TYPES[source])

    # Steps along half-edges, where they are recorded ------------------------------------------

    def step(self, name: str) -> Any:
        """The ``StepMethod`` of a step."""
        declared, pinned = self._declared, self._pinned
        exists = declared.exists(declared.steps[name].source)
        take, address = declared.stepping[name].step(pinned, exists), pinned.address

        def walk(handles: Any) -> Any:
            kind = type(handles)
            if kind is int or kind in NUMPY_INTEGERS:
                handle = handles if kind is int else int(handles)
                if 0 <= handle < MOST and (found := take(handle, address)) >= 0:
                    return found
            return self._walk(name, handles)

        return walk

    @cached_property
    def _pinned(self) -> Any:
        return self._state.pin(lambda its: ())

    def _walk(self, name: str, handles: Any) -> Any:
        """Any handles for a step, checked."""
        step, state = self._declared.steps[name], self._state
        asked = arguments.integers(name, handles)
        rows = np.require(np.atleast_1d(asked), np.int64, ["C", "W"])  # as the walk is compiled for
        found = np.empty(len(rows), HANDLE_TYPES.get(step.target, np.int64))
        walk, records = self._declared.walks[name], state.records

        def all_are_there(begin: int, end: int, _: int) -> bool:
            return walk(rows[begin:end], found[begin:end], *records) == end - begin

        if not all(in_slices(all_are_there, len(rows))) or step.source == "vertex":
            state.require(step.source, rows)
        return found if asked.ndim else int(found[0])

    # What follows from them ------------------------------------------------------------------

    def handles(self, element: str) -> Array:
        """The handles of all elements of one kind; KeyError for no such kind."""
        if element not in ELEMENTS:
            raise KeyError(element)
        return self.edges() if element == "edge" else self._state.live(element)

    def edges(self) -> Indices:
        """(n_edges,): each undirected edge once, ascending; searched for if none is recorded."""
        recorded = self._state.storage.edges(self._state.records)
        return each_once(self.ask("face_edges").values) if recorded is None else recorded

    def count_edges(self) -> int:
        """Search for the edges where their number is not known yet; operations keep it up."""
        counts = self._state.records.counts
        if counts[EDGES] == UNKNOWN:
            counts[EDGES] = len(self.edges())
        return int(counts[EDGES])

    def find_edge(self, a: Any, b: Any) -> int | None:
        """See ``Structure.find_edge``."""
        find, address = self._find_edge
        a, b = integer("find_edge", "vertex", a), integer("find_edge", "vertex", b)
        found = find(a, b, address)
        if found >= 0:
            return found
        self._state.require("vertex", np.array([a, b]))
        self._state.widen()
        found = find(a, b, address)
        return None if found < 0 else found

    @cached_property
    def _find_edge(self) -> tuple[Callable[[int, int, Any], int], Any]:
        """The function, and the address of what it works on."""
        state, k = self._state, self._declared.kernels
        ends = state.storage.row(2, HANDLE_TYPES["edge"])
        pinned = state.pin(lambda its: (its.out["edge"], ends))
        uses = self._declared.queries["vertex_edges"]
        find = uses.find_edge(pinned, k["vertex_exists"], k["edge_vertices"])
        return self._prepared("vertex_edges", find), pinned.address

    def copy_touched(self, touched: ArrayLike, points: Points, indices: Handles) -> None:
        """See ``Structure.copy_touched``."""
        entries, state = np.asarray(touched, np.int64), self._state
        copy = self._declared.copy_touched
        done = copy(entries, points, indices, state.out["face"], *state.records)
        if done < len(entries):
            kind = "vertices" if entries[done] & 7 < FACE else "faces"
            rows = {kind: entries[done : done + 1] >> 3}
            raise MeshError("no row for what an edit touched", **rows)

    # For measuring -----------------------------------------------------------------------------

    def sweep(self, name: str, handles: Array) -> Sweep:
        """See ``Structure.prepare_sweep``."""
        wanted, out = self._ready(name, handles)
        self.count_edges()
        self._state.prepare([name])
        loop, counts = self._declared.queries[name].sweep, self._state.records.counts
        return Sweep(loop, wanted, out, self._state, counts.tobytes())

    def work(self, name: str, handles: Array) -> Indices:
        """See ``Structure.work``."""
        return self._declared.queries[name].work(*self._ready(name, handles), self._state.records)

    def reads(self, name: str, handle: int, fields: Sequence[Field]) -> list[Read]:
        """See ``Structure.reads``."""
        (wanted,), out = self._ready(name, [handle])
        state = self._state
        state.prepare([name])
        return self._declared.queries[name].reads(int(wanted), out, state.records, fields)

    def _ready(self, name: str, handles: ArrayLike) -> tuple[Array, Any]:
        """Handles that were checked, and scratch of its own for the answers to each.

        Other threads may ask meanwhile.
        """
        wanted, target = self._checked(name, handles), QUERIES[name].target
        self._state.widen()
        return wanted, self._state.storage.row(len(self._state.out[target]), HANDLE_TYPES[target])
