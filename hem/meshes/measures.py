"""How large: bounds, lengths, areas, normals and volume, from plain arrays.

Vectors stand in the last axis, (…, 3), and triangles as their corners, (m, 3, 3). Sums are taken in
one order, so that the answers are the same on every machine.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Floats
from hem.errors import MeshError


def corners(points: Array, triangles: Array) -> Floats:
    """(m, 3, 3): where the corners of triangles (m, 3) are."""
    return points[triangles].astype(np.float64)


def dot(a: Array, b: Array) -> Any:
    """(…,): the scalar products."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def length(vectors: Array) -> Any:
    """(…,): of vectors."""
    return np.sqrt(dot(vectors, vectors))


def unit(vectors: Array) -> Floats:
    """Of length 1, (…, 3); what has no length becomes NaN."""
    return vectors / length(vectors)[..., None]


def direction(given: ArrayLike) -> Floats:
    """One direction (3,), of length 1. Raises MeshError for three zeros, or no three numbers."""
    vector = position(given, "a direction")
    largest = float(np.abs(vector).max())
    if not largest > 0:
        raise MeshError("a direction has some length, and this one has none")
    return unit(vector / largest)  # so that no square overflows or vanishes


def position(given: object, what: str = "a position") -> Floats:
    """Three finite numbers as (3,), or MeshError."""
    try:
        at = np.array(given, np.float64)
    except (TypeError, ValueError, OverflowError):
        at = np.zeros(0)
    if at.shape != (3,) or not np.isfinite(at).all():
        raise MeshError(f"{what} is three finite numbers, not {given!r}")
    return at


def normals(corners: Array) -> Floats:
    """(m, 3): outward, of twice the area's length."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def areas(corners: Array) -> Floats:
    """(m,): of triangles."""
    return length(normals(corners)) / 2


def volume(corners: Array) -> float:
    """Enclosed by triangles that form a closed surface, positive if they are wound outward."""
    about = corners - (corners[0, 0] if len(corners) else 0)
    return float(dot(about[:, 0], np.cross(about[:, 1], about[:, 2])).sum() / 6)


def bounds(points: Array) -> tuple[Floats, Floats]:
    """The lower and the upper corner (3,) of the bounding box of points (n, 3), NaN aside. O(n)."""
    columns = np.ascontiguousarray(points.T)
    low = np.fmin.reduce(columns, axis=1, initial=np.inf)
    high = np.fmax.reduce(columns, axis=1, initial=-np.inf)
    return low.astype(np.float64), high.astype(np.float64)


def diagonal(points: Array) -> float:
    """The length of the diagonal of the bounding box of points (n, 3), NaN aside. O(n)."""
    low, high = bounds(points)
    return float(length(high - low))
