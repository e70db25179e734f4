"""To the meshes of other libraries, where they are installed: the same points and faces."""

from __future__ import annotations

from abc import ABC, abstractmethod
from importlib import import_module
from typing import Any

import numpy as np

from hem.arrays import Points
from hem.ragged import Ragged

CELLS = {3: "triangle", 4: "quad"}
"""What meshio calls faces by their corners; the others are polygons."""


class Convertible(ABC):
    """What has points and faces of any size; the way back is in ``hem.meshes.conversions``."""

    points: Points

    @abstractmethod
    def face_rows(self) -> Ragged:
        """The corners of every face."""

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
            for begin, end in zip(begins, [*begins[1:], len(faces)], strict=True)
        ]
        return library("meshio").Mesh(self.points, blocks)

    def plot(self, **options: Any) -> Any:
        """Show the mesh with PyVista, whose options these are: a picture in a notebook."""
        return self.to_pyvista().plot(**{"show_edges": True, "color": "lightgray", **options})


def library(name: str) -> Any:
    """A library that is asked for; ImportError that says how to get it."""
    try:
        return import_module(name)
    except ImportError as missing:
        raise ImportError(f"{name} is not installed; pip install {name}") from missing
