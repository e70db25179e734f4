"""What every mesh data structure has in common: the contract, derived from its kernels.

A structure is a subclass that declares its records (a ``NamedTuple`` of arrays), their fields, one
kernel per query, how it is built and how it is validated. The rest stands here.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol, Self, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.errors import MeshError
from hem.kernels import Kernel
from hem.mesh import TriangleMesh
from hem.pinned import Pinned
from hem.queries import ELEMENTS, QUERIES, Query
from hem.ragged import Ragged
from hem.slices import in_slices, slice_count
from hem.uses import Uses, move

REFERENCE_TYPES = {4: np.int32, 8: np.int64}
"""Bytes of a stored reference to the type that holds it. The thesis counts 8 (section 7)."""

HANDLE_TYPES = {"vertex": np.int32, "edge": np.int64, "face": np.int32}
"""The type of the handles by kind of element."""


TYPICAL_NEIGHBORS = {"vertex": 7, "edge": 11, "face": 3}
"""Room to begin with for the answers to a batch, per element; it grows where it is too small."""


class Field(NamedTuple):
    """One field of one record: ``half_edge.twin`` is 1 element wide in the array ``half_edge``."""

    name: str
    array: str
    width: int = 1

    @property
    def element(self) -> str:
        """The record that has the field, such as ``half_edge``."""
        return self.name.split(".")[0]


class QueryMethod(Protocol):
    """A query as a method: one handle -> 1-D array; an array of handles -> ``Ragged``."""

    @overload
    def __call__(self, handles: int) -> NDArray[Any]: ...
    @overload
    def __call__(self, handles: NDArray[Any] | list[int]) -> Ragged: ...


def _query_method(query: Query) -> Any:
    """The attribute ``Structure.vertex_faces`` and its like, bound once per structure."""

    def bound(self: Structure) -> QueryMethod:
        out, end = self._out[query.target], self._handle_end[query.source]
        pinned = Pinned(*self.records, out)
        single, address = self._uses[query.name].single(pinned), pinned.address

        def ask(handles: Any) -> Any:
            # One plain integer is the way that programs take a million times: no detours here.
            if type(handles) is int and 0 <= handles < end:
                count = single(handles, address)
                if count or query.source != "edge":
                    return out[:count].copy()
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


class Structure(ABC):
    """A triangle mesh held in one data structure, interchangeable behind one contract.

    Not safe for single queries from several threads at once: they share one scratch array.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    abbreviation: ClassVar[str]
    fields: ClassVar[tuple[Field, ...]]
    kernels: ClassVar[Mapping[str, Kernel]]
    emulated: ClassVar[frozenset[str]] = frozenset()
    """Queries answered without edge records: table 1's N/A."""

    records_type: ClassVar[type[Any]]
    """The `NamedTuple` of the structure's arrays, with from→to names."""

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

    def __init_subclass__(cls) -> None:
        """Derive the four uses of every kernel; abstract intermediates declare none."""
        super().__init_subclass__()
        if hasattr(cls, "kernels"):
            cls._uses = {name: Uses(cls.kernels[name], cls.records_type) for name in QUERIES}

    def __init__(self, records: tuple[NDArray[Any], ...]) -> None:
        self.records: Any = records

    @classmethod
    @abstractmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """The structure of ``mesh``, with stored references of 4 or 8 bytes.

        Cost O(n_v + n_t). Raises NonManifoldError, with the elements, for what the structure
        cannot represent.
        """

    @abstractmethod
    def validate(self) -> None:
        """Check every invariant on the raw arrays; no query is used. Cost O(n_v + n_t).

        Raises MeshError that names the broken invariant and the elements that break it.
        """

    # Elements --------------------------------------------------------------------------------

    @property
    @abstractmethod
    def n_faces(self) -> int:
        """Number of faces."""

    @property
    def n_vertices(self) -> int:
        """Number of vertices, unreferenced ones included."""
        return len(self.points)

    @cached_property
    def n_edges(self) -> int:
        """Number of undirected edges."""
        return len(self.edges())

    @property
    def points(self) -> NDArray[np.float32]:
        """(n_vertices, 3) float32: positions by vertex."""
        points: NDArray[np.float32] = self.records.vertex_point
        return points

    def vertices(self) -> NDArray[np.int32]:
        """(n_vertices,) int32: the handles of all vertices."""
        return np.arange(self.n_vertices, dtype=np.int32)

    def edges(self) -> NDArray[np.int64]:
        """(n_edges,) int64: the handles of all edges, ascending, each undirected edge once."""
        return np.unique(self.face_edges(self.faces()).values)

    def faces(self) -> NDArray[np.int32]:
        """(n_faces,) int32: the handles of all faces."""
        return np.arange(self.n_faces, dtype=np.int32)

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
        ends = np.empty(2, np.int64)
        found = self._find_edge(int(a), int(b), self._out["edge"], ends, *self.records)
        return None if found < 0 else int(found)

    def to_triangles(self) -> TriangleMesh:
        """The same mesh as points and counterclockwise triangles. Cost O(n_v + n_t)."""
        corners = self.face_vertices(self.faces()).values
        return TriangleMesh(self.points, corners.reshape(-1, 3))

    def memory(self) -> dict[str, int]:
        """Bytes per field of live elements, such as ``{"vertex.point": 12 * n_vertices, …}``."""
        counts = {
            "vertex": self.n_vertices,
            "edge": self.n_edges,
            "half_edge": 3 * self.n_faces,
            "face": self.n_faces,
            "triangle": self.n_faces,
        }
        return {
            field.name: counts[field.element]
            * field.width
            * int(getattr(self.records, field.array).itemsize)
            for field in self.fields
        }

    # Measuring -------------------------------------------------------------------------------

    def sweep(self, query: str, handles: NDArray[Any]) -> int:
        """Answer ``query`` for every handle in one compiled loop, keeping nothing -> a checksum.

        What the experiments time; the handles are not checked. Raises KeyError for no query.
        """
        out = self._out[QUERIES[query].target]
        return int(self._uses[query].sweep(handles, out, *self.records))

    def work(self, query: str, handles: NDArray[Any]) -> NDArray[np.int64]:
        """(n,) int64: elements of the structure's arrays read to answer ``query``, per handle.

        Exact and the same on every machine; runs uncompiled. Raises KeyError for no query.
        """
        out = self._out[QUERIES[query].target]
        return self._uses[query].work(handles, out, self.records)

    # Behind the contract ---------------------------------------------------------------------

    @cached_property
    def _handle_end(self) -> dict[str, int]:
        """One past the largest handle, by kind of element."""
        return {"vertex": self.n_vertices, "edge": self._edge_end, "face": self.n_faces}

    @property
    @abstractmethod
    def _edge_end(self) -> int:
        """One past the largest edge handle; 0 where handles need a closer look."""

    @cached_property
    def _width(self) -> int:
        """Room for the answer to any one query, with what it finds twice and a table to tell."""
        corners = self._ragged("face_vertices", self.faces(), 3).values
        return 12 * (int(np.bincount(corners).max(initial=0)) + 1)

    @cached_property
    def _out(self) -> dict[str, NDArray[Any]]:
        """Scratch for the answer to one query, by the kind of element in it."""
        return {element: np.empty(self._width, dtype) for element, dtype in HANDLE_TYPES.items()}

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
        width = 3 if query.name in ("face_vertices", "face_edges") else self._width
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

    def _check_handles(self, element: str, handles: NDArray[Any]) -> None:
        """Raise MeshError if any of ``handles`` (n,) names no element of this mesh."""
        end = self._handle_end[element]
        if handles.size and (handles.min() < 0 or handles.max() >= end):
            refuse_handles(element, handles[(handles < 0) | (handles >= end)])


def refuse_handles(element: str, handles: NDArray[Any]) -> None:
    """Raise the MeshError for ``handles`` that name no element of the mesh."""
    raise MeshError(f"no such {element} in this mesh", **{ELEMENTS[element]: handles})
