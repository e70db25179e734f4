"""How an operation is done: checked, tried, given room where there is none, and logged.

And algorithms of one's own, written over the queries and operations of any structure.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Handles
from hem.authoring import (
    ELEMENTS,
    ENTRIES,
    NEEDS_ROOM,
    OPERATIONS,
    SIDES,
    WIDTH,
    WORDS,
    Kernel,
    Kernels,
    Operation,
    Refusal,
)
from hem.contract import arguments
from hem.contract.following import Following
from hem.edit import Edit
from hem.engine import CHECK, DO, MODE, Uses
from hem.errors import MeshError, TopologyError

Algorithm = Callable[[Kernels, Kernels], Kernel]
"""Makes an algorithm of one structure's queries and operations, see ``Algorithms.run``."""


class Bound(NamedTuple):
    """An operation bound to a structure: where its arguments and its result lie.

    Views, as they are faster to write and read than arrays.
    """

    perform: Callable[[int], int]
    pinned: Any
    task: memoryview
    args: memoryview
    point: memoryview
    result: memoryview


class Operating(Following, abstract=True):
    """Operations bound to a structure."""

    operations: ClassVar[Mapping[str, Operation]] = OPERATIONS
    """What can be done to this structure, by name."""

    _operation_uses: ClassVar[dict[str, Uses]]

    _lasting_uses: ClassVar[Mapping[str, Uses]] = {}
    """The uses of those on edges for lasting names, where handles are not stable."""

    def operate(self, operation: str, *handles: int, point: ArrayLike | None = None) -> Edit:
        """Do an operation by its name, as the method of that name does where there is one.

        ``handles``: one to three. Raises KeyError for no operation.
        """
        first, *more = handles or (-1,)
        return self._do[operation](first, point, *more)

    @cached_property
    def _at(self) -> Any:
        """Scratch for the parts of a diamond."""
        return np.zeros(6, np.int64)

    @cached_property
    def _log(self) -> memoryview:
        """What the operation under way has touched. Views are faster to read than arrays."""
        return memoryview(np.zeros(1, np.int64).data)

    @cached_property
    def _bound(self) -> dict[str, Bound]:
        """Every operation, bound; by name."""
        self._count_edges()
        return {operation: self._bind(operation) for operation in self.operations}

    def _bind(self, operation: str) -> Bound:
        task, args = np.array([DO, 0, 1]), np.full((1, 3), -1, np.int64)
        points, result = np.zeros((1, 3), np.float32), np.zeros(1, np.int64)
        own = task, args, points, result, self._at
        pinned = self._pin(lambda: (*own, self._out["edge"], np.asarray(self._log)))
        perform = self._operation_uses[operation].perform(pinned)
        views = [memoryview(it.reshape(-1).data) for it in own[:4]]
        return Bound(perform, pinned, views[0], views[1], views[2], views[3])

    @cached_property
    def _do(self) -> dict[str, Callable[..., Edit]]:
        """Every operation as a function of its first handle, a point and two more handles."""
        return {operation: self._doing(operation) for operation in self.operations}

    def _doing(self, operation: str) -> Callable[..., Edit]:
        perform, pinned, _, args, position, result = self._bound[operation]
        address, names_a_vertex = pinned.address, self.operations[operation].names_a_vertex
        takes_a_point = self.operations[operation].takes_a_point

        def do(a: Any, point: Any = None, b: Any = None, c: Any = None) -> Edit:
            # What programs do a million times takes no detours here.
            try:
                args[0] = a
                if b is not None:
                    args[1] = b
                    if c is not None:
                        args[2] = c
                if takes_a_point:
                    place = point.tolist() if type(point) is np.ndarray else point
                    position[0], position[1], position[2] = place
            except (TypeError, ValueError, OverflowError) as error:
                raise arguments.refusal(operation, (a, b, c), point) from error
            if not perform(address) and result[0] == NEEDS_ROOM:
                self._make_way(operation)
                perform(address)
            vertex = result[0]
            if vertex < 0:
                raise self._refusal(operation, vertex, args)
            log = self._log
            touched = log[1 : log[0] + 1].tolist()
            edit = Edit(operation, vertex if names_a_vertex else -1, touched)
            if self._subscribers or self._attributes:
                self._publish(edit)
            return edit

        return do

    def _may(self, operation: str, edge: Any) -> bool:
        perform, pinned, task, args, _, result = self._bound[operation]
        try:
            args[0] = edge
            args[1] = -1
        except (TypeError, ValueError, OverflowError) as error:
            raise arguments.refusal(operation, (edge,), None) from error
        try:
            task[MODE] = CHECK
            if not perform(pinned.address) and result[0] == NEEDS_ROOM:
                self._make_way(operation)
                perform(pinned.address)
        finally:  # interrupted or not: or nothing would ever be done again
            task[MODE] = DO
        if result[0] == Refusal.NO_EDGE:
            raise self._refusal(operation, Refusal.NO_EDGE, args)
        return bool(result[0] >= 0)

    def _make_way(self, operation: str) -> None:
        """Make room for what one operation may need."""
        more = int(self.records.counts[SIDES]) - 3
        vertices, faces = self.operations[operation].growth
        self._make_room(vertices, faces + more * self.operations[operation].grows_with_sides)
        self._widen()
        neighbors = len(self._out["edge"]) // WIDTH
        entries = max(2 * neighbors, 3 * (more + 3)) + 2 * ENTRIES  # a split face: three per corner
        if len(self._log) < entries:
            self._log = memoryview(np.zeros(entries, np.int64).data)
            self._repin()

    def _all(
        self, called: str, operation: str, handles: Array, points: ArrayLike, names: Array
    ) -> Handles:
        """Do an operation for all handles, or for none if one is refused -> the vertices."""
        positions = arguments.positions(called, points, len(handles))
        element = self.operations[operation].element
        self._require_different(called, element, handles, names)
        args = arguments.rows(handles)
        if element == "edge":
            self._require_allowed(operation, args, positions)
        results, log = self._run(operation, args, positions)
        self._publish(Edit(called, -1, log))
        return results.astype(np.int32)

    def _require_different(self, called: str, element: str, handles: Array, names: Array) -> None:
        """Raise for handles that name nothing, and for elements ``names`` that are named twice."""
        try:
            self._check_handles(element, handles)
        except MeshError as error:
            raise TopologyError(f"{called}: {error.reason} (any more)", **error.elements) from None
        many = ELEMENTS[element]
        again = np.delete(handles, np.unique(names, return_index=True)[1])
        if len(again):
            raise TopologyError(f"{called} takes different {many}, each once", **{many: again})

    def _require_allowed(self, operation: str, args: Array, positions: Array) -> None:
        """Raise for the first row of ``args`` (n, 3) that would be refused; change nothing."""
        results, _ = self._run(operation, args, positions, CHECK)
        refused = np.flatnonzero(results < 0)
        if len(refused):
            raise self._refusal(operation, int(results[refused[0]]), args[refused[0]].tolist())

    def _run(
        self, operation: str, args: Array, points: Array, mode: int = DO
    ) -> tuple[Array, Array]:
        """Do an operation for every row of ``args`` (n, 3) -> the results (n,) and the log."""
        perform, n = self._bound[operation].perform, len(args)
        results, logs, done = np.zeros(n, np.int64), [], 0
        vertices, faces = self.operations[operation].growth
        if operation in self._lasting_uses:
            args = np.column_stack([self._lasting_names(args[:, 0]), args[:, 1:]])
            perform = self._lasting_uses[operation].perform(self._bound[operation].pinned)
        if mode == DO:
            # A face of more corners needs the edges of so many triangles.
            self._make_room(vertices * n, (faces + args.shape[1] - 3) * n)
        while True:
            log = np.empty(ENTRIES * (n + 1) + 2 * len(self._log), np.int64)
            task = np.array([mode, done, n])
            scratch = task, args, points, results, self._at, self._out["edge"], log
            pinned = self.pinning(*self.records, *scratch)
            done = perform(pinned.address)
            logs.append(log[1 : log[0] + 1])
            if done == n or results[done] != NEEDS_ROOM:
                return results, np.concatenate(logs)
            self._make_way(operation)

    def _refusal(self, operation: str, code: int, args: Any) -> MeshError | TopologyError:
        """The error for a code, with the elements as the user knows them."""
        words, handle = WORDS[code], int(args[0])
        if code == Refusal.NOT_FINITE:
            return MeshError(words)
        if operation == "add_face":
            return TopologyError(f"cannot {operation}: {words}", vertices=[int(v) for v in args])
        element = self.operations[operation].element
        if element != "edge" or code == Refusal.NO_EDGE:
            many = ELEMENTS.get(element, "half_edges")
            return TopologyError(f"cannot {operation}: {words}", **{many: [handle]})
        ends = self.edge_vertices(handle)
        elements = {"edges": ends[None, :]}
        if code == Refusal.NOT_AN_END:
            elements["vertices"] = np.array([args[1]])
        if code == Refusal.COMMON_NEIGHBOR:
            a, b = (self.vertex_vertices(int(v)) for v in ends)
            beside = self.face_vertices(self.edge_faces(handle)).values
            elements["vertices"] = np.setdiff1d(np.intersect1d(a, b), beside)
        return TopologyError(f"cannot {operation}: {words}", **elements)


class Algorithms(Operating, abstract=True):
    """What is run over a mesh in one go, beside single queries and operations."""

    uses_type: ClassVar[type[Uses]] = Uses
    """How kernels become what is called."""

    _algorithms: ClassVar[dict[Algorithm, Uses]]

    def run(self, make: Algorithm, plan: Any) -> int:
        """Run an algorithm over this mesh in one go, compiled where the structure is.

        ``make(queries, operations)`` gets the kernels of this structure by name and makes one of
        them, ``algorithm(m, plan) -> result``; it is asked once per structure. ``plan`` is a
        ``NamedTuple`` of arrays. Who writes an algorithm checks the handles in it, for which there
        are kernels such as ``vertex_exists``. Operations need room and scratch, see ``scratch``,
        and are told to subscribers by ``tell``.
        """
        return int(type(self)._algorithm(make).run(plan, *self.records))

    def scratch(self, splits: int, operations: int | None = None) -> tuple[Any, Array]:
        """Make room for so many splits -> scratch and a log, for all of them or ``operations``.

        Cost O(1) per split in the long run.
        """
        more = splits if operations is None else operations
        self._count_edges()
        self._make_room(splits, 2 * splits)
        self._widen(more)
        return self._out["edge"], np.zeros(ENTRIES * (more + 2), np.int64)

    @property
    def followed(self) -> bool:
        """Whether anyone is to be told of edits: subscribers or attributes."""
        return bool(self._subscribers or self._attributes)

    def tell(self, kind: str, touched: Array) -> None:
        """Tell subscribers of one edit, by the log of what an algorithm touched."""
        if self.followed:
            self._publish(Edit(kind, -1, touched))

    @classmethod
    def _algorithm(cls, make: Algorithm) -> Uses:
        if make not in cls._algorithms:
            operations = {name: uses.kernel for name, uses in cls._operation_uses.items()}
            made = make(cls.kernels, operations)
            cls._algorithms[make] = cls.uses_type(made, cls.records_type)
        return cls._algorithms[make]
