"""Kernels where operations move half-edges: an edge is named by one, and by a mark of its ends.

A handle is ``half-edge << 31 | mark``. Both half-edges of an edge have one mark. Two edges with
a common end never have, any other two by a chance of one in 2³¹. So a handle whose half-edge has
come to join other vertices is known to name nothing, in O(1).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring.kernels import Kernel, kernel
from hem.authoring.steps import then
from hem.authoring.walks import Given

BITS = 31
MARK = (1 << BITS) - 1


def scatter(v: Any) -> Any:
    """For every vertex another number of 31 bits, as each of the steps can be taken back."""
    v = (v * 0x45D9F3B) & MARK
    v = ((v ^ (v >> 15)) * 0x119DE1F3) & MARK
    return v ^ (v >> 16)


scattered = kernel(scatter)


@kernel
def half_edge_of(m: Any, e: int) -> int:
    """The half-edge that a handle names."""
    return e >> BITS


def of_edge(step: Kernel) -> Kernel:
    """Make a step from an edge of one from a half-edge."""
    return then(half_edge_of, step)


def mark_of(origin: Kernel, tip: Kernel) -> Kernel:
    """Make ``mark(m, h)``: of the edge of a half-edge."""

    @kernel
    def mark(m: Any, h: int) -> int:
        return scattered(origin(m, h)) ^ scattered(tip(m, h))

    return mark


def smaller_of_twins(origin: Kernel, twin: Kernel, mark: Kernel) -> Given:
    """Make ``edge_of(m, h)``: the handle of an edge, by the smaller of its half-edges."""

    @kernel
    def edge_of(m: Any, h: int) -> int:
        other = twin(m, h)
        # Which is the smaller cannot be foreseen, and to wait for it would stop all loads behind.
        smaller = other + (h - other) * ((other < 0) | (h < other))
        return (np.int64(smaller) << BITS) | mark(m, h)

    @kernel
    def smaller(m: Any, h: int, other: int) -> int:
        ends = scattered(origin(m, h)) ^ scattered(origin(m, other))
        return (np.int64(other + (h - other) * (h < other)) << BITS) | ends

    return Given(edge_of, smaller)


def marked(half_edge_exists: Kernel, mark: Kernel) -> Kernel:
    """Make ``edge_exists(m, e)``: whether the half-edge lives and still joins the same vertices."""

    @kernel
    def edge_exists(m: Any, e: int) -> bool:
        h = e >> BITS
        return bool(half_edge_exists(m, h) and mark(m, h) == e & MARK)

    return edge_exists


def left_first(left_and_right: Kernel) -> Kernel:
    """Make ``left_and_right(m, e)`` of an edge of that of a half-edge."""

    @kernel
    def of_an_edge(m: Any, e: int) -> tuple[int, int]:
        return left_and_right(m, e >> BITS)

    return of_an_edge


def named_by_ends(operation: Kernel, edge_between: Kernel) -> Kernel:
    """Make an operation that takes ``smaller end << 32 | larger end``, or -1, for its edge.

    The edge is looked up when its turn comes: operations before it may have moved its half-edges.
    """

    @kernel
    def operate(
        m: Any, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
    ) -> int:
        ends = args[0]
        args[0] = edge_between(m, ends >> 32, ends & 0xFFFFFFFF) if ends >= 0 else -1
        result = operation(m, args, point, at, out, log, dry)
        args[0] = ends
        return int(result)

    return operate
