"""Where a picture is taken from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True)
class Camera:
    """Where a picture is taken from. ``field_of_view`` is the vertical one, in degrees."""

    position: Array
    target: Array
    up: Array
    field_of_view: float = 26.0

    @classmethod
    def around(
        cls,
        points: ArrayLike,
        azimuth: float = 30.0,
        elevation: float = 18.0,
        up: ArrayLike = AXES["y"],
        aspect: float = 4 / 3,
        margin: float = 0.08,
        field_of_view: float = 26.0,
    ) -> Camera:
        """A camera that sees all points (n, 3) and stands as near as that allows. O(n).

        ``azimuth`` turns it around ``up``, from the axis that follows next but one (z for y, y
        for x, x for z), ``elevation`` lifts it; both in degrees. ``margin`` is the part of the
        picture that stays free on each side.
        """
        top = unit(np.asarray(up, float))
        toward = _toward(top, azimuth, elevation)
        right, above = _axes(toward, top)
        p = np.asarray(points, float)
        depth, across, height = p @ -toward, p @ right, p @ above
        tall = np.tan(np.radians(field_of_view) / 2) * (1 - 2 * margin)
        (x, far_x), (y, far_y) = (
            _between(across, depth, tall * aspect),
            _between(height, depth, tall),
        )
        back = min(far_x, far_y)
        position = x * right + y * above - back * toward
        middle = (depth.min() + depth.max()) / 2
        return cls(position, position - (middle - back) * toward, top, field_of_view)

    def axes(self) -> tuple[Array, Array, Array]:
        """To the right, to the top, and forward: (3,) each, of length 1."""
        toward = unit(self.position - self.target)
        return *_axes(toward, self.up), -toward

    def rays(self, x: Array, y: Array, size: tuple[int, int]) -> Array:
        """The directions (k, 3) through places of a picture of (width, height) pixels."""
        width, height = size
        right, above, forward = self.axes()
        tall = np.tan(np.radians(self.field_of_view) / 2)
        across = (x / width * 2 - 1) * tall * width / height
        down = (1 - y / height * 2) * tall
        return unit(forward + across[:, None] * right + down[:, None] * above)


def unit(vectors: Array) -> Array:
    """Vectors (…, 3) of length 1; those of no length stay."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1)


def frame(axis: Array) -> tuple[Array, Array]:
    """Two directions across an axis and across each other."""
    first = unit(np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    return first, np.cross(axis, first)


def _toward(up: Array, azimuth: float, elevation: float) -> Array:
    around, lifted = np.radians(azimuth), np.radians(elevation)
    start = np.roll(up, 1) if np.count_nonzero(up) == 1 else frame(up)[0]
    level = np.cos(around) * start + np.sin(around) * np.cross(up, start)
    return np.cos(lifted) * level + np.sin(lifted) * up


def _between(across: Array, depth: Array, slope: float) -> tuple[float, float]:
    """Where the apex of a wedge of this slope stands that just holds all points."""
    left, right = (across - slope * depth).max(), (-across - slope * depth).max()
    return float(left - right) / 2, float(-(left + right) / (2 * slope))


def _axes(toward: Array, up: Array) -> tuple[Array, Array]:
    right = np.cross(up, toward)
    if np.linalg.norm(right) < 1e-9:
        right = frame(up)[0]
    right = unit(right)
    return right, np.cross(toward, right)
