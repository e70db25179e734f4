"""The queries of the contract, derived from a structure's kernels."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, Protocol, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.authoring import EDGES, QUERIES, SIDES, UNKNOWN, VALENCE, WIDTH, Query
from hem.contract.elements import HANDLE_TYPES, refuse_handles
from hem.contract.scratch import Scratch
from hem.errors import MeshError
from hem.ragged import Ragged

MOST = 1 << 63
"""More than any handle."""

ALL: Any = object()
"""Stands for the handles of all live elements."""

NUMPY_INTEGERS = frozenset(np.dtype(it).type for it in np.typecodes["AllInteger"])
"""What a loop over an array of handles gives."""


class QueryMethod(Protocol):
    """A query as a method: one handle -> 1-D array; an array of handles, or all -> ``Ragged``."""

    @overload
    def __call__(self, handles: int) -> NDArray[Any]: ...
    @overload
    def __call__(self, handles: NDArray[Any] | list[int] = ...) -> Ragged: ...


def _query_method(query: Query) -> Any:
    """The attribute ``Structure.vertex_faces`` and its like, bound once per structure."""

    def bound(self: Queryable) -> QueryMethod:
        target = query.target
        pinned = self._pin(lambda: (self._out[target],))
        single = self._uses[query.name].single(pinned, self.kernels[f"{query.source}_exists"])
        address = pinned.address

        def ask(handles: Any = ALL) -> Any:
            # One integer is the way that programs take a million times: no detours here.
            handle = int(handles) if type(handles) in NUMPY_INTEGERS else handles
            if type(handle) is int and -MOST <= handle < MOST:
                answer = single(handle, address)
                if len(answer):
                    return answer
            return self._ask(query, handles)

        ask.__name__, ask.__doc__ = query.name, attribute.__doc__
        ask.__dict__["pinned"] = pinned  # lives as long as the address is in use
        return ask

    attribute = cached_property(bound)
    attribute.__doc__ = (
        f"{query.title}, of one {query.source} or of many.\n\n"
        "One handle gives a 1-D array, an array of handles (n,) a ``Ragged`` with n rows, and no\n"
        "argument one of all live elements. Each neighbor comes once; around a vertex or face\n"
        "counterclockwise where the structure knows the order. Cost per handle: thesis, table 1.\n"
        f"Raises MeshError for a handle that names no {query.source} of this mesh."
    )
    return attribute


def _as_integer(handle: Any, called: str, element: str) -> int:
    if isinstance(handle, np.ndarray) and handle.ndim == 0:
        handle = handle[()]
    if isinstance(handle, int | np.integer) and not isinstance(handle, bool):
        return int(handle)
    raise MeshError(
        f"{called} takes a {element} handle (an integer) or an array of them, "
        f"not {type(handle).__name__} {handle!r}"
    )


class Queryable(Scratch, abstract=True):
    """The queries for the neighbors of elements.

    Any number of threads may ask at once, as long as none operates on the mesh.
    """

    emulated: ClassVar[frozenset[str]] = frozenset()
    """Queries answered without edge records: table 1's N/A."""

    stable_edge_handles: ClassVar[bool] = True
    """Whether an edge keeps its handle as long as it joins the same two vertices.

    Where it does not, an operation may give other edges of the faces that it changes new handles.
    The old ones are refused then; ``find_edge`` finds the new ones.
    """

    vertex_vertices: QueryMethod = _query_method(QUERIES["vertex_vertices"])
    vertex_edges: QueryMethod = _query_method(QUERIES["vertex_edges"])
    vertex_faces: QueryMethod = _query_method(QUERIES["vertex_faces"])
    edge_vertices: QueryMethod = _query_method(QUERIES["edge_vertices"])
    edge_edges: QueryMethod = _query_method(QUERIES["edge_edges"])
    edge_faces: QueryMethod = _query_method(QUERIES["edge_faces"])
    face_vertices: QueryMethod = _query_method(QUERIES["face_vertices"])
    face_edges: QueryMethod = _query_method(QUERIES["face_edges"])
    face_faces: QueryMethod = _query_method(QUERIES["face_faces"])

    @property
    def n_edges(self) -> int:
        """Number of live undirected edges."""
        self._count_edges()
        return int(self.records.counts[EDGES])

    def edges(self) -> NDArray[np.int64]:
        """(n_edges,) int64: the handles of all live edges, ascending, each undirected edge once."""
        return np.unique(self.face_edges(self.faces()).values)

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
        find, address = self._find_edge
        a, b = (_as_integer(it, "find_edge", "vertex") for it in (a, b))
        found = find(a, b, address) if min(a, b) >= -MOST and max(a, b) < MOST else -1
        if found >= 0:
            return found
        self._check_handles("vertex", np.array([a, b]))
        self._widen()
        found = find(a, b, address)
        return None if found < 0 else found

    def _edge_names(self, handles: NDArray[Any]) -> NDArray[Any]:
        """The one name of each edge, where it has two handles."""
        return handles

    def _lasting_names(self, handles: NDArray[Any]) -> NDArray[Any]:
        """Names of edges that last whatever is done to others; -1 for what is no edge."""
        return handles

    def _lasting_handle(self, name: int) -> int:
        """The handle of an edge by its lasting name; one that is refused where there is none."""
        return name

    def _count_edges(self) -> None:
        """Search for the edges where their number is not known yet; operations keep it up."""
        if self.records.counts[EDGES] == UNKNOWN:
            self.records.counts[EDGES] = len(self.edges())

    @cached_property
    def _find_edge(self) -> tuple[Callable[[int, int, Any], int], Any]:
        """The function, and the address of what it works on."""
        ends = self._room(2, HANDLE_TYPES["edge"])
        pinned = self._pin(lambda: (self._out["edge"], ends))
        exists, edge_vertices = self.kernels["vertex_exists"], self.kernels["edge_vertices"]
        find = self._uses["vertex_edges"].find_edge(pinned, exists, edge_vertices)
        self.__dict__["_find_edge_pinned"] = pinned  # lives as long as the address is in use
        return find, pinned.address

    def _ask(self, query: Query, handles: Any) -> NDArray[Any] | Ragged:
        """Any handles for a query, checked."""
        if handles is ALL:
            handles = self.handles(query.source)
        if np.ndim(handles):
            return self._ask_many(query, handles)
        handle = _as_integer(handles, query.name, query.source)
        return self._ask_many(query, [handle])[0].copy()

    def _checked(self, query: Query, handles: ArrayLike) -> NDArray[Any]:
        """(n,) handles for a query; MeshError unless they all name elements of this mesh."""
        wanted = np.asarray(handles)
        if wanted.ndim != 1 or (wanted.size and not np.issubdtype(wanted.dtype, np.integer)):
            raise MeshError(
                f"{query.name} takes one {query.source} handle or a 1-D array of integers, "
                f"not {wanted.dtype} of shape {wanted.shape}"
            )
        self._check_handles(query.source, wanted)
        return np.ascontiguousarray(wanted, HANDLE_TYPES[query.source])

    def _ask_many(self, query: Query, handles: ArrayLike) -> Ragged:
        wanted = self._checked(query, handles)
        self._widen()
        fixed = query.name in ("face_vertices", "face_edges")
        counts = self.records.counts
        width = int(counts[SIDES]) if fixed else WIDTH * int(counts[VALENCE] + 1)
        answers = self._ragged(query.name, wanted, width)
        if query.source == "edge" and not answers.counts.all():
            refuse_handles(query.source, wanted[answers.counts == 0])
        return answers
