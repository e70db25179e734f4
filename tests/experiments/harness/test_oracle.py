"""The check before every timing: it agrees with answers found by hand, and catches a change."""

import numpy as np
import pytest

import hem
import structures
from experiments.harness import PRESETS, time_rounds
from experiments.harness.oracle import CheckFailedError, check_query, neighbors, pack_pairs
from experiments.runs import experiments
from hem.contract import QUERIES
from tests.extent import OF_EACH_KIND, waiting_for

# Two triangles (0, 1, 2) and (0, 2, 3) that share the edge 0-2.
SQUARE = hem.TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
BY_HAND = {
    "vertex_vertices": (1, [0, 2]),
    "vertex_edges": (1, [(0, 1), (1, 2)]),
    "vertex_faces": (1, [0]),
    "edge_vertices": ((0, 2), [0, 2]),
    "edge_edges": ((0, 2), [(0, 1), (1, 2), (2, 3), (0, 3)]),
    "edge_faces": ((0, 2), [0, 1]),
    "face_vertices": (1, [0, 2, 3]),
    "face_edges": (1, [(0, 2), (2, 3), (0, 3)]),
    "face_faces": (1, [0]),
}


def packed(values: list) -> list[int]:
    return sorted(pack_pairs(np.array(values)).tolist()) if isinstance(values[0], tuple) else values


@pytest.mark.parametrize("query", QUERIES)
def test_neighbors_are_those_found_by_hand(query):
    key, expected = BY_HAND[query]
    key = packed([key])[0] if isinstance(key, tuple) else key
    assert neighbors(SQUARE.triangles, QUERIES[query], key).tolist() == packed(expected)


@pytest.mark.parametrize("name", waiting_for(OF_EACH_KIND, structures.NAMES))
@pytest.mark.parametrize("query", QUERIES)
def test_a_wrong_answer_is_caught(name, query, monkeypatch):
    s = structures.build(name, hem.generate("torus", 100))
    handles = s.handles(QUERIES[query].source)[10:12]
    check_query(s, hem.generate("torus", 100), QUERIES[query], handles)
    right = getattr(s, query)
    monkeypatch.setitem(s.__dict__, query, lambda handle: right(handle)[:-1])
    if query == "edge_vertices":
        return  # the names of edges themselves come from this query
    with pytest.raises(CheckFailedError, match=f"{name}.{query}"):
        check_query(s, hem.generate("torus", 100), QUERIES[query], handles)


def test_an_edge_between_two_vertices_that_no_face_joins_is_caught():
    mesh = hem.generate("torus", 100)
    s = structures.build("half_edge", mesh)
    right = s.edge_vertices

    def wrong(edges):
        answer = right(edges)
        values = answer.values if np.ndim(edges) else answer
        values[1::2] = (values[1::2] + 50) % 100
        return answer

    s.__dict__["edge_vertices"] = wrong
    with pytest.raises(CheckFailedError, match="edge_vertices"):
        check_query(s, mesh, QUERIES["edge_vertices"], s.handles("edge")[:3])


@pytest.mark.parametrize("wrong", ["inside out", "a point elsewhere"])
def test_a_structure_that_does_not_give_its_mesh_back_is_not_timed(monkeypatch, wrong):
    its, build = experiments()["bench_build"], structures.build

    def build_wrong(name, mesh, *given):
        if wrong == "inside out":
            return build(name, hem.TriangleMesh(mesh.points, mesh.triangles[:, ::-1]), *given)
        s = build(name, mesh, *given)
        s.move_vertex(0, (9, 9, 9))
        return s

    monkeypatch.setattr(structures, "build", build_wrong)
    case = its.cases(PRESETS["smoke"], "half_edge")[0]
    with pytest.raises(AssertionError):
        its.measure(case, PRESETS["smoke"], time_rounds)
