"""Subdivision against its masks, written down from the triangle list, and against its counts."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from tests.extent import waiting_for
from tests.hem.algorithms.meshes import dented
from tests.hem.algorithms.test_passes import neighbors

CLOSED, OPEN = dented("torus", 400), dented("grid", 100)
ICOSAHEDRON = hem.generate("sphere", 12)


def old_to_old(mesh: hem.TriangleMesh, scheme: str) -> np.ndarray:
    """(n, n): the mask of every old vertex."""
    shared = neighbors(mesh)
    mask = np.eye(len(shared))
    for v, row in enumerate(shared):
        ring, along = np.flatnonzero(row), np.flatnonzero(row == 1)
        if len(along) and scheme == "loop":
            mask[v, v], mask[v, along] = 3 / 4, 1 / 8
        if len(along):
            continue
        n = len(ring)
        cosine = np.cos(2 * np.pi / n)
        beta = {
            "loop": (5 / 8 - (3 / 8 + cosine / 4) ** 2) / n,
            "sqrt3": (4 - 2 * cosine) / 9 / n,
        }
        mask[v, v], mask[v, ring] = 1 - n * beta[scheme], beta[scheme]
    return mask


@pytest.mark.parametrize("scheme", algorithms.SCHEMES)
@pytest.mark.parametrize("mesh", [CLOSED, OPEN, ICOSAHEDRON], ids=["closed", "open", "icosahedron"])
def test_old_vertices_go_where_their_mask_says(scheme: str, mesh: hem.TriangleMesh) -> None:
    s = structures.build("half_edge", mesh)
    algorithms.subdivide(s, scheme)
    expected = old_to_old(mesh, scheme) @ mesh.points
    assert np.allclose(s.points[: len(mesh.points)], expected, atol=1e-6)


def points_on_edges(mesh: hem.TriangleMesh) -> dict[frozenset[int], np.ndarray]:
    """By edge the new point of Loop's masks, (3,) float64."""
    edges: dict[frozenset[int], list[int]] = {}
    for a, b, c in mesh.triangles.tolist():
        for x, y, z in ((a, b, c), (b, c, a), (c, a, b)):
            edges.setdefault(frozenset((x, y)), []).append(z)
    points = mesh.points.astype(np.float64)
    return {
        edge: 3 / 8 * points[list(edge)].sum(axis=0) + points[beside].sum(axis=0) / 8
        if len(beside) == 2
        else points[list(edge)].mean(axis=0)
        for edge, beside in edges.items()
    }


@pytest.mark.parametrize("mesh", [CLOSED, OPEN], ids=["closed", "open"])
def test_loop_makes_of_each_face_four_with_the_points_of_the_masks(mesh: hem.TriangleMesh) -> None:
    s = structures.build("half_edge", mesh)
    algorithms.subdivide(s, "loop")
    new = points_on_edges(mesh)
    numbered = {edge: len(mesh.points) + i for i, edge in enumerate(sorted(new, key=sorted))}
    expected = set()
    for a, b, c in mesh.triangles.tolist():
        ab, bc, ca = (numbered[frozenset(pair)] for pair in ((a, b), (b, c), (c, a)))
        expected |= {(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)}
    found = {tuple(np.roll(row, -int(row.argmin()))) for row in s.triangles()}
    assert found == {tuple(np.roll(row, -int(np.argmin(row)))) for row in expected}
    for edge, v in numbered.items():
        assert np.allclose(s.points[v], new[edge], atol=1e-6)
    assert s.n_edges == 2 * len(new) + 3 * len(mesh.triangles)


def test_sqrt3_makes_a_face_for_each_corner_and_its_two_middles() -> None:
    """On a closed mesh: the middles of the faces on both sides of an edge, and either end of it."""
    s = structures.build("half_edge", CLOSED)
    algorithms.subdivide(s, "sqrt3")
    n, beside = len(CLOSED.points), {}
    for f, (a, b, c) in enumerate(CLOSED.triangles.tolist()):
        beside |= {(a, b): f, (b, c): f, (c, a): f}
    expected = {(a, n + beside[b, a], n + f) for (a, b), f in beside.items()}
    found = {tuple(np.roll(row, -int(row.argmin()))) for row in s.triangles()}
    assert found == {tuple(np.roll(row, -int(np.argmin(row)))) for row in expected}
    middles = CLOSED.points[CLOSED.triangles].mean(axis=1)
    assert np.allclose(s.points[n:], middles, atol=1e-6)


@pytest.mark.parametrize(("scheme", "factor"), [("loop", 4), ("sqrt3", 3)])
def test_counts_grow_as_the_scheme_says_and_the_surface_stays_sound(
    scheme: str, factor: int
) -> None:
    for mesh in (CLOSED, OPEN):
        s = structures.build("half_edge", mesh)
        algorithms.subdivide(s, scheme, times=2)
        assert s.n_faces == factor**2 * len(mesh.triangles)
        hem.require_sound(s.to_triangles())
    algorithms.subdivide(s, scheme, times=0)
    assert s.n_faces == factor**2 * len(OPEN.triangles)


def test_loop_makes_an_icosahedron_round() -> None:
    s = structures.build("half_edge", ICOSAHEDRON)
    algorithms.subdivide(s, "loop", times=4)
    radius = np.linalg.norm(s.points, axis=1)
    assert radius.std() < 0.02 * radius.mean()


def limits(mesh: hem.TriangleMesh, scheme: str) -> np.ndarray:
    """(n, 3): where old vertices of a closed mesh end, by the limit masks (Loop, Kobbelt)."""
    shared = neighbors(mesh) > 0
    around = 1 - np.diag(old_to_old(mesh, scheme))[:, None]  # what the mask has of the neighbors
    means = shared @ mesh.points.astype(float) / shared.sum(axis=1)[:, None]
    part = around / (around + {"loop": 3 / 8, "sqrt3": 1 / 3}[scheme])
    return mesh.points + part * (means - mesh.points)


@pytest.mark.parametrize("scheme", algorithms.SCHEMES)
def test_old_vertices_of_any_valence_come_to_the_limit_of_the_scheme(scheme: str) -> None:
    s = structures.build("half_edge", dented("sphere", 42))
    s.split_faces([0, 30], s.points[s.triangles()[[0, 30]]].mean(axis=1) * 1.2)
    mesh = s.to_triangles()
    assert set((neighbors(mesh) > 0).sum(axis=1)) == {3, 5, 6, 7}
    algorithms.subdivide(s, scheme, times=6)
    far, left = (
        np.linalg.norm(limits(mesh, scheme) - points, axis=1)
        for points in (mesh.points, s.points[: len(mesh.points)])
    )
    assert far.max() > 0.05
    assert (left < 0.4**6 * far + 1e-6).all()


def test_split_and_collapse_gives_the_mesh_back() -> None:
    for mesh in (CLOSED, OPEN):
        s = structures.build("half_edge", mesh)
        algorithms.split_and_collapse(s)
        assert s.same_as(structures.build("half_edge", mesh))


@pytest.mark.parametrize("scheme", waiting_for(["sqrt3"], algorithms.SCHEMES))
def test_where_a_mesh_lies_does_not_matter_also_where_fans_meet(scheme: str) -> None:
    points = np.array([(0, 0, 0), (4, 0, 0), (4, 2, 0), (-4, 0, 0), (-4, -2, 1)], float)
    found = []
    for shift in (0, 16):
        mesh = hem.TriangleMesh(points + shift, [(0, 1, 2), (0, 3, 4)])
        s = structures.build("indexed", mesh)
        algorithms.subdivide(s, scheme)
        found.append(s.points - shift)
    assert np.allclose(*found, atol=1e-5)
