"""How a structure's validator states what must hold. Nothing here uses a structure's queries."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hem.errors import MeshError

Array = NDArray[Any]


def require(holds: NDArray[np.bool_], invariant: str, elements: str) -> None:
    """Raise MeshError naming the ``invariant`` and the ``elements`` for which it does not hold.

    ``holds``: (n,) or (n, k) bool, one row per element.
    """
    if not holds.all():
        broken = ~holds if holds.ndim == 1 else ~holds.all(axis=1)
        raise MeshError(f"broken invariant: {invariant}", **{elements: np.flatnonzero(broken)})


def require_references(values: Array, end: int, field: str, elements: str, least: int = 0) -> None:
    """Require ``least <= values < end``: every reference names a record that exists."""
    require((values >= least) & (values < end), f"{field} lies in {least} … {end - 1}", elements)


def require_points(points: Array) -> None:
    """Require finite positions."""
    require(np.isfinite(points), "positions are finite", "vertices")


def require_distinct_edges(a: Array, b: Array, elements: str) -> None:
    """Require that no two edges (a[i], b[i]) join the same two vertices, and none joins one."""
    require(a != b, "an edge joins two different vertices", elements)
    named = (np.minimum(a, b).astype(np.int64) << 32) | np.maximum(a, b)
    first = np.zeros(len(named), np.bool_)
    first[np.unique(named, return_index=True)[1]] = True
    require(first, "two vertices are joined by at most one edge", elements)


def require_one_fan(vertex: Array, clockwise: Array) -> None:
    """Require that the faces around every vertex form one fan.

    ``vertex``: (n,) the vertex of each corner. ``clockwise``: (n,) the corner that follows around
    the same vertex, or -1 at the border.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(vertex)
    if n == 0:
        return
    corners = np.flatnonzero(clockwise >= 0)
    steps = (np.ones(len(corners), np.bool_), (corners, clockwise[corners]))
    fan = connected_components(coo_array(steps, shape=(n, n)), directed=False)[1]
    owner = vertex[np.unique(fan, return_index=True)[1]]
    require(np.bincount(owner) < 2, "the faces around a vertex form one fan", "vertices")
