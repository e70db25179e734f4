"""Edges of structures that keep no record of an edge: named by their two vertices."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from hem.structure import Structure, refuse_handles


class PackedEdges(Structure):
    """A structure whose edge handle is the edge's two vertices packed into one int64.

    The smaller vertex stands in the upper 32 bits. Table 1 prints N/A for the queries from an edge;
    here they are answered by searching for the two vertices. ``edge_vertices`` only unpacks the
    handle and does not look whether the two are joined.
    """

    emulated = frozenset({"edge_vertices", "edge_edges", "edge_faces"})

    @property
    def _edge_end(self) -> int:
        return 0

    def _check_handles(self, element: str, handles: NDArray[Any]) -> None:
        if element != "edge":
            return super()._check_handles(element, handles)
        smaller, larger = handles >> 32, handles & 0xFFFFFFFF
        legal = (smaller >= 0) & (smaller < larger) & (larger < self.n_vertices)
        if not legal.all():
            refuse_handles("edge", handles[~legal])
