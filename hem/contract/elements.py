"""The elements of a mesh, read off a structure's records."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Array, Bools, Handles, Points
from hem.authoring import (
    ELEMENTS,
    ENDS,
    FACE_END,
    FACES,
    SIDES,
    VERTEX_END,
    VERTICES,
    Field,
    Kernel,
    live,
)
from hem.contract.description import Described
from hem.errors import MeshError

HANDLE_TYPES = {"vertex": np.int32, "edge": np.int64, "face": np.int32}
"""The type of the handles by kind of element."""


class Elements(Described, abstract=True):
    """What a mesh consists of."""

    records_type: ClassVar[type[Any]]
    """The `NamedTuple` of the structure's arrays, with from→to names."""

    fields: ClassVar[tuple[Field, ...]]
    kernels: ClassVar[Mapping[str, Kernel]]
    """By name; those of the module that the class stands in, unless it says others."""

    def __init__(self, records: tuple[Any, ...]) -> None:
        self.records: Any = records

    @property
    def n_vertices(self) -> int:
        """Number of live vertices, unreferenced ones included."""
        return int(self.records.counts[VERTICES])

    @property
    def n_faces(self) -> int:
        """Number of live faces."""
        return int(self.records.counts[FACES])

    @property
    def points(self) -> Points:
        """(n, 3) float32: positions by vertex; those of dead ones are NaN.

        A view: ``move_vertex`` tells subscribers of a new position, writing here does not.
        """
        points: Points = self.records.vertex_point
        return points[: self.records.counts[VERTEX_END]]

    def vertices(self) -> Handles:
        """(n_vertices,) int32: the handles of all live vertices, ascending."""
        return self._live("vertex")

    def faces(self) -> Handles:
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

    def _live(self, element: str) -> Handles:
        """The indices of the live vertices or faces, ascending."""
        if self._any_dead(element):
            return np.flatnonzero(self._alive(element)).astype(np.int32)
        return np.arange(self.records.counts[ENDS[element]], dtype=np.int32)

    def _alive(self, element: str, rows: Any = slice(None)) -> Bools:
        """(end,) bool: which of the records of a kind are live, or which of ``rows``. O(rows)."""
        return live(self.records, self.fields, element, rows)

    def _check_handles(self, element: str, handles: Array) -> None:
        """Raise MeshError if any of ``handles`` (n,) names no live element of this mesh. O(n)."""
        if not handles.size:
            return
        end = self.records.counts[ENDS[element]]
        if handles.min() < 0 or handles.max() >= end:
            refuse_handles(element, handles[(handles < 0) | (handles >= end)])
        # A polygon's edge may die without a face, and how many edges are recorded is not counted.
        if "edge" in element or self._any_dead(element):
            dead = ~self._alive(element, handles)
            if dead.any():
                refuse_handles(element, handles[dead])

    def _any_dead(self, element: str) -> bool:
        """Whether any vertex or face is dead."""
        alive, end = (VERTICES, VERTEX_END) if element == "vertex" else (FACES, FACE_END)
        return bool(self.records.counts[alive] < self.records.counts[end])


def refuse_handles(element: str, handles: NDArray[Any]) -> None:
    """Raise the MeshError for ``handles`` that name no element of the mesh."""
    words = f"no such {element.replace('_', '-')} in this mesh"
    raise MeshError(words, **{ELEMENTS.get(element, f"{element}s"): handles})
