"""Edges without a record of their own: named by their two vertices, or marked by them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Bools, Indices
from hem.authoring import BITS, EDGE_END, ENDLESS, FACE_ROOM, MARK, VERTEX_END, scatter
from hem.contract.navigation import Navigable
from hem.contract.storage import Storage, refuse_handles
from hem.contract.structure import Structure


class PackedStorage(Storage):
    """Records of vertices and faces; an edge handle is its two vertices."""

    def require(self, records: Any, element: str, handles: Array) -> None:
        """See ``Storage.require``; whether an edge joins the two is not looked at."""
        if element != "edge":
            return super().require(records, element, handles)
        names = handles.astype(np.int64)
        smaller, larger = names >> 32, names & 0xFFFFFFFF
        legal = (smaller >= 0) & (smaller < larger) & (larger < records.counts[VERTEX_END])
        if not legal.all():
            refuse_handles("edge", handles[~legal])

    def renumbered(self, edges: ArrayLike, number: Mapping[str, Array]) -> Indices:
        """See ``Storage.renumbered``."""
        handles = np.asarray(edges, np.int64)
        known, n = handles >= 0, len(number["vertex"])
        known &= (handles >> 32 < n) & (handles & 0xFFFFFFFF < n)
        handles = np.where(known, handles, 0)
        new = np.append(number["vertex"], -1)
        smaller, larger = new[handles >> 32], new[handles & 0xFFFFFFFF]
        gone = ~known | (smaller < 0) | (larger < 0)
        return np.where(gone, -1, (smaller << 32) | larger)


class PackedEdges(Structure, abstract=True):
    """A structure whose edge handle is the edge's two vertices packed into one int64.

    The smaller vertex stands in the upper 32 bits. Table 1 prints N/A for the queries from an edge;
    here they are answered by searching for the two vertices. ``edge_vertices`` only unpacks the
    handle and does not look whether the two are joined.
    """

    emulated = frozenset({"edge_vertices", "edge_edges", "edge_faces"})
    storage = PackedStorage


class MarkedStorage(Storage):
    """Records of vertices and half-edges; an edge handle is a half-edge and a mark of its ends."""

    _step: Any

    def alive(self, records: Any, element: str, rows: Any = slice(None)) -> Bools:
        """See ``Storage.alive``; a face is live where its half-edges are."""
        if element == "face":
            element = "half_edge"
            rows = slice(None, None, 3) if isinstance(rows, slice) else 3 * rows.astype(np.int64)
        return super().alive(records, element, rows)

    def edges(self, records: Any) -> Indices:
        """See ``Storage.edges``."""
        h = self.live(records, "half_edge")
        names = self._step("edge", records, h)
        return names[names >> BITS == h]

    def edge_names(self, records: Any, edges: Indices) -> Indices:
        """See ``Storage.edge_names``."""
        return self._step("edge", records, edges >> BITS)

    def lasting_names(self, records: Any, edges: Indices) -> Indices:
        """See ``Storage.lasting_names``: ``smaller end << 32 | larger end``."""
        known, names = self._are_edges(records, edges), np.full(len(edges), -1)
        h = edges[known] >> BITS
        ends = np.sort([self._step(it, records, h) for it in ("origin", "tip")], axis=0)
        names[known] = ends[0] << 32 | ends[1]
        return names

    def require(self, records: Any, element: str, handles: Array) -> None:
        """See ``Storage.require``."""
        if element != "edge":
            return super().require(records, element, handles)
        known = self._are_edges(records, handles.astype(np.int64))
        if not known.all():
            refuse_handles("edge", handles[~known])

    def _are_edges(self, records: Any, handles: Indices) -> Bools:
        """(n,) which handles name an edge."""
        h = handles >> BITS
        known: Bools = (h >= 0) & (h < records.counts[EDGE_END])
        known[known] = self.alive(records, "half_edge", h[known])
        known[known] = (self._step("edge", records, h[known]) ^ handles[known]) & MARK == 0
        return known

    def compacted(self, records: Any) -> tuple[Any, dict[str, Array]]:
        """See ``Storage.compacted``; also the mark that each old edge had, and its new handle."""
        h = self.live(records, "half_edge")
        twin, *ends = (self._step(it, records, h) for it in ("twin", "origin", "tip"))
        was, new = np.full((2, int(records.counts[EDGE_END])), -1)
        was[h] = self._step("edge", records, h) & MARK
        records, number = super().compacted(records)
        records.counts[FACE_ROOM] = ENDLESS
        of = number["half_edge"]
        place = np.where(twin >= 0, np.minimum(of[h], of[twin]), of[h]).astype(np.int64)
        marks = (scatter(number["vertex"][it].astype(np.int64)) for it in ends)
        new[h] = place << BITS | np.bitwise_xor(*marks)
        return records, number | {"face": of[::3] // 3, "mark": was, "edge": new}

    def renumbered(self, edges: ArrayLike, number: Mapping[str, Array]) -> Indices:
        """See ``Storage.renumbered``."""
        handles = np.asarray(edges, np.int64)
        h = handles >> BITS
        known = (h >= 0) & (h < len(number["mark"]))
        h = np.where(known, h, 0)
        known[known] = number["mark"][h[known]] == handles[known] & MARK
        return np.where(known, np.append(number["edge"], -1)[h], -1)


class MarkedEdges(Navigable, abstract=True):
    """A structure whose half-edges are the sides of its faces: 3 f, 3 f + 1, 3 f + 2.

    Faces have no records, and an operation may move the half-edges of those that it changes. So an
    edge is named as ``hem.authoring.marked`` says, and a handle whose half-edge has come to join
    other vertices is refused in O(1). Attributes follow: ``SideAttribute``.
    """

    stable_edge_handles = False
    storage = MarkedStorage
