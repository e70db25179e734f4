"""Flights: what mechanics says of them, piece by piece."""

from __future__ import annotations

import tracemalloc
from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation

import hem
from hem.fracture.files import names
from hem.fracture.material import MATERIALS
from hem.fracture.pieces import Fracture
from hem.fracture.show import GRAVITY, Flight, flight
from hem.fracture.show.flight import BOUNCE, FRICTION


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
    arms = broken.pieces[piece].points.astype(float) - broken.mass.centers[piece]
    return arms @ flown.rotations[frame, piece].T + flown.positions[frame, piece]


def lowest(broken: Fracture, flown: Flight, frame: int) -> np.ndarray:
    return np.array(
        [points_of(broken, flown, frame, i)[:, 2].min() for i in range(len(broken.pieces))]
    )


def test_above_the_floor_the_centers_follow_parabolas_and_turn_evenly():
    broken, motion = heap()
    flown = flight(broken, motion, 2.0, 21, up=(0, 0, 1), floor=-1e3)
    t = flown.times[:, None, None]
    fall = np.array([0, 0, -GRAVITY])
    exact = broken.mass.centers + t * motion.velocities + t * t / 2 * fall
    np.testing.assert_allclose(flown.positions, exact, atol=1e-9)
    steps = flown.rotations[1:] @ np.swapaxes(flown.rotations[:-1], 2, 3)
    cosines = (np.trace(steps, axis1=2, axis2=3) - 1) / 2
    turned = np.cos(np.linalg.norm(motion.spins, axis=1) * 0.1)
    np.testing.assert_allclose(cosines, np.tile(turned, (20, 1)), atol=1e-9)
    assert not flown.at_rest.any()


def test_pieces_land_never_sink_and_come_to_rest_on_the_floor():
    broken, motion = heap()
    flown = flight(broken, motion, 6.0, 121, up=(0, 0, 1), floor=0.05)
    heights = np.array([lowest(broken, flown, frame) for frame in range(121)])
    assert heights.min() > 0.05 - 1e-9
    np.testing.assert_allclose(heights[-1], 0.05, atol=1e-9)
    assert flown.at_rest.all()
    np.testing.assert_allclose(flown.positions[-1], flown.positions[-2], atol=1e-6)
    turns = flown.rotations
    assert np.abs(turns @ turns.transpose(0, 1, 3, 2) - np.eye(3)).max() < 1e-9
    assert (np.linalg.det(turns) > 0).all()


def test_at_rest_a_box_lies_on_a_side():
    broken, motion = heap()
    flown = flight(broken, motion, 6.0, 5, up=(0, 0, 1))
    for piece in range(len(broken.pieces)):
        points = points_of(broken, flown, 4, piece)
        assert (points[:, 2] < points[:, 2].min() + 1e-3).sum() == 4


def test_a_box_let_go_flat_lands_flat_and_stays():
    broken = fracture([box((0.3, 0.2, 0.4), (0, 1.0, 0))])
    flown = flight(broken, Motion(np.zeros((1, 3)), np.zeros((1, 3))), 3.0, 31)
    np.testing.assert_allclose(flown.positions[-1, 0], (0, 0.1, 0), atol=1e-6)
    np.testing.assert_allclose(flown.rotations[-1, 0], np.eye(3), atol=1e-6)
    assert flown.at_rest.all()


def test_a_sliding_box_is_stopped_by_friction_after_the_way_that_coulomb_says():
    broken = fracture([box((1.0, 0.1, 1.0), (0, 0.05, 0))])
    flown = flight(broken, Motion(np.array([[2.0, 0, 0]]), np.zeros((1, 3))), 2.0, 41)
    way = 2.0**2 / (2 * FRICTION * GRAVITY)
    np.testing.assert_allclose(flown.positions[-1, 0, 0], way, rtol=1e-6)


def test_a_box_thrown_flat_hops_once_and_slides_from_where_it_meets_the_floor():
    broken = fracture([box((0.4, 0.2, 0.4), (0, 0.6, 0))])
    flown = flight(broken, Motion(np.array([[1.0, 2, 0]]), np.array([[0, 5.0, 0]])), 1.2, 241)
    arrives = np.sqrt(2.0**2 + 2 * GRAVITY * 0.5)
    landing, stop = (2 + arrives) / GRAVITY, 1 / (FRICTION * GRAVITY)
    t, after = flown.times, np.maximum(flown.times - landing, 0)
    hop = np.maximum(BOUNCE * arrives * after - GRAVITY / 2 * after**2, 0)
    height = np.where(after > 0, hop, 0.5 + 2 * t - GRAVITY / 2 * t**2)
    slid = np.minimum(after, stop)
    way = np.minimum(t, landing) + slid - slid**2 / (2 * stop)
    np.testing.assert_allclose(flown.positions[:, 0, 1], 0.1 + height, atol=0.01)
    np.testing.assert_allclose(flown.positions[:, 0, 0], way, atol=0.01)


def test_a_leaning_piece_comes_to_rest_on_a_side_that_its_center_is_above():
    upright = box((0.2, 0.6, 0.2))
    leaning = upright.points + upright.points[:, 1:2] * (1, 0, 0)
    turns = Rotation.random(12, random_state=1).as_matrix()
    pieces = [hem.TriangleMesh(leaning @ it.T, upright.triangles) for it in (np.eye(3), *turns)]
    flown = flight(fracture(pieces), Motion(*np.zeros((2, 13, 3))), 6.0, 5, floor=-1)
    for piece in range(len(pieces)):
        points = points_of(fracture(pieces), flown, 4, piece)
        below = points[points[:, 1] < -1 + 1e-3][:, [0, 2]]
        assert Delaunay(below).find_simplex(flown.positions[4, piece, [0, 2]]) >= 0


@pytest.mark.parametrize(("spin", "turned"), [(3.0, 47), (-3.0, -43)])
def test_a_tilted_box_falls_onto_the_side_that_it_turns_to(spin, turned):
    upright = box((0.2, 0.2, 0.2))
    tilted = Rotation.from_rotvec((0, 0, 43), degrees=True).apply(upright.points)
    broken = fracture([hem.TriangleMesh(tilted, upright.triangles)])
    motion = Motion(np.zeros((1, 3)), np.array([[0, 0, spin]]))
    flown = flight(broken, motion, 3.0, 5, floor=float(tilted[:, 1].min()))
    found = Rotation.from_matrix(flown.rotations[-1, 0]).as_rotvec(degrees=True)
    np.testing.assert_allclose(found, (0, 0, turned), atol=0.1)
    np.testing.assert_allclose(flown.rotations[0, 0], np.eye(3), atol=1e-12)


def test_held_pieces_stay_and_the_same_arguments_give_the_same_flight():
    broken, motion = heap(5)
    first, again = (flight(broken, motion, 1.0, 11, up=(0, 0, 1), held=[2]) for _ in range(2))
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
    flown = flight(broken, Motion(np.zeros((2, 3)), np.full((2, 3), 5.0)), 3.0, 31)
    assert all(np.isfinite(each).all() for each in flown)
    np.testing.assert_allclose(points_of(broken, flown, 30, 0)[:, 1], 0, atol=1e-3)


@pytest.mark.parametrize(
    "arguments",
    [
        {"seconds": 0},
        {"seconds": float("nan")},
        {"frames": 1},
        {"frames": 2.5},
        {"ease": 0},
        {"seconds": "1"},
        {"ease": None},
        {"floor": float("nan")},
        {"floor": "low"},
    ],
)
def test_times_that_make_no_sense_are_refused(arguments):
    broken, motion = heap(2)
    with pytest.raises(hem.MeshError, match="a flight takes"):
        flight(broken, motion, **arguments)


def test_a_flat_piece_of_many_vertices_takes_memory_in_proportion_to_them():
    sheet = fracture([hem.generate("grid", 2_500)], method="surface")
    tracemalloc.start()
    flown = flight(sheet, Motion(*np.zeros((2, 1, 3))), 1.0, 5, up=(0, 0, 1), floor=-0.1)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 8 * 2_500**2  # bytes of a matrix of vertices by vertices
    np.testing.assert_allclose(points_of(sheet, flown, 4, 0)[:, 2], -0.1, atol=1e-6)


def test_names_are_in_the_order_of_pieces():
    assert names(fracture([box((1, 1, 1))] * 2)) == ["shard_000", "shard_001"]
