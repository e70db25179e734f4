"""Circulating, normals and smoothing, against the triangle list and another library."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import njit

import hem
import structures
from hem import algorithms
from hem.authoring import visiting, walks
from tests.extent import OF_EACH_KIND, waiting_for
from tests.hem.algorithms.meshes import dented

CLOSED, OPEN = dented("torus", 400), dented("grid", 400)


def neighbors(mesh: hem.TriangleMesh) -> np.ndarray:
    """(n, n): how many faces two vertices share."""
    joined = np.zeros((len(mesh.points),) * 2, int)
    for a, b, c in mesh.triangles.tolist():
        for x, y in ((a, b), (b, c), (c, a)):
            joined[x, y] += 1
            joined[y, x] += 1
    return joined


@pytest.mark.parametrize("name", OF_EACH_KIND)
def test_sums_of_neighbors_are_exact_in_any_order(name: str) -> None:
    rng = np.random.default_rng(3)
    shape = CLOSED.points.shape
    points = (rng.uniform(1, 2, shape) * 2.0 ** rng.integers(-23, 2, shape)).astype(np.float32)
    points *= rng.choice([-1, 1], shape).astype(np.float32)
    s = structures.build(name, hem.TriangleMesh(points, CLOSED.triangles))
    algorithms.smooth(s)
    for v, joined in enumerate(neighbors(CLOSED)):
        around, before = points[joined > 0].astype(float), points[v].astype(float)
        sums = np.array([math.fsum(column) for column in around.T.tolist()])
        expected = before + (sums / len(around) - before)
        assert np.array_equal(s.points[v], expected.astype(np.float32))


@pytest.mark.parametrize("mesh", [CLOSED, OPEN], ids=["closed", "open"])
def test_circulating_meets_every_edge_twice_and_every_face_thrice(mesh: hem.TriangleMesh) -> None:
    s = structures.build("half_edge", mesh)
    edges = np.count_nonzero(np.triu(neighbors(mesh)))
    assert algorithms.circulate(s) == 2 * edges + 3 * len(mesh.triangles)


def test_the_center_is_the_mean_of_all_corners() -> None:
    s = structures.build("half_edge", OPEN)
    mean = OPEN.points[OPEN.triangles].astype(np.float64).mean(axis=(0, 1))
    assert np.allclose(algorithms.center(s), mean, atol=1e-12)
    assert np.allclose(s.points, OPEN.points - mean, atol=1e-6)
    assert np.allclose(algorithms.center(s), 0, atol=1e-6)


@pytest.mark.parametrize("name", waiting_for(OF_EACH_KIND, structures.NAMES))
def test_nothing_is_centered_where_a_place_would_not_be_finite(name: str) -> None:
    points = np.array([(3e38, 0, 0), (3e38, 1, 0), (-3e38, 0, 1)], np.float32)
    s = structures.build(name, hem.TriangleMesh(points, [(0, 1, 2)]))
    with pytest.raises(hem.MeshError, match="vertices: 2"):
        algorithms.center(s)
    assert np.array_equal(s.points, points)


@pytest.mark.parametrize("mesh", [CLOSED, OPEN], ids=["closed", "open"])
def test_normals_are_those_of_trimesh_weighted_by_area(mesh: hem.TriangleMesh) -> None:
    trimesh = pytest.importorskip("trimesh")
    other = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
    expected = trimesh.geometry.weighted_vertex_normals(
        len(mesh.points), mesh.triangles, other.face_normals, other.area_faces[:, None] * [1, 1, 1]
    )
    s = structures.build("half_edge", mesh)
    assert np.allclose(algorithms.vertex_normals(s), expected, atol=1e-5)
    assert np.allclose(algorithms.SIX["normals"](s), expected, atol=1e-5)


@pytest.mark.parametrize("scale", [1e-18, 1.0, 1e18])
def test_normals_around_vertices_are_vertex_normals_at_the_sizes_that_they_tell(scale) -> None:
    mesh = hem.TriangleMesh(10 * scale * CLOSED.points.astype(np.float64), CLOSED.triangles)
    s = structures.build("half_edge", mesh)
    assert np.allclose(algorithms.SIX["normals"](s), algorithms.vertex_normals(s), atol=1e-6)


def test_normals_of_a_sphere_point_away_from_its_middle() -> None:
    mesh = hem.generate("sphere", 2562)
    found = algorithms.vertex_normals(structures.build("winged_edge", mesh))
    outward = mesh.points / np.linalg.norm(mesh.points, axis=1, keepdims=True)
    assert ((found * outward).sum(axis=1) > 0.999).all()


@pytest.mark.parametrize("mesh", [CLOSED, OPEN], ids=["closed", "open"])
def test_smoothing_is_a_product_with_the_matrix_of_means(mesh: hem.TriangleMesh) -> None:
    shared = neighbors(mesh)
    means = (shared > 0) / (shared > 0).sum(axis=1, keepdims=True)
    border = (shared == 1).any(axis=1)
    means[border] = np.eye(len(shared))[border]
    s = structures.build("half_edge", mesh)
    algorithms.smooth(s, iterations=3)
    assert np.allclose(s.points, np.linalg.matrix_power(means, 3) @ mesh.points, atol=1e-5)
    algorithms.smooth(t := structures.build("half_edge", mesh), 1, "taubin")
    one = np.eye(len(shared))
    expected = (one - 0.53 * (means - one)) @ (one + 0.5 * (means - one)) @ mesh.points
    assert np.allclose(t.points, expected, atol=1e-5)


@pytest.mark.parametrize("compiled", [True, False])
def test_a_vertex_where_fans_of_faces_meet_stays_whatever_the_numbers_of_its_neighbors(
    compiled: bool,
) -> None:
    points = np.random.default_rng(0).normal(size=(9, 3))  # 1² + 8² is 4² + 7²
    mesh = hem.TriangleMesh(points, [(0, 1, 4), (0, 8, 7)])
    s = structures.build("indexed", mesh, compiled=compiled)
    algorithms.smooth(s)
    assert np.array_equal(s.points, mesh.points)


def test_a_lone_triangle_stays_whatever_the_numbers_of_its_corners() -> None:
    first, last = 0, 389_588  # whose squares were as good as one, once they had been spread
    points = np.random.default_rng(0).normal(size=(last + 1, 3)).astype(np.float32)
    s = structures.build("half_edge", hem.TriangleMesh(points, [(first, 1, last)]))
    algorithms.smooth(s)
    assert np.array_equal(s.points, points)


def test_taubin_keeps_the_volume_that_laplace_loses() -> None:
    mesh = hem.generate("sphere", 642)
    kept, lost = (structures.build("half_edge", mesh) for _ in range(2))
    algorithms.smooth(kept, 20, "taubin")
    algorithms.smooth(lost, 20)
    volume = mesh.volume()
    assert abs(kept.to_triangles().volume() - volume) < 0.02 * volume
    assert lost.to_triangles().volume() < 0.9 * volume


@pytest.mark.parametrize("name", ["half_edge", "half_edge_objects"])
def test_nothing_is_smoothed_where_a_place_would_not_be_finite(name: str) -> None:
    """Taubin's second pass takes a sphere a little beyond where it was."""
    sphere, largest = hem.generate("sphere", 162), np.finfo(np.float32).max
    mesh = hem.TriangleMesh(sphere.points * (largest / sphere.points.max()), sphere.triangles)
    beyond = mesh.points.max(axis=1) == largest
    shared = neighbors(mesh) > 0
    means = shared @ mesh.points.astype(float) / shared.sum(axis=1, keepdims=True)
    s = structures.build(name, mesh, compiled=False)
    with np.errstate(all="raise"), pytest.raises(hem.MeshError, match="must be finite") as error:
        algorithms.smooth(s, 1, "taubin")
    assert np.isin(np.flatnonzero(beyond), error.value.elements["vertices"]).all()
    assert np.allclose(s.points, (mesh.points + means) / 2, rtol=1e-5)


@pytest.mark.parametrize("query", ["vertex_faces", "face_vertices"])
def test_passes_ask_for_memory_ahead_and_queries_do_not(query: str) -> None:
    s = structures.build("half_edge", CLOSED)
    kernel = type(s).kernels[query]
    visit_all = visiting(kernel, walks.count_one)
    passing = njit(lambda m, out: visit_all(m, 0, 0, out))
    asking = njit(lambda m, out: kernel(m, 0, out))
    for compiled, asks in ((passing, True), (asking, False)):
        assert compiled(s.records, np.zeros(64, np.int64)) == len(getattr(s, query)(0))
        (code,) = compiled.inspect_llvm().values()
        assert ("llvm.prefetch" in code) == asks
