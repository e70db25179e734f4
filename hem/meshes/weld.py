"""Which vertices share a position."""

import numpy as np

from hem.arrays import Indices, Points, Triangles
from hem.meshes.components import components

Clusters = tuple[Indices, Triangles]


def clusters(points: Points, tolerance: float) -> Clusters:
    """The first vertex of each cluster in ascending order, and the cluster of each vertex.

    Two vertices are in one cluster when their positions are equal (-0.0 equals 0.0), or when a
    chain of steps of at most `tolerance` leads from one to the other. O(n log n), and with a
    tolerance the number of pairs that close besides.
    """
    first, cluster = _equal(points)
    if tolerance > 0:
        nearby, joined = _close(points[first], tolerance)
        first, cluster = first[nearby], joined[cluster]
    return first, cluster


def _equal(points: Points) -> Clusters:
    whole = (points + points.dtype.type(0)).view(f"V{3 * points.itemsize}").ravel()  # no -0.0
    _, first, label = np.unique(whole, return_index=True, return_inverse=True)
    return _in_order_of_first(first, label)


def _close(points: Points, tolerance: float) -> Clusters:
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    _, label = components(len(points), pairs)
    return _in_order_of_first(np.unique(label, return_index=True)[1], label)


def _in_order_of_first(first: Indices, label: Indices) -> Clusters:
    order = np.argsort(first)
    rank = np.empty(len(first), np.int32)
    rank[order] = np.arange(len(first), dtype=np.int32)
    return first[order], rank[label]
