"""The nearest points of a surface, for vertices that are to stay on it.

Of a few triangles, those whose middles are nearest, the nearest point is taken. On a surface of
very long triangles that may be a point beside the nearest one. Triangles that face away from a
vertex come last: they are the other side of a thin wall.
"""

from __future__ import annotations

import numpy as np

from hem.algorithms.parts import cross, dot
from hem.arrays import Array, Floats
from hem.authoring import kernel
from hem.engine import kept

CANDIDATES = 12
"""How many triangles are looked at for each point."""

FLAT = 1e-14
"""How little the square of twice an area may be: a part of those of its sides and of the way there.
"""


class Surface:
    """Triangles to be asked for nearest points. Cost O(n_t log n_t)."""

    def __init__(self, points: Array, triangles: Array) -> None:
        from scipy.spatial import cKDTree  # here, as it is long to import

        self._corners = points[triangles].astype(np.float64)
        self._middles = cKDTree(self._corners.mean(axis=1)) if len(triangles) else None

    def nearest(self, points: Array, normals: Array) -> Floats:
        """(n, 3) float64, for points (n, 3) and their normals. Cost O(log n_t) each."""
        found = points.astype(np.float64)
        if self._middles is not None and len(points):
            few = range(1, min(CANDIDATES, len(self._corners)) + 1)
            _, candidates = self._middles.query(found, k=few)
            _nearest(self._corners, candidates, normals, found)
        return found


@kernel
def nearest_weights(corners: Floats, p: Floats) -> tuple[float, float, float]:
    """The barycentric weights of the point of a triangle (3, 3) that is nearest to p (3,).

    By the regions of a triangle: Ericson, Real-Time Collision Detection (2005), 5.1.5.
    """
    ab, ac, ap = corners[1] - corners[0], corners[2] - corners[0], p - corners[0]
    d1, d2 = dot(ab, ap), dot(ac, ap)
    if d1 <= 0 and d2 <= 0:
        return 1.0, 0.0, 0.0
    bp = p - corners[1]
    d3, d4 = dot(ab, bp), dot(ac, bp)
    if d3 >= 0 and d4 <= d3:
        return 0.0, 1.0, 0.0
    cp = p - corners[2]
    d5, d6 = dot(ab, cp), dot(ac, cp)
    if d6 >= 0 and d5 <= d6:
        return 0.0, 0.0, 1.0
    a, b, c = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    if a + b + c <= FLAT * (dot(ap, ap) + dot(ab, ab)) * dot(ac, ac):
        a = b = c = 0.0  # as they are but roundings: what lies beside a side is nearest to it
    # Where two corners coincide their edge has no length to divide by; then another one is taken.
    if c <= 0 <= d1 and d3 <= 0 and d3 < d1:
        v = d1 / (d1 - d3)
        return 1 - v, v, 0.0
    if b <= 0 <= d2 and d6 <= 0 and d6 < d2:
        w = d2 / (d2 - d6)
        return 1 - w, 0.0, w
    if a <= 0 <= d4 - d3 and d5 >= d6 and (d4 - d3) + (d5 - d6) > 0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 0.0, 1 - w, w
    total = a + b + c
    return (a / total, b / total, c / total) if total > 0 else (1.0, 0.0, 0.0)


@kept
def _nearest(corners: Floats, candidates: Array, normals: Floats, points: Floats) -> None:
    """Take every point to the nearest of its candidates, of those that face as it does if any."""
    for i in range(len(points)):
        least, best = (True, np.inf), points[i].copy()
        for f in candidates[i]:
            a, b, c = corners[f, 0], corners[f, 1], corners[f, 2]
            x, y, z = cross(b - a, c - a)
            away = x * normals[i, 0] + y * normals[i, 1] + z * normals[i, 2] < 0
            u, v, w = nearest_weights(corners[f], points[i])
            there = u * a + v * b + w * c
            far = away, ((there - points[i]) ** 2).sum()
            if far < least:
                least, best = far, there
        points[i] = best
