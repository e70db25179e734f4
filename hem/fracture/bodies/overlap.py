"""Which tetrahedra overlap, and which cross a surface: by separating axes.

Two convex bodies are apart if and only if their shadows on some axis are. For polyhedra it is
enough to try the normals of their faces and the vector products of their edges (Gottschalk, Lin &
Manocha, OBBTree, 1996). Bodies that touch, in a point, an edge or a face, do not overlap.
"""

import numpy as np
from numba import njit

from hem.arrays import Array

# The faces of a tetrahedron by three corners, and its edges; a triangle has the first of each.
_FACES = np.array([(0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
_EDGES = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])


@njit(cache=True)
def overlapping(tetrahedra: Array, least: float) -> Array:
    """(k,) bool: which of tetrahedra (k, 4, 3) overlap another one by more than ``least`` deep.

    Cost O(k²) for the bounding boxes, and the axes for pairs whose boxes meet.
    """
    found = np.zeros(len(tetrahedra), np.bool_)
    for i in range(len(tetrahedra)):
        for j in range(i):
            if _overlap(tetrahedra[i], tetrahedra[j], least):
                found[i] = found[j] = True
    return found


@njit(cache=True)
def crossing(tetrahedra: Array, triangles: Array, least: float) -> Array:
    """(k,) bool: which of tetrahedra (k, 4, 3) reach into any of triangles (m, 3, 3). O(k m)."""
    found = np.zeros(len(tetrahedra), np.bool_)
    for i in range(len(tetrahedra)):
        for j in range(len(triangles)):
            if _overlap(tetrahedra[i], triangles[j], least):
                found[i] = True
                break
    return found


@njit(cache=True)
def _boxes_meet(a: Array, b: Array) -> bool:
    for j in range(3):
        low_a = high_a = a[0, j]
        low_b = high_b = b[0, j]
        for i in range(1, len(a)):
            low_a, high_a = min(low_a, a[i, j]), max(high_a, a[i, j])
        for i in range(1, len(b)):
            low_b, high_b = min(low_b, b[i, j]), max(high_b, b[i, j])
        if high_a <= low_b or high_b <= low_a:
            return False
    return True


@njit(cache=True)
def _overlap(a: Array, b: Array, least: float) -> bool:
    """Whether no axis is found on which the shadows overlap by ``least`` at most."""
    if not _boxes_meet(a, b):
        return False
    axis = np.zeros(3)
    for body in (a, b):
        for f in range(4 if len(body) == 4 else 1):
            p, q, r = body[_FACES[f, 0]], body[_FACES[f, 1]], body[_FACES[f, 2]]
            _cross(q, p, r, p, axis)
            if _apart(a, b, axis, least):
                return False
    for i in range(6 if len(a) == 4 else 3):
        for j in range(6 if len(b) == 4 else 3):
            _cross(a[_EDGES[i, 1]], a[_EDGES[i, 0]], b[_EDGES[j, 1]], b[_EDGES[j, 0]], axis)
            if _apart(a, b, axis, least):
                return False
    return True


@njit(cache=True)
def _cross(p: Array, q: Array, r: Array, s: Array, axis: Array) -> None:
    """The vector product of p - q and r - s."""
    for j in range(3):
        k, m = (j + 1) % 3, (j + 2) % 3
        axis[j] = (p[k] - q[k]) * (r[m] - s[m]) - (p[m] - q[m]) * (r[k] - s[k])


@njit(cache=True)
def _apart(a: Array, b: Array, axis: Array, least: float) -> bool:
    size = np.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
    if size < least * least:  # the edges are parallel, and no axis
        return False
    low_a = low_b = np.inf
    high_a = high_b = -np.inf
    for i in range(len(a)):
        at = (a[i, 0] * axis[0] + a[i, 1] * axis[1] + a[i, 2] * axis[2]) / size
        low_a, high_a = min(low_a, at), max(high_a, at)
    for i in range(len(b)):
        at = (b[i, 0] * axis[0] + b[i, 1] * axis[1] + b[i, 2] * axis[2]) / size
        low_b, high_b = min(low_b, at), max(high_b, at)
    return bool(min(high_a - low_b, high_b - low_a) <= least)  # how far to push one out
