"""Kernels that are the same wherever vertices are rows of an array and faces triangles.

Where a vertex refers to other records, ``clear_vertex`` and ``set_vertex_face`` are its own.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring import sums
from hem.authoring.kernels import VERTEX_END, kernel, kernels_of
from hem.authoring.sums import Sum


@kernel
def coordinate(m: Any, v: int, i: int) -> float:
    """x, y or z of vertex v; NaN if it is dead."""
    return float(m.vertex_point[np.uint64(v), np.uint64(i)])


@kernel
def position(m: Any, v: int) -> Sum:
    """Where vertex v is, to be added up: see ``hem.authoring.sums``."""
    return sums.position(m.vertex_point, v)


@kernel
def set_point(m: Any, v: int, point: Array) -> None:
    """Give a vertex its position, be it new or not."""
    for i in range(3):
        m.vertex_point[v, i] = point[i]


@kernel
def kill_vertex(m: Any, v: int) -> None:
    """Make a vertex dead."""
    for i in range(3):
        m.vertex_point[v, i] = np.nan


@kernel
def clear_vertex(m: Any, v: int) -> None:
    """See to it that vertex v has no faces, where it would not know of them anyway."""


@kernel
def set_vertex_face(m: Any, v: int, f: int) -> None:
    """Let vertex v know of the face f, where it would not know of any."""


@kernel
def sides(m: Any, f: int) -> int:
    """How many sides face f has, where all are triangles."""
    return 3


@kernel
def vertex_exists(m: Any, v: int) -> bool:
    """Whether there is a record for v, live or dead; who asks further finds no faces there."""
    return bool(0 <= v < m.counts[VERTEX_END])


OF_ARRAYS = kernels_of(__name__)
"""By name; a structure's own come first."""
