"""The nine queries, against sets worked out from the triangle list alone."""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
import pytest

import hem
import structures
from hem.contract import QUERIES
from tests.extent import OF_EACH_KIND
from tests.structures.conftest import HOLDS_ANYTHING, NEEDS_MANIFOLD

ORDERED = NEEDS_MANIFOLD
"""Where nothing holds faces together, none knows their order."""


class Relations:
    """Every adjacency of a mesh as sets; an edge is the set of its two vertices."""

    def __init__(self, mesh: hem.TriangleMesh) -> None:
        faces = [tuple(face) for face in mesh.triangles.tolist()]
        edges = {frozenset(pair) for face in faces for pair in combinations(face, 2)}
        self.members = {
            "vertex": {v: frozenset([v]) for v in range(len(mesh.points))},
            "edge": {e: e for e in edges},
            "face": {f: frozenset(face) for f, face in enumerate(faces)},
        }

        self._known: dict[tuple[str, str, object], set[object]] = {}

    def __call__(self, source: str, target: str, key: object) -> set[object]:
        asked = source, target, key
        if asked not in self._known:
            self._known[asked] = self._search(*asked)
        return self._known[asked]

    def _search(self, source: str, target: str, key: object) -> set[object]:
        mine = self.members[source][key]
        return {
            other
            for other, theirs in self.members[target].items()
            if (source != target or other != key) and self._adjacent(source, target, mine, theirs)
        }

    def _adjacent(self, source: str, target: str, mine: frozenset, theirs: frozenset) -> bool:
        if source == target == "vertex":
            return mine | theirs in self.members["edge"]
        if source == target == "face":
            return len(mine & theirs) >= 2
        return mine <= theirs or theirs <= mine or (source == target and bool(mine & theirs))


relations_of = cache(Relations)
"""Those of a mesh are the same for all structures."""


def vertices_of(s: structures.Structure, edge: int) -> frozenset[int]:
    return frozenset(s.edge_vertices(edge).tolist())


def test_a_query_gives_what_the_triangle_list_says_each_neighbor_once(name, mesh):
    s, relations = structures.build(name, mesh), relations_of(mesh)
    for query in QUERIES.values():
        for handle in s.handles(query.source).tolist():
            answer = getattr(s, query.name)(handle).tolist()
            keys = [vertices_of(s, e) for e in answer] if query.target == "edge" else answer
            key = vertices_of(s, handle) if query.source == "edge" else handle
            assert len(keys) == len(set(keys)), query.name
            assert set(keys) == relations(query.source, query.target, key), query.name


def test_many_handles_give_the_answers_of_one_by_one(name, mesh):
    s = structures.build(name, mesh)
    for query in QUERIES.values():
        handles = s.handles(query.source)
        handles = np.concatenate([handles[::-1], handles])
        answers = getattr(s, query.name)(handles)
        assert len(answers) == len(handles), query.name
        for handle, answer in zip(handles.tolist(), answers, strict=True):
            assert answer.tolist() == getattr(s, query.name)(handle).tolist(), query.name


def test_large_references_change_no_answer(mesh):
    for name in OF_EACH_KIND:
        small, large = (structures.build(name, mesh, reference_bytes=k) for k in (4, 8))
        for query in QUERIES.values():
            handles = small.handles(query.source)
            a, b = (getattr(s, query.name)(handles) for s in (small, large))
            assert a.offsets.tolist() == b.offsets.tolist(), query.name
            assert a.values.tolist() == b.values.tolist(), query.name
            expected = np.int64 if query.target == "edge" else np.int32
            assert a.values.dtype == b.values.dtype == expected, query.name


@pytest.mark.parametrize("name", ORDERED)
def test_neighbors_come_counterclockwise(name, mesh):
    s = structures.build(name, mesh)
    for v in s.vertices().tolist():
        ring, around = s.vertex_vertices(v).tolist(), s.vertex_faces(v).tolist()
        corners = [[v, b, c] for b, c in zip(ring, ring[1:] + ring[:1], strict=True)]
        for f, corner in zip(around, corners, strict=False):
            turned = mesh.triangles[f].tolist()
            assert corner in (turned[i:] + turned[:i] for i in range(3))
        assert [vertices_of(s, e) for e in s.vertex_edges(v)] == [frozenset((v, w)) for w in ring]


def test_counts_and_handles_are_those_of_the_triangle_list(name, mesh):
    s, relations = structures.build(name, mesh), relations_of(mesh)
    sizes = [len(relations.members[kind]) for kind in ("vertex", "edge", "face")]
    assert [s.n_vertices, s.n_edges, s.n_faces] == sizes
    assert [len(s.vertices()), len(s.edges()), len(s.faces())] == sizes
    assert {vertices_of(s, e) for e in s.edges().tolist()} == set(relations.members["edge"])
    assert (np.diff(s.edges()) > 0).all()


def test_an_edge_is_found_by_its_vertices_from_either_end(name, mesh):
    s, relations = structures.build(name, mesh), relations_of(mesh)
    for a, b in combinations(range(min(len(mesh.points), 40)), 2):
        found = s.find_edge(a, b)
        assert found == s.find_edge(b, a)
        if frozenset((a, b)) in relations.members["edge"]:
            assert found in s.edges()
            assert vertices_of(s, found) == {a, b}
        else:
            assert found is None


@pytest.mark.parametrize("query", QUERIES.values(), ids=QUERIES)
def test_a_handle_that_names_nothing_is_refused(name, query):
    s = structures.build(name, hem.generate("torus", 100))
    for wrong in (-1, 10**6, 2**40 + 7, -(2**40)):
        for handles in (wrong, np.array([s.handles(query.source)[0], wrong])):
            with pytest.raises(hem.MeshError, match=query.source):
                getattr(s, query.name)(handles)


@pytest.mark.parametrize("wrong", ["7", 7.0, None, [0.5], [[1, 2]], True])
def test_what_is_no_handle_is_refused(name, wrong):
    s = structures.build(name, hem.generate("torus", 100))
    with pytest.raises(hem.MeshError, match="handle"):
        s.vertex_faces(wrong)


def test_vertices_that_are_not_joined_are_no_edge():
    for name in (*HOLDS_ANYTHING, "triangle_neighbor"):
        s = structures.build(name, hem.generate("torus", 100))
        apart = next(v for v in range(1, 100) if s.find_edge(0, v) is None)
        for query in ("edge_edges", "edge_faces"):
            with pytest.raises(hem.MeshError, match="edge"):
                getattr(s, query)(apart)


def test_any_integer_type_names_a_handle(name):
    s = structures.build(name, hem.generate("torus", 100))
    expected = s.vertex_faces(7).tolist()
    for handle in (np.int32(7), np.int64(7), np.uint8(7), np.array(7)):
        assert s.vertex_faces(handle).tolist() == expected
    assert s.vertex_faces([7])[0].tolist() == expected
    assert len(s.vertex_faces([])) == 0


def test_a_vertex_of_a_very_large_valence_is_answered(name):
    mesh = hem.generate("cone", 5000)
    s, apex = structures.build(name, mesh), int(np.bincount(mesh.triangles.ravel()).argmax())
    ring = s.vertex_vertices(apex)
    faces = mesh.triangles[(mesh.triangles == apex).any(axis=1)]
    assert sorted(ring.tolist()) == np.setdiff1d(faces, [apex]).tolist()
    assert len(s.vertex_faces(apex)) == len(faces)


@pytest.mark.parametrize("query", ["vertex_faces", "vertex_edges", "vertex_vertices"])
def test_a_batch_may_begin_with_a_slice_without_answers(name, query, monkeypatch):
    torus = hem.generate("torus", 100)
    points = np.vstack([np.zeros_like(torus.points), torus.points])
    s = structures.build(name, hem.TriangleMesh(points, torus.triangles + len(torus.points)))
    alone = getattr(s, query)()
    for module in ("hem.authoring.slices", "hem.contract.state"):
        monkeypatch.setattr(f"{module}.slice_count", lambda n: min(n, 4) or 1)
    found = getattr(s, query)()
    assert found.offsets.tolist() == alone.offsets.tolist()
    assert found.values.tolist() == alone.values.tolist()
    assert len(alone.values)
