"""Kernels where no edges are recorded: an edge is named by its two vertices."""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring.kernels import VERTEX_END, Kernel, kernel
from hem.authoring.walks import Way, never, query_of


@kernel
def pack(a: int, b: int) -> int:
    """The handle of edge (a, b) where no edges are recorded: both vertices in one int64."""
    return int((np.int64(min(a, b)) << 32) | np.int64(max(a, b)))


@kernel
def edge_vertices(m: Any, e: int, out: Array) -> int:
    """The kernel where no edges are recorded: unpacked from the handle, nothing is read."""
    out[0] = e >> 32
    out[1] = e & 0xFFFFFFFF
    return 2


@kernel
def edge_exists(m: Any, e: int) -> bool:
    """Whether the handle names two vertices, where no edges are recorded."""
    return bool(0 <= e >> 32 < e & 0xFFFFFFFF < m.counts[VERTEX_END])


def between(are_joined: Kernel) -> Kernel:
    """Make ``edge_between(m, a, b)``: the edge between two vertices, or -1."""

    @kernel
    def edge_between(m: Any, a: int, b: int) -> int:
        return pack(a, b) if are_joined(m, a, b) else -1

    return edge_between


def vertex_edges(vertex_vertices: Kernel) -> Kernel:
    """Make the kernel of the query: an edge to every neighbor."""

    @kernel
    def vertex_edges(m: Any, v: int, out: Array) -> int:
        count = vertex_vertices(m, v, out)
        for i in range(count):
            out[i] = pack(v, out[i])
        return int(count)

    return vertex_edges


def face_vertices(corner: Kernel, ahead: Kernel = never) -> Kernel:
    """Make the kernel of the query of ``corner(m, f, i)``. Cost O(1)."""
    return _each_corner(corner, ahead)


def face_edges(corner: Kernel) -> Kernel:
    """Make the kernel of the query of ``corner(m, f, i)``. Cost O(1)."""

    @kernel
    def side(m: Any, f: int, i: int) -> int:
        return pack(corner(m, f, i), corner(m, f, (i + 1) % 3))

    return _each_corner(side)


def _each_corner(give: Kernel, ahead: Kernel = never) -> Kernel:
    def visiting(way: Way) -> Kernel:
        visit, asks = way.visit, way.asking(ahead)

        @kernel
        def visit_all(m: Any, f: int, state: Any, given: Any) -> tuple[Any, bool]:
            asks(m, f)
            for i in range(3):
                state = visit(m, give(m, f, i), state, given)
            return state, False

        return visit_all

    return query_of(visiting)
