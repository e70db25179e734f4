"""A heap of edges in compiled code: the cheapest first, at equal costs the one named first.

Entries are never changed. An entry has the stamp that its edge had when it was pushed; what has
another one by now is stale, and is passed over. Four children per entry, so that a step down reads
one or two cache lines.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring import part

CHILDREN = 4


class Heap(NamedTuple):
    """Entries, one per place; the children of place i are at 4 i + 1 and behind it."""

    cost: Array  # (room,) float64
    edge: Array  # (room,) int64: smaller end << 32 | larger end
    stamp: Array  # (room,) int64
    size: Array  # (1,) int64


def heap_for(edges: int) -> Heap:
    """An empty heap with room for each of so many edges and as many stale entries."""
    room = 2 * edges + 64
    own = np.zeros(room), np.zeros(room, np.int64), np.zeros(room, np.int64)
    return Heap(*own, np.zeros(1, np.int64))


@part
def push(heap: Heap, cost: float, edge: int, stamp: int) -> None:
    """Add an entry. Cost O(log size), O(1) on average."""
    place = heap.size[0]
    heap.size[0] += 1
    while place > 0:
        above = (place - 1) // CHILDREN
        other = heap.cost[above]
        if other < cost or (other == cost and heap.edge[above] <= edge):
            break
        heap.cost[place], heap.edge[place] = other, heap.edge[above]
        heap.stamp[place] = heap.stamp[above]
        place = above
    heap.cost[place], heap.edge[place], heap.stamp[place] = cost, edge, stamp


@part
def pop(heap: Heap) -> None:
    """Take the first entry away. Cost O(log size)."""
    heap.size[0] -= 1
    size, place = heap.size[0], 0
    cost, edge, stamp = heap.cost[size], heap.edge[size], heap.stamp[size]
    while CHILDREN * place + 1 < size:
        least = CHILDREN * place + 1
        for child in range(least + 1, min(least + CHILDREN, size)):
            other, best = heap.cost[child], heap.cost[least]
            if other < best or (other == best and heap.edge[child] < heap.edge[least]):
                least = child
        other = heap.cost[least]
        if cost < other or (cost == other and edge <= heap.edge[least]):
            break
        heap.cost[place], heap.edge[place] = other, heap.edge[least]
        heap.stamp[place] = heap.stamp[least]
        place = least
    heap.cost[place], heap.edge[place], heap.stamp[place] = cost, edge, stamp


@part
def purge(heap: Heap, version: Array) -> None:
    """Keep what is not stale: the stamp of an edge is the sum of its ends' versions."""
    size = heap.size[0]
    heap.size[0] = 0
    for i in range(size):
        edge, stamp = heap.edge[i], heap.stamp[i]
        if version[edge >> 32] + version[edge & 0xFFFFFFFF] == stamp:
            push(heap, heap.cost[i], edge, stamp)
