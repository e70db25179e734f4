"""Impacts do what their single operations do, and refuse what is no face as a whole."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from hem.algorithms import impacts
from tests.extent import QUICK_TO_COMPILE
from tests.hem.algorithms.meshes import MESHES, used


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
@pytest.mark.parametrize("mesh", ["torus", "grid"])
def test_impacts_are_their_single_operations(name: str, mesh: str) -> None:
    one, many = (used(name, MESHES[mesh]()) for _ in "12")
    faces = np.random.default_rng(5).choice(one.faces(), 40)  # some of them twice
    found = 0
    for face in faces.tolist():
        corners = one.face_vertices(face)
        new = one.split_face(face, one.points[corners].astype(float).mean(axis=0)).vertex
        found += sum(len(one.vertex_faces(v)) for v in corners.tolist())
        edge = one.find_edge(new, int(corners.min()))
        assert edge is not None
        one.split_edge(edge, one.points[[new, corners.min()]].astype(float).mean(axis=0))
        found += len(one.face_faces(face))
    assert impacts(many, faces) == found
    many.validate()
    assert np.array_equal(one.triangles(), many.triangles())
    assert np.allclose(one.points, many.points, atol=1e-6, equal_nan=True)


def test_coordinates_may_be_as_large_as_numbers_are() -> None:
    mesh = MESHES["torus"]()
    points = mesh.points * np.float32(3.2e38 / np.abs(mesh.points).max())
    s = structures.build("half_edge", hem.TriangleMesh(points, mesh.triangles))
    faces = s.faces()
    impacts(s, faces)
    assert s.n_vertices == len(points) + 2 * len(faces)


def test_what_is_no_face_is_refused_before_anything_changes() -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    before = s.copy()
    with pytest.raises(hem.MeshError):
        impacts(s, [0, 1, s.face_end])
    assert s.same_as(before)
    assert impacts(s, []) == 0
