"""Flights: what mechanics says of them, piece by piece."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

import hem
from hem.fracture.files import names
from hem.fracture.material import MATERIALS
from hem.fracture.pieces import Fracture
from hem.fracture.show.flight import GRAVITY, Flight, Ground, flight, lowest


class Motion(NamedTuple):
    velocities: np.ndarray
    spins: np.ndarray


def box(size, center=(0.0, 0.0, 0.0)) -> hem.TriangleMesh:
    """A box of the lengths ``size`` around a center, wound outward."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return hem.TriangleMesh(corners * size + np.asarray(center), triangles)


def fracture(pieces, method="voronoi") -> Fracture:
    return Fracture(
        method=method,
        material=MATERIALS["stone"],
        seed=0,
        impact=np.zeros(3),
        direction=np.array([1.0, 0, 0]),
        shards=pieces,
        rest=[],
        counts={},
        diagonal=1.0,
        find_neighbors=lambda: np.zeros((0, 2), np.int64),
    )


def heap(n=12, seed=0) -> tuple[Fracture, Motion]:
    """Boxes of all shapes above each other, thrown in all directions."""
    random = np.random.default_rng(seed)
    pieces = [
        box(random.uniform(0.04, 0.25, 3), (*random.uniform(-0.3, 0.3, 2), 0.3 + 0.12 * i))
        for i in range(n)
    ]
    motion = Motion(random.normal(size=(n, 3)), 8 * random.normal(size=(n, 3)))
    return fracture(pieces), motion


def points_of(broken: Fracture, flown: Flight, frame: int, piece: int) -> np.ndarray:
    arms = broken.pieces[piece].points.astype(float) - flown.centers[piece]
    return arms @ flown.rotations[frame, piece].T + flown.positions[frame, piece]


def test_without_a_floor_the_centers_follow_parabolas():
    broken, motion = heap()
    ground = Ground(up=(0, 0, 1))
    flown = flight(broken, motion, 2.0, 21, ground=ground, collide=False)
    t = flown.times[:, None, None]
    fall = np.array([0, 0, -GRAVITY])
    exact = broken.mass.centers + t * motion.velocities + t * t / 2 * fall
    np.testing.assert_allclose(flown.positions, exact, atol=1e-9)


def test_a_free_body_keeps_its_angular_momentum_and_all_but_its_energy():
    broken = fracture([box((0.4, 0.2, 0.1))])
    motion = Motion(np.zeros((1, 3)), np.array([[1.0, 6.0, 0.5]]))
    flown = flight(broken, motion, 2.0, 41, ground=Ground(gravity=0.0))
    assert np.ptp(flown.energies) < 0.005 * flown.energies[0, 0]
    assert np.abs(flown.rotations[-1] - np.eye(3)).max() > 0.1


def test_a_symmetric_top_precesses_as_euler_says():
    # About its axis of symmetry, a body turns relative to its own frame at (1 - I3/I1) w3; its
    # axis goes around the angular momentum at |L| / I1.
    broken = fracture([box((0.2, 0.2, 0.5))])
    spin = np.array([1.0, 0.0, 5.0])
    seconds = 1.5
    flown = flight(broken, Motion(np.zeros((1, 3)), spin[None]), seconds, 31,
                   ground=Ground(gravity=0.0), rate=2000)  # fmt: skip
    inertia = np.diag(broken.mass.inertias[0])
    inertia = inertia + 0.01 * inertia.sum()  # as hem.fracture.show.flight makes them firm
    momentum = inertia * spin
    rate = np.linalg.norm(momentum) / inertia[0]
    along = momentum / np.linalg.norm(momentum)
    axis = np.array([0.0, 0.0, 1.0])
    turn = rate * seconds
    flat = axis - (axis @ along) * along
    exact = (axis @ along) * along + np.cos(turn) * flat + np.sin(turn) * np.cross(along, flat)
    np.testing.assert_allclose(flown.rotations[-1, 0] @ axis, exact, atol=2e-3)


@pytest.mark.parametrize("up", [(0, 0, 1), (0, 0, 2.5)])
@pytest.mark.parametrize("collide", [False, True])
def test_pieces_land_come_to_rest_and_neither_sink_nor_gain_energy(up, collide):
    broken, motion = heap()
    ground = Ground(up=up, height=0.05)
    flown = flight(broken, motion, 6.0, 121, ground=ground, collide=collide)
    for frame in range(len(flown.times)):
        for piece in range(len(broken.pieces)):
            assert points_of(broken, flown, frame, piece)[:, 2].min() > 0.05 - 1e-6
    total = flown.energies.sum(axis=1)
    assert np.diff(total).max() <= 1e-9 * total[0]
    assert flown.at_rest.all()
    np.testing.assert_array_equal(flown.positions[-1], flown.positions[-2])
    turns = flown.rotations
    product = turns @ turns.transpose(0, 1, 3, 2)
    assert np.abs(product - np.eye(3)).max() < 1e-9
    assert (np.linalg.det(turns) > 0).all()


def test_a_box_let_go_flat_lands_flat_and_stays():
    broken = fracture([box((0.3, 0.2, 0.4), (0, 1.0, 0))])
    flown = flight(broken, Motion(np.zeros((1, 3)), np.zeros((1, 3))), 3.0, 31,
                   ground=Ground(height=0.0))  # fmt: skip
    np.testing.assert_allclose(flown.positions[-1, 0], (0, 0.1, 0), atol=2e-3)
    np.testing.assert_allclose(flown.rotations[-1, 0], np.eye(3), atol=0.02)
    assert flown.at_rest.all()


def test_a_sliding_box_is_stopped_by_friction_after_the_way_that_coulomb_says():
    broken = fracture([box((1.0, 0.1, 1.0), (0, 0.05, 0))])
    ground = Ground(height=0.0, friction=0.4, bounce=0.0)
    flown = flight(broken, Motion(np.array([[2.0, 0, 0]]), np.zeros((1, 3))), 2.0, 41,
                   ground=ground)  # fmt: skip
    np.testing.assert_allclose(flown.positions[-1, 0, 0], 2.0**2 / (2 * 0.4 * GRAVITY), rtol=0.05)


def test_pieces_that_meet_keep_their_common_momentum_and_do_not_pass_through():
    pieces = [box((0.2, 0.2, 0.2), (x, 0, 0)) for x in (-1, 1)]
    broken = fracture([pieces[0], pieces[1]])
    motion = Motion(np.array([[1.0, 0, 0], [-1.0, 0, 0]]), np.zeros((2, 3)))
    flown = flight(broken, motion, 2.0, 21, ground=Ground(gravity=0.0))
    assert (flown.positions[:, 0, 0] < flown.positions[:, 1, 0]).all()
    np.testing.assert_allclose(flown.positions.sum(axis=1), 0, atol=1e-9)


def test_held_pieces_stay_and_the_same_arguments_give_the_same_flight():
    broken, motion = heap(5)
    ground = Ground(up=(0, 0, 1), height=0.0)
    first, again = (flight(broken, motion, 1.0, 11, ground=ground, held=[2]) for _ in range(2))
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(a, b)
    assert (first.positions[:, 2] == first.positions[0, 2]).all()
    assert (first.positions[-1, 1] != first.positions[0, 1]).any()


def test_frames_may_begin_in_slow_motion():
    broken, motion = heap(2)
    plain, eased = (flight(broken, motion, 1.0, 5, ease=ease) for ease in (1.0, 2.0))
    np.testing.assert_allclose(plain.times, [0, 0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(eased.times, plain.times**2)


def test_needles_crumbs_and_single_triangles_fly_as_well():
    flat = hem.TriangleMesh([(0, 1, 0), (1, 1, 0), (0, 1, 1)], [(0, 1, 2)])
    needle = hem.TriangleMesh([(0, 1, 0), (1, 1, 0), (1, 1, 1e-7)], [(0, 1, 2)])
    broken = fracture([flat, needle], method="surface")
    motion = Motion(np.zeros((2, 3)), np.full((2, 3), 5.0))
    flown = flight(broken, motion, 3.0, 31, ground=Ground(height=0.0))
    assert all(np.isfinite(it).all() for it in flown)
    assert points_of(broken, flown, 30, 0)[:, 1].min() > -1e-6


def test_lowest_counts_only_vertices_that_have_faces():
    mesh = hem.TriangleMesh([(0, 1, 0), (1, 1, 0), (0, 2, 1), (0, -9, 0)], [(0, 1, 2)])
    assert lowest([mesh], (0, 2, 0)) == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"seconds": 0}, "seconds"),
        ({"seconds": float("nan")}, "seconds"),
        ({"frames": 1}, "frames"),
        ({"rate": 0}, "steps"),
        ({"ease": 0}, "ease"),
        ({"ground": Ground(up=(0, 0, 0))}, "direction"),
        ({"ground": Ground(up=(0, 1))}, "direction"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(arguments, said):
    broken, motion = heap(2)
    with pytest.raises(hem.MeshError, match=said):
        flight(broken, motion, **arguments)


def test_names_are_in_the_order_of_pieces():
    assert names(fracture([box((1, 1, 1))] * 2)) == ["shard_000", "shard_001"]
