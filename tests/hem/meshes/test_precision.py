"""Positions as float32, unless float64 is asked for: what is kept, and what is told of."""

import copy
import pickle
import re
import warnings
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import hem
import structures

FAR = np.array([[500000.01, 0, 0], [500000.013, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = [(0, 1, 2), (1, 3, 2)]
TRIANGLES = hem.TriangleMesh(FAR, FACES, np.float64)
POLYGONS = hem.PolygonMesh(FAR, [(0, 1, 3, 2)], np.float64)


def test_positions_that_become_equal_are_told_of_by_their_rows() -> None:
    random = np.random.default_rng(0)
    points = 1e6 + random.random((100, 3)) * 0.2
    rounded = points.astype(np.float32)
    first = {tuple(p): i for i, p in reversed([*enumerate(rounded.tolist())])}
    pairs = [(first[tuple(p)], i) for i, p in enumerate(rounded.tolist())]
    expected = [f"{i}-{j}" for i, j in pairs if i != j]
    assert len(expected) > 10
    with pytest.warns(hem.MeshWarning, match="equal as float32") as told:
        hem.TriangleMesh(points, [])
    assert told[0].filename == __file__
    listed = re.search(r"rows: (.*) and (\d+) more", str(told[0].message))
    assert listed
    assert listed[1].split(", ") == expected[:6]
    assert int(listed[2]) == len(expected) - 6


@pytest.mark.parametrize(
    "points",
    [
        FAR.astype(np.float32),  # nothing is rounded
        FAR - FAR[0],  # near the origin float32 is fine enough
        np.repeat(FAR[:1], 4, axis=0),  # they were equal before
        np.full((4, 3), -0.1),  # as they were here
        FAR[[0, 2, 3, 3]] * (1 + np.arange(4)[:, None] * 2e-16),  # what computing them left
        (FAR * 100).astype(np.int64)[[0, 2, 3, 3]],
    ],
)
def test_what_loses_nothing_is_not_told_of(points: np.ndarray) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hem.TriangleMesh(points, [])


@pytest.mark.parametrize("mesh", [TRIANGLES, POLYGONS])
def test_float64_is_kept_by_whatever_is_made_of_the_mesh(
    mesh: hem.TriangleMesh | hem.PolygonMesh, tmp_path: Path
) -> None:
    made = [copy.deepcopy(mesh), pickle.loads(pickle.dumps(mesh)), hem.as_mesh(mesh)]
    if isinstance(mesh, hem.PolygonMesh):
        made.append(mesh.triangulated())
    else:
        made += [mesh.flipped(), mesh.welded(), mesh.welded(1e-3)]
    for extension in ("ply", "obj", "off"):
        file = tmp_path / f"mesh.{extension}"
        hem.save(mesh, file)
        made += [hem.load(file, triangulate=True, dtype=np.float64)]
        made += [hem.load_polygons(file, dtype=np.float64)]
        with pytest.warns(hem.MeshWarning, match="rows: 0-1"):
            assert hem.load_polygons(file).points.dtype == np.float32
    for other in made:
        assert other.points.dtype == np.float64
        assert np.array_equal(other.points, FAR)
    assert mesh.astype(np.float64) is mesh


@pytest.mark.parametrize("mesh", [TRIANGLES, POLYGONS])
def test_a_mesh_that_was_given_a_name_is_copied(mesh: hem.TriangleMesh | hem.PolygonMesh) -> None:
    named = copy.copy(mesh)
    named.name = "far"  # type: ignore[union-attr]
    assert np.array_equal(copy.deepcopy(named).points, FAR)
    with pytest.warns(hem.MeshWarning):
        assert named.astype(np.float32).points.dtype == np.float32
    with pytest.raises(AttributeError, match="points of a mesh do not change"):
        named.points = FAR


def test_a_weld_is_of_positions_as_they_are_kept() -> None:
    points = np.vstack([FAR, FAR[1:2] * -0.0, FAR[1:2]])
    assert len(hem.TriangleMesh(points, [], np.float64).welded().points) == 5
    with pytest.warns(hem.MeshWarning):
        assert len(hem.TriangleMesh(points, []).welded().points) == 4


@pytest.mark.parametrize("name", structures.NAMES)
def test_a_structure_holds_float32_and_says_what_that_takes(name: str) -> None:
    with pytest.warns(hem.MeshWarning, match=r"equal as float32 \(rows: 0-1\)"):
        s = structures.build(name, TRIANGLES)
    assert s.points.dtype == np.float32
    assert np.array_equal(s.points, FAR.astype(np.float32))


@pytest.mark.parametrize("dtype", [np.int32, np.float16, "complex64"])
def test_positions_are_of_no_other_type(dtype: type) -> None:
    with pytest.raises(hem.MeshError, match="float32 or float64"):
        hem.TriangleMesh(FAR, FACES, dtype)


def test_measures_of_both_types_agree() -> None:
    near = hem.TriangleMesh(np.vstack([np.eye(3), [[0.1, 0.2, 0.3]]]), [*combinations(range(4), 3)])
    fine = hem.TriangleMesh(np.vstack([np.eye(3), [[0.1, 0.2, 0.3]]]), near.triangles, np.float64)
    assert near.area() == pytest.approx(fine.area())
    assert near.summary() == fine.summary()
