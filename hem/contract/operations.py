"""How an operation is done: checked, tried, given room where there is none, and logged."""

from collections.abc import Callable
from functools import cached_property
from threading import RLock
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Bools, Handles
from hem.authoring import (
    ELEMENTS,
    ENTRIES,
    FACE_END,
    NEEDS_ROOM,
    SIDES,
    VALENCE,
    VERTEX_END,
    VERTICES,
    WIDTH,
    WORDS,
    Refusal,
)
from hem.contract import arguments
from hem.contract.following import Followers
from hem.contract.queries import Queries
from hem.contract.state import State
from hem.edit import Edit
from hem.engine import CHECK, DO, ENDED, FORGET, KEEP, MODE, PERSIST, TELL
from hem.errors import MeshError, TopologyError


class Bound(NamedTuple):
    """An operation bound to a mesh: where its arguments and its result lie.

    Views, as they are faster to write and read than arrays.
    """

    perform: Callable[[int], Array]
    address: Any
    task: memoryview
    args: memoryview
    point: memoryview
    result: memoryview


class Prepared(NamedTuple):
    """Operations that only wait to be run; ``results`` (n,): what became of each, < 0: refused."""

    perform: Callable[[int], Array]
    pinned: Any
    task: Array
    results: Array

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
        self.perform(self.pinned.address)
        if self.task[ENDED] < len(self.results):
            raise RuntimeError("there is no more room; prepare fewer operations at a time")


class Methods(dict[str, Callable[..., Edit]]):
    """Operations as functions, by name: each is made when it is first asked for.

    To bind one takes as long as to do some fifty.
    """

    def __init__(self, make: Callable[[str], Callable[..., Edit]]) -> None:
        self._make = make

    def __missing__(self, operation: str) -> Callable[..., Edit]:
        made = self[operation] = self._make(operation)
        return made


class Operations:
    """The operations on one mesh, by name."""

    def __init__(self, state: State, queries: Queries, followers: Followers) -> None:
        self._state, self._queries, self._followers = state, queries, followers
        self._operations = state.declared.operations
        self._known: dict[str, Bound] = {}
        self._asking = RLock()  # to ask whether something may be done is no operation

    # One at a time ---------------------------------------------------------------------------

    def method(self, operation: str) -> Callable[..., Edit]:
        """An operation as a function of its first handle, a point and two more handles."""
        publish = self._followers.publish
        subscribers, attributes = self._followers.subscribers, self._followers.attributes
        perform, address, _, args, position, result = self._bound(operation)
        names_a_vertex = self._operations[operation].names_a_vertex
        takes_a_point = self._operations[operation].takes_a_point

        def do(a: Any, point: Any = None, b: Any = ..., c: Any = ...) -> Edit:
            # What programs do a million times takes no detours here.
            try:
                if type(a) is bool:  # it would count as 1 or 0
                    raise TypeError
                args[0] = a
                if b is not ...:
                    if type(b) is bool or type(c) is bool:
                        raise TypeError
                    args[1] = b
                    if c is not ...:
                        args[2] = c
                if takes_a_point:
                    place = point.tolist() if type(point) is np.ndarray else point
                    position[0], position[1], position[2] = place
            except (TypeError, ValueError, OverflowError) as error:
                raise arguments.refusal(operation, (a, b, c), point) from error
            touched = perform(address)
            vertex = result[0]
            if vertex < 0:
                if vertex == NEEDS_ROOM:
                    self.make_way(operation)
                    touched = perform(address)
                    vertex = result[0]
                if vertex < 0:
                    raise self.refusal(operation, vertex, args)
            edit = Edit(operation, vertex if names_a_vertex else -1, touched)
            if subscribers or attributes:
                publish(edit)
            return edit

        return do

    def may(self, operation: str, edge: Any) -> bool:
        """Whether an operation on an edge would be done; TopologyError if there is no edge."""
        with self._asking:
            perform, address, task, args, _, result = self._bound(operation)
            try:
                if type(edge) is bool:
                    raise TypeError  # it would count as 1 or 0
                args[0] = edge
                args[1] = -1
            except (TypeError, ValueError, OverflowError) as error:
                raise arguments.refusal(operation, (edge,), None) from error
            try:
                task[MODE] = CHECK
                perform(address)
                if result[0] == NEEDS_ROOM:
                    self.make_way(operation)
                    perform(address)
            finally:  # interrupted or not: or nothing would ever be done again
                task[MODE] = DO
            if result[0] == Refusal.NO_EDGE:
                raise self.refusal(operation, Refusal.NO_EDGE, args)
            return bool(result[0] >= 0)

    def make_way(self, operation: str) -> None:
        """Make room for what one operation may need."""
        state = self._state
        state.make_room(*self._growth(operation))
        state.widen()
        neighbors = len(state.out["edge"]) // WIDTH
        corners = 3 * int(state.records.counts[SIDES])  # a split face: three entries for each
        state.lengthen(max(2 * neighbors, corners) + 2 * ENTRIES)

    def _growth(self, operation: str) -> tuple[int, int]:
        """How many vertices and faces one may create, at the largest face there is."""
        it, more = self._operations[operation], int(self._state.records.counts[SIDES]) - 3
        return it.growth[0], it.growth[1] + more * it.grows_with_sides

    def _bound(self, operation: str) -> Bound:
        """An operation, bound once."""
        if operation in self._known:
            return self._known[operation]
        self._queries.count_edges()
        state = self._state
        task, args = np.array([DO, 0, 1, TELL, 0, 0]), np.full((1, 3), -1, np.int64)
        points, result = np.zeros((1, 3), np.float32), np.zeros(1, np.int64)
        own = task, args, points, result, state.seen, state.at
        pinned = state.pin(lambda its: (*own, its.out["edge"], np.asarray(its.log)))
        perform = state.declared.perform(operation, pinned)
        views = [memoryview(it.reshape(-1).data) for it in own[:4]]
        bound = self._known[operation] = Bound(perform, pinned.address, *views)
        return bound

    # Many at once ----------------------------------------------------------------------------

    def all(self, called: str, operation: str, given: ArrayLike, points: ArrayLike) -> Handles:
        """Do an operation for all handles, or for none if one is refused -> the vertices."""
        handles, element = arguments.handles(called, given), self._operations[operation].element
        positions = arguments.positions(called, points, len(handles))
        self.require_different(called, element, handles)
        args = arguments.rows(handles)
        if element == "edge":
            results = self.run(operation, args, positions, CHECK)
            refused = np.flatnonzero(results < 0)
            if len(refused):
                first = refused[0]
                raise self.refusal(operation, int(results[first]), args[first].tolist())
        return self._told(called, operation, args, positions, DO).astype(np.int32)

    def require_different(self, called: str, element: str, given: ArrayLike) -> Array:
        """The handles (n,) int64; raises for those of nothing, and for one named twice."""
        handles = arguments.handles(called, given)
        try:
            self._state.require(element, handles)
        except MeshError as error:
            raise TopologyError(f"{called}: {error.reason} (any more)", **error.elements) from None
        names = self._state.edge_names(handles) if element == "edge" else handles
        if arguments.any_twice(names):
            again = np.delete(handles, np.unique(names, return_index=True)[1])
            many = ELEMENTS[element]
            raise TopologyError(f"{called} takes different {many}, each once", **{many: again})
        return handles

    def persist(self, called: str, operation: str, args: Array) -> Bools:
        """Do an operation for every row of ``args`` (n, 3) but those refused -> which were done."""
        return self._told(called, operation, args, arguments.NO_POINT, PERSIST) >= 0

    def _told(self, called: str, operation: str, args: Array, points: Array, mode: int) -> Array:
        """As ``run``, one edit -> the results. What is done before an interrupt is told."""
        logs: list[Array] = []
        try:
            results = self.run(operation, args, points, mode, logs)
            self._publish(called, logs)
        except BaseException:  # an interrupt, say, before anybody was told
            self._publish(called, logs)
            raise
        return results

    def _publish(self, called: str, logs: list[Array]) -> None:
        """Tell of one edit by its logs, which are forgotten as soon as anybody is told."""
        if logs:
            held = [*logs]  # freed when all are told, as that takes time to be interrupted in
            edit = Edit(called, -1, np.concatenate(held))
            logs.clear()
            self._followers.publish(edit)

    def one_by_one(self, do: Callable[..., Edit], args: Array) -> Bools:
        """As ``persist`` of one on edges, each an edit of its own."""
        names = self._state.storage.lasting_names(self._state.records, args[:, 0])
        results = np.ones(len(args), np.bool_)
        for i, (name, (_, b, c)) in enumerate(zip(names.tolist(), args.tolist(), strict=True)):
            before = int(self._state.records.counts[VERTICES])
            try:
                do(self._lasting_handle(name), None, b, c)
            except TopologyError:
                if self._state.records.counts[VERTICES] != before:  # it is a follower's
                    raise
                results[i] = False
        return results

    def _lasting_handle(self, name: int) -> int:
        """The handle of an edge by its lasting name; one that is refused where there is none."""
        if not self._state.declared.lasting:
            return name
        try:
            edge = self._queries.find_edge(name >> 32, name & 0xFFFFFFFF)
        except MeshError:  # an end is gone
            return -1
        return -1 if edge is None else edge

    def run(
        self, operation: str, args: Array, points: Array = arguments.NO_POINT, mode: int = DO,
        logs: list[Array] | None = None,
    ) -> Array:  # fmt: skip
        """Do an operation for every row of ``args`` (n, 3) -> the results (n,).

        What they touch is appended to ``logs``, also before an interrupt.
        Ends at one that is refused, unless the ``mode`` is another. Nobody is told, and where
        nobody follows, nothing is kept to tell: fresh memory for the log takes longer than it.
        """
        state, perform, n = self._state, self._bound(operation).perform, len(args)
        forgets = not self._followers
        results, done, logs = np.zeros(n, np.int64), 0, [] if logs is None else logs
        vertices, faces = self._operations[operation].growth
        lasting = operation in state.declared.lasting
        ahead = state.declared.operating[operation].ahead if n > 1 else 0
        if lasting:
            names = state.storage.lasting_names(state.records, args[:, 0])
            args = np.column_stack([names, args[:, 1:]])
        if mode == DO:
            # A face of more corners needs the edges of so many triangles.
            state.make_room(vertices * n, (faces + args.shape[1] - 3) * n)
        state.widen()  # corners are read ahead before an operation looks for scratch
        while True:
            entries = ENTRIES * (1 if forgets else n + 1) + 2 * len(state.log)
            log = np.empty(entries, np.int64)
            log[0] = 0
            task = np.array([mode, done, n, FORGET if forgets else KEEP, ahead, done])
            scratch = task, args, points, results, state.seen, state.at, state.out["edge"], log
            pinned = state.pinned_now(*scratch)
            if lasting:
                perform = state.declared.perform_lasting(operation, pinned)
            try:
                perform(pinned.address)
            finally:
                logs.append(log[1 : log[0] + 1])
            done = int(task[ENDED])
            if done == n or results[done] != NEEDS_ROOM:
                return results
            self.make_way(operation)

    def edit(self, called: str, operation: str, result: int, log: Any) -> Edit:
        """What subscribers are told of an operation, by the name of the method that was called."""
        names_a_vertex = self._operations[operation].names_a_vertex
        return Edit(called, result if names_a_vertex else -1, log)

    def refusal(
        self, operation: str, code: int, args: Any, called: str = ""
    ) -> MeshError | TopologyError:
        """The error for a code, with the elements as the user knows them."""
        called = called or operation
        words, handle, ask = WORDS[code], int(args[0]), self._queries.ask
        if code == Refusal.NOT_FINITE:
            return MeshError(words)
        if operation == "add_face":
            return TopologyError(f"cannot {operation}: {words}", vertices=[int(v) for v in args])
        element = self._operations[operation].element
        if element != "edge" or code == Refusal.NO_EDGE:
            many = ELEMENTS.get(element, "half_edges")
            return TopologyError(f"cannot {called}: {words}", **{many: [handle]})
        ends = self._edge_vertices(handle)
        elements = {"edges": ends[None, :]}
        if code == Refusal.NOT_AN_END and args[1] >= 0:
            elements["vertices"] = np.array([args[1]])
        if code == Refusal.COMMON_NEIGHBOR:
            a, b = ask("vertex_vertices", ends)
            beside = ask("face_vertices", ask("edge_faces", handle)).values
            elements["vertices"] = np.setdiff1d(np.intersect1d(a, b), beside)
        return TopologyError(f"cannot {called}: {words}", **elements)

    @cached_property
    def _edge_vertices(self) -> Any:
        return self._queries.method("edge_vertices")

    # For measuring -----------------------------------------------------------------------------

    def reserve(self, splits: int) -> None:
        """See ``Structure.reserve``."""
        counts = self._state.records.counts
        arguments.grown(splits, int(counts[VERTEX_END]), int(counts[FACE_END]))
        self._state.make_room(splits, 2 * splits)
        self._state.widen(splits)
        for operation in self._operations:
            self._bound(operation)
            self.make_way(operation)

    def prepare(self, operation: str, args: ArrayLike, points: ArrayLike | None) -> Prepared:
        """See ``Structure.prepare``."""
        given = arguments.integers(operation, args, (1, 2)).astype(np.int64)
        rows = arguments.rows(given) if given.ndim == 1 else np.ascontiguousarray(given)
        if rows.shape[1] < 3:
            raise MeshError(f"{operation} takes (n,) or (n, 3) handles, not {rows.shape}")
        state, perform, n = self._state, self._bound(operation).perform, len(rows)
        state.make_room(*(n * it for it in self._growth(operation)))
        state.count_valence()
        state.widen(2 * n)  # an operation adds at most 2 to a valence, if it merges nothing
        positions = arguments.NO_POINT
        if points is not None or self._operations[operation].takes_a_point:
            positions = arguments.positions(operation, () if points is None else points, n)
        valence = int(state.records.counts[VALENCE])
        entries = n * (3 * valence + ENTRIES) + 2 * (valence + 2 * n + ENTRIES)
        results, log = np.zeros(n, np.int64), np.empty(entries, np.int64)
        task = np.array([PERSIST, 0, n, KEEP, 0, 0])
        scratch = task, rows, positions, results, state.seen, state.at, state.out["edge"], log
        return Prepared(perform, state.pinned_now(*scratch), task, results)

    def work(self, operation: str, handles: tuple[int, ...], point: Any) -> int:
        """See ``Structure.operation_work``."""
        if not 1 <= len(handles) <= 3:
            raise MeshError(f"{operation} takes one to three handles, not {len(handles)}")
        element = self._operations[operation].element
        row = [arguments.integer(operation, element, it) for it in handles]
        (position,) = arguments.positions(operation, [point], 1)
        self._queries.count_edges()
        self.make_way(operation)
        state, row = self._state, [*row, -1, -1][:3]
        log = state.log
        log[0] = 0
        work = state.declared.operating[operation].operation_work
        result, accesses = work(row, position, state.out["edge"], log, state.records)
        if result < 0:
            raise self.refusal(operation, result, row)
        self._followers.publish(
            self.edit(operation, operation, result, log[1 : log[0] + 1].tolist())
        )
        return accesses
