"""The teapot, against Bernstein's formula evaluated directly and what is known of the model."""

import json
from importlib.resources import files
from math import comb

import numpy as np
import pytest

import hem
from hem.sources.teapot import teapot

DATA = json.loads(files("hem.sources").joinpath("teapot.json").read_text())


def test_the_data_are_thirty_two_patches_of_sixteen_control_points() -> None:
    patches = np.array(DATA["patches"])
    assert patches.shape == (32, 16)
    assert np.array(DATA["points"]).shape == (290, 3)
    assert len(DATA["parts"]) == 32
    assert "Newell" in DATA["source"]
    assert set(patches.ravel()) == set(range(290))


@pytest.mark.parametrize("n", [1, 2, 5])
def test_unwelded_vertices_lie_on_the_bezier_patches(n: int) -> None:
    mesh = teapot(n, welded=False)
    assert (len(mesh.points), len(mesh.triangles)) == (32 * (n + 1) ** 2, 64 * n * n)
    t = np.arange(n + 1) / n
    bernstein = [[comb(3, i) * x**i * (1 - x) ** (3 - i) for x in t] for i in range(4)]
    control = np.array(DATA["points"])[DATA["patches"]].reshape(32, 4, 4, 3)
    truth = np.einsum("iu,jv,pijk->puvk", bernstein, bernstein, control).reshape(32, -1, 3)
    found = mesh.points.reshape(32, -1, 3)
    as_sets = [np.sort(np.round(x.astype(float), 4), axis=1) for x in (truth, found)]
    assert np.allclose(as_sets[0], as_sets[1], atol=2e-4)


@pytest.mark.parametrize("n", [2, 3, 7, 10, 33])
def test_the_welded_teapot_is_four_surfaces_with_nothing_doubled(n: int) -> None:
    mesh = teapot(n)
    hem.require_manifold(mesh)
    summary = mesh.summary()
    assert (summary.components, summary.unreferenced) == (4, 0)
    assert summary.faces == 64 * n * n - 8 * n
    assert summary.border_edges == 16 * n
    handle_touches_body = 1
    assert len(mesh.points) - len(mesh.welded().points) == handle_touches_body


@pytest.mark.parametrize("welded", [True, False])
def test_the_teapot_is_wound_outward(welded: bool) -> None:
    mesh = teapot(12, welded)
    a, b, c = mesh.points[mesh.triangles].astype(float).swapaxes(0, 1)
    normals, middles = np.cross(b - a, c - a), (a + b + c) / 3
    radius = np.hypot(middles[:, 0], middles[:, 1])
    belly = (radius < 2.01) & (radius > 1.6) & (middles[:, 2] > 0.3) & (middles[:, 2] < 1.2)
    outward = (normals[:, :2] * middles[:, :2]).sum(axis=1)
    assert belly.sum() > 100
    assert (outward[belly] > 0).mean() > 0.95, "all but ends of handle and spout inside it"
    area = np.linalg.norm(normals, axis=1) > 1e-7
    knob = area & (middles[:, 2] > 3.1)
    bottom = area & (middles[:, 2] < 0.01) & (radius < 1.0)
    assert (normals[knob, 2] > 0).all()
    assert (normals[bottom, 2] < 0).all()


def test_the_teapot_has_its_known_size() -> None:
    points = teapot(40).points
    assert np.allclose(points.min(axis=0), [-3, -2, 0], atol=0.02)
    assert np.allclose(points.max(axis=0), [3.434, 2, 3.15], atol=0.02)


@pytest.mark.parametrize(("n", "welded"), [(0, False), (-3, False), (1, True)])
def test_too_coarse_a_tessellation_is_refused(n: int, welded: bool) -> None:
    with pytest.raises(hem.MeshError, match=r"tessellation of [12] or more"):
        hem.sample("teapot", tessellation=n, welded=welded)
