"""Which vertices share a position."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hem.meshes.triangles import Points

Clusters = tuple[NDArray[np.int64], NDArray[np.int32]]


def clusters(points: Points, tolerance: float) -> Clusters:
    """The first vertex of each cluster in ascending order, and the cluster of each vertex.

    Two vertices are in one cluster when their positions are equal (-0.0 equals 0.0), or when a
    chain of steps of at most `tolerance` leads from one to the other. O(n), and with a tolerance
    O(n log n) and the number of pairs that close.
    """
    first, cluster = _equal(points)
    if tolerance > 0:
        nearby, joined = _close(points[first], tolerance)
        first, cluster = first[nearby], joined[cluster]
    return first, cluster


def _equal(points: Points) -> Clusters:
    words = (points + np.float32(0)).view(np.uint32)  # -0.0 + 0.0 is 0.0
    cluster = np.empty(len(points), np.int32)
    first = np.empty(len(points), np.int64)
    size = 1 << max(4, (2 * len(points) - 1).bit_length())
    count = _number(words, np.full(size, -1, np.int32), cluster, first)
    return first[:count], cluster


@njit(cache=True)
def _number(
    words: NDArray[Any], table: NDArray[Any], cluster: NDArray[Any], first: NDArray[Any]
) -> int:
    """Number equal rows alike in the order they come, by a hash table -> how many there are."""
    count, mask = 0, len(table) - 1
    for v in range(len(words)):
        mixed = np.uint64(words[v, 0])
        for i in range(1, 3):
            mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0x9E3779B97F4A7C15)
            mixed += np.uint64(words[v, i])
        mixed = (mixed ^ (mixed >> np.uint64(32))) * np.uint64(0x9E3779B97F4A7C15)
        place = np.int64(mixed >> np.uint64(33)) & mask
        while table[place] >= 0:
            u = first[table[place]]
            if (
                words[u, 0] == words[v, 0]
                and words[u, 1] == words[v, 1]
                and words[u, 2] == words[v, 2]
            ):
                break
            place = (place + 1) & mask
        if table[place] < 0:
            table[place] = count
            first[count] = v
            count += 1
        cluster[v] = table[place]
    return count


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
