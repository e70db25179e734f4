"""The operations of the contract, and who is told of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.authoring.kernels import SIDES, VALENCE, Kernel
from hem.authoring.operations import ENTRIES, OPERATIONS, WIDTH, Operation
from hem.authoring.records import compacted
from hem.authoring.topology import (
    BETWEEN,
    COMMON_NEIGHBOR,
    NEEDS_ROOM,
    NO_EDGE,
    NOT_AN_END,
    NOT_FINITE,
    REFUSALS,
)
from hem.contract import arguments
from hem.contract.queries import ELEMENTS
from hem.contract.queryable import Queryable
from hem.contract.removal import Removal, remaining, removing, vanishing_edges
from hem.edit import Edit, Remapping
from hem.engine.uses import CHECK, DO, MODE, PERSIST, Uses
from hem.errors import MeshError, TopologyError

Array = NDArray[Any]

Algorithm = Callable[[Mapping[str, Kernel], Mapping[str, Kernel]], Kernel]
"""Makes an algorithm of one structure's queries and operations, see ``Editable.run``."""


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


class Prepared(NamedTuple):
    """Operations that only wait to be run."""

    perform: Callable[[int], int]
    pinned: Any
    task: Array
    results: Array
    """(n,): what became of each; a refusal is negative."""

    def check(self) -> NDArray[np.bool_]:
        """Change nothing -> (n,) which of them would be done."""
        self.task[MODE] = CHECK
        self.perform(self.pinned.address)
        self.task[MODE] = PERSIST
        return self.results >= 0

    def run(self) -> None:
        """Do them all, but those that are refused; RuntimeError if not all could be tried."""
        if self.perform(self.pinned.address) < len(self.results):
            raise RuntimeError("there is no more room; prepare fewer operations at a time")


class Editable(Queryable):
    """What a mesh can have done to it.

    Each operation checks first. If it may not be done, it raises TopologyError with the reason and
    the elements, and nothing has changed; so it does for a handle that names nothing (any more).
    MeshError is raised for arguments that are no handles or positions at all. Handles of untouched
    elements stay valid; new vertices and faces take the next index.
    """

    operations: ClassVar[Mapping[str, Operation]] = OPERATIONS
    """What can be done to this structure, by name."""

    _operation_uses: ClassVar[dict[str, Uses]]
    _algorithms: ClassVar[dict[Algorithm, Uses]]

    # One at a time ---------------------------------------------------------------------------

    def split_edge(self, edge: int, point: ArrayLike) -> Edit:
        """Put a new vertex on an edge; each face there becomes two. The point may lie anywhere.

        Interior: 1 vertex, 3 edges and 2 faces more; border: 1, 2 and 1. Cost O(1) where edges are
        recorded, else that of finding the faces: O(n_ev) or O(n_t). Thesis 4.1.
        """
        return self._do["split_edge"](edge, point)

    def split_face(self, face: int, point: ArrayLike) -> Edit:
        """Put a new vertex into a face, which becomes three.

        1 vertex, 3 edges and 2 faces more. Cost O(1). Thesis 4.3.
        """
        return self._do["split_face"](face, point)

    def collapse_edge(self, edge: int, keep: int | None = None) -> Edit:
        """Merge one end of an edge into the other, ``keep``, which stays where it is.

        ``keep`` is ``edge_vertices(edge)[1]`` unless it is said. Interior: 1 vertex, 3 edges and 2
        faces fewer; border: 1, 2 and 1. Cost O(n_ev), or O(n_t) where neighbors are searched for.
        Thesis 4.2; refused as ``hem.authoring.topology`` says.
        """
        return self._do["collapse_edge"](edge, None, -1 if keep is None else keep)

    def flip_edge(self, edge: int) -> Edit:
        """Turn an edge inside the two faces at it, so that it joins their other two corners.

        No count changes; a second flip undoes the first. Cost O(1) where edges are recorded, and
        to see that no edge is there yet O(the smaller valence of the two corners).
        """
        return self._do["flip_edge"](edge)

    def add_face(self, a: int, b: int, c: int) -> Edit:
        """Make a face of three vertices, counterclockwise. 1 face and 0 to 3 edges more.

        Every corner must be without faces or share an edge with the surface. Cost O(n_ev).
        """
        return self._do["add_face"](a, None, b, c)

    def remove_face(self, face: int) -> Edit:
        """Take a face away. 1 face and 0 to 3 edges fewer; vertices stay. Cost O(n_ev)."""
        return self._do["remove_face"](face)

    def move_vertex(self, vertex: int, point: ArrayLike) -> Edit:
        """Give a vertex another position. Cost O(1)."""
        return self._do["move_vertex"](vertex, point)

    def add_vertex(self, point: ArrayLike) -> Edit:
        """Make a vertex that no face uses yet. 1 vertex more. O(1), as none is searched for."""
        return self._do["add_vertex"](-1, point)

    def can_collapse_edge(self, edge: int) -> bool:
        """Whether ``collapse_edge`` would do it. Raises TopologyError if there is no such edge."""
        return self._may("collapse_edge", edge)

    def can_flip_edge(self, edge: int) -> bool:
        """Whether ``flip_edge`` would do it. Raises TopologyError if there is no such edge."""
        return self._may("flip_edge", edge)

    # Many at once ----------------------------------------------------------------------------

    def split_edges(self, edges: ArrayLike, points: ArrayLike) -> NDArray[np.int32]:
        """Split different edges (k,) at points (k, 3), in order -> the new vertices (k,) int32.

        All are checked before any is split. Subscribers hear of one edit.
        """
        handles = arguments.handles("split_edges", edges)
        return self._all("split_edges", "split_edge", handles, points, self._edge_names(handles))

    def split_faces(self, faces: ArrayLike, points: ArrayLike) -> NDArray[np.int32]:
        """Split different faces (k,) at points (k, 3), in order -> the new vertices (k,) int32.

        All are checked before any is split. Subscribers hear of one edit.
        """
        handles = arguments.handles("split_faces", faces)
        return self._all("split_faces", "split_face", handles, points, handles)

    def split_all_faces(self) -> NDArray[np.int32]:
        """Split every face at its centroid -> the new vertices. Thrice as many faces. O(n_t)."""
        faces = self.faces()
        corners = self.face_vertices(faces).values.reshape(-1, 3)
        centroids = self.points[corners].mean(axis=1, dtype=np.float64)
        return self._all("split_all_faces", "split_face", faces, centroids, faces)

    def remove_faces(self, faces: ArrayLike) -> None:
        """Take different faces (k,) away, all at once or none; vertices stay.

        Refused where two fans of what is left would meet in one vertex. Subscribers hear of one
        edit. Cost: that of ``vertex_faces`` at all the corners.
        """
        handles = arguments.handles("remove_faces", faces)
        self._require_different("remove_faces", "face", handles, handles)
        if not len(handles):
            return
        left = remaining(self, handles)
        pinched = left.pinched()
        if len(pinched):
            raise TopologyError(f"cannot remove_faces: {REFUSALS[BETWEEN]}", vertices=pinched)
        vertices, first = np.unique(left.vertex, return_index=True)
        anchors = np.stack([vertices, left.face[first]], axis=1)
        vanishing = np.array([vanishing_edges(self, handles, left)])
        log = np.zeros(len(handles) + ENTRIES, np.int64)
        self._count_edges()
        self.run(removing, Removal(handles, anchors, vanishing, log))
        self.tell("remove_faces", log[1 : log[0] + 1])

    def move_vertices(self, vertices: ArrayLike, points: ArrayLike) -> None:
        """Give different vertices (k,) the positions (k, 3). One edit. Cost O(k)."""
        handles = arguments.handles("move_vertices", vertices)
        self._all("move_vertices", "move_vertex", handles, points, handles)

    def collapse_edges(self, edges: ArrayLike, keep: ArrayLike | None = None) -> NDArray[np.bool_]:
        """Collapse edges (k,) in order, skipping what is gone or refused -> which were done.

        ``keep``: (k,) the ends that stay, each ``edge_vertices(edge)[1]`` unless it is said. Edges
        at a merged vertex live on where edges are recorded; named by their ends they are gone.
        Subscribers hear of one edit.
        """
        handles = arguments.handles("collapse_edges", edges)
        ends = (
            np.full(len(handles), -1) if keep is None else arguments.handles("collapse_edges", keep)
        )
        if len(ends) != len(handles):
            raise MeshError(
                f"collapse_edges takes one vertex to keep per edge, not {len(ends)} "
                f"for {len(handles)}"
            )
        results, log = self._run(
            "collapse_edge", arguments.rows(handles, ends), arguments.NO_POINT, PERSIST
        )
        self._publish(Edit("collapse_edges", -1, log))
        return results >= 0

    def compact(self) -> Remapping:
        """Drop what is dead and the room for more; handles change -> the old ones to the new ones.

        Elements keep their order. Cost O(n_v + n_t).
        """
        self._count_edges()
        self.records, number = self._compacted()
        for pinned, scratch in self._pins:
            pinned.replace(*self.records, *scratch())
        vertices = number["vertex"].astype(np.int32)
        faces = next(number[it] for it in ("face", "triangle") if it in number).astype(np.int32)
        remapping = Remapping(vertices, faces, lambda edges: self._renumbered(edges, number))
        edit = Edit("compact", -1, np.zeros(0, np.int64))
        edit.remapping = remapping
        self._publish(edit)
        return remapping

    def _compacted(self) -> tuple[Any, dict[str, Array]]:
        """The live records without gaps, and the new number of each old one by kind."""
        return compacted(self.records, self.fields)

    def _renumbered(self, edges: ArrayLike, number: Mapping[str, Array]) -> NDArray[np.int64]:
        recorded = next(it for it in ("half_edge", "edge") if it in number)
        return number[recorded][np.asarray(edges, np.int64)].astype(np.int64)

    # Following -------------------------------------------------------------------------------

    def subscribe(self, callback: Callable[[Edit], Any]) -> Callable[[], None]:
        """Have ``callback`` called with every ``Edit`` once it is done -> a way to end that.

        All are called, in the order they subscribed, even if one of them raises; what the first of
        them raised is raised then.
        """
        self._subscribers.append(callback)

        def unsubscribe() -> None:
            if callback in self._subscribers:
                self._subscribers.remove(callback)

        return unsubscribe

    @cached_property
    def _subscribers(self) -> list[Callable[[Edit], Any]]:
        return []

    def _publish(self, edit: Edit) -> None:
        failures = []
        for callback in tuple(self._subscribers):
            try:
                callback(edit)
            except Exception as failure:
                failures.append(failure)
        if failures:
            raise failures[0]

    def copy_touched(
        self, touched: ArrayLike, points: NDArray[np.float32], indices: NDArray[np.int32]
    ) -> None:
        """Write what an edit touched into the arrays of a render mesh, clockwise. O(edit).

        ``points`` (n, 3) and ``indices`` (m, 3) have a row for every vertex and face there ever
        was; what is dead becomes zeros.
        """
        entries, out = np.asarray(touched, np.int64), self._out["face"]
        self._copy_touched(entries, points, indices, out, *self.records)

    @cached_property
    def _copy_touched(self) -> Callable[..., None]:
        uses, k = self._uses["face_vertices"], self.kernels
        return uses.copy_touched(k["face_exists"], k["coordinate"])

    # Algorithms of one's own -----------------------------------------------------------------

    def run(self, make: Algorithm, plan: Any) -> int:
        """Run an algorithm over this mesh in one go, compiled where the structure is.

        ``make(queries, operations)`` gets the kernels of this structure by name and makes one of
        them, ``algorithm(m, plan) -> result``; it is asked once per structure. ``plan`` is a
        ``NamedTuple`` of arrays. Operations need room and scratch, see ``scratch``, and are told to
        subscribers by ``tell``.
        """
        return int(type(self)._algorithm(make).run(plan, *self.records))

    def scratch(self, splits: int) -> tuple[Any, Array]:
        """Make room for so many splits -> scratch for all of them, and a log.

        Cost O(1) per split in the long run.
        """
        self._count_edges()
        self._make_room(splits, 2 * splits)
        if "_out" not in self.__dict__:
            self._out = self._scratch(max(splits, self.n_faces // 8))
        valence = int(self.records.counts[VALENCE]) + splits + 1
        if WIDTH * (valence + 1) > len(self._out["edge"]):
            self._out.update(self._scratch(max(splits, self.n_faces // 8)))
            self._repin()
        return self._out["edge"], np.zeros(ENTRIES * (splits + 2), np.int64)

    def tell(self, kind: str, touched: Array) -> None:
        """Tell subscribers of one edit, by the log of what an algorithm touched."""
        if self._subscribers:
            self._publish(Edit(kind, -1, touched))

    @classmethod
    def _algorithm(cls, make: Algorithm) -> Uses:
        if make not in cls._algorithms:
            operations = {name: uses.kernel for name, uses in cls._operation_uses.items()}
            made = make(cls.kernels, operations)
            cls._algorithms[make] = cls.uses_type(made, cls.records_type)
        return cls._algorithms[make]

    # Measuring -------------------------------------------------------------------------------

    def reserve(self, splits: int) -> None:
        """Make room for so many splits at once, so that none of them has to. Cost O(n_v + n_t)."""
        self._make_room(splits, 2 * splits)

    def prepare(self, operation: str, args: ArrayLike, points: ArrayLike | None = None) -> Prepared:
        """Have operations ready to be run in one compiled loop, untold to anyone: for measuring.

        ``args``: (n,) first handles, or (n, 3) all of them. Refused ones are passed over. There is
        room for them all from here on; the arrays must stay the same until it is run. Raises
        KeyError for no operation.
        """
        rows = np.asarray(args, np.int64)
        rows = arguments.rows(rows) if rows.ndim == 1 else np.ascontiguousarray(rows)
        n, bound = len(rows), self._bound[operation]
        vertices, faces = self.operations[operation].growth
        self._make_room(vertices * n, faces * n)
        self._out.update(self._scratch(2 * n))  # an operation adds at most 2 to a valence
        self._repin()
        positions = (
            arguments.NO_POINT if points is None else arguments.positions("prepare", points, n)
        )
        valence = int(self.records.counts[VALENCE])
        entries = n * (2 * valence + ENTRIES) + 2 * (valence + 2 * n + ENTRIES)
        results, log = np.zeros(n, np.int64), np.empty(entries, np.int64)
        task = np.array([PERSIST, 0, n])
        scratch = task, rows, positions, results, self._at, self._out["edge"], log
        return Prepared(bound.perform, self.pinning(*self.records, *scratch), task, results)

    def operation_work(self, operation: str, *args: int, point: ArrayLike = (0, 0, 0)) -> int:
        """Do one operation uncompiled -> the array elements it read and wrote, exactly.

        Arguments as for the method of that name, which says what it raises; KeyError for no
        operation.
        """
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

    # Behind the contract ---------------------------------------------------------------------

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
            if self._subscribers:
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
        task[MODE] = CHECK
        if not perform(pinned.address) and result[0] == NEEDS_ROOM:
            self._make_way(operation)
            perform(pinned.address)
        task[MODE] = DO
        if result[0] == NO_EDGE:
            raise self._refusal(operation, NO_EDGE, args)
        return bool(result[0] >= 0)

    def _make_way(self, operation: str) -> None:
        """Make room for what one operation may need."""
        more = int(self.records.counts[SIDES]) - 3
        vertices, faces = self.operations[operation].growth
        self._make_room(vertices, faces + more * self.operations[operation].grows_with_sides)
        self._widen()
        neighbors = len(self._out["edge"]) // WIDTH
        if len(self._log) < 2 * neighbors + 2 * ENTRIES:
            self._log = memoryview(np.zeros(2 * neighbors + 2 * ENTRIES, np.int64).data)
            self._repin()

    def _all(
        self, called: str, operation: str, handles: Array, points: ArrayLike, names: Array
    ) -> NDArray[np.int32]:
        """Do an operation for all handles, or for none if one is refused -> the vertices."""
        positions = arguments.positions(called, points, len(handles))
        element = self.operations[operation].element
        self._require_different(called, element, handles, names)
        args = arguments.rows(handles)
        if element == "edge" and self.emulated:
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
        """Raise for the first row of ``args`` (n, 3) that would be refused; change nothing.

        Where edges are recorded a live one can always be split. Else it may not even be one.
        """
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
        words, handle = REFUSALS[code], int(args[0])
        if code == NOT_FINITE:
            return MeshError(words)
        if operation == "add_face":
            return TopologyError(f"cannot {operation}: {words}", vertices=[int(v) for v in args])
        element = self.operations[operation].element
        if element != "edge" or code == NO_EDGE:
            many = ELEMENTS.get(element, "half_edges")
            return TopologyError(f"cannot {operation}: {words}", **{many: [handle]})
        ends = self.edge_vertices(handle)
        elements = {"edges": ends[None, :]}
        if code == NOT_AN_END:
            elements["vertices"] = np.array([args[1]])
        if code == COMMON_NEIGHBOR:
            a, b = (self.vertex_vertices(int(v)) for v in ends)
            beside = self.face_vertices(self.edge_faces(handle)).values
            elements["vertices"] = np.setdiff1d(np.intersect1d(a, b), beside)
        return TopologyError(f"cannot {operation}: {words}", **elements)

    def _edge_names(self, handles: Array) -> Array:
        return handles
