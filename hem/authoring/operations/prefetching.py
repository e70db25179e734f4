"""Reading what many operations will need, so that memory is waited for once and not for each.

An operation waits for what it reads, and the next one for it. Reads alone wait side by side.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import Kernel, Kernels, kernel
from hem.authoring.operations.rules import LEFT, RIGHT, C, D


@kernel
def nothing(m: Any, handle: int, at: Array, out: Array) -> int:
    """Read nothing ahead."""
    return 0


def prefetching(k: Kernels, element: str) -> Kernel:
    """Make ``prefetch(m, handle, at, out) -> checksum``: what an operation on it reads first.

    The checksum keeps compilers from leaving the reads out. Cost: that of ``diamond``, or
    ``face_vertices``.
    """
    if element == "face":
        return _of_face(k["face_exists"], k["face_vertices"])
    if element == "edge":
        return _of_edge(k["edge_exists"], k["diamond"], k["face_exists"])
    return nothing


@cache
def _of_face(face_exists: Kernel, face_vertices: Kernel) -> Kernel:
    @kernel
    def prefetch(m: Any, f: int, at: Array, out: Array) -> int:
        checksum = 0
        if face_exists(m, f):
            for i in range(face_vertices(m, f, out)):
                checksum += out[i]
        return checksum

    return prefetch


@cache
def _of_edge(edge_exists: Kernel, diamond: Kernel, face_exists: Kernel) -> Kernel:
    @kernel
    def prefetch(m: Any, e: int, at: Array, out: Array) -> int:
        if not edge_exists(m, e):
            return 0
        diamond(m, e, at)
        return at[C] + at[D] + face_exists(m, at[LEFT]) + face_exists(m, at[RIGHT])

    return prefetch
