"""Remeshing: as even as another library makes it, and still the same surface."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from scipy.spatial import Delaunay

import hem
import structures
from hem import algorithms
from hem.algorithms.nearest import Surface
from hem.algorithms.remeshing import LEAST_COSINE, flip_to_even, relax
from hem.meshes.measures import normals
from hem.sources import meshlab
from tests.hem.algorithms.meshes import dented
from tests.hem.algorithms.test_passes import OPEN


def edges_of(mesh: hem.TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
    """(k, 2): the edges, and how many faces each has."""
    sides = np.concatenate([np.roll(mesh.triangles, i, axis=1)[:, :2] for i in range(3)])
    return np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)


def lengths(mesh: hem.TriangleMesh) -> np.ndarray:
    edges, _ = edges_of(mesh)
    return np.linalg.norm(np.diff(mesh.points[edges].astype(float), axis=1)[:, 0], axis=1)


def valence_error(mesh: hem.TriangleMesh) -> float:
    """How far the valence is from 6, or from 4 on the border, on average."""
    edges, faces = edges_of(mesh)
    wanted = np.full(len(mesh.points), 6)
    wanted[edges[faces == 1]] = 4
    return float(np.abs(np.bincount(edges.reshape(-1), minlength=len(wanted)) - wanted).mean())


def remeshed(mesh: hem.TriangleMesh, **asked: float) -> hem.TriangleMesh:
    s = structures.build("half_edge", mesh)
    algorithms.remesh(s, **asked)  # type: ignore[arg-type]
    s.validate()
    return s.to_triangles()


def by_pymeshlab(mesh: hem.TriangleMesh, length: float) -> hem.TriangleMesh:
    pymeshlab = pytest.importorskip("pymeshlab")
    scene = pymeshlab.MeshSet()
    scene.add_mesh(pymeshlab.Mesh(mesh.points, mesh.triangles))
    scene.meshing_isotropic_explicit_remeshing(iterations=10, targetlen=pymeshlab.PureValue(length))
    found = scene.current_mesh()
    return hem.TriangleMesh(found.vertex_matrix(), found.face_matrix())


def test_edges_are_as_long_as_asked_for_and_valences_evener_than_those_of_pymeshlab() -> None:
    mesh = hem.sample("bunny")
    length = 1.5 * float(lengths(mesh).mean())
    mine, theirs = remeshed(mesh, length=length), by_pymeshlab(mesh, length)
    found = lengths(mine) / length
    assert ((found > 4 / 5) & (found < 4 / 3)).mean() >= 0.95
    assert valence_error(mine) < valence_error(theirs)
    assert meshlab.distances(mesh, mine)[1] < 1e-3
    hem.require_sound(mine)


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_surface_stays_where_it_is_finer_or_coarser(factor: float) -> None:
    mesh = hem.generate("torus", 2500)
    mine = remeshed(mesh, length=factor * float(lengths(mesh).mean()))
    assert np.isclose(mine.volume(), mesh.volume(), rtol=0.05)
    assert (len(mine.points) > len(mesh.points)) == (factor < 1)


def a_box(*extents: float) -> hem.TriangleMesh:
    box = pytest.importorskip("trimesh").creation.box(extents)
    return hem.TriangleMesh(box.vertices, box.faces)


def a_cone(height: float) -> hem.TriangleMesh:
    cone = pytest.importorskip("trimesh").creation.cone(1, height, sections=64)
    return hem.TriangleMesh(cone.vertices, cone.faces)


@pytest.mark.parametrize(
    ("make", "length", "share", "within"),
    [
        (partial(a_box, 1, 1, 1), 0.07, 0.9, 0.001),
        (partial(a_box, 10, 10, 0.5), 1.0, 0.8, 0.001),
        (partial(a_box, 0.1, 0.1, 10), 0.05, 0.85, 0.001),
        (partial(a_cone, 2), 0.15, 0.9, 0.001),
        (partial(a_cone, 10), 0.15, 0.9, 0.02),  # its tip is finer than the length
    ],
)
def test_what_is_sharp_stays_sharp(
    make: Callable[[], hem.TriangleMesh], length: float, share: float, within: float
) -> None:
    mesh = make()
    mine = remeshed(mesh, length=length)
    found = lengths(mine) / length
    assert ((found > 4 / 5) & (found < 4 / 3)).mean() >= share
    assert np.isclose(mine.area(), mesh.area(), rtol=0.01)
    assert np.isclose(mine.volume(), mesh.volume(), rtol=0.01)
    assert np.allclose(mine.points.max(axis=0), mesh.points.max(axis=0), rtol=within)
    assert meshlab.distances(mesh, mine)[1] < 0.01


@pytest.mark.parametrize("sides", [6, 8])
def test_a_prism_keeps_the_creases_between_its_sides(sides: int) -> None:
    prism = pytest.importorskip("trimesh").creation.cylinder(1, 3, sections=sides)
    mesh = hem.TriangleMesh(prism.vertices, prism.faces)
    mine = remeshed(mesh, length=0.15)
    assert np.isclose(mine.volume(), mesh.volume(), rtol=1e-3)


def test_two_sheets_that_lie_on_each_other_stay() -> None:
    angles = np.arange(6) * np.pi / 3
    hexagon = np.concatenate(
        [[(0, 0, 0)], np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1)]
    )
    fan = [(0, i + 1, (i + 1) % 6 + 1) for i in range(6)]
    sheet = pytest.importorskip("trimesh").Trimesh(hexagon, fan).subdivide().subdivide().subdivide()
    above, n = np.asarray(sheet.faces), len(sheet.vertices)
    edges, faces = edges_of(hem.TriangleMesh(sheet.vertices, above))
    rim = np.isin(np.arange(n), edges[faces == 1])
    below = np.where(rim, np.arange(n), n + np.cumsum(~rim) - 1)[above][:, ::-1]
    points = np.concatenate([sheet.vertices, sheet.vertices[~rim]])
    pillow = hem.TriangleMesh(points, np.concatenate([above, below]))
    mine = remeshed(pillow, iterations=5)
    assert np.isclose(mine.area(), pillow.area(), rtol=0.05)


def test_no_vertex_goes_to_the_other_side_of_a_thin_wall() -> None:
    ball = hem.generate("sphere", 642)
    points = np.concatenate([ball.points, 0.99 * ball.points])
    faces = np.concatenate([ball.triangles, ball.triangles[:, ::-1] + len(ball.points)])
    shell = hem.TriangleMesh(points, faces)
    mine = remeshed(shell, length=0.3, iterations=3)
    assert np.isclose(mine.volume(), shell.volume(), rtol=0.05)


def test_a_nearest_point_is_found_where_all_faces_look_away() -> None:
    surface = Surface(np.eye(3), np.array([[0, 1, 2]]))
    for normal in ((1, 1, 1), (-1, -1, -1)):
        found = surface.nearest(np.ones((1, 3)), np.array([normal], float))
        assert np.allclose(found, 1 / 3)


def test_the_length_is_the_mean_unless_it_is_said() -> None:
    mesh = hem.generate("sphere", 642)
    assert np.isclose(lengths(remeshed(mesh)).mean(), lengths(mesh).mean(), rtol=0.1)


@pytest.mark.parametrize("length", [3e38, 1e300])
def test_a_length_beyond_all_positions_is_one_as_well(length: float) -> None:
    mesh = hem.generate("sphere", 162)
    with np.errstate(all="raise"):
        mine = remeshed(mesh, length=length, iterations=1)
    assert np.array_equal(mine.points, remeshed(mesh, length=100, iterations=1).points)


@pytest.mark.parametrize("power", [-100, 127])  # nearly as large as numbers are
def test_the_unit_of_length_makes_no_difference(power: int) -> None:
    corners = 1.99 * np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], np.float32)
    faces = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]
    scale = np.float32(2.0**power)
    one = remeshed(hem.TriangleMesh(corners, faces), length=2, iterations=3)
    mine = remeshed(hem.TriangleMesh(corners * scale, faces), length=2 * 2.0**power, iterations=3)
    assert np.array_equal(mine.triangles, one.triangles)
    assert np.array_equal(mine.points, one.points * scale)


def test_border_vertices_stay() -> None:
    edges, faces = edges_of(OPEN)
    border = np.unique(edges[faces == 1])
    s = structures.build("half_edge", OPEN)
    algorithms.remesh(s, 1.5 * float(lengths(OPEN).mean()), iterations=3)
    assert np.array_equal(s.points[border], OPEN.points[border])
    assert s.is_border(border).all()


def test_edges_that_have_no_middle_in_float32_stay() -> None:
    """Of a plane so far away that coordinates along it come in steps of 2."""
    x, y = (it.reshape(-1) for it in np.meshgrid(np.arange(5), np.arange(5)))
    points = np.stack([2 * x + 2.0**24, 2 * y, 0 * x], axis=1)
    first = (5 * y + x)[(x < 4) & (y < 4)]
    corners = [first + i for i in (0, 1, 6)], [first + i for i in (0, 6, 5)]
    mesh = hem.TriangleMesh(points, np.concatenate([np.stack(it, axis=1) for it in corners]))
    mine = remeshed(mesh, length=1.0)
    assert len(mine.points) < 100
    assert np.isclose(mine.face_areas().sum(), 64)


def test_a_nearest_point_is_that_of_trimesh_on_the_triangle_that_faces_as_the_vertex_does() -> None:
    closest_point = pytest.importorskip("trimesh").triangles.closest_point
    rng = np.random.default_rng(3)
    for corners in rng.normal(size=(50, 3, 3)):
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        points = corners.mean(axis=0) + 2 * rng.normal(size=(40, 3)) + 0.3 * normal
        both = Surface(
            np.concatenate([corners, corners + 0.3 * normal]), np.array([[0, 1, 2], [3, 5, 4]])
        )
        normals = rng.normal(size=(40, 3))
        along = normals @ normal > 0
        expected = closest_point(
            np.where(along[:, None, None], corners, corners + 0.3 * normal), points
        )
        assert np.allclose(both.nearest(points, normals), expected)


@pytest.mark.parametrize("turn", range(3))
@pytest.mark.parametrize(("corners", "place", "expected"), [
    ([(0, 0, 0), (0, 0, 0), (2, 0, 0)], (1, 1, 0), (1, 0, 0)),
    ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], (1.5, 1, 1), (1.5, 0, 0)),
    ([(1, 2, 3), (1, 2, 3), (1, 2, 3)], (0, 1, 0), (1, 2, 3)),
    ([(0, 0, 0), (3, 0, 0), (0, 3, 0)], (1, 1, 5), (1, 1, 0)),
])  # fmt: skip
def test_a_triangle_without_area_has_a_nearest_point_as_well(
    corners: list[tuple[float, ...]],
    place: tuple[float, ...],
    expected: tuple[float, ...],
    turn: int,
) -> None:
    surface = Surface(np.array(np.roll(corners, turn, axis=0)), np.array([[0, 1, 2]]))
    assert np.allclose(surface.nearest(np.array([place], float), np.zeros((1, 3))), [expected])


def test_a_mesh_with_vertices_in_the_same_place_can_be_remeshed() -> None:
    points = OPEN.points.copy()
    points[OPEN.triangles[::50, 1]] = points[OPEN.triangles[::50, 0]]
    mine = remeshed(hem.TriangleMesh(points, OPEN.triangles), iterations=2)
    assert np.isfinite(mine.points).all()


def test_a_mean_length_that_makes_too_many_faces_is_refused_as_one_that_is_said() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    points = np.concatenate([corners, np.tile(1e-6 * corners, (100_000, 1))])
    s = structures.build(
        "half_edge", hem.TriangleMesh(points, np.arange(len(points)).reshape(-1, 3))
    )
    with pytest.raises(hem.MeshError, match="makes too many faces"):
        algorithms.remesh(s, iterations=1)


def test_on_an_even_surface_a_nearest_point_is_that_of_trimesh() -> None:
    mesh = dented("torus", 400)
    trimesh = pytest.importorskip("trimesh")
    at = mesh.points[::3] + np.random.default_rng(2).normal(0, 0.05, mesh.points[::3].shape)
    whole = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
    _, far, _ = trimesh.proximity.closest_point_naive(whole, at)
    found = Surface(mesh.points, mesh.triangles).nearest(at, np.zeros_like(at))
    assert np.allclose(np.linalg.norm(found - at, axis=1), far)


def unevenness(s: structures.Structure) -> int:
    """The sum of squares by which valences differ from 6, or from 4 on the border."""
    wanted = np.where(s.is_border(s.vertices()), 4, 6)
    return int(((s.valence(s.vertices()) - wanted) ** 2).sum())


def test_in_the_plane_edges_are_flipped_as_long_as_that_evens_out_valences() -> None:
    points = np.random.default_rng(2).random((60, 2))
    flat = hem.TriangleMesh(np.pad(points, ((0, 0), (0, 1))), Delaunay(points).simplices)
    s = structures.build("half_edge", flat, compiled=False)
    s.corner_attribute("any")  # so that every flip is told on its own
    told = [unevenness(s)]
    end = s.subscribe(lambda edit: told.append(unevenness(s)))
    for _ in range(10):
        flip_to_even(s)
    assert told == sorted(set(told), reverse=True)
    assert len(told) > 10
    assert (normals(s.points[s.triangles()].astype(float))[:, 2] > 0).all()
    end()
    for e in s.edges().tolist():
        other = s.copy()
        if other.can_flip_edge(e):
            other.flip_edge(e)
            turned = normals(other.points[other.triangles()].astype(float))[:, 2] <= 0
            assert turned.any() or unevenness(other) >= told[-1]


def test_no_face_turns_when_vertices_are_moved() -> None:
    mesh = hem.generate("torus", 400)
    rough = mesh.points + np.random.default_rng(5).normal(0, 0.1, mesh.points.shape)
    s = structures.build("half_edge", hem.TriangleMesh(rough, mesh.triangles), compiled=False)
    before, told = s.to_triangles().face_normals(), list[hem.Edit]()
    s.subscribe(told.append)
    relax(s, Surface(s.points, s.triangles()))
    assert len(told[0].changed_vertices) > 100
    cosines = (before * s.to_triangles().face_normals()).sum(axis=1)
    assert cosines.min() > LEAST_COSINE - 1e-4  # of float32


def test_the_nearest_point_of_three_corners_in_a_line_lies_between_the_outer_two() -> None:
    rng = np.random.default_rng(4)
    for way in rng.integers(1, 10, (300, 3)):
        corners, at = np.outer(rng.permutation([0, 3, 7]), way), rng.normal(0, 20, (1, 3))
        found = Surface(corners, np.array([[0, 1, 2]])).nearest(at, np.zeros((1, 3)))
        assert np.allclose(found, np.clip(at @ way / (way @ way), 0, 7) * way)
