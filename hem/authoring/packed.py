"""Kernels where no edges are recorded: an edge is named by its two vertices."""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring.kernels import VERTEX_END, Kernel, kernel


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


def vertex_edges(vertex_vertices: Kernel) -> Kernel:
    """Make the kernel of the query: an edge to every neighbor."""

    @kernel
    def vertex_edges(m: Any, v: int, out: Array) -> int:
        count = vertex_vertices(m, v, out)
        for i in range(count):
            out[i] = pack(v, out[i])
        return int(count)

    return vertex_edges


def face_vertices(corner: Kernel) -> Kernel:
    """Make the kernel of the query of ``corner(m, f, i)``. Cost O(1)."""

    @kernel
    def face_vertices(m: Any, f: int, out: Array) -> int:
        for i in range(3):
            out[i] = corner(m, f, i)
        return 3

    return face_vertices


def face_edges(corner: Kernel) -> Kernel:
    """Make the kernel of the query of ``corner(m, f, i)``. Cost O(1)."""

    @kernel
    def face_edges(m: Any, f: int, out: Array) -> int:
        for i in range(3):
            out[i] = pack(corner(m, f, i), corner(m, f, (i + 1) % 3))
        return 3

    return face_edges
