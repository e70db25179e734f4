"""What every mesh is: points and faces that do not change, and that other libraries can have."""

from abc import ABC, abstractmethod
from importlib import import_module
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.typing import DTypeLike

from hem.arrays import Indices, Points
from hem.errors import MeshError
from hem.meshes.edges import distinct_edges
from hem.meshes.summary import MeshSummary, summarize
from hem.ragged import Ragged

CELLS = {3: "triangle", 4: "quad"}
"""What meshio calls faces by their corners; the others are polygons."""


def position_type(dtype: DTypeLike) -> np.dtype[Any]:
    """The type to keep positions as; MeshError for another than float32 and float64."""
    try:
        kind = np.dtype(dtype)
    except TypeError:
        raise MeshError(f"positions are kept as float32 or float64, not as {dtype!r}") from None
    if kind not in (np.float32, np.float64):
        raise MeshError(f"positions are kept as float32 or float64, not as {kind}")
    return kind


class Convertible(ABC):
    """Points and faces of any size; the way from other libraries is ``hem.meshes.conversions``.

    A subclass is made of its points, its faces and the type of the points, and sets them in order.
    """

    points: Points

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self.__dict__:
            raise AttributeError(f"the {name} of a mesh do not change; make another mesh of them")
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copied and unpickled as it is made, so that the copy is read-only, too."""
        return type(self), (*self._parts(), self.points.dtype)

    def astype(self, dtype: DTypeLike) -> Self:
        """The mesh with positions of this type, float32 or float64: itself if they are. O(n)."""
        make: Any = type(self)
        kind = position_type(dtype)
        return self if self.points.dtype == kind else make(*self._parts(), kind)

    def _parts(self) -> list[Any]:
        return list(vars(self).values())[:2]  # behind them stands what others have added

    @abstractmethod
    def face_rows(self) -> Ragged:
        """The corners of every face."""

    def sides(self) -> tuple[Indices, Indices]:
        """(corners,) of every side of every face the vertex where it starts and where it ends."""
        faces = self.face_rows()
        here = faces.values.astype(np.int64)
        return here, here[faces.following]

    def summary(self) -> MeshSummary:
        """Counts of elements, borders, components and valences. O(n log n)."""
        edges, faces_per_edge = distinct_edges(*self.sides())
        return summarize(len(self.points), len(self.face_rows()), edges, faces_per_edge)

    def to_pyvista(self) -> Any:
        """A ``pyvista.PolyData``. O(n + m). ImportError where PyVista is not installed."""
        faces = self.face_rows()
        sizes = np.insert(faces.values, faces.offsets[:-1], faces.counts)
        return library("pyvista").PolyData(self.points.copy(), sizes)

    def to_meshio(self) -> Any:
        """A ``meshio.Mesh``: a block of cells for every run of faces of one size. O(n + m).

        ImportError where meshio is not installed.
        """
        faces = self.face_rows()
        begins = np.flatnonzero(np.diff(faces.counts, prepend=-1)).tolist()
        blocks = [
            (CELLS.get(int(faces.counts[begin]), "polygon"), np.stack(list(faces[begin:end])))
            for begin, end in pairwise([*begins, len(faces)])
        ]
        return library("meshio").Mesh(self.points.copy(), blocks)

    def plot(self, **options: Any) -> Any:
        """Show the mesh with PyVista, whose options these are: a picture in a notebook."""
        return self.to_pyvista().plot(**{"show_edges": True, "color": "lightgray", **options})


def library(name: str) -> Any:
    """A library that is asked for; ImportError that says how to get it."""
    try:
        return import_module(name)
    except ImportError as missing:
        raise ImportError(f"{name} is not installed; pip install {name}") from missing
