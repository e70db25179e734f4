"""Error quadrics: the sum of squared distances from a point to planes, as a quadratic function.

A quadric is a row ``xx xy xz yy yz zz x y z 1 weight`` of the symmetric matrix A, the vector b and
the number c of ``p·A·p + 2 b·p + c``; the weight is that of all its planes together. Sums of planes
are sums of rows. Source: Garland & Heckbert, Surface Simplification Using Quadric Error Metrics
(1997).
"""

from __future__ import annotations

import numpy as np

from hem.algorithms.parts import cross, unit
from hem.arrays import Array, Floats
from hem.authoring import kernel
from hem.engine import kept

WIDTH = 11

TOWARD_MIDDLE = 1e-3
"""How much the middle of an edge counts, against the planes: it decides where they do not."""

BORDER_WEIGHT = 1.0
"""How much the planes that stand upright on the border count: as a square on the edge."""


@kernel
def add_plane(
    rows: Floats, corners: tuple[int, ...], normal: tuple[float, ...], weight: float, plane: Floats
) -> None:
    """Add to the quadrics of some vertices the plane through the first one, normal to a vector.

    ``plane`` (WIDTH,) is scratch: the compiler adds up what lies in a row four numbers at a time.
    """
    first = corners[0]
    x, y, z = unit(*normal)
    d = -(x * rows[first, 0] + y * rows[first, 1] + z * rows[first, 2])
    parts = x * x, x * y, x * z, y * y, y * z, z * z, x * d, y * d, z * d, d * d, 1.0
    for i in range(WIDTH):
        plane[i] = weight * parts[i]
    for v in corners:
        for i in range(WIDTH):
            rows[v, 3 + i] += plane[i]


@kernel
def between(rows: Floats, a: int, b: int) -> tuple[float, float, float]:
    """From one vertex to another."""
    return rows[b, 0] - rows[a, 0], rows[b, 1] - rows[a, 1], rows[b, 2] - rows[a, 2]


@kept
def add_quadrics(rows: Floats, triangles: Array, borders: Array) -> None:
    """Add to each vertex the planes of its faces and borders, weighted by area.

    ``rows`` (n, 3 + WIDTH or more): position and quadric of each. ``borders`` (k, 3): the two ends
    of each edge on the border, and the third corner of its face.
    """
    plane = np.zeros(WIDTH)
    for f in range(len(triangles)):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        x, y, z = cross(between(rows, a, b), between(rows, a, c))
        add_plane(rows, (a, b, c), (x, y, z), np.sqrt(x * x + y * y + z * z) / 2, plane)
    for f in range(len(borders)):
        a, b, c = borders[f, 0], borders[f, 1], borders[f, 2]
        side = x, y, z = between(rows, a, b)
        upright = cross(side, cross(side, between(rows, a, c)))
        add_plane(rows, (a, b), upright, BORDER_WEIGHT * (x * x + y * y + z * z), plane)


@kernel
def value(row: Array, x: float, y: float, z: float) -> float:
    """The weighted sum of squared distances of a point."""
    total = row[0] * x * x + row[3] * y * y + row[5] * z * z + row[9]
    total += 2 * (row[1] * x * y + row[2] * x * z + row[4] * y * z)
    total += 2 * (row[6] * x + row[7] * y + row[8] * z)
    return max(total, 0.0)


@kernel
def best_point(row: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """The point nearest to all planes, by Cramer's rule; a little drawn to a middle (x, y, z)."""
    pull = TOWARD_MIDDLE * (row[0] + row[3] + row[5])
    xx, yy, zz = row[0] + pull, row[3] + pull, row[5] + pull
    xy, xz, yz = row[1], row[2], row[4]
    u, v, w = pull * x - row[6], pull * y - row[7], pull * z - row[8]
    first, second, third = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    size = xx * first + xy * second + xz * third
    if not size > 0:
        return x, y, z
    fourth, fifth, sixth = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    return (
        (first * u + second * v + third * w) / size,
        (second * u + fourth * v + fifth * w) / size,
        (third * u + fifth * v + sixth * w) / size,
    )
