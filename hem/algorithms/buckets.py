"""A queue of edges in compiled code: the cheap ones first, in buckets of about the same cost.

A bucket holds what costs up to a sixteenth more than the cheapest in it. One is taken out, or some
at once where it does not matter yet which is cheaper; what is put back comes to lie no lower. Edges
are named by their numbers, and come in that order, which is that of the mesh in memory: a heap
waits for another end of memory at each of its levels. And what comes next is known ahead, so it can
be fetched before its turn.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring import kernel

LEAST, MOST = -640, 560
"""Powers of two beyond which costs are not told apart: a cost grows with the length to the fourth.
"""
BITS = 4
"""Of the fraction of a cost that tell buckets apart, beside its exponent."""

PER_DOUBLING = 1 << BITS
BUCKETS = (MOST - LEAST) * PER_DOUBLING

LOWEST, HIGHEST, PLACE, COUNT, FREE, FRESH = range(6)
"""The buckets that are being taken out, how far that is, and how many edges they had; the first
block that is free again, and the first that never was used."""

BLOCK = 15
"""Edges in a block of a bucket: with the number of the block before they fill a cache line."""

DIGIT = 11
"""Bits by which numbers are sorted at a time."""


class Queue(NamedTuple):
    """Buckets, each a chain of blocks, of which only the last one may not be full."""

    last: Array  # (BUCKETS,) int32: block, or -1
    filled: Array  # (BUCKETS,) int32: edges in the last block
    block: Array  # (b, 1 + BLOCK) int32: the block before, or -1, and edges
    lowest: Array  # (k,) int32: the edges of the lowest buckets, in order
    spare: Array  # (k,) int32: to put them in order
    digits: Array  # (1 << DIGIT,) int32: the same
    state: Array  # (6,) int64


def queue_for(edges: int) -> Queue:
    """An empty queue for so many edges."""
    last, filled = np.full(BUCKETS, -1, np.int32), np.full(BUCKETS, BLOCK, np.int32)
    block = np.zeros((edges // BLOCK + BUCKETS + 1, 1 + BLOCK), np.int32)
    lowest, spare, digits = (np.zeros(n, np.int32) for n in (edges, edges, 1 << DIGIT))
    return Queue(last, filled, block, lowest, spare, digits, np.array([0, -1, 0, 0, -1, 0]))


@kernel
def bucket_of(queue: Queue, cost: float) -> int:
    """By the exponent and the bits behind it, but not below the lowest that is in use."""
    bits = np.float64(cost).view(np.int64) >> (52 - BITS)
    return int(max(min(bits - (1023 + LEAST) * PER_DOUBLING, BUCKETS - 1), queue.state[LOWEST]))


@kernel
def put(queue: Queue, bucket: int, edge: int) -> None:
    """Put an edge into a bucket. Cost O(1)."""
    state = queue.state
    if queue.filled[bucket] == BLOCK:
        new = state[FREE]
        if new >= 0:
            state[FREE] = queue.block[new, 0]
        else:
            new = state[FRESH]
            state[FRESH] += 1
        queue.block[new, 0] = queue.last[bucket]
        queue.last[bucket], queue.filled[bucket] = new, 0
    queue.filled[bucket] += 1
    queue.block[queue.last[bucket], queue.filled[bucket]] = edge


@kernel
def put_off(queue: Queue, bucket: int, edge: int) -> None:
    """Put an edge where it costs four times as much as in a bucket, and behind what is in use.

    Nowhere if that is too much.
    """
    to = max(bucket + 2 * PER_DOUBLING, queue.state[HIGHEST] + 1)
    if to < BUCKETS:
        put(queue, to, edge)


@kernel
def peek(queue: Queue, width: int) -> int:
    """The next edge, which stays; -1 if there is none. So many buckets are begun at once.

    Cost O(1) in the long run.
    """
    state = queue.state
    while state[PLACE] == state[COUNT]:
        state[LOWEST] = state[HIGHEST] + 1
        while state[LOWEST] < BUCKETS and queue.last[state[LOWEST]] < 0:
            state[LOWEST] += 1
        if state[LOWEST] == BUCKETS:
            state[HIGHEST] = BUCKETS - 1
            return -1
        state[HIGHEST] = min(state[LOWEST] + width, BUCKETS) - 1
        take_out(queue)
        put_in_order(queue)
    return int(queue.lowest[state[PLACE]])


@kernel
def drop(queue: Queue) -> None:
    """Take the edge away that ``peek`` told."""
    queue.state[PLACE] += 1


@kernel
def take_out(queue: Queue) -> None:
    """Empty the lowest buckets into one row."""
    state, count = queue.state, 0
    for bucket in range(state[LOWEST], state[HIGHEST] + 1):
        block, filled = queue.last[bucket], queue.filled[bucket]
        queue.last[bucket], queue.filled[bucket] = -1, BLOCK
        while block >= 0:
            for i in range(filled):
                queue.lowest[count + i] = queue.block[block, 1 + i]
            count += filled
            before = queue.block[block, 0]
            queue.block[block, 0] = state[FREE]
            state[FREE], block, filled = block, before, BLOCK
    state[PLACE], state[COUNT] = 0, count


@kernel
def put_in_order(queue: Queue) -> None:
    """Sort the row by one digit of the edges' numbers after the other."""
    count, digits, values, other = queue.state[COUNT], queue.digits, queue.lowest, queue.spare
    shift = 0
    while len(values) >> shift > 0:
        for digit in range(1 << DIGIT):
            digits[digit] = 0
        for i in range(count):
            digits[values[i] >> shift & (1 << DIGIT) - 1] += 1
        end = 0
        for digit in range(1 << DIGIT):
            end += digits[digit]
            digits[digit] = end - digits[digit]
        for i in range(count):
            digit = values[i] >> shift & (1 << DIGIT) - 1
            other[digits[digit]] = values[i]
            digits[digit] += 1
        for i in range(count):
            values[i] = other[i]
        shift += DIGIT
