"""What pieces weigh: volume, mass, center and inertia of many meshes at once.

Every integral over a piece is a sum over its triangles (Lien & Kajiya, A symbolic method for
calculating the integral properties of arbitrary nonconvex polyhedra, 1984): over the tetrahedra
that the triangles span with an origin, or over the triangles themselves. The origin lies amid each
piece, so that a piece far from zero keeps its digits. Everything is float64, and all triangles of
all pieces are worked through together: O(faces), whatever the number of pieces.
"""

from collections.abc import Sequence
from contextlib import suppress
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Floats, Indices
from hem.errors import MeshError
from hem.meshes import NOTHING, TriangleMesh, areas, dot, joined


class Mass(NamedTuple):
    """How heavy pieces are, and where: what decides how they move. All float64.

    volumes   (n,): of closed pieces, or area × thickness of pieces of a sheet
    masses    (n,) kg
    centers   (n, 3): the centers of mass
    inertias  (n, 3, 3) kg m²: about the centers
    """

    volumes: Floats
    masses: Floats
    centers: Floats
    inertias: Floats


def of_bodies(meshes: Sequence[TriangleMesh], density: float) -> Mass:
    """Of closed, outward oriented pieces of a density in kg / m³, by the divergence theorem.

    A piece without volume weighs nothing, and its center is that of its bounding box. Raises
    MeshError for a density that is not positive and finite.
    """
    corners, owner, origins = _corners(meshes)
    volumes = dot(corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    return _mass(corners, owner, origins, volumes, (4, 20), positive(density, "a density"))


def of_sheets(meshes: Sequence[TriangleMesh], density: float, thickness: float) -> Mass:
    """Of sheets of a thickness in m and a density in kg / m³, by the areas of their triangles.

    The thickness counts for volume and mass; the inertia is that of a sheet without thickness.
    Raises MeshError for a density or a thickness that is not positive and finite.
    """
    corners, owner, origins = _corners(meshes)
    volumes = areas(corners) * positive(thickness, "a thickness")
    return _mass(corners, owner, origins, volumes, (3, 12), positive(density, "a density"))


def positive(value: Any, what: str) -> float:
    """The value, if it is a positive and finite number; else MeshError."""
    if isinstance(value, Real) and not isinstance(value, bool):
        with suppress(OverflowError):  # an integer that is no float any more
            if 0 < float(value) < np.inf:
                return float(value)
    raise MeshError(f"{what} is positive and finite, not {value!r:.60}")


def _corners(meshes: Sequence[TriangleMesh]) -> tuple[Floats, Indices, Floats]:
    """(m, 3, 3) corners of all triangles from their piece's origin, whose they are, the origins."""
    points, triangles = joined([NOTHING, *((mesh.points, mesh.triangles) for mesh in meshes)])
    counts = [len(mesh.triangles) for mesh in meshes]
    owner = np.repeat(np.arange(len(meshes)), counts)
    corners = points[triangles]
    origins = np.zeros((len(meshes), 3))
    filled = np.flatnonzero(counts)
    first = np.cumsum([0, *counts])[filled]  # those without triangles begin where the next one does
    low = np.minimum.reduceat(corners.min(axis=1), first)
    origins[filled] = (low + np.maximum.reduceat(corners.max(axis=1), first)) / 2
    return corners - origins[owner, None], owner, origins


def _mass(
    corners: Floats, owner: Indices, origins: Floats, volumes: Floats, parts: tuple[int, int],
    density: float,
) -> Mass:  # fmt: skip
    """The masses from the volume of each triangle's simplex, (m,).

    Over a simplex with corners v and their sum s, the mean of x is s / n, and that of x xᵀ is
    (s sᵀ + Σ v vᵀ) / (n (n + 1)): ``parts`` are n and n (n + 1), with n = 4 for tetrahedra, whose
    fourth corner is the origin, and 3 for triangles.
    """
    n = len(origins)
    total = _sums(owner, volumes, n)
    safe = np.where(total == 0, 1, total)
    sums = corners.sum(axis=1)
    centers = _sums(owner, volumes[:, None] * sums, n) / (parts[0] * safe[:, None])
    squares = sums[:, :, None] * sums[:, None] + np.einsum("mki,mkj->mij", corners, corners)
    second = _sums(owner, volumes[:, None, None] * squares, n) / parts[1]
    second -= total[:, None, None] * centers[:, :, None] * centers[:, None]
    trace = np.trace(second, axis1=1, axis2=2)[:, None, None]
    inertias = density * (trace * np.eye(3) - second)
    return Mass(total, density * total, origins + centers, inertias)


def _sums(owner: Indices, values: Floats, n: int) -> Floats:
    """The values (m, …) of each of n owners added up: (n, …)."""
    columns = values.reshape(len(values), int(np.prod(values.shape[1:])))
    summed = np.zeros((n, columns.shape[1]))
    for i, column in enumerate(columns.T):
        summed[:, i] = np.bincount(owner, column, n)
    return summed.reshape(n, *values.shape[1:])
