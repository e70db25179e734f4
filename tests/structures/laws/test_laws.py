"""Laws that operations obey together."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

import hem
import structures
from hem.authoring import VALENCE
from tests.structures.histories.actions import Aimed, faces_of, surface_of
from tests.structures.histories.surface import Surface
from tests.structures.histories.truth import predict
from tests.structures.laws.test_operations import STARTS


def triangles(s: structures.Structure) -> list[tuple[int, ...]]:
    return sorted(faces_of(s).values())


def test_a_collapse_undoes_a_split_of_any_edge(s):
    before = triangles(s)
    for a, b in s.edge_array()[::5].tolist():
        for keep in (a, b):
            new = s.split_edge(s.find_edge(a, b), (0, 0, 0)).vertex
            s.collapse_edge(s.find_edge(new, keep), keep=keep)
            assert triangles(s) == before
    s.validate()


def test_a_collapse_undoes_a_split_of_any_face(s):
    before = triangles(s)
    for face in s.faces()[::7].tolist():
        for keep in s.face_vertices(face).tolist():
            around = sorted(s.face_vertices(face).tolist())
            new = s.split_face(face, (0, 0, 0)).vertex
            s.collapse_edge(s.find_edge(new, keep), keep=keep)
            assert triangles(s) == before
            face = next(f for f, t in faces_of(s).items() if sorted(t) == around)
    s.validate()


def test_a_second_flip_undoes_the_first_face_by_face(s):
    flipped = 0
    for edge in s.edges().tolist():
        a, b = s.edge_vertices(edge).tolist()
        edge = s.find_edge(a, b)
        if not s.can_flip_edge(edge):
            continue
        before = faces_of(s)
        faces = s.edge_faces(edge)
        c, d = sorted({*s.face_vertices(faces).values.tolist()} - {a, b})
        s.flip_edge(edge)
        assert s.find_edge(a, b) is None
        s.flip_edge(s.find_edge(c, d))
        assert faces_of(s) == before
        flipped += 1
    assert flipped > 50
    s.validate()


def test_a_face_that_was_removed_can_be_added_again(s):
    before, counts = triangles(s), (s.n_vertices, s.n_edges, s.n_faces)
    for face in s.faces()[::6].tolist():
        corners = s.face_vertices(face).tolist()
        try:
            s.remove_face(face)
        except hem.TopologyError:
            continue
        assert s.n_faces == counts[2] - 1
        s.add_face(*corners)
        assert triangles(s) == before
        assert (s.n_vertices, s.n_edges, s.n_faces) == counts
    s.validate()


def test_splitting_all_faces_one_by_one_or_at_once_is_the_same(s):
    other = s.copy()
    corners = s.face_vertices(s.faces()).values.reshape(-1, 3)
    for face, center in zip(s.faces().tolist(), s.points[corners].mean(axis=1), strict=True):
        other.split_face(face, center)
    before = s.n_faces
    s.split_all_faces()
    assert s.n_faces == 3 * before
    assert faces_of(s) == faces_of(other)
    assert np.allclose(s.points, other.points, atol=1e-6)


def test_a_moved_vertex_is_moved_and_nothing_else(s):
    before, points = triangles(s), s.points.copy()
    edit = s.move_vertex(7, (1, 2, 3))
    assert edit.changed_vertices.tolist() == [7]
    assert s.points[7].tolist() == [1, 2, 3]
    points[7] = (1, 2, 3)
    assert np.array_equal(s.points, points)
    assert triangles(s) == before


@pytest.mark.parametrize("start", STARTS)
def test_what_may_be_done_is_at_every_place_what_the_faces_alone_say(name, start):
    """As built, and where there are splits and holes."""
    s = structures.build(name, STARTS[start]())
    for edited in (False, True):
        if edited:
            some = s.faces()[::3]
            s.split_faces(some, np.zeros((len(some), 3)))
            for face in s.faces()[::4].tolist():
                with suppress(hem.TopologyError):
                    s.remove_face(face)
        m = surface_of(s)
        for a, b in s.edge_array().tolist():
            edge = s.find_edge(a, b)
            assert s.can_flip_edge(edge) == may_be_done(m, "flip_edge", a, b), (a, b)
            assert s.can_collapse_edge(edge) == may_be_done(m, "collapse_edge", a, b), (a, b)
        faces = s.faces()
        told = s.prepare("remove_face", faces).check().tolist()
        assert told == [may_be_done(m, "remove_face", face) for face in faces.tolist()]


def may_be_done(m: Surface, operation: str, *elements: int) -> bool:
    """Tried on the faces alone, and taken back."""
    before = m.state()
    told = predict(m, Aimed(operation, elements, elements[-1]))
    m.restore(before)
    return told is not None


def test_a_collapse_raises_the_bound_on_the_valence(name):
    s = structures.build(name, hem.generate("torus", 100))
    s.collapse_edge(int(s.edges()[0]))
    assert 6 < s.valence().max() <= s.records.counts[VALENCE]
