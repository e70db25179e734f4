from __future__ import annotations

import hashlib
import pickle
from dataclasses import replace

import numpy as np
import pytest
import trimesh

import hem
import structures
from hem.fracture import (
    MATERIALS,
    Material,
    islands,
    nearest_face,
    require_body,
    scanned,
    shatter,
    tetrahedra,
    voronoi,
    wrapped,
)
from hem.fracture.surface.breaking import breaking
from hem.fracture.surface.hanging import hanging
from hem.fracture.surface.nearest import ROUNDING
from hem.fracture.surface.shatter import TOLERANCE, break_points, break_surface
from tests.extent import OF_EACH_KIND, QUICK_TO_COMPILE, some, waiting_for
from tests.hem.fracture.laws import MODELS, require_surface_laws, sharing_sides, struck, surface
from tests.hem.rendering.test_render import assert_in_step

NAMES = tuple(MATERIALS)


def sheet(n: int = 8) -> hem.TriangleMesh:
    """A flat square of n × n squares, cut in two, at whole coordinates."""
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    y, x = np.divmod(np.arange(at.size), n + 1)
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return hem.TriangleMesh(np.stack([x, y, 0 * x], 1), faces)


def diagonal(mesh: hem.TriangleMesh) -> float:
    return float(np.linalg.norm(np.ptp(mesh.points.astype(float), axis=0)))


def corners(shards) -> np.ndarray:
    return np.stack([shard.points for shard in shards])


@pytest.mark.parametrize("model", MODELS)
def test_shards_and_rest_make_up_the_surface_again(model):
    """On the bunny with fewer seeds: ``make soak`` breaks every model a hundred times."""
    mesh = surface(model)
    original = structures.build("half_edge", mesh)
    for seed in range(some(10 if model == "bunny" else 100)):
        s = original.copy()
        broken = shatter(s, struck(mesh, seed), NAMES[seed % len(NAMES)], seed)
        s.validate()
        require_surface_laws(mesh, broken, TOLERANCE * diagonal(mesh))
        points = sum(broken.material.circles)
        told = [broken.counts[it] for it in ("in a face", "on an edge", "on a vertex", "outside")]
        assert sum(told) == points


@pytest.mark.parametrize(("model", "seeds"), [("plate", 100), ("sphere", 25), ("teapot", 4)])
def test_all_structures_give_the_same_shards(model, seeds):
    mesh = surface(model)
    originals = [structures.build(name, mesh) for name in QUICK_TO_COMPILE]
    for seed in range(some(seeds)):
        at, material = struck(mesh, seed), NAMES[seed % len(NAMES)]
        broken = [shatter(it.copy(), at, material, seed) for it in originals]
        for other in broken[1:]:
            assert np.array_equal(corners(other.shards), corners(broken[0].shards))
            assert other.counts == broken[0].counts
            assert len(other.rest) == len(broken[0].rest)
            assert all(
                np.array_equal(a.points, b.points)
                for a, b in zip(other.rest, broken[0].rest, strict=True)
            )


def test_the_shards_of_a_seed_are_the_same_on_every_machine():
    shards = shatter(structures.build("half_edge", sheet()), (3.2, 4.1, 0), "glass", 7).shards
    told = hashlib.sha256(corners(shards).astype("<f4").tobytes()).hexdigest()
    assert (len(shards), told[:16]) == DIGEST


DIGEST = (219, "b10c9e20c1c8ae05")


def test_nothing_overlaps_in_the_plane():
    mesh = sheet()
    for seed in range(20):
        broken = shatter(structures.build("half_edge", mesh), struck(mesh, seed), "glass", seed)
        corners = np.concatenate([it.points[it.triangles] for it in broken.pieces])[:, :, :2]
        at = np.random.default_rng(seed).random((400, 2)) * 8
        turns = []
        for i in range(3):
            side, way = corners[:, i - 2] - corners[:, i], at[:, None] - corners[None, :, i]
            turns.append(side[:, 0] * way[:, :, 1] - side[:, 1] * way[:, :, 0])
        assert (np.min(turns, axis=0) > 0).sum(axis=1).tolist() == [1] * 400


def test_break_points_lie_in_growing_circles():
    material = replace(MATERIALS["glass"], circles=(500, 0, 2000))
    points = break_points(material, 3, 2.0)
    far = np.hypot(*points.T)
    assert far[:500].max() <= 1.0
    assert 4.5 < far[500:].max() <= 5.0
    # Uniform in the circle: half of them within the radius over the root of 2.
    assert abs((far[500:] < 5 / np.sqrt(2)).mean() - 0.5) < 0.04
    assert abs(points[500:].mean(axis=0)).max() < 0.2


def test_in_the_plane_points_stay_where_they_were_scattered():
    mesh, at = sheet(), np.array([4.3, 3.9, 0])
    wanted = break_points(MATERIALS["stone"], 5, 1.0) + at[:2]
    s = structures.build("half_edge", mesh)
    shatter(s, at, "stone", 5, scale=1.0)
    new = s.points[len(mesh.points) :, :2]
    near = np.linalg.norm(wanted[:, None] - new[None], axis=2).min(axis=1)
    inside = ((wanted > 0) & (wanted < 8)).all(axis=1)
    assert inside.sum() > 10
    assert near[inside].max() < 1e-4


def test_on_a_sphere_points_keep_their_distance_over_the_surface():
    mesh = hem.generate("sphere", 40_000)
    radius = float(np.linalg.norm(mesh.points[0]))
    s, at = structures.build("half_edge", mesh), struck(mesh, 1)
    offsets = break_points(MATERIALS["glass"], 2, 0.15 * radius)
    shatter(s, at, "glass", 2, scale=0.15 * radius)
    new = s.points[len(mesh.points) :].astype(float)
    cosine = new @ at / np.linalg.norm(new, axis=1) / np.linalg.norm(at)
    arcs = radius * np.arccos(np.clip(cosine, -1, 1))
    for wanted in np.hypot(*offsets.T):
        assert np.abs(arcs - wanted).min() < 2e-3 * radius


def test_points_that_are_cast_too_far_to_be_followed_are_outside():
    for scale in (1e99, 1e300):
        s = structures.build("half_edge", hem.generate("sphere", 42))
        broken = shatter(s, (0, 0, 1), "glass", scale=scale)
        assert broken.counts["outside"] == sum(MATERIALS["glass"].circles)


def test_the_impact_and_the_middles_of_the_sides_are_split():
    s = structures.build("half_edge", sheet())
    bare = replace(MATERIALS["glass"], circles=())
    broken = shatter(s, (4.5, 4.25, 0), bare)
    new = s.points[81:].tolist()
    assert new == [[4.5, 4.25, 0], [4.5, 4, 0], [5, 4.5, 0], [4.5, 4.5, 0]]
    # Three faces of the one that was hit, each split at a side, and the three neighbors in two.
    assert len(broken.shards) == 3 * 2 + 3 * 2


@pytest.mark.parametrize(
    ("impact", "what"), [((4, 4, 0), "a vertex"), ((4.5, 4, 0), "a side"), ((0, 0.5, 0), "border")]
)
def test_an_impact_on_a_vertex_or_a_side_is_handled(impact, what):
    for name in QUICK_TO_COMPILE:
        s = structures.build(name, sheet())
        broken = shatter(s, impact, "glass", 3)
        s.validate()
        require_surface_laws(sheet(), broken, TOLERANCE * diagonal(sheet()))
        assert len(broken.shards) > 20


def test_points_on_sides_and_vertices_split_the_sides_or_nothing():
    grid = sheet()
    s = structures.build("half_edge", grid)
    s.split_face(0, (0.6, 0.3, 0))
    before = s.n_vertices
    tiny = replace(MATERIALS["glass"], circles=(50,))
    broken = shatter(s, (0.6, 0.3, 0), tiny, 1, scale=1e-5)
    # All points lie within the tolerance of the vertex that is there already.
    assert broken.counts["on a vertex"] == 50
    assert s.n_vertices <= before + 3


def test_what_hangs_in_a_point_comes_off():
    grid = hem.generate("grid", 400)
    s = structures.build("half_edge", grid)
    split = s.copy()
    _, faces, _ = break_surface(split, grid.points.mean(axis=0), MATERIALS["glass"], 0)
    with pytest.raises(hem.TopologyError, match="two fans"):
        split.remove_faces(faces)
    broken = shatter(s, grid.points.mean(axis=0), "glass", 0)
    assert broken.counts["broken off"] == len(broken.shards) - len(faces) > 0


@pytest.mark.parametrize(
    ("radii", "off"), [((0.9, 1), [0, 3]), ((1, 0.9), [1, 2]), ((1, 1), [1, 2])]
)
def test_of_two_fans_that_would_meet_in_a_point_the_larger_or_else_the_first_stays(radii, off):
    angles = np.arange(6) * np.pi / 3
    ring = np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1) * np.repeat(radii, 3)[:, None]
    fan = [(0, i + 1, (i + 1) % 6 + 1) for i in (0, 3, 4, 1, 2, 5)]
    s = structures.build("half_edge", hem.TriangleMesh([(0, 0, 0), *ring], fan), compiled=False)
    assert hanging(s, np.array([4, 5])).tolist() == off


def test_islands_are_as_many_as_there_are_parts_of_the_type_they_had():
    triangles = np.arange(600).reshape(-1, 3)
    points = np.random.default_rng(0).random((601, 3))
    found = hem.fracture.islands(hem.TriangleMesh(points, triangles, np.float64))
    areas = [it.area() for it in found]
    assert len(found) == 200
    assert areas == sorted(areas, reverse=True)
    assert {it.points.dtype for it in found} == {np.dtype(np.float64)}
    corners = {it.points.tobytes() for it in found}
    assert corners == {points[it].tobytes() for it in triangles}


def test_islands_are_parts_of_the_rest_the_largest_first():
    dense = replace(MATERIALS["glass"], circles=(0, 0, 400))
    found = 0
    for seed in range(30):
        s = structures.build("half_edge", hem.generate("grid", 2_500))
        broken = shatter(s, s.points[1200], replace(dense, scale=0.08), seed)
        sizes = [len(it.triangles) for it in broken.rest]
        assert sum(sizes) == s.n_faces
        assert all(it.summary().components == 1 for it in broken.rest)
        found += len(sizes) > 1
    assert found > 3


@pytest.mark.parametrize("name", waiting_for(["half_edge"], QUICK_TO_COMPILE))
def test_what_broke_stays_as_it_was_whatever_is_done_to_the_mesh_later(name):
    meshes = [structures.build(name, sheet()) for _ in "12"]
    broken, expected = (shatter(s, (3.3, 4.2, 0), "stone", 2) for s in meshes)
    wanted = [it.points for it in expected.pieces], expected.neighbors, expected.mass.masses
    s = meshes[0]
    shatter(s, (6.3, 6.2, 0), "stone", 3)
    s.split_all_faces()
    s.move_vertices(s.vertices(), np.zeros((s.n_vertices, 3)))
    s.compact()
    found = [it.points for it in broken.pieces], broken.neighbors, broken.mass.masses
    assert all(np.array_equal(*it) for it in zip(found[0], wanted[0], strict=True))
    assert all(np.array_equal(*it) for it in zip(found[1:], wanted[1:], strict=True))


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_a_render_mesh_follows(name):
    s = structures.build(name, sheet())
    render = hem.RenderMesh(s)
    shatter(s, (3.3, 4.2, 0), "wood", 2)
    assert_in_step(render)


def test_neighbors_are_those_that_share_a_side():
    broken = shatter(structures.build("half_edge", sheet()), (3.3, 4.2, 0), "stone", 2)
    assert broken.neighbors.tolist() == sharing_sides(broken.pieces)


def thin(height: float = 0.1) -> hem.TriangleMesh:
    """A closed plate, 100 times as wide as it is thick."""
    made = trimesh.creation.box((10, 10, height)).subdivide().subdivide()
    return hem.TriangleMesh(made.vertices, made.faces)


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_a_blow_strikes_the_side_of_a_thin_plate_that_it_comes_from(name):
    s = structures.build(name, thin())
    rng = np.random.default_rng(0)
    for way in (1, -1) * some(30):
        at = np.append(10 * rng.random(2) - 5, way * 0.05)
        for given in (at, at.astype(np.float32), at + way * np.array([0, 0, 0.01])):
            assert np.allclose(nearest_face(s, given).point, at, rtol=0, atol=1e-5)
    broken = shatter(s, (0.0482, 0.5207, 0.05), seed=1)
    assert broken.direction.tolist() == [0, 0, -1]


@pytest.mark.parametrize("model", [*MODELS, "cow", "thin"])
def test_walking_finds_what_looking_at_every_face_finds(model):
    mesh = thin() if model == "thin" else surface(model)
    s = structures.build("half_edge", mesh)
    rng, rounding = np.random.default_rng(4), ROUNDING * np.abs(mesh.points).max()
    for seed in range(40):
        at = struck(mesh, seed) + rng.normal(size=3) * (seed % 4) * 1e-3 * diagonal(mesh)
        walked, looked = nearest_face(s, at), scanned(s, at)
        apart = np.linalg.norm(walked.point - at), np.linalg.norm(looked.point - at)
        assert apart[1] * (1 - 1e-9) <= apart[0] <= apart[1] + rounding
        if not seed % 4:
            assert np.linalg.norm(walked.point - looked.point) < 1e-5 * diagonal(mesh)


@pytest.mark.parametrize(("away", "looks"), [(0.0, False), (5e-4, False), (2e-3, True)])
def test_only_what_lies_beside_its_face_has_every_face_looked_at(away, looks):
    """A hit that a physics engine tells is a little off the surface."""
    mesh = hem.generate("torus", 2_000)
    s = structures.build("half_edge", mesh)
    for corners in mesh.points[mesh.triangles[::500]].astype(float):
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max()
        across = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        at = corners.mean(axis=0) + away * longest * across / np.linalg.norm(across)
        assert nearest_face(s, at).scanned == looks


def test_a_walk_visits_few_faces_and_starts_where_it_is_told():
    mesh = hem.generate("grid", 40_000)
    s = structures.build("half_edge", mesh)
    visited = [nearest_face(s, struck(mesh, i)).visited for i in range(50)]
    from_afar = [nearest_face(s, struck(mesh, i), start=0).visited for i in range(50)]
    assert np.mean(visited) < 60
    assert 100 < np.mean(from_afar) < 1000
    for start in (-2, 10**6, 2**40):
        with pytest.raises(hem.MeshError, match="no such face"):
            nearest_face(s, struck(mesh, 0), start=start)


def test_materials_of_ones_own(tmp_path):
    own = Material("jelly", 1000, 0.01, (3, 3), 0.1, 4, 0.1, 0.1)
    broken = shatter(structures.build("half_edge", sheet()), (3.3, 4.2, 0), own)
    assert broken.material is own
    assert broken.mass.masses.sum() == pytest.approx(1000 * 0.01 * diagonal(sheet()) * 64, rel=1e-6)
    file = tmp_path / "mine.toml"
    file.write_text("[jelly]\ndensity = 1.0\n")
    with pytest.raises(hem.MeshError, match=r"mine\.toml.*jelly.*lacks burst"):
        hem.fracture.materials(file)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ("circles = 5", "circles cannot be 5"),
        ("circles = [3, true]", "circles"),
        ("thickness = true", "thickness"),
        (f"density = 1{400 * '0'}", "density"),
        ('burst = "0.3"', "burst"),
        ("density = -1.0", "density"),
        ('color = "blue"', "color"),
        ('color = "#fff"', "color"),
    ],
)
def test_a_wrong_number_of_a_material_is_told_with_its_file(tmp_path, wrong, words):
    file, name = tmp_path / "mine.toml", wrong.partition(" ")[0]
    right = {
        "density": "1", "thickness": "1", "circles": "[1]", "scale": "1", "sites": "1",
        "reach": "1", "burst": "1",
    }  # fmt: skip
    lines = [f"{key} = {value}" for key, value in right.items() if key != name]
    file.write_text("\n".join(["[jelly]", *lines, wrong]))
    with pytest.raises(hem.MeshError, match=rf"mine\.toml.*jelly.*{words}"):
        hem.fracture.materials(file)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: shatter(s, (1, 2)), "three finite numbers"),
        (lambda s: shatter(s, (1, 2, np.nan)), "three finite numbers"),
        (lambda s: shatter(s, "here"), "three finite numbers"),
        (lambda s: shatter(s, (1, 2, 5.7)), "more than half of its size"),  # which is 8 √2
        (lambda s: shatter(s, (1, 2, 0), "glas"), "did you mean 'glass'"),
        (lambda s: shatter(s, (1, 2, 0), seed=-1), "a seed is a whole number"),
        (lambda s: shatter(s, (1, 2, 0), scale=0), "positive and finite"),
    ],
)
def test_what_cannot_be_shattered_is_said_and_nothing_changes(call, message):
    s = structures.build("half_edge", sheet())
    before = s.copy()
    with pytest.raises(hem.MeshError, match=message):
        call(s)
    assert np.array_equal(s.points, before.points)
    assert s.faces().tolist() == before.faces().tolist()


def test_polygons_and_empty_meshes_are_refused():
    quads = hem.PolygonMesh(np.eye(3)[[0, 1, 2, 0]] + [[0], [0], [0], [1]], [[0, 1, 2, 3]])
    with pytest.raises(hem.MeshError, match="triangles only"):
        shatter(structures.build("plankton", quads), (0, 0, 1))
    for find in (scanned, nearest_face):
        with pytest.raises(hem.MeshError, match="triangles only"):
            find(structures.build("plankton", quads), (0, 0, 1))
    empty = hem.TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    for name in OF_EACH_KIND:
        with pytest.raises(hem.MeshError, match="no faces"):
            shatter(structures.build(name, empty), (0, 0, 1))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"material": None}, "no material None"),
        ({"material": "gold"}, "no material 'gold'"),
        ({"scale": "wide"}, "positive and finite, not 'wide'"),
        ({"scale": 0}, "positive and finite, not 0"),
        ({"scale": True}, "positive and finite, not True"),
        ({"scale": 10**400}, "positive and finite, not 1000"),
        ({"impact": (1e308, 1e308, 1e308)}, "more than half of its size"),
        ({"impact": (10**400, 0, 0)}, "three finite numbers"),
    ],
)
def test_bad_arguments_are_refused_and_the_mesh_stays(given, words):
    s = structures.build("half_edge", sheet())
    before = s.to_triangles()
    with pytest.raises(hem.MeshError, match=words):
        shatter(s, **{"impact": (3.2, 4.1, 0)} | given)
    assert np.array_equal(s.to_triangles().triangles, before.triangles)


BOOK = hem.TriangleMesh(
    [(0, 0, 0), (0, 0, 1), (1, 0, 0), (-1, 1, 0), (-1, -1, 0)], [(0, 1, 2), (0, 1, 3), (0, 1, 4)]
)
PILLOW = hem.TriangleMesh(np.eye(3), [(0, 1, 2), (0, 2, 1)])


def test_what_is_no_surface_is_refused_by_all_that_hold_it_and_stays():
    held = 0
    for name in structures.NAMES:
        try:
            s = structures.build(name, BOOK)
        except hem.NonManifoldError:
            continue
        with pytest.raises(hem.TopologyError, match="cannot shatter: edges lie in more than two"):
            shatter(s, BOOK.points[BOOK.triangles[0]].mean(axis=0))
        assert np.array_equal(s.points, BOOK.points)
        held += 1
    assert held


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_two_faces_with_the_same_corners_break_alike_and_keep_their_area(name):
    broken = shatter(structures.build(name, PILLOW), (0.34, 0.33, 0.33), seed=1)
    assert len(broken.shards) == 186
    assert sum(it.area() for it in broken.pieces) == pytest.approx(PILLOW.area())


@pytest.mark.parametrize("given", [sheet(), "bunny", None])
def test_what_is_no_structure_is_told_what_to_give(given):
    for ask in (shatter, tetrahedra, nearest_face, scanned):
        words = f"{ask.__name__} takes a structure, such as .*, not {type(given).__name__}"
        with pytest.raises(hem.MeshError, match=words):
            ask(given, (0, 0, 0))


@pytest.mark.parametrize("given", [structures.build("half_edge", sheet()), "bunny", None])
def test_what_is_no_triangle_mesh_is_told_what_to_give(given):
    for ask in (islands, require_body, wrapped, lambda it: voronoi(it, (0, 0, 0))):
        name = getattr(ask, "__name__", "voronoi").replace("<lambda>", "voronoi")
        words = f"{name} takes a TriangleMesh, such as .*, not {type(given).__name__}"
        with pytest.raises(hem.MeshError, match=words):
            ask(given)


@pytest.mark.parametrize("name", OF_EACH_KIND)
def test_a_mesh_in_one_point_is_told_to_be_so_and_not_of_a_scale(name):
    s = structures.build(name, hem.TriangleMesh(np.ones((3, 3)), [(0, 1, 2)]))
    with pytest.raises(hem.MeshError, match="all vertices lie in one point"):
        shatter(s, (1, 1, 1))


class Stop(BaseException):
    """An interrupt."""


def require_whole(s: structures.Structure, render: hem.RenderMesh) -> None:
    """The mesh is sound, followers know of all that was done, and it can be broken yet."""
    s.validate()
    assert_in_step(render)
    shatter(s, (3.3, 4.2, 0), "stone", 2)
    s.validate()
    assert_in_step(render)


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_an_interrupt_leaves_a_whole_mesh_that_its_followers_know(name, compiled, monkeypatch):
    """It reaches Python when compiled code ends."""
    s = structures.build(name, sheet(), compiled=compiled)
    render, run = hem.RenderMesh(s), type(s).run

    def stopped(mesh, make, plan):
        result = run(mesh, make, plan)
        if make is breaking:
            raise Stop
        return result

    with monkeypatch.context() as patched:
        patched.setattr(type(s), "run", stopped)
        with pytest.raises(Stop):
            shatter(s, (3.3, 4.2, 0), "stone", 2)
    require_whole(s, render)


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_what_a_subscriber_raises_ends_it_after_an_edit_that_all_are_told_of(name):
    s = structures.build(name, sheet())

    def fail(edit: hem.Edit) -> None:
        raise ZeroDivisionError

    end = s.subscribe(fail)
    render = hem.RenderMesh(s)
    with pytest.raises(ZeroDivisionError):
        shatter(s, (3.3, 4.2, 0), "stone", 2)
    end()
    require_whole(s, render)


def test_far_from_the_origin_what_is_within_roundings_of_a_vertex_lies_on_it():
    far = 2.0**14
    near, corner = ((far + 4 + it, 4 + it / 2, 0) for it in (0.03, 0))
    assert TOLERANCE * diagonal(sheet()) < 0.03 < ROUNDING * far
    mesh = hem.TriangleMesh(sheet().points + np.float32((far, 0, 0)), sheet().triangles)
    none = replace(MATERIALS["glass"], circles=())
    found = [shatter(structures.build("half_edge", mesh), it, none).shards for it in (near, corner)]
    assert len(found[0]) == len(found[1])


def test_a_mesh_without_area_is_told_to_be_struck_elsewhere_and_stays():
    s = structures.build(
        "half_edge", hem.TriangleMesh([(0, 0, 0), (1, 0, 0), (3, 0, 0)], [(0, 1, 2)])
    )
    with pytest.raises(hem.MeshError, match="has no area; strike beside it"):
        shatter(s, (1, 0, 0))
    assert s.n_faces == 1


def test_faces_without_area_are_no_trouble_to_find_others():
    flat = hem.TriangleMesh(
        [(0, 0, 0), (0, 0, 0), (0, 0, 0), (1, 0, 0), (2, 0, 0), (5, 0, 0), (6, 0, 0), (5, 1, 0)],
        [(0, 1, 2), (0, 1, 3), (0, 3, 4), (3, 4, 2), (5, 6, 7)],
    )
    s = structures.build("indexed", flat)
    for at, face in (
        ((5.2, 0.2, 0.5), 4), ((-1, 0, 1), 0), ((1.5, -1, 0), 2), ((0.5, -1, 0), 1)
    ):  # fmt: skip
        assert scanned(s, at).face == face


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_the_face_that_is_hit_says_of_what_material_it_is(name):
    at = (3.2, 4.1, 0)
    s = structures.build(name, sheet())
    made_of = s.face_attribute("material", np.int8)
    made_of[s.faces()] = NAMES.index("wood")
    made_of[nearest_face(s, at).face] = NAMES.index("glass")
    expected = shatter(structures.build(name, sheet()), at, "glass", 7)
    broken = shatter(s, at, made_of, 7)
    assert broken.material == MATERIALS["glass"]
    assert np.array_equal(corners(broken.shards), corners(expected.shards))
    assert set(made_of[s.faces()].tolist()) <= {NAMES.index("wood"), NAMES.index("glass")}
    for other in ({"dtype": np.int8, "shape": 2}, {}):
        odd = s.face_attribute(f"odd {len(other)}", **other)
        with pytest.raises(hem.MeshError, match="one integer per face"):
            shatter(s, (7.5, 7.1, 0), odd)
    made_of[s.faces()] = 99
    with pytest.raises(hem.MeshError, match="material 99 is none of"):
        shatter(s, (7.5, 7.1, 0), made_of)
    with pytest.raises(hem.MeshError, match="no attribute of the faces of this mesh"):
        shatter(structures.build(name, sheet()), at, made_of)


def test_a_fracture_can_be_pickled():
    broken = shatter(structures.build("half_edge", sheet()), (3.2, 4.1, 0), "glass", 7)
    again = pickle.loads(pickle.dumps(broken))
    assert np.array_equal(corners(again.shards), corners(broken.shards))
    for it in (again, replace(again, seed=8)):
        assert np.array_equal(it.neighbors, broken.neighbors)
    assert again.counts == broken.counts
