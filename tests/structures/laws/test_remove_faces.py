"""Many faces taken away at once."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from tests.structures.histories.actions import faces_of


def patch(s: structures.Structure, rng: np.random.Generator) -> np.ndarray:
    """Some faces, of which many lie side by side."""
    faces = [int(rng.choice(s.faces()))]
    for _ in range(int(rng.integers(40))):
        near = s.face_faces(int(rng.choice(faces)))
        beside = len(near) and rng.random() < 0.9
        faces.append(int(rng.choice(near if beside else s.faces())))
    return rng.permutation(np.unique(faces))


def test_faces_go_at_once_if_and_only_if_a_surface_is_left(s):
    rng, outcomes = np.random.default_rng(5), []
    for _ in range(60):
        one, gone = s.copy(), patch(s, rng)
        rest = {f: t for f, t in faces_of(s).items() if f not in gone}
        left = hem.TriangleMesh(s.points, list(rest.values()) or np.zeros((0, 3), int))
        try:
            hem.require_sound(left)
            sound = True
        except hem.MeshError:
            sound = False
        outcomes.append(sound)
        if sound:
            one.remove_faces(gone)
            assert faces_of(one) == rest
            ends = {frozenset(p) for t in rest.values() for p in zip(t, t[1:] + t[:1], strict=True)}
            assert one.n_edges == len(ends)
            assert one.n_faces == len(rest)
        else:
            with pytest.raises(hem.TopologyError, match="two fans"):
                one.remove_faces(gone)
            assert faces_of(one) == faces_of(s)
            assert one.n_edges == s.n_edges
        one.validate()
    assert {True, False} == set(outcomes)


def test_a_ring_goes_that_could_not_go_face_by_face(name):
    s = structures.build(name, hem.generate("grid", 400))
    ring = set(s.vertex_faces(s.vertex_vertices(200)).values.tolist())
    ring -= set(s.vertex_faces(200).tolist())
    one_by_one, left = s.copy(), sorted(ring)
    while left:
        refused = []
        for face in left:
            try:
                one_by_one.remove_face(face)
            except hem.TopologyError:
                refused.append(face)
        if len(refused) == len(left):
            break
        left = refused
    assert left
    s.remove_faces(sorted(ring))
    s.validate()
    assert s.to_triangles().summary().components == 2


def test_all_faces_can_go(s):
    heard = []
    s.subscribe(heard.append)
    gone = s.faces()
    s.remove_faces(gone)
    s.validate()
    assert (s.n_faces, s.n_edges) == (0, 0)
    assert [edit.removed_faces.tolist() for edit in heard] == [gone.tolist()]


def test_what_comes_after_finds_a_sound_mesh(s):
    rng = np.random.default_rng(8)
    for _ in range(12):
        try:
            s.remove_faces(patch(s, rng))
        except hem.TopologyError:
            continue
        if not s.n_faces:
            break
        for _ in range(6):
            edge = int(rng.choice(s.edges()))
            if s.can_collapse_edge(edge):
                s.collapse_edge(edge)
            s.validate()
        for v in s.vertices()[::9].tolist():
            assert sorted(s.vertex_faces(v).tolist()) == [
                f for f, t in faces_of(s).items() if v in t
            ]
        hem.require_sound(s.to_triangles())


def test_polygons_go_at_once():
    at = np.arange(25).reshape(5, 5)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2).reshape(-1, 4)
    y, x = np.divmod(np.arange(25), 5)
    s = structures.build("plankton", hem.PolygonMesh(np.stack([x, y, 0 * x], 1), quads.tolist()))
    with pytest.raises(hem.TopologyError):
        s.remove_faces([5, 10])  # they meet in one vertex alone
    s.remove_faces([5, 6, 9, 10])
    s.validate()
    assert (s.n_faces, s.n_edges) == (12, 36)


@pytest.mark.parametrize(
    ("faces", "error", "message"),
    [
        ([0, 0], hem.TopologyError, "different faces"),
        ([0, 10**9], hem.TopologyError, "any more"),
        ([-1], hem.TopologyError, "any more"),
        ([0.5], hem.MeshError, "handles"),
        ([[0, 1]], hem.MeshError, "handles"),
    ],
)
def test_handles_that_name_nothing_are_refused(s, faces, error, message):
    before = faces_of(s)
    with pytest.raises(error, match=message):
        s.remove_faces(faces)
    assert faces_of(s) == before


def test_no_faces_are_no_change(s):
    before = faces_of(s)
    s.remove_faces([])
    assert faces_of(s) == before
