"""Edges of structures that keep no record of an edge: named by their two vertices."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.contract.elements import refuse_handles
from hem.contract.structure import Structure


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
