"""How pieces fly: free fall from the blow's velocities, a hop on the floor, and rest.

A piece meets the floor with its convex hull and nothing else: pieces pass through each other. On
the floor friction stops it and it tips onto the side it can lie on. All is in closed form.
"""

from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Bools, Floats
from hem.errors import MeshError
from hem.fracture.pieces import Fracture
from hem.meshes import TriangleMesh, direction

GRAVITY = 9.81
"""m/s²"""

BOUNCE, FRICTION = 0.25, 0.5
_RATE = 200  # moments a second at which it is seen whether a piece has met the floor


class Flight(NamedTuple):
    """Where the pieces are in every frame.

    A point p of piece i, as it stands in the piece's mesh, is in frame f at
    ``rotations[f, i] @ (p - mass.centers[i]) + positions[f, i]``.
    """

    times: Floats  # (f,) s after the blow
    positions: Floats  # (f, n, 3): of the centers of mass
    rotations: Floats  # (f, n, 3, 3)
    at_rest: Bools  # (n,): which lie still at the end


def flight(
    fracture: Fracture, motion: Any, seconds: float = 1.0, frames: int = 60, *,
    up: ArrayLike = (0.0, 1.0, 0.0), floor: float = 0.0, held: ArrayLike = (), ease: float = 1.0,
) -> Flight:  # fmt: skip
    """The flight of a fracture's pieces from the velocities and spins of a motion.

    ``frames`` moments from 0 to ``seconds``, both included, at (i / last) ** ``ease`` of it: with
    more than 1 the first ones are slow motion. The floor lies across ``up`` (3,), of any length, at
    the height ``floor``. The pieces of the indices ``held`` stay where they are. Cost O(pieces ·
    seconds · vertices of a hull). Raises MeshError for times and frames that make no sense.
    """
    numbers = all(isinstance(it, Real) for it in (seconds, ease, floor)) and np.isfinite(floor)
    whole = numbers and isinstance(frames, int | np.integer) and 2 <= frames <= 100_000
    if not (whole and 0 < seconds <= 600 and 0 < ease <= 10):
        raise MeshError(
            "a flight takes 0 … 600 seconds, 2 … 100,000 frames, an ease of 0 … 10 and a floor "
            f"somewhere, not {seconds!r}, {frames!r}, {ease!r} and {floor!r}"
        )
    times, top = seconds * np.linspace(0, 1, frames) ** ease, direction(up)
    mass = fracture.mass
    positions = np.tile(mass.centers, (frames, 1, 1))
    rotations = np.tile(np.eye(3), (frames, len(mass.centers), 1, 1))
    at_rest = np.ones(len(mass.centers), bool)
    for i in fracture.free(held):
        piece = _Piece(fracture.pieces[i], mass.centers[i], top, floor)
        fallen = piece.fly(motion.velocities[i], motion.spins[i], times)
        positions[:, i], rotations[:, i], at_rest[i] = fallen
    return Flight(times, positions, rotations, at_rest)


class _Piece:
    """The hull of a piece: its corners from the center of mass, and what it may lie on."""

    def __init__(self, mesh: TriangleMesh, center: Floats, up: Floats, floor: float) -> None:
        points = mesh.points[np.unique(mesh.triangles)].astype(float) - center
        self.center, self.up, self.floor = center, up, floor
        self.corners, self.sides = _hull(points)

    def fly(self, velocity: Floats, spin: Floats, times: Floats) -> tuple[Floats, Floats, bool]:
        """Positions (f, 3), rotations (f, 3, 3), and whether it lies still at the last time."""
        landing = self._landing(velocity, spin, times[-1])
        positions, rotations = self._free(velocity, spin, np.minimum(times, landing))
        after = np.maximum(times - landing, 0)
        arrived = velocity - GRAVITY * landing * self.up
        sinking = float(arrived @ self.up)
        along = arrived - sinking * self.up
        speed = float(np.linalg.norm(along))
        stop = speed / (FRICTION * GRAVITY)
        t = np.minimum(after, stop)[:, None]
        positions += along * t * (1 - t / (2 * stop) if stop else 1)
        tipping = np.sqrt(np.linalg.norm(self.corners, axis=1).max() / GRAVITY) / 3
        part = 1 - (1 + after / tipping) * np.exp(-after / tipping)
        turn = self._tip(spin, landing, tipping)
        rotations = _turned(part[:, None] * turn) @ rotations
        hop = np.maximum(-BOUNCE * sinking * after - GRAVITY / 2 * after**2, 0)
        height = self._height(positions, rotations)
        lift = np.where(after > 0, hop - height, np.maximum(-height, 0))
        rest = after[-1] > max(stop, 10 * tipping)
        return positions + lift[:, None] * self.up, rotations, bool(rest)

    def _free(self, velocity: Floats, spin: Floats, t: Floats) -> tuple[Floats, Floats]:
        fallen = self.center + t[:, None] * velocity - (GRAVITY / 2 * t**2)[:, None] * self.up
        return fallen, _turned(t[:, None] * spin)

    def _height(self, positions: Floats, rotations: Floats) -> Floats:
        """(f,) how far above the floor the lowest corner is."""
        lowest = (np.swapaxes(rotations, 1, 2) @ self.up @ self.corners.T).min(axis=1)
        return positions @ self.up + lowest - self.floor

    def _landing(self, velocity: Floats, spin: Floats, end: float) -> float:
        """When it first touches the floor on its way down, or else ``end``."""
        t = np.linspace(0, end, max(2, int(end * _RATE)))
        low = self._height(*self._free(velocity, spin, t))
        met = (low <= 1e-6 * np.abs(self.corners).max()) & (velocity @ self.up <= GRAVITY * t)
        return float(t[met.argmax()]) if met.any() else end

    def _tip(self, spin: Floats, landing: float, ahead: float) -> Floats:
        """The rotation vector from how it lands to how it lies: onto the side it is tipping to."""
        down, soon = _turned(spin * np.array([[landing], [landing + ahead]]))
        side = self.sides[(self.sides @ -((down + soon).T @ self.up)).argmax()]
        turned = down @ side
        axis, cosine = np.cross(turned, -self.up), float(turned @ -self.up)
        sine = float(np.linalg.norm(axis))
        return axis / sine * np.arctan2(sine, cosine) if sine > 1e-9 else np.zeros(3)


def _hull(points: Floats) -> tuple[Floats, Floats]:
    """The corners of the convex hull (k, 3), and the normals of the sides it can lie on (s, 3).

    On a side it lies if its center of mass is above that side. What is flat lies on its face.
    """
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        flat = np.linalg.svd(points, full_matrices=False)[2][2]  # through the center of mass
        return points, np.stack([flat, -flat])
    normals, far = hull.equations[:, :3], -hull.equations[:, 3]
    below = (normals @ normals.T * far[:, None] <= far[None, :] + 1e-9 * far.max()).all(axis=1)
    return points[hull.vertices], normals[below]  # the nearest side is always one of them


def _turned(angles: Floats) -> Floats:
    """Rotations (f, 3, 3) about the vectors (f, 3), by their lengths."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(angles).as_matrix()
