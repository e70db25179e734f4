"""The blow: how its energy decides where a body breaks, and how the pieces fly."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Bools, Floats
from hem.errors import MeshError
from hem.fracture.mass import Mass, positive
from hem.fracture.material import Material
from hem.fracture.pieces import Fracture
from hem.meshes import direction, dot, length, position

MOST_SITES = 1000  # however strong a blow is, it makes no more cells than this
LEAST_REACH, MOST_REACH = 0.01, 2.0  # in diagonals: less makes dust, and more finds nothing more
STRIKER = 0.1  # the mass of what strikes, as a part of the mass of what is struck
ANCHORS = 96  # so many sites around the broken part, whose cells stay whole
TRIES = 200  # positions for each site wanted, and at least 20,000, until all are inside


@dataclass(frozen=True, eq=False)
class Blow:
    """A blow of so many joules per kilogram of what is struck, whose energy is force × mass.

    impact     (3,) float64: where it strikes, on the surface
    direction  (3,) float64: where it goes; of any length, and of length 1 from then on
    force      J / kg, so that a large model breaks as a small one does

    Raises MeshError for a force that is not positive and finite, and for an impact or a direction
    that is not three finite numbers, or a direction of no length.
    """

    impact: Floats
    direction: Floats
    force: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", positive(self.force, "a force in J/kg"))
        object.__setattr__(self, "impact", position(self.impact, "an impact"))
        object.__setattr__(self, "direction", direction(self.direction))

    def count(self, material: Material) -> int:
        """How many sites: material.sites × √force, at least 2 and at most MOST_SITES."""
        return max(round(min(material.sites * math.sqrt(self.force), MOST_SITES)), 2)

    def reach(self, material: Material, diagonal: float) -> float:
        """How far sites lie at most: material.reach × diagonal × ∛force, within limits.

        What is broken is then in proportion to the energy, as its volume is to reach³.
        """
        part = material.reach * cube_root(self.force)
        return min(max(part, LEAST_REACH), MOST_REACH) * diagonal

    def tightness(self) -> float:
        """How they gather: 0, evenly in distance, for the weakest; near 3/4 for the strongest."""
        return 0.75 * self.force / (1 + self.force)


class Sites(NamedTuple):
    """Where a body breaks."""

    points: Floats  # (k, 3): inside the body; their cells break off
    anchors: Floats  # (a, 3): around them, inside or not; their cells stay whole
    outside: int  # how many positions were outside and given up


class Motion(NamedTuple):
    """How pieces set off.

    velocities  (n, 3) m / s: of the centers of mass
    spins       (n, 3) rad / s: about the centers of mass
    """

    velocities: Floats
    spins: Floats


def sites(
    blow: Blow, material: Material, diagonal: float, inside: Callable[[Floats], Bools], seed: int
) -> Sites:
    """Break points inside a body, gathered round the impact.

    The directions are even over the sphere. The distances are reach × u (1 - t + t u) for u even
    in 0 … 1 and t the blow's tightness: as many sites per unit of distance, and so 1/r² as many per
    unit of volume, and more toward the impact yet for stronger blows. ``inside`` says which of the
    positions (k, 3) are. There may be fewer sites than blow.count where little of the body is in
    reach, and MeshError is raised if there is none.

    The same seed gives the same sites on every machine: PCG64 and IEEE arithmetic decide alone.
    Source: Müller, Chentanez & Kim, Real time dynamic fracture with volumetric approximate convex
    decompositions, 2013, for a pattern that is denser toward the impact.
    """
    random = generator(seed)
    reach, tight = blow.reach(material, diagonal), blow.tightness()
    around = _directions(random, ANCHORS)
    anchors = blow.impact + around * (reach * (1.1 + 0.4 * random.random(ANCHORS))[:, None])
    wanted = blow.count(material)
    found, tried = np.zeros((0, 3)), 0
    while len(found) < wanted and tried < max(TRIES * wanted, 20_000):
        u = random.random(wanted)
        far = reach * u * ((1 - tight) + tight * u)
        at = blow.impact + _directions(random, wanted) * far[:, None]
        found = np.concatenate([found, at[inside(at)]])
        tried += wanted
    if not len(found):
        raise MeshError(f"the body is too thin here: none of {tried:,} positions tried is inside")
    return Sites(found[:wanted], anchors, tried - len(found))


def motion(fracture: Fracture, blow: Blow, seed: int | None = None, held: ArrayLike = ()) -> Motion:
    """How the pieces fly: their velocities and spins, right after the blow.

    What was struck was at rest, and a striker of a tenth of its mass brings the energy force ×
    mass. As in an inelastic impact it gives the whole the momentum J × direction at the impact,
    for which J stands to the striker's momentum as the mass that the whole opposes there to the
    sum of both (Mirtich, Impulse-based dynamic simulation, 1996): at most a quarter of the energy.
    Apart from that the pieces burst outward from a point above the impact, the faster the nearer
    their centers of mass are, and tumble, half by the seed (the fracture's own if not given); the
    whole gains no momentum from it and material.burst × energy, three quarters at most. The pieces
    of the indices ``held`` stay at rest: what holds them takes up their part of the blow, and the
    others are the whole.

    So Σ m v = J d, the angular momentum about the impact is 0, and the kinetic energy is at most
    force × mass; for pieces of sheets as for bodies. O(n).
    """
    pieces = fracture.of_density_1  # a blow is per kilogram; no sum of squares overflows then
    if not pieces.masses.sum() > 0:
        raise MeshError("the pieces weigh nothing, and no blow moves them")
    moving = Motion(*np.zeros((2, len(fracture.pieces), 3)))
    free = fracture.free(held)
    mass = Mass(*(column[free] for column in pieces))
    if not mass.masses.sum() > 0:
        return moving
    whole = _whole(mass)
    random = generator(fracture.seed if seed is None else seed)
    thrown = _thrown(mass, fracture, blow, random)
    burst = _without_momentum(mass, whole, thrown)
    part = min(fracture.material.burst, 0.75) * float(whole.masses[0])
    own = kinetic_energy(mass, burst)
    # What rounding leaves of a single piece's burst is no motion to be scaled up.
    real = own > 1e-20 * kinetic_energy(mass, thrown)
    scale = math.sqrt(blow.force) * math.sqrt(part / own) if real else 0.0
    velocities, spins = _carried(mass, whole, _struck(whole, blow))
    moving.velocities[free] = velocities + scale * burst.velocities
    moving.spins[free] = spins + scale * burst.spins
    return moving


def momentum(mass: Mass, motion: Motion, about: Floats) -> tuple[Floats, Floats]:
    """The linear momentum (3,) of all pieces, and the angular one (3,) about a position."""
    linear = mass.masses[:, None] * motion.velocities
    spun = np.einsum("nij,nj->ni", mass.inertias, motion.spins)
    return linear.sum(axis=0), (np.cross(mass.centers - about, linear) + spun).sum(axis=0)


def kinetic_energies(mass: Mass, motion: Motion) -> Floats:
    """(n,) joules: of each piece."""
    moving = mass.masses * dot(motion.velocities, motion.velocities)
    turning = np.einsum("ni,nij,nj->n", motion.spins, mass.inertias, motion.spins)
    return (moving + turning) / 2


def kinetic_energy(mass: Mass, motion: Motion) -> float:
    """In joules, of all pieces."""
    return float(kinetic_energies(mass, motion).sum())


def cube_root(value: float) -> float:
    """Of a positive number, the same on every machine, which a library's need not be."""
    root = math.ldexp(1.0, -(-math.frexp(value)[1] // 3))
    for _ in range(8):  # Newton's; from above, at most twice as large
        root = (2 * root + value / (root * root)) / 3
    return root


def generator(seed: int) -> np.random.Generator:
    """Random numbers, the same on every machine. MeshError for what is no seed."""
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise MeshError(f"a seed is a whole number from 0 on, not {seed!r}")
    return np.random.Generator(np.random.PCG64(int(seed)))


def _directions(random: np.random.Generator, n: int) -> Floats:
    """(n, 3) of length 1, even over the sphere: what of a cube lies in the ball, cast outward."""
    found = np.zeros((0, 3))
    while len(found) < n:
        cast = 2 * random.random((2 * n, 3)) - 1
        square = dot(cast, cast)
        good = (square <= 1) & (square > 1e-4)
        found = np.concatenate([found, cast[good] / np.sqrt(square[good])[:, None]])
    return found[:n]


def _whole(mass: Mass) -> Mass:
    """All pieces as one, rigidly joined; a Mass of one piece."""
    total = mass.masses.sum()
    center = (mass.masses[:, None] * mass.centers).sum(axis=0) / total
    from_center = mass.centers - center
    squares = dot(from_center, from_center)[:, None, None] * np.eye(3)
    outer = from_center[:, :, None] * from_center[:, None]
    moved = mass.inertias + mass.masses[:, None, None] * (squares - outer)
    return Mass(mass.volumes.sum()[None], total[None], center[None], moved.sum(axis=0)[None])


def _struck(whole: Mass, blow: Blow) -> Motion:
    """How the whole moves after an inelastic impact of the striker."""
    turning = np.linalg.pinv(whole.inertias[0], hermitian=True)
    lever = np.cross(blow.impact - whole.centers[0], blow.direction)
    total = float(whole.masses[0])
    opposed = 1 / (1 / total + float(lever @ turning @ lever))
    striker = STRIKER * total
    brought = math.sqrt(blow.force) * math.sqrt(2 * striker * total)
    impulse = brought * (opposed / (striker + opposed))
    return Motion((impulse / total * blow.direction)[None], (impulse * turning @ lever)[None])


def _thrown(mass: Mass, fracture: Fracture, blow: Blow, random: np.random.Generator) -> Motion:
    """Away from a point above the impact, at speeds without a scale; and tumbling."""
    reach = blow.reach(fracture.material, fracture.diagonal)
    away = mass.centers - (blow.impact - 0.02 * fracture.diagonal * blow.direction)
    far = length(away)[:, None]
    outward = away / np.maximum(far, 1e-9 * fracture.diagonal)
    speed = 1 / (1 + (far / reach) ** 2)
    size = np.sqrt(np.trace(mass.inertias, axis1=1, axis2=2) / np.maximum(mass.masses, 1e-300))
    any_way = _directions(random, len(far)) * random.random(len(far))[:, None]
    lever = np.cross(outward, blow.direction)
    rim = np.maximum(size, 0.05 * fracture.diagonal)[:, None]
    return Motion(speed * outward, speed / rim * (any_way + lever) / 2)


def _without_momentum(mass: Mass, whole: Mass, thrown: Motion) -> Motion:
    """What is left of a motion without that of the whole: no momentum, linear or angular."""
    linear, angular = momentum(mass, thrown, whole.centers[0])
    spin = np.linalg.pinv(whole.inertias[0], hermitian=True) @ angular
    shared = _carried(mass, whole, Motion(linear[None] / whole.masses[0], spin[None]))
    return Motion(thrown.velocities - shared.velocities, thrown.spins - shared.spins)


def _carried(mass: Mass, whole: Mass, rigid: Motion) -> Motion:
    """What each piece does while the whole moves rigidly."""
    levers = mass.centers - whole.centers[0]
    velocities = rigid.velocities[0] + np.cross(rigid.spins[0], levers)
    return Motion(velocities, np.broadcast_to(rigid.spins[0], levers.shape).copy())
