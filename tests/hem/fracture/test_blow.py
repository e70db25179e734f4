import math
from dataclasses import replace

import numpy as np
import pytest

import hem
from hem.fracture import MATERIALS, Fracture
from hem.fracture.blow import (
    LEAST_REACH,
    MOST_REACH,
    MOST_SITES,
    Blow,
    Motion,
    cube_root,
    kinetic_energy,
    momentum,
    motion,
    sites,
)
from hem.fracture.bodies.voronoi import voronoi
from tests.extent import some, waiting_for
from tests.hem.fracture.solids import NAMES, body, box, spot

GLASS, STONE = MATERIALS["glass"], MATERIALS["stone"]
TRIALS = [(name, seed) for name in NAMES for seed in range(some({"bunny": 4}.get(name, 32)))]


def everywhere(points):
    return np.ones(len(points), bool)


def struck(name, seed):
    it = body(name)
    material = list(MATERIALS.values())[seed % len(MATERIALS)]
    force = (0.1, 1.0, 5.0)[seed % 3]
    way = np.random.default_rng(seed).normal(size=3) if seed % 2 else None
    found = voronoi(it, spot(it.mesh, seed), material, force, seed, way)
    return found, Blow(found.impact, found.direction, force)


@pytest.mark.parametrize(("name", "seed"), TRIALS)
def test_momentum_is_conserved_and_energy_is_no_more_than_the_blow_brings(name, seed):
    found, blow = struck(name, seed)
    moved, mass = motion(found, blow), found.mass
    m, c = mass.masses, mass.centers
    linear = np.zeros(3)
    angular = np.zeros(3)
    energy = 0.0
    for i in range(len(m)):  # piece by piece, as in a textbook
        v, w = moved.velocities[i], moved.spins[i]
        linear += m[i] * v
        angular += np.cross(c[i] - blow.impact, m[i] * v) + mass.inertias[i] @ w
        energy += (m[i] * (v @ v) + w @ mass.inertias[i] @ w) / 2
    brought = blow.force * m.sum()
    scale = math.sqrt(2 * brought * m.sum())
    impulse = linear @ blow.direction
    assert 0 < impulse <= math.sqrt(2 * 0.1 * m.sum() * brought) * 2
    np.testing.assert_allclose(linear, impulse * blow.direction, atol=1e-12 * scale)
    np.testing.assert_allclose(angular, 0, atol=1e-12 * scale * found.diagonal)
    assert found.material.burst * brought < energy < brought
    assert kinetic_energy(mass, moved) == pytest.approx(energy, rel=1e-12)
    np.testing.assert_allclose(momentum(mass, moved, blow.impact)[0], linear, atol=1e-12 * scale)


def test_an_impulse_through_the_center_is_that_of_an_inelastic_impact():
    found = voronoi(body("plate"), (0, 0, 1), "stone", sites=[(0, 0, 0)])
    moved = motion(found, Blow(found.impact, found.direction, 2.0))
    # A striker of m/10 with the energy 2 m: v = √40, and m v / 11 m is shared.
    np.testing.assert_allclose(moved.velocities, [[0, 0, -math.sqrt(40) / 11]], atol=1e-12)
    np.testing.assert_allclose(moved.spins, 0, atol=1e-12)


def test_a_single_piece_struck_off_its_center_spins():
    found = voronoi(body("plate"), (1.9, 0, 1), "stone", sites=[(0, 0, 0)])
    moved = motion(found, Blow(found.impact, found.direction, 1.0))
    assert moved.velocities[0, 2] < 0
    assert moved.spins[0, 1] > 0
    np.testing.assert_allclose(moved.spins[0, [0, 2]], 0, atol=1e-12)


def test_near_pieces_burst_faster_than_far_ones():
    found, blow = struck("sphere", 0)
    found = voronoi(body("sphere"), (0, 0, 1), "glass", 10.0, 3)
    blow = Blow(found.impact, found.direction, 10.0)
    moved = motion(found, blow)
    far = np.linalg.norm(found.mass.centers - blow.impact, axis=1)
    speed = np.linalg.norm(moved.velocities, axis=1)
    assert np.corrcoef(far, speed)[0, 1] < -0.3
    near = far < np.median(far)
    assert np.median(speed[near]) > 1.2 * np.median(speed[~near])


def test_pieces_fly_apart():
    found = voronoi(body("sphere"), (0, 0, 1), "glass", 5.0, 1)
    moved = motion(found, Blow(found.impact, found.direction, 5.0))
    centers, velocities = found.mass.centers, moved.velocities
    a, b = found.neighbors.T
    parting = ((centers[a] - centers[b]) * (velocities[a] - velocities[b])).sum(axis=1)
    assert (parting > 0).mean() > 0.8


def test_speeds_grow_with_the_root_of_the_force():
    found = voronoi(body("sphere"), (0, 0, 1), "glass", 1.0)
    whole = [
        kinetic_energy(found.mass, motion(found, Blow(found.impact, (0, 0, -1), f)))
        for f in (1e-9, 1, 1e9)
    ]
    np.testing.assert_allclose(np.array(whole) / [1e-9, 1, 1e9], whole[1], rtol=1e-9)


@pytest.mark.parametrize("force", waiting_for([5e-324, 1.7e308], [5e-324, 1e-300, 1e300, 1.7e308]))
def test_forces_without_measure_give_finite_motions(force):
    found = voronoi(body("plate"), (0, 0, 1), "glass", force)
    moved = motion(found, Blow(found.impact, found.direction, force))
    assert np.isfinite(moved.velocities).all()
    assert np.isfinite(moved.spins).all()


@pytest.mark.parametrize("density", [5e-324, 1e-300, 1e300, 1.7e308])
def test_a_blow_per_kilogram_moves_a_light_and_a_heavy_material_alike(density):
    found, blow = struck("sphere", 3)
    other = replace(found, material=replace(found.material, density=density))
    for one, it in zip(motion(found, blow), motion(other, blow), strict=True):
        np.testing.assert_allclose(it, one, rtol=1e-9)


def test_the_same_seed_gives_the_same_motion_and_another_one_another():
    found, blow = struck("sphere", 3)
    one, again, other = motion(found, blow), motion(found, blow), motion(found, blow, seed=99)
    np.testing.assert_array_equal(one.spins, again.spins)
    assert not np.array_equal(one.spins, other.spins)


def sheets(*meshes):
    return Fracture(
        method="surface",
        material=GLASS,
        seed=1,
        impact=np.zeros(3),
        direction=np.array([0.0, 0.0, -1.0]),
        shards=meshes,
        rest=[],
        counts={},
        diagonal=2.0,
        find_neighbors=lambda: np.zeros((0, 2), np.int64),
    )


@pytest.mark.parametrize("burst", [GLASS.burst, 1.0])
def test_pieces_of_sheets_keep_the_same_laws(burst):
    random = np.random.default_rng(4)
    triangles = [hem.TriangleMesh(random.random((3, 3)), [(0, 1, 2)]) for _ in range(30)]
    found = replace(sheets(*triangles), material=replace(GLASS, burst=burst))
    blow = Blow((0.1, 0.2, 0.3), (1, 2, 2), 3.0)
    moved = motion(found, blow)
    linear, angular = momentum(found.mass, moved, blow.impact)
    np.testing.assert_allclose(np.cross(linear, blow.direction), 0, atol=1e-12)
    np.testing.assert_allclose(angular, 0, atol=1e-12)
    brought = 3.0 * found.mass.masses.sum()
    assert min(burst, 0.75) * brought < kinetic_energy(found.mass, moved) <= brought


def test_a_single_piece_has_none_to_part_from_and_takes_no_more_than_the_striker_gives():
    for corners in np.random.default_rng(4).random((30, 3, 3)):
        alone, blow = (
            sheets(hem.TriangleMesh(corners, [(0, 1, 2)])),
            Blow((0, 0, 0), (1, 2, 2), 3.0),
        )
        energy = kinetic_energy(alone.mass, motion(alone, blow))
        assert energy <= 3.0 * alone.mass.masses.sum() / 4


def test_what_is_struck_flies_on_and_what_is_around_it_aside():
    angles = np.arange(8) * math.pi / 4
    ring = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    corner = 0.01 * np.array([(1, 0, 0), (-1, 1, 0), (0, -1, 0)])  # around 0
    pieces = [hem.TriangleMesh(corner + 0.1 * at, [(0, 1, 2)]) for at in [np.zeros(3), *ring]]
    moved = motion(sheets(*pieces), Blow((0, 0, 0), (0, 0, -1), 1.0))
    assert (moved.velocities[0, 2] < moved.velocities[1:, 2]).all()
    assert ((moved.velocities[1:] * ring).sum(axis=1) > 0).all()


def test_what_is_held_stays_and_the_others_fly_as_if_it_were_not_there():
    random = np.random.default_rng(5)
    triangles = [hem.TriangleMesh(random.random((3, 3)), [(0, 1, 2)]) for _ in range(30)]
    plate = hem.TriangleMesh(9 * random.random((3, 3)), [(0, 1, 2)])
    blow = Blow((0.1, 0.2, 0.3), (1, 2, 2), 3.0)
    alone = motion(sheets(*triangles), blow)
    beside = motion(sheets(*triangles, plate), blow, held=[30])
    for without, every in zip(alone, beside, strict=True):
        np.testing.assert_array_equal(every, [*without, (0, 0, 0)])
    assert momentum(sheets(*triangles, plate).mass, beside, blow.impact)[0] @ blow.direction > 0
    assert not np.any(motion(sheets(plate), blow, held=[0]))


def test_held_are_told_by_index_from_either_end_or_by_a_mask_and_nothing_else():
    random = np.random.default_rng(5)
    broken = sheets(*(hem.TriangleMesh(random.random((3, 3)), [(0, 1, 2)]) for _ in range(4)))
    blow = Blow((0.1, 0.2, 0.3), (1, 2, 2), 3.0)
    for held in ([3], 3, [-1], np.arange(4) == 3):
        still = ~motion(broken, blow, held=held).velocities.any(axis=1)
        assert still.tolist() == [False, False, False, True]
    for held in ([4], [-5], [0.5], [True], "abc", None):
        with pytest.raises(hem.MeshError, match="indices of 4 pieces"):
            motion(broken, blow, held=held)


def test_pieces_without_weight_stand_no_blow():
    flat = hem.TriangleMesh([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    for found in (sheets(), sheets(flat)):
        with pytest.raises(hem.MeshError, match="weigh nothing"):
            motion(found, Blow((0, 0, 0), (0, 0, 1), 1.0))


def test_momentum_and_energy_of_one_ball_are_those_of_the_textbook():
    from hem.fracture.mass import of_bodies

    mass = of_bodies([box(1, 1, 1, at=(0, 0, 2))], 6.0)
    moved = Motion(np.array([[1.0, 0, 0]]), np.array([[0, 0, 3.0]]))
    linear, angular = momentum(mass, moved, np.zeros(3))
    np.testing.assert_allclose(linear, (6, 0, 0))
    np.testing.assert_allclose(angular, (0, 12, 3), atol=1e-14)
    assert kinetic_energy(mass, moved) == pytest.approx(3 + 4.5)


def test_stronger_blows_have_more_sites_that_reach_farther_and_gather_more():
    forces = [1e-9, 1e-2, 0.1, 1.0, 10.0, 100.0]
    blows = [Blow((0, 0, 0), (0, 0, 1), force) for force in forces]
    for material in MATERIALS.values():
        counts = [blow.count(material) for blow in blows]
        assert counts == sorted(counts)
        assert counts[0] >= 2
        assert counts[3] == round(material.sites)
        reaches = [blow.reach(material, 3.0) for blow in blows]
        assert reaches == sorted(reaches)
        assert reaches[3] == pytest.approx(3.0 * material.reach)
        few, many = (Blow((0, 0, 0), (0, 0, 1), it).reach(material, 3.0) for it in (1e-300, 1e300))
        assert (few, many) == (3 * LEAST_REACH, 3 * MOST_REACH)
        medians = []
        for blow, reach in zip(blows[2:], reaches[2:], strict=True):
            found = np.concatenate(
                [sites(blow, material, 3.0, everywhere, seed).points for seed in range(30)]
            )
            medians.append(np.median(np.linalg.norm(found, axis=1)) / reach)
        assert medians == sorted(medians, reverse=True)
    for material in (GLASS, replace(GLASS, sites=1e300)):
        assert Blow((0, 0, 0), (0, 0, 1), 1e300).count(material) == MOST_SITES


def test_sites_are_within_reach_and_even_in_direction():
    blow = Blow((1, 2, 3), (0, 0, 1), 1.0)
    found = np.concatenate(
        [sites(blow, GLASS, 2.0, everywhere, seed).points for seed in range(200)]
    )
    away = found - (1, 2, 3)
    far = np.linalg.norm(away, axis=1)
    assert far.max() <= blow.reach(GLASS, 2.0)
    ways = away / far[:, None]
    np.testing.assert_allclose(ways.mean(axis=0), 0, atol=4 / math.sqrt(3 * len(ways)))
    np.testing.assert_allclose(ways.T @ ways / len(ways), np.eye(3) / 3, atol=0.02)


def test_sites_are_inside_and_those_that_are_not_are_counted():
    asked = []

    def upper(points):
        asked.append(len(points))
        return points[:, 2] > 0

    found = sites(Blow((0, 0, 0), (0, 0, 1), 4.0), GLASS, 2.0, upper, 0)
    assert len(found.points) == 48
    assert (found.points[:, 2] > 0).all()
    assert sum(asked) >= 48 + found.outside
    assert found.outside == pytest.approx(sum(asked) / 2, rel=0.3)
    reach = 4.0 ** (1 / 3) * GLASS.reach * 2
    assert (np.linalg.norm(found.anchors, axis=1) > 1.09 * reach).all()


def test_a_body_without_room_for_sites_is_refused_after_a_bounded_number_of_tries():
    asked = []

    def nowhere(points):
        asked.append(len(points))
        return np.zeros(len(points), bool)

    with pytest.raises(hem.MeshError, match="too thin"):
        sites(Blow((0, 0, 0), (0, 0, 1), 1.0), GLASS, 1.0, nowhere, 0)
    assert 20_000 <= sum(asked) < 21_000


def test_a_seed_gives_these_sites_on_every_machine():
    found = sites(Blow((0.1, 0.2, 0.3), (0, 0, 1), 2.0), STONE, 1.5, everywhere, 42)
    assert [x.hex() for x in found.points[0].tolist()] == PINNED[0]
    assert [x.hex() for x in found.points[-1].tolist()] == PINNED[1]
    assert [x.hex() for x in found.anchors[0].tolist()] == PINNED[2]


PINNED = [
    ["0x1.04c69632379a0p-8", "0x1.35b017c476becp-3", "0x1.29aa101504fbep-1"],
    ["0x1.6e8fd21f2d298p-7", "0x1.2374d8151282ep-4", "0x1.28e21c9cceb09p-2"],
    ["0x1.77124b80cea5cp-2", "0x1.1fee19ad6cd2ep-3", "0x1.4c0ee7cc9fdb2p-1"],
]


@pytest.mark.parametrize("value", [5e-324, 1e-300, 1e-9, 0.1, 1.0, 2.0, 8.0, 27.0, 1e9, 1e308])
def test_cube_roots_are_those_of_the_library_to_the_last_digits(value):
    assert cube_root(value) == pytest.approx(float(np.cbrt(value)), rel=5e-16)


@pytest.mark.parametrize("force", [0, -1, np.nan, np.inf, 10**400, True, None, "1", [1.0]])
def test_forces_are_positive_and_finite(force):
    with pytest.raises(hem.MeshError, match="force"):
        Blow((0, 0, 0), (0, 0, 1), force)


@pytest.mark.parametrize("way", [(0, 0, 0), (np.nan, 0, 0), (1, 0), None, "up"])
def test_directions_have_some_length(way):
    with pytest.raises(hem.MeshError, match="direction"):
        Blow((0, 0, 0), way, 1.0)


@pytest.mark.parametrize("way", [(1e-300, 0, 0), (1e300, 1e300, 0), (3, 4, 0), (1, 2, 2)])
def test_directions_are_made_of_length_1(way):
    assert np.linalg.norm(Blow((0, 0, 0), way, 1.0).direction) == pytest.approx(1, rel=1e-15)
