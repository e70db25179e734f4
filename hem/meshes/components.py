"""What hangs together, what lies in one place, and what is used."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Array, Indices, Points


def components(n: int, pairs: Array) -> tuple[int, Indices]:
    """How many parts n things form of which pairs (k, 2) are joined, and the part of each (n,).

    Parts are numbered by their first thing. O(n + k).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if not n:
        return 0, np.zeros(0, np.int64)
    joined = coo_array((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    count, label = connected_components(joined, directed=False)
    return int(count), label.astype(np.int64)


NOTHING: tuple[Array, Array] = np.zeros((0, 3)), np.zeros((0, 3), np.int64)
"""No points and no triangles."""


def joined(parts: Iterable[tuple[Array, Array]]) -> tuple[Array, Array]:
    """The points (n, 3) and the triangles (m, 3) of several meshes in two arrays."""
    points, triangles = zip(*parts, strict=True)
    starts = np.cumsum([0, *map(len, points[:-1])])
    shifted = [rows + start for rows, start in zip(triangles, starts, strict=True)]
    return np.concatenate(points), np.concatenate(shifted)


def used_only(points: Array, triangles: Array) -> tuple[Array, Indices]:
    """The points that triangles (m, 3) use, in the order they had, and the triangles by them."""
    used, renumbered = np.unique(triangles, return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)


def clusters(points: Points, tolerance: float) -> tuple[Indices, NDArray[np.int32]]:
    """The first vertex of each cluster in ascending order, and the cluster of each vertex.

    Two vertices are in one cluster when their positions are equal (-0.0 equals 0.0), or when a
    chain of steps of at most `tolerance` leads from one to the other. O(n log n), and with a
    tolerance the number of pairs that close besides.
    """
    whole = (points + points.dtype.type(0)).view(f"V{3 * points.itemsize}").ravel()  # no -0.0
    _, first, label = np.unique(whole, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(first), np.int32)
    rank[order] = np.arange(len(first), dtype=np.int32)
    first, cluster = first[order], rank[label]
    if tolerance > 0:
        from scipy.spatial import cKDTree

        pairs = cKDTree(points[first]).query_pairs(tolerance, output_type="ndarray")
        _, part = components(len(first), pairs)  # numbered by their first, too
        first = first[np.unique(part, return_index=True)[1]]
        cluster = part.astype(np.int32)[cluster]
    return first, cluster
