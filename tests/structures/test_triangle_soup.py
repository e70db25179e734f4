"""What is its own in a triangle soup: triangles meet where their points do, and names only name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from hem.contract import Structure
from tests.extent import waiting_for
from tests.structures.conftest import shuffled


def built(n: int = 100, family: str = "torus") -> Structure:
    return structures.build("triangle_soup", shuffled(hem.generate(family, n)))


def soup_of(s: Structure) -> Any:
    """(n_faces, 3, 3): the points of the live triangles, from the records alone."""
    return s.records.triangle_point[s.faces()].reshape(-1, 3, 3)


@pytest.mark.parametrize("axis", range(3))
def test_triangles_meet_where_their_points_do(axis: int):
    s = built()
    v = 7
    f, *others = s.vertex_faces(v).tolist()
    s.records.triangle_point[f, axis::3] += 1  # torn off, and called as before
    assert s.vertex_faces(v).tolist() == others
    assert f not in s.face_faces(others[0]).tolist()
    with pytest.raises(hem.MeshError, match="points are where their vertices lie") as broken:
        s.validate()
    assert broken.value.elements["faces"].tolist() == [f]


def test_two_vertices_at_one_position_are_kept_apart():
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0), (2, 0, 0), (0, 2, 0)])
    s = structures.build("triangle_soup", hem.TriangleMesh(points, [(0, 1, 2), (3, 4, 5)]))
    assert [s.vertex_faces(v).tolist() for v in (0, 3)] == [[0], [1]]
    s.move_vertex(3, (9, 9, 9))
    assert soup_of(s)[:, 0].tolist() == [[0, 0, 0], [9, 9, 9]]


def test_a_vertex_moves_in_every_triangle_around_it():
    s = built()
    around = s.vertex_faces(7)
    s.move_vertex(7, (5, 6, 7))
    moved = (soup_of(s) == (5, 6, 7)).all(axis=2)
    assert np.flatnonzero(moved.any(axis=1)).tolist() == sorted(around.tolist())
    assert s.vertex_faces(7).tolist() == around.tolist()
    s.validate()


@pytest.mark.parametrize("family", ["torus", "grid"])
def test_after_any_operations_the_soup_is_that_of_an_indexed_mesh(family: str):
    rng, mesh = np.random.default_rng(3), shuffled(hem.generate(family, 64))
    kinds = 6 if family == "torus" else 5  # not every face of a border can be taken away
    both = [structures.build(name, mesh) for name in ("triangle_soup", "indexed")]
    for _ in range(60):
        at, kind = int(rng.integers(both[0].n_edges)), int(rng.integers(kinds))
        point = rng.random(3)
        for s in both:
            edge, face = int(s.edges()[at]), int(s.faces()[at % s.n_faces])
            if kind == 0:
                s.split_edge(edge, point)
            elif kind == 1:
                s.split_face(face, point)
            elif kind == 2 and s.can_collapse_edge(edge):
                s.collapse_edge(edge)
            elif kind == 3 and s.can_flip_edge(edge):
                s.flip_edge(edge)
            elif kind == 4:
                s.move_vertex(s.face_vertices(face)[0], point)
            elif kind == 5:
                corners = s.face_vertices(face).tolist()
                s.remove_face(face)
                s.add_face(*corners)
    soup, indexed = both
    soup.validate()
    assert soup.same_as(indexed)
    assert np.array_equal(soup_of(soup), indexed.points[indexed.triangles()])
    soup.compact()
    soup.validate()
    assert np.array_equal(soup_of(soup), soup.points[soup.triangles()])


MOVING = algorithms.smooth, algorithms.center


@pytest.mark.parametrize("algorithm", waiting_for(MOVING, [*MOVING, algorithms.impacts]))
def test_what_an_algorithm_writes_is_in_the_soup(algorithm: Any):
    s = built()
    given = [s.faces()[:20]] if algorithm is algorithms.impacts else []
    algorithm(s, *given)
    s.validate()
    assert np.array_equal(soup_of(s), s.points[s.triangles()])


def test_points_that_a_dead_triangle_kept_are_found():
    s = built()
    s.remove_face(3)
    s.validate()
    s.records.triangle_point[3] = 1
    with pytest.raises(hem.MeshError, match="a dead triangle has no points") as broken:
        s.validate()
    assert broken.value.elements["faces"].tolist() == [3]


def test_names_are_told_apart_from_what_a_soup_takes():
    s = built(400)
    assert s.memory() == {"triangle.point": 400 * 72}
    assert s.memory(names=True) == {"triangle.point": 400 * 72, "names": 400 * 36}
    assert s.memory(room=True)["names"] == 400 * 36
