"""How pieces fly: rigid bodies under gravity that land on a floor and come to rest.

Each piece turns freely as its inertia demands, falls, and meets the floor with the vertices of its
convex hull, where it bounces a little and rubs. Pieces that move into each other push each other
away as balls of half their size would: enough that heaps form and nothing falls through the
others, at a cost that does not grow with their faces. It is no engine for stacking bricks.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.errors import MeshError
from hem.fracture.pieces import Fracture, Mass
from hem.meshes.triangles import TriangleMesh

Floats = NDArray[np.float64]

GRAVITY = 9.81
"""m/s²"""

BOUNCE, FRICTION = 0.25, 0.5
_ROLLING = 4.0
"""1/s: how fast what touches the floor stops turning, so that no ball rolls for ever."""

_PASSES = 4
_MOST_HULL = 64
_STILL_STEPS = 24


class Flight(NamedTuple):
    """Where the pieces are in every frame. All float64.

    A point p of piece i, as it stands in the piece's mesh, is in frame f at
    ``rotations[f, i] @ (p - centers[i]) + positions[f, i]``.
    """

    times: Floats
    """(f,) s after the blow."""

    positions: Floats
    """(f, n, 3): of the centers of mass."""

    rotations: Floats
    """(f, n, 3, 3): what has turned each piece about its center of mass."""

    energies: Floats
    """(f, n) J: kinetic and potential above the floor, or above the origin without one."""

    centers: Floats
    """(n, 3): the centers of mass before the blow."""

    at_rest: NDArray[np.bool_]
    """(n,): which lie still at the end."""


@dataclass(frozen=True)
class Ground:
    """What the pieces fall on: a plane across ``up`` at ``height`` (none: they fall forever)."""

    up: ArrayLike = (0.0, 1.0, 0.0)
    height: float | None = None
    gravity: float = GRAVITY
    bounce: float = BOUNCE
    friction: float = FRICTION


def flight(
    fracture: Fracture,
    motion: Any,
    seconds: float = 1.0,
    frames: int = 60,
    *,
    ground: Ground | None = None,
    rate: float = 240.0,
    collide: bool = True,
    held: ArrayLike = (),
    ease: float = 1.0,
) -> Flight:
    """The flight of a fracture's pieces from the velocities and spins of a motion.

    ``frames`` moments from 0 to ``seconds``, both ends included, at (i / last) ** ``ease`` of it:
    with more than 1 the first ones are slow motion. ``rate`` steps are made a second. By
    default the floor is at the lowest point of all pieces, across y. Pieces of the indices ``held``
    stay where they are, and nothing meets them. Energy is never gained: what
    a correction would add is taken from the motion.

    Cost: O(steps · (vertices of the pieces' hulls + pieces log pieces)); 100 pieces for a second
    take some 0.3 s. Raises MeshError for times, frames or directions that make no sense.
    """
    mass = fracture.mass
    if ground is None:
        ground = Ground(height=lowest(fracture.pieces, (0.0, 1.0, 0.0)))
    _require(seconds, frames, rate, ease, ground)
    bodies = _Bodies(fracture.pieces, mass, motion, ground, collide, held)
    times = seconds * np.linspace(0, 1, frames) ** ease
    kept = [bodies.state()]
    for begin, end in pairwise(times):
        steps = max(1, int(np.ceil((end - begin) * rate - 1e-9)))
        for _ in range(steps):
            bodies.step((end - begin) / steps)
        kept.append(bodies.state())
    positions, rotations, energies = (np.stack(it) for it in zip(*kept, strict=True))
    return Flight(times, positions, rotations, energies, mass.centers.copy(), bodies.asleep.copy())


def lowest(pieces: Any, up: ArrayLike) -> float:
    """How high above the origin, along ``up``, the lowest point of all meshes is. O(points)."""
    top = _unit_of(up)
    return min(float((p.points[np.unique(p.triangles)] @ top).min()) for p in pieces)


def _require(seconds: float, frames: int, rate: float, ease: float, ground: Ground) -> None:
    if not (0 < seconds <= 600):
        raise MeshError(f"a flight takes more than 0 and at most 600 seconds, not {seconds}")
    if not 2 <= frames <= 100_000:
        raise MeshError(f"a flight has 2 … 100,000 frames, not {frames}")
    if not 1 <= rate <= 100_000:
        raise MeshError(f"a flight is computed in 1 … 100,000 steps a second, not {rate}")
    if not 0 < ease <= 10:
        raise MeshError(f"ease is a power of more than 0 and at most 10, not {ease}")
    _unit_of(ground.up)


def _unit_of(up: ArrayLike) -> Floats:
    vector = np.asarray(up, float)
    length = np.linalg.norm(vector) if vector.shape == (3,) else 0.0
    if not (np.isfinite(length) and length > 0):
        raise MeshError(f"up is a direction of three numbers, not {vector.tolist()}")
    return vector / length


class _Bodies:
    """All pieces at once: x (n, 3), turn (n, 3, 3), v (n, 3), spin (n, 3), and what they weigh."""

    def __init__(
        self,
        pieces: Any,
        mass: Mass,
        motion: Any,
        ground: Ground,
        collide: bool,
        held: ArrayLike,
    ) -> None:
        self.mass, self.x = _heavy(mass.masses), mass.centers.copy()
        self.turn = np.tile(np.eye(3), (len(self.x), 1, 1))
        self.v, self.spin = (np.array(it, float) for it in (motion.velocities, motion.spins))
        self.inertia = _firm(mass.inertias)
        self.inverse: Floats = np.linalg.inv(self.inertia).astype(np.float64)
        self.up, self.ground = _unit_of(ground.up), ground
        self.pull = -ground.gravity * self.up
        hulls = [_hull(piece) for piece in pieces]
        self.count = np.array([len(it) for it in hulls])
        self.start = np.cumsum(self.count) - self.count
        self.piece = np.repeat(np.arange(len(hulls)), self.count)
        self.arms = np.concatenate(hulls) - self.x[self.piece]
        self.radius = 0.5 * _sizes(mass.volumes, self.arms, self.start)
        self.collide = collide and len(self.x) > 1
        self.held = np.zeros(len(self.x), bool)
        self.held[np.asarray(held, int)] = True
        self.v[self.held] = self.spin[self.held] = 0
        self.radius[self.held] = 0
        self.asleep = self.held.copy()
        self.still = np.zeros(len(self.x), int)

    def state(self) -> tuple[Floats, Floats, Floats]:
        return self.x.copy(), self.turn.copy(), self.energy()

    def energy(self) -> Floats:
        """(n,) J: of the motion, of the spin and of the height."""
        return self._kinetic() + self._potential()

    def _kinetic(self) -> Floats:
        body = np.einsum("nji,nj->ni", self.turn, self.spin)
        turning = np.einsum("ni,nij,nj->n", body, self.inertia, body)
        return (self.mass * (self.v * self.v).sum(axis=1) + turning) / 2

    def _potential(self) -> Floats:
        return -self.mass * (
            self.x @ self.pull - (self.ground.height or 0.0) * (self.up @ self.pull)
        )

    def step(self, dt: float) -> None:
        """Fly freely, then meet the others and the floor; nothing gains energy but from others."""
        before = self.energy()
        x, turn = self.x.copy(), self.turn.copy()
        awake = ~self.asleep
        self._fly(dt, awake)
        if self.collide:
            before = before + self._meet()
        if self.ground.height is not None:
            self._land(before, x, turn, dt)

    def _fly(self, dt: float, awake: NDArray[np.bool_]) -> None:
        """Exact under gravity; the turn by the midpoint, with the angular momentum kept."""
        now = awake[:, None]
        self.x += np.where(now, self.v * dt + self.pull * (dt * dt / 2), 0)
        self.v += np.where(now, self.pull * dt, 0)
        momentum = _apply(self.turn, self.inertia, self.spin)
        half = _turned(self.spin * (dt / 2)) @ self.turn
        middle = _apply(half, self.inverse, momentum)
        self.turn = np.where(now[:, None], _turned(middle * dt) @ self.turn, self.turn)
        self.spin = _apply(self.turn, self.inverse, momentum)

    def _meet(self) -> Floats:
        """Pieces that come closer than their balls allow stop doing so: (n,) J that each gained."""
        from scipy.spatial import cKDTree

        gained = np.zeros(len(self.x))
        pairs = cKDTree(self.x).query_pairs(2 * float(self.radius.max()), output_type="ndarray")
        if not len(pairs):
            return gained
        a, b = pairs.T
        apart = self.x[b] - self.x[a]
        far = np.linalg.norm(apart, axis=1)
        near = (far < self.radius[a] + self.radius[b]) & (far > 0)
        near &= ~(self.asleep[a] & self.asleep[b]) & ~self.held[a] & ~self.held[b]
        a, b, normal = a[near], b[near], apart[near] / far[near, None]
        kinetic = self._kinetic()
        closing = np.einsum("ij,ij->i", self.v[a] - self.v[b], normal)
        hit = closing > 1e-3
        a, b, normal, closing = a[hit], b[hit], normal[hit], closing[hit]
        shared = np.maximum(np.bincount(np.r_[a, b], minlength=len(self.x)), 1)
        first, second = self.mass[a] / shared[a], self.mass[b] / shared[b]
        push = (first * second / (first + second) * closing)[:, None] * normal
        np.add.at(self.v, a, -push / self.mass[a, None])
        np.add.at(self.v, b, push / self.mass[b, None])
        stirred = np.r_[a, b][np.r_[closing, closing] > 0.25]
        self.asleep[stirred], self.still[stirred] = False, 0
        return self._kinetic() - kinetic

    def _land(self, before: Floats, x: Floats, turn: Floats, dt: float) -> None:
        assert self.ground.height is not None
        arms = np.einsum("kij,kj->ki", self.turn[self.piece], self.arms)
        height = (self.x @ self.up)[self.piece] + arms @ self.up - self.ground.height
        deepest = np.minimum.reduceat(height, self.start)
        touching = (deepest < 0) & ~self.asleep
        if touching.any():
            self._push(arms, height, touching, dt)
        self._lift(deepest, touching, before, x, turn)
        self._settle(deepest, dt)

    def _push(self, arms: Floats, height: Floats, touching: NDArray[Any], dt: float) -> None:
        """Impulses where it sinks fastest, a few times over: bounce and friction."""
        below = np.where((height < 0) & touching[self.piece])[0]
        piece = self.piece[below]
        first = np.r_[True, piece[1:] != piece[:-1]]
        start, owner = np.flatnonzero(first), piece[first]
        group = np.cumsum(first) - 1
        r = arms[below]
        inverse = self.turn[owner] @ self.inverse[owner] @ self.turn[owner].transpose(0, 2, 1)
        self.spin[owner] *= max(0.0, 1 - _ROLLING * dt)
        slow = 2.5 * self.ground.gravity * dt
        for turn in range(_PASSES):
            velocity = self.v[piece] + np.cross(self.spin[piece], r)
            sinking = velocity @ self.up
            least = np.minimum.reduceat(sinking, start)
            tied = (sinking <= least[group] + 1e-6)[:, None]  # an edge or a face: at its middle
            many = np.add.reduceat(tied, start, dtype=float)
            arm = np.add.reduceat(tied * r, start) / many
            speed = np.add.reduceat(tied * velocity, start) / many
            down = np.minimum(speed @ self.up, 0)
            bounce = np.where((-down > slow) & (turn == 0), self.ground.bounce, 0.0)
            along = speed - (speed @ self.up)[:, None] * self.up
            normal = np.tile(self.up, (len(owner), 1))
            press = -(1 + bounce) * down / self._ease(owner, inverse, arm, normal)
            sliding = np.linalg.norm(along, axis=1)
            way = along / np.where(sliding > 0, sliding, 1)[:, None]
            hold = sliding / self._ease(owner, inverse, arm, way)
            rub = np.minimum(hold, self.ground.friction * press)
            impulse = press[:, None] * self.up - rub[:, None] * way
            self.v[owner] += impulse / self.mass[owner, None]
            self.spin[owner] += np.einsum("nij,nj->ni", inverse, np.cross(arm, impulse))

    def _ease(self, owner: Any, inverse: Floats, arm: Floats, way: Floats) -> Floats:
        """(k,) 1/kg: how much an impulse of 1 at the arm, along a way, changes the speed there."""
        twist = np.einsum("nij,nj->ni", inverse, np.cross(arm, way))
        eased: Floats = 1 / self.mass[owner] + np.einsum("ni,ni->n", np.cross(twist, arm), way)
        return eased

    def _lift(
        self, deepest: Floats, touching: NDArray[Any], before: Floats, x: Floats, turn: Floats
    ) -> None:
        """Nothing stays below the floor, and what lifts it is taken from its motion."""
        self.x += np.where(touching, -deepest, 0)[:, None] * self.up
        kinetic, room = self._kinetic(), before - self._potential()
        over = kinetic > room
        scale = np.sqrt(np.clip(room, 0, None) / np.where(kinetic > 0, kinetic, 1))
        scale = np.where(over, scale, 1)[:, None]
        self.v *= scale
        self.spin *= scale
        stuck = touching & (room < 0)  # turned into a corner: stays where it was, at rest
        self.x[stuck], self.turn[stuck] = x[stuck], turn[stuck]
        self.v[stuck] = self.spin[stuck] = 0

    def _settle(self, deepest: Floats, dt: float) -> None:
        """What lies on the floor and has been all but still for a while stays so."""
        slow = self._kinetic() / self.mass < 0.5 * (6 * self.ground.gravity * dt) ** 2
        self.still = np.where(slow & (deepest < 0), self.still + 1, np.where(slow, self.still, 0))
        self.asleep |= self.still >= _STILL_STEPS
        self.v[self.asleep] = self.spin[self.asleep] = 0


def _hull(piece: TriangleMesh) -> Floats:
    """The corners of a piece's convex hull, or all its vertices where it has none."""
    from scipy.spatial import ConvexHull, QhullError

    points = piece.points[np.unique(piece.triangles)].astype(float)
    if len(points) <= 8:
        return points
    try:
        return points[ConvexHull(points).vertices]
    except QhullError:  # a flat one
        return points


def _sizes(volumes: Floats, arms: Floats, start: Any) -> Floats:
    """(n,) the radius of a ball of each one's volume, but not beyond where the piece ends."""
    far = np.maximum.reduceat(np.linalg.norm(arms, axis=1), start)
    return np.minimum(np.cbrt(3 * np.abs(volumes) / (4 * np.pi)), far)


def _heavy(masses: Floats) -> Floats:
    """Masses that can be divided by: crumbs without volume weigh next to nothing."""
    return np.maximum(masses, 1e-9 * max(float(masses.max(initial=0)), 1e-30))


def _firm(inertias: Floats) -> Floats:
    """Inertias that can be inverted: needles and crumbs spin as if a hundredth thicker."""
    trace = np.trace(inertias, axis1=1, axis2=2)
    floor = np.maximum(0.01 * trace, 1e-30)
    return inertias + floor[:, None, None] * np.eye(3)


def _apply(turn: Floats, inertia: Floats, vector: Floats) -> Floats:
    """The body's tensor, turned as the body is, times a vector."""
    body = np.einsum("nji,nj->ni", turn, vector)
    return np.einsum("nij,njk,nk->ni", turn, inertia, body)


def _turned(angles: Floats) -> Floats:
    """Rotations (n, 3, 3) about the vectors (n, 3), by their lengths: Rodrigues' formula."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(angles).as_matrix()
