"""Measures against other ways to the same number, and parts against a search by hand."""

import numpy as np
import pytest

import hem
from hem.meshes import components, used_only
from hem.meshes.measures import (
    areas,
    bounds,
    corners,
    diagonal,
    direction,
    dot,
    length,
    normals,
    position,
    unit,
    volume,
)
from hem.naming import look_up


def test_a_cube_has_the_measures_of_a_cube() -> None:
    from itertools import product

    points = np.array(list(product((1.0, 3.0), repeat=3)))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    at = corners(points, hem.PolygonMesh(points, quads).triangulated().triangles)
    assert areas(at).sum() == pytest.approx(24)
    assert volume(at) == pytest.approx(8)
    assert volume(at[:, ::-1]) == pytest.approx(-8)
    outward = dot(normals(at), at.mean(axis=1) - 2)
    assert (outward > 0).all()
    dead = np.vstack([points, np.full(3, np.nan)]).astype(np.float32)
    assert [side.tolist() for side in bounds(dead)] == [[1, 1, 1], [3, 3, 3]]
    assert diagonal(dead) == pytest.approx(np.sqrt(12))


def test_vectors_are_measured_as_numpy_does() -> None:
    a, b = np.random.default_rng(0).normal(size=(2, 50, 3))
    assert dot(a, b) == pytest.approx(np.einsum("ij,ij->i", a, b))
    assert length(a) == pytest.approx(np.linalg.norm(a, axis=1))
    assert length(unit(a)) == pytest.approx(np.ones(50))
    assert direction((3e-300, 0, 4e-300)) == pytest.approx([0.6, 0, 0.8])
    with pytest.raises(hem.MeshError, match="this one has none"):
        direction((0, -0.0, 0))


@pytest.mark.parametrize("given", [(1, 2), (1, 2, np.inf), "here", None])
def test_what_is_no_position_is_refused(given: object) -> None:
    with pytest.raises(hem.MeshError, match="an impact is three finite numbers"):
        position(given, "an impact")


def test_components_are_what_a_search_reaches() -> None:
    random = np.random.default_rng(1)
    pairs = random.integers(0, 60, (40, 2))
    count, label = components(60, pairs)
    reached = np.arange(60)
    for _ in range(60):
        for a, b in pairs:
            reached[[a, b]] = min(reached[a], reached[b])
    assert count == len(set(reached.tolist()))
    assert len(set(zip(label.tolist(), reached.tolist(), strict=True))) == count


def test_only_the_points_that_are_used_stay_in_order() -> None:
    points, triangles = used_only(np.arange(15.0).reshape(5, 3), np.array([[4, 1, 2]]))
    assert points[:, 0].tolist() == [3, 6, 12]
    assert triangles.tolist() == [[2, 0, 1]]


def test_a_wrong_name_is_told_the_nearest_one() -> None:
    with pytest.raises(hem.MeshError, match=r"no thing 'tors' \(there are torus, cone\).*'torus'"):
        look_up("tors", {"torus": 1, "cone": 2}, "thing")
