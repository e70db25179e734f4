"""Which vertices share a position."""

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Indices, Points
from hem.meshes.components import components


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
        _, joined = components(len(first), pairs)  # numbered by their first, too
        first = first[np.unique(joined, return_index=True)[1]]
        cluster = joined.astype(np.int32)[cluster]
    return first, cluster
