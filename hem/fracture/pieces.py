"""What a mesh broke into, and what the pieces weigh."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hem.fracture.material import Material
from hem.meshes.triangles import TriangleMesh

Floats = NDArray[np.float64]


class Mass(NamedTuple):
    """How heavy pieces are, and where: what decides how they move. All float64."""

    volumes: Floats
    """(n,): of closed pieces, or area × thickness of pieces of a sheet."""

    masses: Floats
    """(n,) kg."""

    centers: Floats
    """(n, 3): the centers of mass."""

    inertias: Floats
    """(n, 3, 3) kg m²: about the centers."""


@dataclass(frozen=True)
class Fracture:
    """What a blow made of a mesh: shards, and the rest of it.

    method     how it was broken: ``surface``, ``tetra`` or ``voronoi``
    impact     (3,) float64: where the blow struck, on the surface
    direction  (3,) float64, of length 1: where the blow goes, into the surface
    shards     the pieces that came out, each a mesh of its own; closed bodies but for ``surface``
    rest       what is left, the largest part first; the others are islands that nothing holds
    counts     what became of the break points: ``used``, ``outside``, ``on a vertex`` …
    """

    method: str
    material: Material
    seed: int
    impact: Floats
    direction: Floats
    shards: Sequence[TriangleMesh]
    rest: Sequence[TriangleMesh]
    counts: Mapping[str, int]
    diagonal: float
    """Of the bounding box of what was struck; what the material's lengths are parts of."""

    find_neighbors: Callable[[], NDArray[np.int64]]

    @property
    def closed(self) -> bool:
        """Whether the pieces are bodies; else they are parts of a sheet of some thickness."""
        return self.method != "surface"

    @cached_property
    def pieces(self) -> list[TriangleMesh]:
        """All shards, then all parts of the rest."""
        return [*self.shards, *self.rest]

    @cached_property
    def neighbors(self) -> NDArray[np.int64]:
        """(k, 2): the pieces that touch along more than a point, each pair once and ascending."""
        return self.find_neighbors()

    @cached_property
    def mass(self) -> Mass:
        """What the pieces weigh. Cost O(faces)."""
        from hem.fracture.mass import of_bodies, of_sheets

        density = self.material.density
        if self.closed:
            return of_bodies(self.pieces, density)
        return of_sheets(self.pieces, density, self.material.thickness * self.diagonal)


def diagonal(points: NDArray[Any]) -> float:
    """The length of the diagonal of the bounding box of points (n, 3), the dead (NaN) aside."""
    low, high = box(points)
    x, y, z = high - low
    return float(np.sqrt(x * x + y * y + z * z))


@njit(cache=True)
def box(points: NDArray[Any]) -> tuple[Floats, Floats]:
    """The lower and the upper corner (3,) of the bounding box of points (n, 3), NaN aside. O(n)."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for i in range(len(points)):
        for j in range(3):
            low[j] = min(low[j], points[i, j])
            high[j] = max(high[j], points[i, j])
    return low, high
