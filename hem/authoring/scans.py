"""Kernels where nothing is recorded of neighbors: whoever asks for one searches all triangles.

Each is made of ``is_corner(m, t, i, v)``, whether corner i of triangle t is vertex v, or of
``has_corner(m, t, v)``, whether any is. ``m.triangle`` tells which vertices the corners are.
"""

from __future__ import annotations

from typing import Any

from hem.arrays import Array
from hem.authoring.kernels import FACE_END, Kernel, distinct, kernel
from hem.authoring.operations import LEFT, RIGHT, A, B, C, D


def has_corner(is_corner: Kernel) -> Kernel:
    """Make ``has_corner(m, t, v)``: whether v is a corner of triangle t."""

    @kernel
    def has_corner(m: Any, t: int, v: int) -> bool:
        return bool(is_corner(m, t, 0, v) or is_corner(m, t, 1, v) or is_corner(m, t, 2, v))

    return has_corner


def vertex_vertices(has_corner: Kernel) -> Kernel:
    """Make the kernel of the query. Cost O(n_t)."""

    @kernel
    def vertex_vertices(m: Any, v: int, out: Array) -> int:
        count = 0
        for t in range(m.counts[FACE_END]):
            if has_corner(m, t, v):
                for i in range(3):
                    if m.triangle[t, i] != v:
                        out[count] = m.triangle[t, i]
                        count += 1
        return int(distinct(out, count))

    return vertex_vertices


def vertex_faces(has_corner: Kernel) -> Kernel:
    """Make the kernel of the query. Cost O(n_t)."""

    @kernel
    def vertex_faces(m: Any, v: int, out: Array) -> int:
        count = 0
        for t in range(m.counts[FACE_END]):
            if has_corner(m, t, v):
                out[count] = t
                count += 1
        return count

    return vertex_faces


def edge_faces(has_corner: Kernel) -> Kernel:
    """Make the kernel of the query. Cost O(n_t): the search of thesis chapter 5."""

    @kernel
    def edge_faces(m: Any, e: int, out: Array) -> int:
        a, b = e >> 32, e & 0xFFFFFFFF
        count = 0
        for t in range(m.counts[FACE_END]):
            if has_corner(m, t, a) and has_corner(m, t, b):
                out[count] = t
                count += 1
        return count

    return edge_faces


def follows(is_corner: Kernel) -> Kernel:
    """Make ``follows(m, t, a, b)``: whether corner b comes right after corner a in triangle t."""

    @kernel
    def follows(m: Any, t: int, a: int, b: int) -> bool:
        for i in range(3):
            if is_corner(m, t, i, a) and is_corner(m, t, (i + 1) % 3, b):
                return True
        return False

    return follows


def face_left_of(follows: Kernel) -> Kernel:
    """Make ``face_left_of(m, a, b)``: the triangle that runs a → b, or -1. Cost O(n_t)."""

    @kernel
    def face_left_of(m: Any, a: int, b: int) -> int:
        for t in range(m.counts[FACE_END]):
            if follows(m, t, a, b):
                return t
        return -1

    return face_left_of


def are_joined(has_corner: Kernel) -> Kernel:
    """Make ``are_joined(m, a, b)``: whether any triangle has both. Cost O(n_t)."""

    @kernel
    def are_joined(m: Any, a: int, b: int) -> bool:
        for t in range(m.counts[FACE_END]):
            if has_corner(m, t, a) and has_corner(m, t, b):
                return True
        return False

    return are_joined


def diamond(has_corner: Kernel, follows: Kernel) -> Kernel:
    """Make what operations ask of an edge: its triangles, and the corners opposite. Cost O(n_t)."""

    @kernel
    def diamond(m: Any, e: int, at: Array) -> int:
        a, b, count = e >> 32, e & 0xFFFFFFFF, 0
        at[A], at[B] = a, b
        at[LEFT], at[RIGHT], at[C], at[D] = -1, -1, -1, -1
        for t in range(m.counts[FACE_END]):
            if has_corner(m, t, a) and has_corner(m, t, b):
                opposite = m.triangle[t, 0] + m.triangle[t, 1] + m.triangle[t, 2] - a - b
                side = LEFT if follows(m, t, a, b) else RIGHT
                count += 1 if at[side] < 0 else 3
                at[side], at[C if side == LEFT else D] = t, opposite
        return min(count, 3)

    return diamond
