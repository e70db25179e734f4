"""Kernels where no edges are recorded: an edge is named by its two vertices."""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring.kernels import VERTEX_END, kernel


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
