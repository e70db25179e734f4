"""What the rules of several operations look at.

Around an edge from ``a`` to ``b``, with ``a`` the smaller vertex, lies its *diamond*::

            c                 a, b    the ends of the edge, a < b
          ╱   ╲               left    the face that runs a → b, with the opposite corner c
        ╱ left  ╲             right   the face that runs b → a, with the opposite corner d
      a ───────▶ b
        ╲ right ╱             Where there is no face, it and its corner are -1.
          ╲   ╱
            d

A face of more than three corners has no opposite one: it is -1, too.

Rules are written over it and over a structure's own query kernels, so each stands once. They answer
``ALLOWED`` or a ``Refusal``. What is made here of the same kernels is made once.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring.defaults import OF_ARRAYS
from hem.authoring.kernels import VERTEX_END, Kernel, Kernels, kernel
from hem.authoring.refusals import ALLOWED, Refusal

A, B, LEFT, RIGHT, C, D = range(6)
"""Where the parts of a diamond stand in the array that ``diamond(m, e, at)`` fills."""


def holds_polygons(k: Kernels) -> bool:
    """Whether faces may have more than three sides: what is about those is not compiled if not."""
    return k["sides"] is not OF_ARRAYS["sides"]


@cache
def surface_edge(edge_exists: Kernel, diamond: Kernel) -> Kernel:
    """Make ``is_surface_edge(m, e, at) -> refusal``, which fills the diamond of an edge."""

    @kernel
    def is_surface_edge(m: Any, e: int, at: Array) -> int:
        if not edge_exists(m, e):
            return Refusal.NO_EDGE
        faces = diamond(m, e, at)
        if faces == 0:
            return Refusal.NO_EDGE
        return Refusal.CROWDED if faces > 2 else ALLOWED

    return is_surface_edge


@cache
def triangle_edge(edge_exists: Kernel, diamond: Kernel) -> Kernel:
    """Make ``is_triangle_edge(m, e, at) -> refusal``: all faces at the edge must be triangles."""
    is_surface_edge = surface_edge(edge_exists, diamond)

    @kernel
    def is_triangle_edge(m: Any, e: int, at: Array) -> int:
        refusal = is_surface_edge(m, e, at)
        if refusal == ALLOWED and ((at[LEFT] >= 0 > at[C]) or (at[RIGHT] >= 0 > at[D])):
            return Refusal.NOT_TRIANGLES
        return refusal

    return is_triangle_edge


@cache
def live_vertex(coordinate: Kernel) -> Kernel:
    """Make ``is_live_vertex(m, v) -> bool``."""

    @kernel
    def is_live_vertex(m: Any, v: int) -> bool:
        return 0 <= v < m.counts[VERTEX_END] and not np.isnan(coordinate(m, v, 0))

    return is_live_vertex
