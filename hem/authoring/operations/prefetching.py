"""Reading what many operations will need, so that memory is waited for once and not for each.

An operation waits for what it reads, and the next one for it. Reads alone wait side by side. So
each part of what a block of operations reads is read for all of them before the next part is.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from hem.arrays import Array
from hem.authoring import packed
from hem.authoring.kernels import Kernel, Kernels, kernel
from hem.authoring.operations.parts import Operation
from hem.authoring.operations.rules import LEFT, RIGHT, A, B
from hem.authoring.walks import STEPPING

BLOCK = 16
"""Operations that are worth prefetching at a time."""

STEPS = 6
"""From neighbor to neighbor around an end of an edge: the valence of most vertices."""

SEEN = 4
"""Numbers of scratch for each operation."""


@kernel
def nothing(m: Any, args: Array, at: Array, out: Array, seen: Array) -> None:
    """Read nothing ahead."""


def prefetching(k: Kernels, operation: Operation, by_ends: bool = False) -> Kernel:
    """Make ``prefetch(m, args, at, out, seen)``: what so many operations read first.

    ``args`` (up to BLOCK, 3) are their handles, of which some may name nothing, or ``by_ends``
    names of edges, as where none are recorded. ``at`` and ``out`` are scratch as for an operation;
    so is ``seen`` (BLOCK, SEEN) int64, which keeps compilers from leaving reads out. Of edges
    nothing is read where ``are_joined`` is not of ``joined_by_steps``. Cost per operation: that of
    ``face_vertices`` or ``diamond``, and of ``STEPS`` around both ends.
    """
    if operation.element == "face":
        return _of_faces(k["face_exists"], k["face_vertices"])
    if operation.element == "edge" and (around := STEPPING.get(k.get("are_joined", nothing))):
        first, clockwise = around
        if by_ends or k["edge_exists"] is packed.edge_exists:
            return _of_ends(k["vertex_exists"], first, _stepping(clockwise, STEPS))
        ring = _stepping(clockwise, STEPS if operation.asks_neighbors else 0)
        return _of_edges(k["edge_exists"], k["diamond"], k["face_exists"], first, ring)
    return nothing


@cache
def _of_faces(face_exists: Kernel, face_vertices: Kernel) -> Kernel:
    @kernel
    def prefetch(m: Any, args: Array, at: Array, out: Array, seen: Array) -> None:
        for i in range(len(args)):
            seen[i, 0] = face_exists(m, args[i, 0])
        for i in range(len(args)):
            checksum = 0
            if seen[i, 0]:
                for j in range(face_vertices(m, args[i, 0], out)):
                    checksum += out[j]
            seen[i, 0] = checksum

    return prefetch


@cache
def _of_edges(
    edge_exists: Kernel, diamond: Kernel, face_exists: Kernel, first: Kernel, ring: Kernel
) -> Kernel:
    @kernel
    def prefetch(m: Any, args: Array, at: Array, out: Array, seen: Array) -> None:
        for i in range(len(args)):
            seen[i, 0] = edge_exists(m, args[i, 0])
        for i in range(len(args)):
            row = seen[i]
            if row[0]:
                diamond(m, args[i, 0], at)
                row[0], row[1], row[2], row[3] = at[A], at[B], at[LEFT], at[RIGHT]
            else:
                row[0] = -1
        for i in range(len(args)):  # a face that is beside the edge exists
            row = seen[i]
            left = row[0] >= 0 and (row[2] < 0 or face_exists(m, row[2]))
            right = row[0] >= 0 and (row[3] < 0 or face_exists(m, row[3]))
            row[2] = first(m, row[0]) if left else -1
            row[3] = first(m, row[1]) if right else -1
        ring(m, len(args), seen)

    return prefetch


@cache
def _of_ends(vertex_exists: Kernel, first: Kernel, ring: Kernel) -> Kernel:
    @kernel
    def prefetch(m: Any, args: Array, at: Array, out: Array, seen: Array) -> None:
        for i in range(len(args)):
            row, name = seen[i], args[i, 0]
            row[0], row[1] = name >> 32, name & 0xFFFFFFFF
            known = name >= 0 and vertex_exists(m, row[0]) and vertex_exists(m, row[1])
            row[2] = first(m, row[0]) if known else -1
            row[3] = first(m, row[1]) if known else -1
        ring(m, len(args), seen)

    return prefetch


@cache
def _stepping(clockwise: Kernel, steps: int) -> Kernel:
    """Make ``ring(m, count, seen)``: go on around both vertices of each row from what lies there.

    A row is two vertices and an item at each, or -1.
    """

    @kernel
    def ring(m: Any, count: int, seen: Array) -> None:
        for _ in range(steps):
            for i in range(count):
                row = seen[i]
                if row[2] >= 0:
                    row[2] = clockwise(m, row[2], row[0])
                if row[3] >= 0:
                    row[3] = clockwise(m, row[3], row[1])

    return ring
