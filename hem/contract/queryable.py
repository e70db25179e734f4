"""The queries of the contract, derived from a structure's kernels.

Records, fields and kernels are the structure's own; how they become methods stands here, and so do
the scratch for answers, the arrays pinned for compiled code, and room for more elements.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, ClassVar, Protocol, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.authoring.kernels import (
    EDGE_END,
    EDGE_GROWTH,
    EDGE_ROOM,
    EDGES,
    FACE_END,
    FACE_ROOM,
    FACES,
    SIDES,
    VALENCE,
    VERTEX_END,
    VERTEX_ROOM,
    VERTICES,
    Kernel,
)
from hem.authoring.operations import WIDTH
from hem.authoring.records import ENDS, UNKNOWN, Field, grown, live
from hem.contract.queries import ELEMENTS, QUERIES, Query
from hem.engine.pinned import Pinned
from hem.engine.slices import in_slices, slice_count
from hem.engine.uses import Uses, move
from hem.errors import MeshError
from hem.ragged import Ragged

Array = NDArray[Any]

MOST = 1 << 63
"""More than any handle."""

HANDLE_TYPES = {"vertex": np.int32, "edge": np.int64, "face": np.int32}
"""The type of the handles by kind of element."""


TYPICAL_NEIGHBORS = {"vertex": 7, "edge": 11, "face": 3}
"""Room to begin with for the answers to a batch, per element; it grows where it is too small."""


class QueryMethod(Protocol):
    """A query as a method: one handle -> 1-D array; an array of handles -> ``Ragged``."""

    @overload
    def __call__(self, handles: int) -> NDArray[Any]: ...
    @overload
    def __call__(self, handles: NDArray[Any] | list[int]) -> Ragged: ...


def _query_method(query: Query) -> Any:
    """The attribute ``Structure.vertex_faces`` and its like, bound once per structure."""

    def bound(self: Queryable) -> QueryMethod:
        target = query.target
        pinned = self._pin(lambda: (self._out[target],))
        single = self._uses[query.name].single(pinned, self.kernels[f"{query.source}_exists"])
        address, scratch, kept = pinned.address, self._out, self._kept(target)

        def ask(handles: Any) -> Any:
            # One plain integer is the way that programs take a million times: no detours here.
            if type(handles) is int and -MOST <= handles < MOST:
                count = single(handles, address)
                if count:
                    return kept(scratch[target][:count])
            return self._ask(query, handles)

        ask.__name__, ask.__doc__ = query.name, attribute.__doc__
        ask.__dict__["pinned"] = pinned  # lives as long as the address is in use
        return ask

    attribute = cached_property(bound)
    attribute.__doc__ = (
        f"{query.title}, of one {query.source} or of many.\n\n"
        "One handle gives a 1-D array, an array of handles (n,) a ``Ragged`` with n rows. Each\n"
        "neighbor comes once; around a vertex or face counterclockwise where the structure\n"
        "knows the order. Cost per handle: thesis, table 1. Raises MeshError for a handle that\n"
        f"names no {query.source} of this mesh."
    )
    return attribute


def _as_integer(handle: Any, query: Query) -> int:
    if isinstance(handle, np.ndarray) and handle.ndim == 0:
        handle = handle[()]
    if isinstance(handle, int | np.integer) and not isinstance(handle, bool):
        return int(handle)
    raise MeshError(
        f"{query.name} takes a {query.source} handle (an integer) or an array of them, "
        f"not {type(handle).__name__} {handle!r}"
    )


class Queryable(ABC):
    """The elements of a mesh and the queries for their neighbors.

    Not safe for single queries from several threads at once: they share one scratch array.
    """

    fields: ClassVar[tuple[Field, ...]]
    kernels: ClassVar[Mapping[str, Kernel]]
    emulated: ClassVar[frozenset[str]] = frozenset()
    """Queries answered without edge records: table 1's N/A."""

    records_type: ClassVar[type[Any]]
    """The `NamedTuple` of the structure's arrays, with from→to names."""

    pinning: ClassVar[type[Any]] = Pinned
    """How records and scratch are handed to kernels time and again."""

    uses_type: ClassVar[type[Uses]] = Uses
    """How kernels become what is called."""

    _uses: ClassVar[dict[str, Uses]]

    vertex_vertices: QueryMethod = _query_method(QUERIES["vertex_vertices"])
    vertex_edges: QueryMethod = _query_method(QUERIES["vertex_edges"])
    vertex_faces: QueryMethod = _query_method(QUERIES["vertex_faces"])
    edge_vertices: QueryMethod = _query_method(QUERIES["edge_vertices"])
    edge_edges: QueryMethod = _query_method(QUERIES["edge_edges"])
    edge_faces: QueryMethod = _query_method(QUERIES["edge_faces"])
    face_vertices: QueryMethod = _query_method(QUERIES["face_vertices"])
    face_edges: QueryMethod = _query_method(QUERIES["face_edges"])
    face_faces: QueryMethod = _query_method(QUERIES["face_faces"])

    def __init__(self, records: tuple[Any, ...]) -> None:
        self.records: Any = records

    # Elements --------------------------------------------------------------------------------

    @property
    def n_vertices(self) -> int:
        """Number of live vertices, unreferenced ones included."""
        return int(self.records.counts[VERTICES])

    @property
    def n_edges(self) -> int:
        """Number of live undirected edges."""
        self._count_edges()
        return int(self.records.counts[EDGES])

    @property
    def n_faces(self) -> int:
        """Number of live faces."""
        return int(self.records.counts[FACES])

    @property
    def points(self) -> NDArray[np.float32]:
        """(n, 3) float32: positions by vertex; those of dead ones are NaN.

        A view: ``move_vertex`` tells subscribers of a new position, writing here does not.
        """
        points: NDArray[np.float32] = self.records.vertex_point
        return points[: self.records.counts[VERTEX_END]]

    def vertices(self) -> NDArray[np.int32]:
        """(n_vertices,) int32: the handles of all live vertices, ascending."""
        return self._live("vertex")

    def edges(self) -> NDArray[np.int64]:
        """(n_edges,) int64: the handles of all live edges, ascending, each undirected edge once."""
        return np.unique(self.face_edges(self.faces()).values)

    def faces(self) -> NDArray[np.int32]:
        """(n_faces,) int32: the handles of all live faces, ascending."""
        return self._live("face")

    @property
    def face_end(self) -> int:
        """One past the largest face handle there ever was; for vertices that is len(points)."""
        return int(self.records.counts[FACE_END])

    @property
    def most_corners(self) -> int:
        """A bound on the corners of any face there ever was: 3 where all are triangles."""
        return int(self.records.counts[SIDES])

    def handles(self, element: str) -> NDArray[Any]:
        """The handles of all elements of one kind: ``vertex``, ``edge`` or ``face``."""
        every: dict[str, Callable[[], NDArray[Any]]] = {
            "vertex": self.vertices,
            "edge": self.edges,
            "face": self.faces,
        }
        return every[element]()

    def find_edge(self, a: int, b: int) -> int | None:
        """The handle of the edge between vertices ``a`` and ``b``, or None where there is none.

        Cost: that of ``vertex_edges``. Raises MeshError if ``a`` or ``b`` is no vertex.
        """
        self._check_handles("vertex", np.array([a, b]))
        self._widen()
        ends = np.empty(2, np.int64)
        found = self._find_edge(int(a), int(b), self._out["edge"], ends, *self.records)
        return None if found < 0 else int(found)

    # Measuring -------------------------------------------------------------------------------

    def sweep(self, query: str, handles: NDArray[Any]) -> int:
        """Answer ``query`` for every handle in one compiled loop, keeping nothing -> a checksum.

        What the experiments time; the handles are not checked. Raises KeyError for no query.
        """
        self._widen()
        out = self._out[QUERIES[query].target]
        return int(self._uses[query].sweep(handles, out, *self.records))

    def work(self, query: str, handles: NDArray[Any]) -> NDArray[np.int64]:
        """(n,) int64: elements of the structure's arrays read to answer ``query``, per handle.

        Exact and the same on every machine; runs uncompiled. Raises KeyError for no query.
        """
        self._widen()
        out = self._out[QUERIES[query].target]
        return self._uses[query].work(handles, out, self.records)

    # Behind the contract ---------------------------------------------------------------------

    def _count_edges(self) -> None:
        """Search for the edges where their number is not known yet; operations keep it up."""
        if self.records.counts[EDGES] == UNKNOWN:
            self.records.counts[EDGES] = len(self.edges())

    def _live(self, element: str) -> NDArray[np.int32]:
        """The indices of the live vertices or faces, ascending."""
        if self._any_dead(element):
            return np.flatnonzero(self._alive(element)).astype(np.int32)
        return np.arange(self.records.counts[ENDS[element]], dtype=np.int32)

    def _alive(self, element: str) -> NDArray[np.bool_]:
        """(end,) bool: which of the records of a kind are live. Cost O(records)."""
        return live(self.records, self.fields, element)

    @cached_property
    def _pins(self) -> list[tuple[Any, Callable[[], tuple[Any, ...]]]]:
        return []

    def _pin(self, scratch: Callable[[], tuple[Any, ...]]) -> Any:
        pinned = self.pinning(*self.records, *scratch())
        self._pins.append((pinned, scratch))
        return pinned

    def _kept(self, element: str) -> Callable[[Any], Array]:
        """How an answer is taken out of the scratch for elements of a kind."""
        return np.ndarray.copy

    @cached_property
    def _out(self) -> dict[str, Array]:
        """Scratch for the answer to one query, by the kind of element in it."""
        return self._scratch(0)

    def _scratch(self, more: int) -> dict[str, Array]:
        """As ``_out``, with room for a valence by so many larger than the largest there is."""
        counts = self.records.counts
        corners = self._ragged("face_vertices", self.faces(), int(counts[SIDES])).values
        valence = max(int(np.bincount(corners).max(initial=0)) + 1, int(counts[SIDES]))
        counts[VALENCE] = valence
        width = WIDTH * (valence + more + 1)
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

    def _widen(self) -> None:
        """See that the answer to any query fits into the scratch for it."""
        if WIDTH * (self.records.counts[VALENCE] + 1) > len(self._out["edge"]):
            # In proportion to the mesh, so that one operation pays O(1) of it in the long run.
            self._out.update(self._scratch(self.n_faces // 8))
            self._repin()

    def _repin(self) -> None:
        for pinned, scratch in self._pins:
            pinned.replace(*self.records, *scratch())

    @cached_property
    def _find_edge(self) -> Callable[..., int]:
        return self._uses["vertex_edges"].find_edge(self.kernels["edge_vertices"])

    def _ask(self, query: Query, handles: Any) -> NDArray[Any] | Ragged:
        """Any handles for a query, checked."""
        if np.ndim(handles):
            return self._ask_many(query, handles)
        return self._ask_many(query, [_as_integer(handles, query)])[0].copy()

    def _ask_many(self, query: Query, handles: ArrayLike) -> Ragged:
        wanted = np.asarray(handles)
        if wanted.ndim != 1 or (wanted.size and not np.issubdtype(wanted.dtype, np.integer)):
            raise MeshError(
                f"{query.name} takes one {query.source} handle or a 1-D array of integers, "
                f"not {wanted.dtype} of shape {wanted.shape}"
            )
        self._check_handles(query.source, wanted)
        self._widen()
        fixed = query.name in ("face_vertices", "face_edges")
        counts = self.records.counts
        width = int(counts[SIDES]) if fixed else WIDTH * int(counts[VALENCE] + 1)
        wanted = np.ascontiguousarray(wanted, HANDLE_TYPES[query.source])
        answers = self._ragged(query.name, wanted, width)
        if query.source == "edge" and not answers.counts.all():
            refuse_handles(query.source, wanted[answers.counts == 0])
        return answers

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

    def _check_handles(self, element: str, handles: Array) -> None:
        """Raise MeshError if any of ``handles`` (n,) names no live element of this mesh."""
        if not handles.size:
            return
        end = self.records.counts[ENDS[element]]
        if handles.min() < 0 or handles.max() >= end:
            refuse_handles(element, handles[(handles < 0) | (handles >= end)])
        if self._any_dead(element):
            dead = ~self._alive(element)[handles]
            if dead.any():
                refuse_handles(element, handles[dead])

    def _any_dead(self, element: str) -> bool:
        """Whether any record of a kind is dead; edges die with faces only."""
        alive, end = (VERTICES, VERTEX_END) if element == "vertex" else (FACES, FACE_END)
        return bool(self.records.counts[alive] < self.records.counts[end])


def refuse_handles(element: str, handles: NDArray[Any]) -> None:
    """Raise the MeshError for ``handles`` that name no element of the mesh."""
    raise MeshError(f"no such {element} in this mesh", **{ELEMENTS[element]: handles})
