"""Questions about whole meshes, against what the faces alone say."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from hem.contract import QUERIES
from hem.errors import MeshError
from hem.meshes import undirected_edges
from tests.extent import OF_EACH_KIND
from tests.structures.conftest import HOLDS_ANYTHING
from tests.structures.test_polygons import CUBE, plankton, sheet


@pytest.fixture(params=["torus", "grid", "two parts", "edited", "empty"])
def whole(request: pytest.FixtureRequest, name: str) -> structures.Structure:
    if request.param == "two parts":
        one, other = hem.generate("torus", 49), hem.generate("grid", 16)
        points = np.concatenate([one.points, other.points + 9])
        triangles = np.concatenate([one.triangles, other.triangles + len(one.points)])
        return structures.build(name, hem.TriangleMesh(points, triangles))
    if request.param == "empty":
        return structures.build(name, hem.TriangleMesh(np.zeros((2, 3)), []))
    s = structures.build(
        name, hem.generate("grid" if request.param == "edited" else request.param, 49)
    )
    if request.param == "edited":
        s.collapse_edge(next(e for e in s.edges().tolist() if s.can_collapse_edge(e)))
        s.remove_face(int(s.faces()[30]))
        s.split_face(int(s.faces()[3]), (0, 0, 0))
    return s


def rows_of(s: structures.Structure) -> dict[int, list[int]]:
    return {f: s.face_vertices(f).tolist() for f in s.faces().tolist()}


def test_all_elements_are_asked_without_an_argument(whole: structures.Structure) -> None:
    s = whole
    assert s.face_vertices().to_list() == list(rows_of(s).values())
    assert s.vertex_faces().to_list() == s.vertex_faces(s.vertices()).to_list()
    assert sorted(map(sorted, s.triangles().tolist())) == sorted(map(sorted, rows_of(s).values()))
    expected, _ = undirected_edges(s.triangles())
    assert sorted(s.edge_array().tolist()) == sorted(expected.tolist())


def test_positions_are_indexed_as_arrays_are(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 9))
    for at in (3, -1, [2, 2, 0], [[0, 1], [2, 3]], np.arange(9) % 2 == 0):
        assert np.array_equal(s.positions(at), s.points[np.asarray(at)])
    for beyond in (9, [True]):
        with pytest.raises(IndexError):
            s.positions(beyond)


def test_a_face_is_found_by_its_corners(whole: structures.Structure) -> None:
    s, rows = whole, rows_of(whole)
    for face, (a, b, c) in rows.items():
        assert s.find_face(b, c, a) == s.find_face(c, b, a) == face
    if rows:
        v = next(iter(rows.values()))[0]
        assert s.find_face(v, v, v) is None


def test_valence_and_border_are_those_of_the_edges(whole: structures.Structure) -> None:
    s = whole
    edges, faces = undirected_edges(s.triangles())
    valence = np.bincount(edges.ravel(), minlength=len(s.points))
    border = np.zeros(len(s.points), np.bool_)
    border[edges[faces == 1]] = True
    vertices = s.vertices()
    assert s.valence().tolist() == valence[vertices].tolist()
    assert s.is_border().tolist() == border[vertices].tolist()
    for v in vertices[:9].tolist():
        assert s.valence(v) == valence[v]
        assert s.is_border(v) is bool(border[v])
    assert s.is_closed() is not bool((faces == 1).any())


def test_border_loops_go_along_every_border_edge_once(whole: structures.Structure) -> None:
    s = whole
    edges, faces = undirected_edges(s.triangles())
    along = [
        tuple(sorted(pair))
        for loop in s.border_loops()
        for pair in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)
    ]
    assert sorted(along) == sorted(map(tuple, edges[faces == 1].tolist()))
    sides = {(row[i - 1], row[i]) for row in rows_of(s).values() for i in range(3)}
    for loop in s.border_loops():
        assert loop[0] == loop.min()
        assert (int(loop[0]), int(loop[1])) in sides  # the surface lies on the left


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
def test_where_fans_meet_each_has_a_border_of_its_own(name: str) -> None:
    mesh = hem.TriangleMesh(np.zeros((7, 3)), [(0, 1, 2), (0, 3, 4), (5, 6, 3)])
    loops = structures.build(name, mesh).border_loops()
    assert sorted(map(sorted, loops)) == [[0, 1, 2], [0, 3, 4], [3, 5, 6]]


BOOK = [(0, 1, 2), (1, 0, 3), (0, 1, 4)]
ENDING = {"a book": (BOOK, [0, 1]), "two ways": ([*BOOK[:2], (0, 2, 1), (1, 2, 4)], [0, 1, 2])}


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
@pytest.mark.parametrize("case", ENDING)
def test_a_border_that_ends_is_no_loop(name: str, case: str) -> None:
    faces, ends = ENDING[case]
    s = structures.build(name, hem.TriangleMesh(np.random.default_rng(0).random((5, 3)), faces))
    with pytest.raises(MeshError, match="does not come round") as refused:
        s.border_loops()
    assert refused.value.elements["vertices"].tolist() == ends


def test_components_are_found_face_by_face(whole: structures.Structure) -> None:
    s = whole
    part: dict[int, set[int]] = {}  # by vertex, the vertices joined to it
    for row in rows_of(s).values():
        joined = set().union(*(part.get(v, {v}) for v in row))
        part.update(dict.fromkeys(joined, joined))
    expected: dict[frozenset[int], list[int]] = {}
    for face, row in rows_of(s).items():
        expected.setdefault(frozenset(part[row[0]]), []).append(face)
    assert [it.tolist() for it in s.components()] == list(expected.values())


def test_polygons_have_borders_and_parts_but_no_triangles() -> None:
    s = plankton(sheet(3))
    (loop,) = s.border_loops()
    assert sorted(loop.tolist()) == sorted(set(range(16)) - {5, 6, 9, 10})
    assert len(s.components()) == 1
    assert plankton(CUBE).is_closed()
    with pytest.raises(MeshError, match="more corners"):
        s.triangles()


def test_a_structure_is_shown_and_compared(whole: structures.Structure) -> None:
    s = whole
    assert s.title in repr(s)
    assert f"{s.n_faces:,} faces" in repr(s)
    other = s.copy()
    assert s.same_as(other)
    other.add_vertex((1, 2, 3))
    assert not s.same_as(other)
    rebuilt, others = (structures.build(it, s.to_triangles()) for it in (s.name, "indexed"))
    assert rebuilt.same_as(others)


def test_rows_of_different_lengths() -> None:
    rows = hem.Ragged.from_lists([[1, 2], [], [3], [4, 5, 6]])
    assert rows.to_list() == [[1, 2], [], [3], [4, 5, 6]]
    assert rows[1:3].to_list() == [[], [3]]
    assert rows[::-2].to_list() == [[4, 5, 6], []]
    assert rows[[3, 0]].to_list() == rows[np.array([3, 0])].to_list() == [[4, 5, 6], [1, 2]]
    place = np.array(-1)
    assert [rows[i].tolist() for i in (place, np.int64(0))] == [[4, 5, 6], [1, 2]]
    assert rows[place].tolist() == [4, 5, 6], "its place is the caller's"
    for outside in (4, -5):
        with pytest.raises(IndexError, match="of 4 rows"):
            rows[outside]
    assert repr(rows) == "Ragged(4 rows: [1, 2], [], [3], …)"
    assert repr(rows[:3]) == "Ragged(3 rows: [1, 2], [], [3])"
    assert rows.values[rows.following].tolist() == [2, 1, 3, 5, 6, 4]
    nothing = hem.Ragged.from_lists([])
    assert nothing.to_list() == nothing.values.tolist() == []


def test_nothing_is_asked_of_a_mesh_without_faces(name: str) -> None:
    for points in ([], [[0, 0, 0]]):
        mesh = hem.TriangleMesh(points, [])
        s = structures.build(name, mesh)
        swept = structures.build(name, mesh, compiled=name in OF_EACH_KIND)
        assert (s.border_loops(), s.components(), s.is_closed()) == ([], [], True)
        assert (len(s.triangles()), len(s.edge_array()), len(s.split_all_faces())) == (0, 0, 0)
        assert s.valence([]).tolist() == []
        assert s.is_border().tolist() == [False] * len(points)
        for query in QUERIES:
            assert getattr(s, query)([]).to_list() == []
            assert (swept.sweep(query, []), s.work(query, []).tolist()) == (0, [])
            with pytest.raises(MeshError, match="no such"):
                getattr(s, query)(len(points))
        s.reserve(3)
        s.split_all_faces()
        s.compact()
        s.validate()
