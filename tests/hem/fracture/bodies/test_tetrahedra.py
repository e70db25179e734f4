from __future__ import annotations

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
import trimesh
from scipy.optimize import linprog

import hem
import structures
from hem.fracture import MATERIALS, material, require_body, tetrahedra
from hem.fracture.bodies.overlap import crossing, overlapping
from tests.extent import QUICK_TO_COMPILE, some, waiting_for
from tests.hem.fracture.laws import body, holders, require_body_laws, sharing_sides, struck
from tests.hem.fracture.solids import require_pieces, together

SEEDS = {"plate": 100, "sphere": 100, "bunny": 4, "teapot": 20}
"""The soak takes 100 of each."""


@pytest.mark.parametrize("model", SEEDS)
def test_tetrahedra_and_rest_are_closed_and_make_up_the_body(model):
    mesh = body(model)
    original = structures.build("half_edge", mesh)
    for seed in range(some(SEEDS[model])):
        s, name = original.copy(), list(MATERIALS)[seed % len(MATERIALS)]
        broken = tetrahedra(s, struck(mesh, seed), name, (0.5, 3.0)[seed % 2], seed)
        s.validate()
        require_body_laws(mesh, broken)
        assert all(len(it.triangles) == 4 for it in broken.shards)
        assert len(broken.shards) > 10


@pytest.mark.parametrize("model", waiting_for(["plate"], ["plate", "sphere", "teapot"]))
def test_every_position_inside_lies_in_one_piece(model):
    mesh = body(model)
    for seed in range(3):
        at = struck(mesh, seed)
        broken = tetrahedra(structures.build("half_edge", mesh), at, "stone", 5.0, seed)
        shards = np.array([it.points for it in broken.shards], float)
        rng = np.random.default_rng(seed)
        # Most of them where the shards are, which are a small part of the body.
        spots = np.concatenate(
            [
                (rng.dirichlet(np.ones(4), len(shards))[:, :, None] * shards).sum(axis=1),
                at + rng.normal(size=(300, 3)) * 0.02 * broken.diagonal,
            ]
        )
        assert np.array_equal(holders(broken.pieces, spots), holders([mesh], spots))


@pytest.mark.parametrize("model", ["plate", "sphere"])
def test_the_rest_does_not_cross_itself(model):
    for seed in range(6):
        s = structures.build("half_edge", body(model))
        broken = tetrahedra(s, struck(body(model), seed), "glass", 4.0, seed)
        require_body(broken.rest[0])


def test_all_structures_give_the_same_tetrahedra():
    mesh = body("sphere")
    for seed in range(some(10)):
        broken = [
            tetrahedra(structures.build(name, mesh), struck(mesh, seed), "glass", 2.0, seed)
            for name in QUICK_TO_COMPILE
        ]
        for other in broken[1:]:
            assert other.counts == broken[0].counts
            assert all(
                np.array_equal(a.points, b.points)
                for a, b in zip(other.pieces, broken[0].pieces, strict=True)
            )


def test_stronger_blows_make_more_and_smaller_shards_near_the_impact():
    mesh, at = hem.generate("sphere", 2_000), struck(hem.generate("sphere", 2_000), 3)
    many, sizes = [], []
    for force in (0.5, 2.0, 8.0, 32.0):
        broken = tetrahedra(structures.build("half_edge", mesh), at, "glass", force, 1)
        k = len(broken.shards)
        near = np.linalg.norm(broken.mass.centers[:k] - at, axis=1) < 0.1 * broken.diagonal
        many.append(k)
        sizes.append(np.median(broken.mass.volumes[:k][near]))
    assert many == sorted(many)
    assert many[-1] > 4 * many[0]
    assert sizes == sorted(sizes, reverse=True)


def test_the_largest_number_of_break_points_is_bounded():
    s, chosen = structures.build("half_edge", body("sphere")), material("glass")
    broken = tetrahedra(s, (0, 0, 1), replace(chosen, scale=1e-3), 1e300)
    require_body_laws(body("sphere"), broken)
    landed = sum(broken.counts[it] for it in ("in a face", "on an edge", "on a vertex", "outside"))
    assert landed == pytest.approx(1000, abs=len(chosen.circles) / 2)


def test_each_shard_has_its_face_on_the_surface_and_its_fourth_point_inside():
    mesh = body("sphere")
    whole = require_body(mesh)
    broken = tetrahedra(structures.build("half_edge", mesh), struck(mesh, 2), "glass", 0.01, 2)
    assert broken.counts["inside"] == 0
    for shard in broken.shards:
        assert whole.contains(shard.points[3:])[0]
        assert not whole.contains(shard.points[:3].mean(axis=0) * 1.0001)[0]


def test_tetrahedra_that_share_what_they_may_do_not_overlap():
    at = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (0, 0, -1)], float)
    pairs = {
        "a face": ((0, 1, 2, 3), (0, 2, 1, 5), False),
        "a side": ((0, 1, 2, 3), (1, 2, 4, 4), False),
        "inside": ((0, 1, 2, 3), (0, 1, 2, 4), True),
    }
    for one, other, expected in pairs.values():
        solids = np.stack([at[list(one)], at[list(other)]])
        if len(set(other)) < 4:
            solids[1, 3] = (2, 1, 1)
        assert overlapping(solids, 1e-9).tolist() == [expected] * 2
    needle = np.array([[(0.1, 0.1, -1), (0.2, 0.1, -1), (0.1, 0.1, 1.0)]])
    assert crossing(at[None, :4], needle, 1e-9).tolist() == [True]
    assert crossing(at[None, :4], needle - (1, 0, 0), 1e-9).tolist() == [False]


def test_each_face_and_each_pair_of_edges_may_be_all_that_keeps_tetrahedra_apart():
    corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
    random = np.random.default_rng(0)
    bent = random.uniform(-0.3, 0.3, (4, 3))  # so that no sides are parallel
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]  # so that bounding boxes meet
    cases = [(2 * way, corners) for way in (*np.eye(3), *-np.eye(3))]  # two edges cross
    cases += [  # a corner stands on a face
        (-4 / 3 * it, corners + bent * (corners != it).any(axis=1)[:, None]) for it in corners
    ]
    for (way, other), order in product(cases, map(list, permutations(range(4)))):
        for far, expected in ((1.001, False), (0.999, True)):
            for both in ((corners[order], other + far * way), (other + far * way, corners[order])):
                assert overlapping(np.stack(both) @ turn, 1e-9).tolist() == [expected] * 2


def test_tetrahedra_overlap_where_some_position_is_a_mean_of_the_corners_of_both():
    rng, found, expected = np.random.default_rng(6), [], []
    for _ in range(200):
        both = rng.normal(size=(2, 4, 3)) + np.multiply.outer([0, 1.2], [[1, 0, 0]])
        sums = np.kron(np.eye(2), np.ones(4))  # of the weights of either's corners
        apart = np.concatenate([both[0], -both[1]]).T
        weights = linprog(np.zeros(8), A_eq=np.vstack([apart, sums]), b_eq=[0, 0, 0, 1, 1])
        expected.append(weights.success)
        found.append(bool(overlapping(both, 1e-9).all()))
    assert found == expected
    assert 50 < sum(found) < 150


@pytest.mark.parametrize(
    ("mesh", "force", "message"),
    [
        (lambda: hem.generate("grid", 100), 1.0, "open"),
        (lambda: body("sphere").flipped(), 1.0, "inside out"),
        (lambda: body("sphere"), 0.0, "positive"),
        (lambda: body("sphere"), float("inf"), "finite"),
    ],
)
def test_what_has_no_inside_is_refused_and_nothing_changes(mesh, force, message):
    s = structures.build("half_edge", mesh())
    before = s.copy()
    with pytest.raises(hem.MeshError, match=message):
        tetrahedra(s, s.points[0], "glass", force)
    assert np.array_equal(s.points, before.points)
    assert s.n_faces == before.n_faces


def test_where_all_lies_on_vertices_nothing_comes_out():
    far = trimesh.creation.box((1, 1, 1)).apply_translation((5e5, 0, 0))  # within 32 roundings
    s = structures.build("half_edge", far)
    broken = tetrahedra(s, (5e5 + 0.5, 0, 0))
    assert len(broken.pieces) == len(broken.rest) == 1
    assert broken.counts["on a vertex"] == sum(MATERIALS["glass"].circles)
    assert s.same_as(structures.build("half_edge", far))


def test_a_face_of_no_area_that_is_touched_hides_no_wall():
    box = trimesh.creation.box((1, 1, 0.02))
    for _ in range(3):
        box = box.subdivide()
    points, faces = np.array(box.vertices), [tuple(map(int, it)) for it in box.faces]
    top = [it for it in faces if (points[list(it), 2] == points[:, 2].max()).all()]
    struck = min(top, key=lambda it: float(abs(points[list(it)].mean(axis=0)[:2]).sum()))
    a, b, _ = struck
    beyond = next(it for it in faces if {a, b} < set(it) and it != struck)
    (d,) = set(beyond) - {a, b}
    middle = len(points)
    faces.remove(beyond)
    faces += [(b, middle, d), (middle, a, d), (b, a, middle)]  # the last one has no area
    points = np.vstack([points, (points[a] + points[b]) / 2])
    s = structures.build("half_edge", hem.TriangleMesh(points, faces))
    broken = tetrahedra(s, points[list(struck)].mean(axis=0), "glass", 1.0, 0)
    assert broken.shards
    assert min(float(it.points[:, 2].min()) for it in broken.shards) >= -0.01


@pytest.mark.parametrize("seed", range(3))
def test_hollows_stay_with_what_is_around_them(seed):
    ball = hem.generate("sphere", 162)
    shells = [hem.TriangleMesh(ball.points * np.float32(r), ball.triangles) for r in (1, 0.8, 0.6)]
    mesh = together(shells[0], shells[1].flipped(), shells[2])
    broken = tetrahedra(structures.build("half_edge", mesh), struck(mesh, seed), "stone", 2, seed)
    require_pieces(broken, require_body(mesh))
    assert len(broken.rest) == 2


def test_neighbors_are_those_that_share_a_side():
    broken = tetrahedra(structures.build("half_edge", body("sphere")), (0, 0, 1), "stone", 2, 1)
    assert broken.counts["inside"]
    assert broken.neighbors.tolist() == sharing_sides(broken.pieces)
