"""Simplification against other libraries, and against what it promises."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from hem.algorithms import parts
from hem.algorithms.buckets import (
    BUCKETS,
    FRESH,
    LOWEST,
    bucket_of,
    drop,
    peek,
    put,
    put_off,
    queue_for,
)
from hem.algorithms.collapsing import (
    BORDER,
    FLAT,
    LENGTH_WEIGHT,
    QUADRIC,
    QUADRICS,
    SHORTEST_EDGE,
    SHORTEST_TO_PLANES,
    simplifying,
)
from hem.algorithms.quadrics import TOWARD_MIDDLE, WIDTH, best_point, value
from hem.algorithms.simplification import LEAST_COSINES, collapsible
from hem.meshes.measures import normals
from hem.sources import meshlab
from tests.extent import QUICK_TO_COMPILE
from tests.hem.algorithms.meshes import dented
from tests.hem.algorithms.test_passes import neighbors

GRID = hem.generate("grid", 900)


def simplified(mesh: hem.TriangleMesh, **asked: object) -> hem.TriangleMesh:
    s = structures.build("half_edge", mesh)
    algorithms.simplify(s, **asked)  # type: ignore[arg-type]
    s.validate()
    return s.to_triangles()


def by_pymeshlab(mesh: hem.TriangleMesh, faces: int) -> hem.TriangleMesh:
    return meshlab.apply("meshing_decimation_quadric_edge_collapse", mesh, targetfacenum=faces)


def by_fast_simplification(mesh: hem.TriangleMesh, faces: int) -> hem.TriangleMesh:
    other = pytest.importorskip("fast_simplification")
    arrays = mesh.points.copy(), mesh.triangles.astype(np.int32)  # it takes none that is read-only
    return hem.TriangleMesh(*other.simplify(*arrays, target_count=faces))


@pytest.mark.parametrize("rival", [by_pymeshlab, by_fast_simplification])
@pytest.mark.parametrize("sample", ["cow", "bunny"])
def test_a_tenth_of_the_faces_is_as_near_as_what_others_make(sample: str, rival) -> None:
    if absent := meshlab.problem():
        pytest.skip(absent)
    mesh = hem.sample(sample)
    faces = len(mesh.triangles) // 10
    theirs = meshlab.distances(mesh, rival(mesh, faces))
    mine = simplified(mesh, faces=faces)
    assert len(mine.triangles) <= faces
    for found, other in zip(meshlab.distances(mesh, mine), theirs, strict=True):
        assert found <= 1.1 * other


def test_how_far_meshes_are_apart_is_told_by_the_way_that_is_larger() -> None:
    if absent := meshlab.problem():
        pytest.skip(absent)
    square = hem.generate("grid", 400)
    wider = hem.TriangleMesh(square.points * np.float32((1.3, 1, 1)), square.triangles)
    for one, other in ((square, wider), (wider, square)):
        farthest, usual = meshlab.distances(one, other)
        size = np.linalg.norm(np.ptp(one.points, axis=0))
        assert farthest * size == pytest.approx(0.3, rel=1e-3)
        assert 0 < usual < farthest / 2


@pytest.mark.parametrize("by", algorithms.MEASURES)
def test_it_stops_at_the_number_asked_for(by: str) -> None:
    mesh = dented("torus", 400)
    assert len(simplified(mesh, vertices=123, by=by).points) == 123
    assert len(simplified(mesh, faces=300, by=by).triangles) == 300
    assert len(simplified(mesh, vertices=10_000, by=by).points) == 400


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
@pytest.mark.parametrize("by", algorithms.MEASURES)
def test_of_vertices_those_count_that_have_faces(name: str, by: str) -> None:
    mesh = dented("torus", 144)
    stray = hem.TriangleMesh(np.concatenate([np.ones((500, 3)), mesh.points]), mesh.triangles + 500)
    s = structures.build(name, stray)
    algorithms.simplify(s, vertices=60, by=by)
    s.validate()
    assert s.n_vertices == 560
    assert len(np.unique(s.triangles())) == 60


def test_a_sphere_can_become_a_tetrahedron_and_nothing_less() -> None:
    assert len(simplified(hem.generate("sphere", 642), vertices=0).points) == 4


def test_a_flat_square_keeps_its_outline_and_its_side() -> None:
    mine = simplified(GRID, error=1e-6)
    assert len(mine.points) < 30
    assert np.isclose(mine.face_areas().sum(), GRID.face_areas().sum(), rtol=1e-5)
    assert np.allclose(mine.bounds, GRID.bounds, atol=1e-5)
    up = normals(GRID.points[GRID.triangles[:1]].astype(float))[0]
    assert (normals(mine.points[mine.triangles].astype(float)) @ up > 0).all()


@pytest.mark.parametrize("by", algorithms.MEASURES)
def test_no_face_of_a_flat_square_loses_its_area(by: str) -> None:
    """On a grid many collapses would leave three corners in a line."""
    s = structures.build("half_edge", hem.generate("grid", 81), compiled=False)
    up = normals(s.points[s.triangles()[:1]].astype(float))[0]
    algorithms.simplify(s, vertices=0, by=by)
    assert s.n_vertices < 40
    assert (normals(s.points[s.triangles()].astype(float)) @ up > 0).all()


@pytest.mark.parametrize("by", algorithms.MEASURES)
def test_no_collapse_turns_a_face_of_a_curved_surface_further_than_it_may(by: str) -> None:
    s = structures.build("half_edge", dented("torus", 900))
    s.corner_attribute("any")  # so that every collapse is told on its own
    before, cosines = normals(s.points.astype(float)[s.triangles()]), []

    def follow(edit: hem.Edit) -> None:
        changed = edit.changed_faces
        after = normals(s.points.astype(float)[s.face_vertices(changed).values.reshape(-1, 3)])
        sizes = np.linalg.norm(before[changed], axis=1) * np.linalg.norm(after, axis=1)
        cosines.append(((before[changed] * after).sum(axis=1) / sizes).min())
        before[changed] = after

    s.subscribe(follow)
    algorithms.simplify(s, vertices=0, by=by)
    assert len(cosines) > 800
    for least, told in zip(LEAST_COSINES, (cosines[:450], cosines), strict=True):
        assert min(told) > least - 1e-4  # of float32


@pytest.mark.parametrize("valence", [20, 500, 8_000])
def test_a_hub_is_simplified_whatever_its_valence(valence: int, monkeypatch: Any) -> None:
    """Where few operations are done at once, and one of them may tell of more than all of those."""
    monkeypatch.setattr(parts, "STEP", 1)
    s = structures.build("half_edge", hem.valence_mesh(valence, 2 * valence + 8))
    algorithms.simplify(s, faces=s.n_faces // 4)
    s.validate()
    assert s.n_faces <= (2 * valence + 8) // 2


@pytest.mark.parametrize("zero", [0.0, 1e-12])  # which is nothing, seen from the middle
def test_by_length_borders_stay_as_they_are(zero: float) -> None:
    mesh = hem.TriangleMesh(np.where(GRID.points == 0, zero, GRID.points), GRID.triangles)
    s = structures.build("half_edge", mesh)
    before = [loop.tolist() for loop in s.border_loops()]
    algorithms.simplify(s, vertices=300, by="shortest_edge")
    assert [loop.tolist() for loop in s.border_loops()] == before
    assert np.array_equal(s.points[before[0]], mesh.points[before[0]])


def test_no_edge_longer_than_the_error_is_collapsed() -> None:
    mesh = dented("torus", 400)
    s = structures.build("half_edge", mesh)
    shortest = np.linalg.norm(np.diff(mesh.points[s.edge_array()], axis=1), axis=2).min()
    algorithms.simplify(s, error=0.99 * shortest, by="shortest_edge")
    assert s.n_vertices == 400
    algorithms.simplify(s, error=1.01 * shortest, by="shortest_edge")
    assert s.n_vertices < 400


def test_the_quadric_error_bounds_how_far_a_sphere_is_left() -> None:
    """The planes of a sphere touch it, so what is far from many of them is far from it."""
    mesh = hem.generate("sphere", 2562)
    counts = []
    for error in (1e-4, 1e-3, 1e-2):
        mine = simplified(mesh, error=error)
        counts.append(len(mine.points))
        assert abs(np.linalg.norm(mine.points, axis=1) - 1).max() < 10 * error + 1e-3
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] < 300


@pytest.mark.parametrize("error", [1e200, np.inf])
def test_an_error_whose_square_is_infinite_bounds_nothing(error: float) -> None:
    mesh = dented("torus", 100)
    assert len(simplified(mesh, error=error).points) == len(simplified(mesh, vertices=0).points)


@pytest.mark.parametrize("power", [-100, 127])  # nearly as large as numbers are
def test_the_unit_of_length_makes_no_difference(power: int) -> None:
    sphere = hem.generate("sphere", 642)
    mesh = hem.TriangleMesh(sphere.points * np.float32(1.5), sphere.triangles)
    expected = simplified(mesh, vertices=6)
    assert len(expected.points) == 6
    scaled = hem.TriangleMesh(mesh.points * np.float32(2.0**power), mesh.triangles)
    mine = simplified(scaled, vertices=6)
    assert np.array_equal(mine.triangles, expected.triangles)
    assert np.array_equal(mine.points, expected.points * np.float32(2.0**power))


def test_faces_without_area_are_simplified_without_a_warning() -> None:
    mesh = hem.generate("sphere", 42)
    s = structures.build(
        "half_edge_objects", hem.TriangleMesh(mesh.points * (1, 0, 0), mesh.triangles)
    )
    with np.errstate(all="raise"):
        algorithms.simplify(s, vertices=8)
    assert s.n_vertices == 8


def test_positions_are_seen_from_the_middle_of_the_bounding_box() -> None:
    for mesh in (GRID, hem.TriangleMesh(GRID.points + np.float32(4096), GRID.triangles)):
        plan = collapsible(structures.build("half_edge", mesh), QUADRICS, 0.7, np.inf)
        assert np.allclose(plan.middle, np.mean(mesh.bounds, axis=0))


@pytest.mark.parametrize("width", [1, 64])
def test_every_edge_that_is_put_off_comes_again_behind_the_cheaper_ones(width: int) -> None:
    costs = np.random.default_rng(1).permutation(2 ** np.linspace(0, 1.5, 100))
    queue = queue_for(len(costs))
    buckets = [bucket_of(queue, cost) for cost in costs]
    for edge in reversed(range(100)):
        put(queue, buckets[edge], edge)
    came: list[int] = []
    while (edge := peek(queue, width)) >= 0:
        drop(queue)
        if edge not in came:
            put_off(queue, bucket_of(queue, costs[edge]), edge)
        came.append(edge)
    assert sorted(came) == sorted([*range(100)] * 2)
    if width == 1:
        assert [*dict.fromkeys(came)] == sorted(range(100), key=lambda it: (buckets[it], it))


def test_an_edge_is_put_off_until_that_is_too_much_and_its_room_is_used_again() -> None:
    queue, times = queue_for(3), [0, 0, 0]
    for edge, below in enumerate((96, 97, 1)):
        put(queue, BUCKETS - below, edge)
    while (edge := peek(queue, 1)) >= 0:
        drop(queue)
        assert bucket_of(queue, 0.0) == queue.state[LOWEST]  # below it would never come
        put_off(queue, queue.state[LOWEST], edge)
        times[edge] += 1
    assert times == [3, 4, 1]  # each time by two doublings, of 16 buckets
    assert queue.state[FRESH] <= 3


def test_no_vertex_comes_to_lie_beyond_all_numbers() -> None:
    """Few planes that touch a sphere meet far outside of it."""
    sphere = hem.generate("sphere", 162)
    points = sphere.points * (np.finfo(np.float32).max / np.abs(sphere.points).max())
    s = structures.build("half_edge", hem.TriangleMesh(points, sphere.triangles))
    algorithms.simplify(s, vertices=6)
    s.validate()
    assert s.n_vertices < 162
    assert np.isfinite(s.points[s.vertices()]).all()


def test_a_quadric_is_the_sum_of_squared_distances_to_the_planes_at_a_vertex() -> None:
    """Of faces by area; of the border, upright on its face, by the square of its length."""
    mesh, at = dented("grid", 64), np.array([0.3, -0.2, 0.5])
    plan = collapsible(structures.build("half_edge", mesh), QUADRICS, 0.7, np.inf)
    points, shared, expected = mesh.points.astype(float), neighbors(mesh), np.zeros((64, 2))

    def add(vertices: list[int], normal: np.ndarray, weight: float) -> None:
        far = (at - points[vertices[0]]) @ normal / np.linalg.norm(normal)
        expected[vertices] += weight * far**2, weight

    for a, b, c in (np.roll(face, i).tolist() for face in mesh.triangles for i in range(3)):
        side, normal = points[b] - points[a], np.cross(points[b] - points[a], points[c] - points[a])
        add([a], normal, np.linalg.norm(normal) / 2)
        if shared[a, b] == 1:
            add([a, b], np.cross(side, normal), side @ side)
    quadrics = plan.rows[:, QUADRIC : QUADRIC + WIDTH]
    found = [(value(row, *(at - plan.middle)), row[10]) for row in quadrics]
    assert np.allclose(found, expected)


def test_the_best_point_is_where_the_sum_of_squares_is_least_a_little_drawn_to_a_middle() -> None:
    plan = collapsible(structures.build("half_edge", dented("grid", 64)), QUADRICS, 0.7, np.inf)
    middle = np.array([0.1, 0.2, 0.3])
    for row in plan.rows[:, QUADRIC : QUADRIC + WIDTH]:
        planes = row[[0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(3, 3)
        pull = TOWARD_MIDDLE * np.trace(planes)
        expected = np.linalg.solve(planes + pull * np.eye(3), pull * middle - row[6:9])
        assert np.allclose(best_point(row, *middle), expected)


@pytest.mark.parametrize(
    ("measure", "most", "count"),
    [(QUADRICS, (72, 0), 72), (SHORTEST_EDGE, (0, 144), 72), (SHORTEST_TO_PLANES, (0, 0), 35)],
)
def test_each_collapse_is_of_the_cheapest_edge_but_for_a_sixteenth(
    measure: int, most: tuple[int, int], count: int
) -> None:
    """Where not much more than half is collapsed, and before one is made cheaper by another."""
    s = structures.build("half_edge", dented("torus", 144), compiled=False)
    s.corner_attribute("any")  # so that every collapse is told on its own
    plan = collapsible(s, measure, 0.7, np.inf, most)
    rows = collapsible(s, QUADRICS, 0.7, np.inf).rows  # by length no planes are found
    edges, told = np.sort(s.edge_array()), list[float]()

    def follow(edit: hem.Edit) -> None:
        nonlocal edges
        ends = rows[edges]
        total, middles = ends[:, :, QUADRIC:BORDER].sum(axis=1), ends[:, :, :3].mean(axis=1)
        planes = total[:, [0, 1, 2, 6, 1, 3, 4, 7, 2, 4, 5, 8, 6, 7, 8, 9]].reshape(-1, 4, 4)
        pull = TOWARD_MIDDLE * total[:, [0, 3, 5]].sum(axis=1)[:, None]
        drawn = planes[:, :3, :3] + pull[:, None] * np.eye(3)
        targets = np.linalg.solve(drawn, (pull * middles - total[:, 6:9])[..., None])[..., 0]
        places = np.pad(targets, ((0, 0), (0, 1)), constant_values=1)
        errors = np.einsum("ni,nij,nj->n", places, planes, places)
        long = (np.diff(ends[:, :, :3], axis=1) ** 2).sum(axis=(1, 2))
        costs = {
            QUADRICS: errors + LENGTH_WEIGHT * long * total[:, 10],
            SHORTEST_EDGE: long,
            SHORTEST_TO_PLANES: np.where(errors <= FLAT * long * total[:, 10], long, np.inf),
        }[measure]
        gone, left = *edit.removed_vertices, *edit.changed_vertices
        mine = np.isin(edges, (gone, left)).all(axis=1)
        told.append(costs[mine].item() / costs.min())
        rows[left, :3] = s.points[left] - plan.middle
        expected = ends[:, 0, :3] if measure == SHORTEST_EDGE else targets
        assert np.allclose(rows[left, :3], expected[mine], atol=1e-6)
        rows[left, QUADRIC:BORDER] += rows[gone, QUADRIC:BORDER]
        edges = np.sort(s.edge_array())

    s.subscribe(follow)
    parts.change(s, "simplify", simplifying, plan)
    assert np.isfinite(told).all()
    assert len(told) >= count
    assert max(told[:count]) < 17 / 16


def test_no_collapse_leaves_an_edge_longer_than_it_may() -> None:
    mesh = dented("torus", 400)
    s = structures.build("half_edge", mesh, compiled=False)
    longest = longest_edge(s)
    plan = collapsible(s, SHORTEST_TO_PLANES, 0.7, longest, longest=longest)
    parts.change(s, "simplify", simplifying, plan)
    assert s.n_vertices < 300
    assert longest_edge(s) <= longest * (1 + 1e-5)  # of float32


def longest_edge(s: structures.Structure) -> float:
    return float(np.linalg.norm(np.diff(s.points[s.edge_array()], axis=1), axis=2).max())
