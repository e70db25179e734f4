"""Which vertices share a position."""

import numpy as np
from numpy.typing import NDArray

from hem.mesh import Points

Clusters = tuple[NDArray[np.int64], NDArray[np.int32]]


def clusters(points: Points, tolerance: float) -> Clusters:
    """The first vertex of each cluster in ascending order, and the cluster of each vertex.

    Two vertices are in one cluster when their positions are equal (-0.0 equals 0.0), or when a
    chain of steps of at most `tolerance` leads from one to the other. O(n log n) and the number of
    pairs that close.
    """
    first, cluster = _equal(points)
    if tolerance > 0:
        nearby, joined = _close(points[first], tolerance)
        first, cluster = first[nearby], joined[cluster]
    return first, cluster


def _equal(points: Points) -> Clusters:
    x, y, z = points.T
    order = np.lexsort((z, y, x))
    in_order = points[order]
    starts = np.ones(len(points), bool)
    starts[1:] = (in_order[1:] != in_order[:-1]).any(axis=1)
    label = np.empty(len(points), np.int64)
    label[order] = np.cumsum(starts) - 1
    return _in_order_of_first(order[starts], label)


def _close(points: Points, tolerance: float) -> Clusters:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    n = len(points)
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    _, first = np.unique(label, return_index=True)
    return _in_order_of_first(first, label.astype(np.int64))


def _in_order_of_first(first: NDArray[np.int64], label: NDArray[np.int64]) -> Clusters:
    order = np.argsort(first)
    rank = np.empty(len(first), np.int32)
    rank[order] = np.arange(len(first), dtype=np.int32)
    return first[order], rank[label]
