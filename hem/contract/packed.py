"""Edges without a record of their own: named by their two vertices, or marked by them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array, Bools
from hem.authoring import EDGE_END, ENDLESS, FACE_ROOM
from hem.authoring.marked import BITS, MARK, scatter
from hem.contract.elements import refuse_handles
from hem.contract.navigation import Navigable
from hem.contract.structure import Structure
from hem.errors import MeshError


class PackedEdges(Structure, abstract=True):
    """A structure whose edge handle is the edge's two vertices packed into one int64.

    The smaller vertex stands in the upper 32 bits. Table 1 prints N/A for the queries from an edge;
    here they are answered by searching for the two vertices. ``edge_vertices`` only unpacks the
    handle and does not look whether the two are joined.
    """

    emulated = frozenset({"edge_vertices", "edge_edges", "edge_faces"})

    def _check_handles(self, element: str, handles: NDArray[Any]) -> None:
        if element != "edge":
            return super()._check_handles(element, handles)
        smaller, larger = handles >> 32, handles & 0xFFFFFFFF
        legal = (smaller >= 0) & (smaller < larger) & (larger < len(self.points))
        if not legal.all():
            refuse_handles("edge", handles[~legal])

    def _renumbered(
        self, edges: ArrayLike, number: Mapping[str, NDArray[Any]]
    ) -> NDArray[np.int64]:
        handles = np.asarray(edges, np.int64)
        known, n = handles >= 0, len(number["vertex"])
        known &= (handles >> 32 < n) & (handles & 0xFFFFFFFF < n)
        handles = np.where(known, handles, 0)
        new = np.append(number["vertex"], -1)
        smaller, larger = new[handles >> 32], new[handles & 0xFFFFFFFF]
        gone = ~known | (smaller < 0) | (larger < 0)
        return np.where(gone, -1, (smaller << 32) | larger)


class MarkedEdges(Navigable, abstract=True):
    """A structure whose half-edges are the sides of its faces: 3 f, 3 f + 1, 3 f + 2.

    Faces have no records, and an operation may move the half-edges of those that it changes. So an
    edge is named as ``hem.authoring.marked`` says, and a handle whose half-edge has come to join
    other vertices is refused in O(1). Attributes follow: ``SideAttribute``.
    """

    stable_edge_handles = False

    def edges(self) -> NDArray[np.int64]:
        """See ``Navigable.edges``; ascending."""
        h = self.half_edges()
        names = self.edge(h)
        return names[names >> BITS == h]

    def _are_edges(self, handles: Array) -> Bools:
        """(n,) which handles name an edge."""
        h = handles >> BITS
        known: Bools = (h >= 0) & (h < self.records.counts[EDGE_END])
        known[known] = self._alive("half_edge", h[known])
        known[known] = (self.edge(h[known]) ^ handles[known]) & MARK == 0
        return known

    def _edge_names(self, handles: Array) -> Array:
        known, names = self._are_edges(handles), handles.copy()
        names[known] = self.edge(handles[known] >> BITS)
        return names

    def _lasting_names(self, handles: Array) -> Array:
        known, names = self._are_edges(handles), np.full(len(handles), -1)
        h = handles[known] >> BITS
        ends = np.sort([self.origin(h), self.tip(h)], axis=0).astype(np.int64)
        names[known] = ends[0] << 32 | ends[1]
        return names

    def _lasting_handle(self, name: int) -> int:
        try:
            edge = self.find_edge(int(name) >> 32, int(name) & 0xFFFFFFFF)
        except MeshError:  # an end is gone
            return -1
        return -1 if edge is None else edge

    def _check_handles(self, element: str, handles: Array) -> None:
        if element != "edge":
            return super()._check_handles(element, handles)
        known = self._are_edges(handles.astype(np.int64))
        if not known.all():
            refuse_handles("edge", handles[~known])

    def _alive(self, element: str, rows: Any = slice(None)) -> Bools:
        if element == "face":
            element = "half_edge"
            first = slice(None, None, 3) if isinstance(rows, slice) else 3 * rows.astype(np.int64)
            rows = first
        return super()._alive(element, rows)

    def _compacted(self) -> tuple[Any, dict[str, Array]]:
        h, end = self.half_edges(), self.records.counts[EDGE_END]
        twin, ends = self.twin(h), (self.origin(h), self.tip(h))
        was, new = np.full((2, end), -1)
        was[h] = self.edge(h) & MARK
        records, number = super()._compacted()
        records.counts[FACE_ROOM] = ENDLESS
        of = number["half_edge"]
        place = np.where(twin >= 0, np.minimum(of[h], of[twin]), of[h])
        marks = (scatter(number["vertex"][it].astype(np.int64)) for it in ends)
        new[h] = place << BITS | np.bitwise_xor(*marks)
        return records, number | {"face": of[::3] // 3, "mark": was, "edge": new}

    def _renumbered(
        self, edges: ArrayLike, number: Mapping[str, NDArray[Any]]
    ) -> NDArray[np.int64]:
        handles = np.asarray(edges, np.int64)
        h = handles >> BITS
        known = (h >= 0) & (h < len(number["mark"]))
        h = np.where(known, h, 0)
        known[known] = number["mark"][h[known]] == handles[known] & MARK
        return np.where(known, np.append(number["edge"], -1)[h], -1)
