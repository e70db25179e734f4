import itertools
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from scipy.spatial import cKDTree

import hem
from hem.fracture import material
from hem.fracture.bodies.cells import cells
from hem.fracture.bodies.solid import require_body
from hem.fracture.bodies.voronoi import voronoi
from hem.meshes.edges import undirected_edges
from tests.extent import exhaustive, some, waiting_for
from tests.hem.fracture.solids import (
    NAMES,
    as_trimesh,
    body,
    box,
    dumbbell,
    holders,
    hollow_sphere,
    inside,
    require_pieces,
    spot,
)

QUICK = "plate", "sphere"
SEEDS = {"plate": 40, "sphere": 30, "bunny": 10, "teapot": 20}
TRIALS = [(name, seed) for name in NAMES for seed in range(some(SEEDS[name]))]


def few(it):
    """So many positions as can be told inside from outside in a second."""
    return 120 if len(it.mesh.triangles) < 10_000 else 30


@pytest.mark.parametrize(("name", "seed"), TRIALS)
def test_pieces_are_closed_and_their_volumes_add_up(name, seed):
    it = body(name)
    force = (0.1, 0.5, 2.0, 8.0)[seed % 4]
    found = voronoi(it, spot(it.mesh, seed), "stone", force, seed)
    require_pieces(found, it)
    assert len(found.shards) + found.counts["vanished"] >= found.counts["used"] >= 2
    assert found.closed


@pytest.mark.parametrize("name", waiting_for(QUICK, NAMES))
def test_every_position_of_the_body_is_in_exactly_one_piece(name):
    it = body(name)
    found = voronoi(it, spot(it.mesh, 5), "ceramic", 2.0, 5)
    held = holders(found.pieces, inside(it, few(it), 5))
    assert (held.sum(axis=1) == 1).all()
    assert held[:, len(found.shards) :].any()
    assert held[:, : len(found.shards)].any()


@pytest.mark.parametrize("name", waiting_for(QUICK, NAMES))
def test_a_shard_is_of_one_site_which_is_the_nearest_to_all_of_it(name):
    it = body(name)
    sites = inside(it, 12, 7)
    found = voronoi(it, sites[0], "glass", sites=sites, seed=7)
    require_pieces(found, it)
    assert not found.rest
    at = inside(it, 2 * few(it), 8)
    held = holders(found.shards, at)
    assert (held.sum(axis=1) == 1).all()
    shard, site = held.argmax(axis=1), cKDTree(sites).query(at)[1]
    sites_of = [set(site[shard == i]) for i in range(len(found.shards))]
    assert all(len(of) <= 1 for of in sites_of)
    in_order = [min(of) for of in sites_of if of]
    assert in_order == sorted(in_order)


def test_a_limb_cut_off_is_an_island():
    it = require_body(dumbbell())
    found = voronoi(it, (0, 0, 0.1), "wood", 0.5)
    require_pieces(found, it)
    assert len(found.rest) == 2
    centers = found.mass.centers[len(found.shards) :]
    assert centers[:, 0].min() < -1
    assert centers[:, 0].max() > 1
    islands = len(found.shards) + np.arange(2)
    assert islands.tolist() not in found.neighbors.tolist()
    assert (it.volume > found.mass.volumes[islands]).all()


@pytest.mark.parametrize("seed", range(4))
def test_hollows_stay_with_what_is_around_them(seed):
    it = require_body(hollow_sphere())
    found = voronoi(it, spot(it.mesh, seed), "stone", 0.05, seed)
    require_pieces(found, it)
    assert not holders(found.pieces, np.zeros((1, 3))).any()


def test_cells_inside_the_body_leave_a_hollow():
    it = body("sphere")
    sites = np.concatenate([[(0, 0, 0)], 0.8 * np.concatenate([np.eye(3), -np.eye(3)])])
    whole = voronoi(it, (0, 0, 1), "glass", sites=sites)
    assert len(whole.shards) == 7
    # The same, with the middle as the only cell that breaks off.
    module = import_module("hem.fracture.bodies.voronoi")
    made = module._cut(it, module._Plan(sites, 1, 0, 0))
    assert len(made.shards) == len(made.rest) == 1
    assert made.rest[0].mesh.summary().components == 2
    assert as_trimesh(made.rest[0].mesh).volume == pytest.approx(
        it.volume - as_trimesh(made.shards[0].mesh).volume, rel=1e-6
    )


@pytest.mark.parametrize("name", waiting_for(QUICK, ["plate", "sphere", "teapot"]))
def test_stronger_blows_make_more_shards_that_are_smaller_near_the_impact(name):
    it = body(name)
    count, near = [], []
    for force in (0.1, 1.0, 10.0, 60.0):
        shards, volumes = [], []
        for seed in range(4):
            found = voronoi(it, spot(it.mesh, 0), "ceramic", force, seed)
            shards.append(len(found.shards))
            mass = found.mass
            far = np.linalg.norm(mass.centers - found.impact, axis=1)[: shards[-1]]
            volumes += mass.volumes[: shards[-1]][far < 0.06 * it.diagonal].tolist()
        count.append(np.median(shards))
        near.append(np.median(volumes))
    assert all(a < b for a, b in itertools.pairwise(count))
    assert all(a > b for a, b in itertools.pairwise(near))


def test_stronger_blows_reach_farther():
    it = body("sphere")
    left = [
        np.mean(
            [
                sum(voronoi(it, (0, 0, 1), "stone", force, seed).mass.volumes[-1:])
                for seed in range(3)
            ]
        )
        for force in (0.1, 1.0, 10.0)
    ]
    assert left[0] > left[1] > left[2]


def test_shards_lie_closer_together_near_the_impact():
    it = body("sphere")
    found = voronoi(it, (0, 0, 1), "glass", 10.0)
    n = len(found.shards)
    far = np.linalg.norm(found.mass.centers[:n] - found.impact, axis=1)
    by_distance = found.mass.volumes[:n][np.argsort(far)]
    thirds = [np.median(part) for part in np.array_split(by_distance, 3)]
    assert thirds[0] < thirds[1] < thirds[2]


@exhaustive
def test_the_same_seed_gives_the_same_pieces_in_another_process():
    code = (
        "import hem, hashlib; from hem.fracture.bodies.voronoi import voronoi;"
        "f = voronoi(hem.generate('sphere', 400), (0.3, 0.4, 0.9), 'glass', 2.0, 11);"
        "print(hashlib.sha256(b''.join(p.points.tobytes() + p.triangles.tobytes()"
        " for p in f.pieces)).hexdigest())"
    )
    runs = {
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        ).stdout
        for _ in range(2)
    }
    assert len(runs) == 1


def test_another_seed_gives_other_pieces():
    it = body("sphere")
    one, other = (voronoi(it, (0, 0, 1), "glass", 1.0, seed) for seed in (0, 1))
    assert not np.array_equal(one.mass.volumes, other.mass.volumes)


def test_a_mesh_and_its_body_break_alike():
    it = body("sphere")
    one = voronoi(it, (0, 0, 1), material("stone"))
    other = voronoi(it.mesh, (0, 0, 1), "stone")
    for a, b in zip(one.pieces, other.pieces, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
        np.testing.assert_array_equal(a.triangles, b.triangles)


TICKS = np.linspace(-0.9, 0.9, 4)
DEGENERATE = {
    "one": [(0, 0, 0)],
    "two": [(0, 0, 0), (0.5, 0, 0)],
    "collinear": [(x, 0, 0) for x in TICKS],
    "coplanar": [(x, y, 0) for x in TICKS for y in TICKS],
    "a grid": list(itertools.product(TICKS, TICKS, TICKS)),
    "walls in the faces": [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 0.3)],
    "walls along edges": [(0.5, 0.5, 0), (-0.5, 0.5, 0), (0.5, -0.5, 0), (-0.5, -0.5, 0)],
    "vertices": list(itertools.product((-1, 1), repeat=3)),
    "on a sphere": (0.5 * hem.generate("sphere", 100).points.astype(float)).tolist(),
    "huddled": (1e-4 * np.random.default_rng(0).random((20, 3))).tolist(),
    "beyond": [(0, 0, 0), (30, 0, 0), (0, -50, 1)],
    "all beyond": [(9, 0, 0), (30, 0, 0), (0, -50, 1)],
    "one beyond the stars": [(0, 0, 0), (0.5, 0, 0), (0, 0.2, 0.1), (1e9, 0, 0), (0, 1e300, 0)],
    "far off": [(1e4, 0, 0), (1e4, 1, 0), (1e4, 0, 1)],
}


@pytest.mark.parametrize("name", ["plate", "sphere"])
@pytest.mark.parametrize("sites", DEGENERATE.values(), ids=DEGENERATE)
def test_sites_in_special_positions_break_the_body_as_any_others(name, sites):
    it = body(name)
    found = voronoi(it, (0, 0, 0.1), "glass", sites=sites)
    require_pieces(found, it)
    for piece in found.pieces:  # no two vertices in one place that an edge joins
        edges, _ = undirected_edges(piece.triangles)
        same = (piece.points[edges[:, 0]] == piece.points[edges[:, 1]]).all(axis=1)
        assert same.sum() <= 0.05 * len(edges)
    at = inside(it, 60, 1)
    held = holders(found.pieces, at)
    away = np.array([[np.hypot.reduce(p - site) for site in np.array(sites, float)] for p in at])
    clear = np.diff(np.sort(away, axis=1), axis=1, append=np.inf)[:, 0] > 1e-5
    assert (held[clear].sum(axis=1) == 1).all()
    # What is in one piece has one nearest site.
    of_site = away[clear].argmin(axis=1)
    of_piece = held[clear].argmax(axis=1)
    for piece in np.unique(of_piece):
        assert len(np.unique(of_site[of_piece == piece])) == 1


def test_repeated_sites_count_once():
    sites = [(0, 0, 0), (0.5, 0, 0), (0, 0, 0), (0.5, 0, 1e-9)]
    found = voronoi(body("sphere"), (0, 0, 1), "glass", sites=sites)
    assert found.counts == {"used": 2, "outside": 0, "repeated": 2, "vanished": 0}
    assert len(found.shards) == 2


def test_every_site_is_counted_once():
    sites = [
        (0, 0, 0),
        (5, 0, 0),
        (30, 0, 0),
        (0, 0, 0),
    ]  # of which the second is near enough to ask
    found = voronoi(body("plate"), (0, 0, 1), "glass", sites=sites)
    assert found.counts == {"used": 1, "outside": 2, "repeated": 1, "vanished": 0}


def test_cells_fill_the_ball_between_them():
    sites = np.random.default_rng(2).random((30, 3))
    made = cells(sites, np.full(3, 0.5), 1.0)
    at = np.random.default_rng(3).random((200, 3))
    nearest = cKDTree(sites).query(at)[1]
    whole = sum(made.cell(i).volume() for i in range(30))
    assert made.union(np.ones(30, bool)).volume() == pytest.approx(whole, rel=1e-9)
    for i in range(30):
        raw = made.cell(i).to_mesh64()
        cell = hem.TriangleMesh(np.asarray(raw.vert_properties)[:, :3], np.asarray(raw.tri_verts))
        np.testing.assert_array_equal(holders([cell], at)[:, 0], nearest == i)


def test_the_impact_is_taken_to_the_nearest_point_and_the_blow_goes_inward():
    found = voronoi(body("plate"), (0.4, -0.7, 1.5), "stone", 0.1)
    np.testing.assert_allclose(found.impact, (0.4, -0.7, 0.15), atol=1e-7)
    np.testing.assert_array_equal(found.direction, (0, 0, -1))
    aslant = voronoi(body("plate"), (0.4, -0.7, 1.5), "stone", 0.1, direction=(3, 0, -4))
    np.testing.assert_allclose(aslant.direction, (0.6, 0, -0.8), rtol=1e-15)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"impact": (99, 0, 0)}, "away from the mesh"),
        ({"impact": (1e300, 0, 0)}, "away from the mesh"),
        ({"impact": (np.nan, 0, 0)}, "impact"),
        ({"impact": (0, 0)}, "impact"),
        ({"impact": "here"}, "impact"),
        ({"force": 0}, "force"),
        ({"force": -1}, "force"),
        ({"force": np.inf}, "force"),
        ({"force": "much"}, "force"),
        ({"direction": (0, 0, 0)}, "direction"),
        ({"direction": (np.inf, 0, 0)}, "direction"),
        ({"direction": [(0, 1), 2]}, "direction"),
        ({"seed": -1}, "seed"),
        ({"seed": 0.5}, "seed"),
        ({"seed": "a", "sites": [(0, 0, 0)]}, "seed"),
        ({"material": "jelly"}, "no material"),
        ({"sites": []}, "sites"),
        ({"sites": [(0, 0)]}, "sites"),
        ({"sites": [(0, 0, np.nan)]}, "sites"),
        ({"sites": [("a", "b", "c")]}, "sites"),
        ({"sites": [(0, 0, 0), (0, 0)]}, "sites"),
        ({"sites": [(1e9, 0, 0), (0, 0, 1e200)]}, "sites"),
    ],
)
def test_wrong_arguments_are_named(wrong, words):
    arguments = {"impact": (0, 0, 1), "material": "stone"} | wrong
    with pytest.raises(hem.MeshError, match=words):
        voronoi(body("sphere"), **arguments)


def test_what_is_no_body_is_refused():
    for mesh, words in (
        (hem.TriangleMesh([], []), "empty"),
        (hem.generate("grid", 100), "open"),
        (hem.sample("teapot"), "open"),
        (hem.sample("cow"), "intersects itself"),
        (box(1, 1, 1).flipped(), "inside out"),
    ):
        with pytest.raises(hem.MeshError, match=words):
            voronoi(mesh, (0, 0, 0), "glass")


def test_far_from_the_origin_there_are_fewer_pieces_and_at_last_it_is_said_what_to_do():
    counts = []
    for far in (0, 1e3, 1e4, 3e4):
        mesh = box(1, 1, 1, at=(far, far, far))
        found = voronoi(mesh, (far, far, far + 0.5), force=10, seed=1)
        assert all((undirected_edges(it.triangles)[1] == 2).all() for it in found.pieces)
        assert sum(it.volume() for it in found.pieces) == pytest.approx(mesh.volume(), rel=1e-3)
        counts.append(len(found.pieces))
    assert counts == sorted(counts, reverse=True)
    # Some pieces are left at the first two, and none at the last.
    for far, force in ((1e5, 1), (5e5, 10), (1e6, 10)):
        with pytest.raises(hem.MeshError, match="move it there first"):
            voronoi(box(1, 1, 1, at=(far, far, far)), (far, far, far + 0.5), force=force, seed=1)


def test_the_largest_number_of_sites_is_bounded():
    found = voronoi(body("plate"), (0, 0, 1), "glass", 1e300)
    require_pieces(found, body("plate"))
    assert found.counts["used"] == 1000


def test_a_shard_can_be_broken_again():
    first = voronoi(body("sphere"), (0, 0, 1), "stone", 4.0)
    for seed, shard in enumerate(first.shards[:8]):
        it = require_body(shard)
        require_pieces(voronoi(it, spot(shard, seed), "stone", 2.0, seed), it)
