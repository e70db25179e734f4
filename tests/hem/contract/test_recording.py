"""Laws of recordings: what was done is counted, and is done as without anybody counting."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from hem.contract.recording import ANEW, CHECKED, COMPILED, PYTHON
from hem.engine import interpreted
from structures import indexed_adjacency

INTERPRETED = next(name for name, it in structures.REGISTRY.items() if not it.compiled)
COMPILED_ONE = "half_edge"
TORUS = hem.generate("torus", 100)


def build(name: str = COMPILED_ONE) -> structures.Structure:
    return structures.build(name, TORUS)


def counts(found: hem.Recording) -> dict[tuple[str, str], float]:
    return {(it.what, it.caller): it.times for it in found.rows if it.times}


@pytest.mark.parametrize("name", [INTERPRETED, COMPILED_ONE])
def test_an_algorithm_that_is_counted_does_what_it_does_otherwise(name: str) -> None:
    plain, counted = build(name), build(name)
    faces = [3, 50, 3, 120]
    found = algorithms.impacts(plain, faces)
    with hem.record(counted) as workload:
        assert algorithms.impacts(counted, faces) == found
    assert np.array_equal(plain.triangles(), counted.triangles())
    assert np.array_equal(plain.points, counted.points)
    counted.validate()
    # Of each impact: its docstring says which operations; three corners are asked for faces.
    assert counts(workload)["split_face", COMPILED] == len(faces)
    assert counts(workload)["split_edge", COMPILED] == len(faces)
    assert counts(workload)["vertex_faces", COMPILED] == 3 * len(faces)


def test_structures_are_asked_the_same_of_their_elements() -> None:
    asked = []
    for name in (INTERPRETED, COMPILED_ONE):
        s = build(name)
        with hem.record(s) as workload:
            algorithms.impacts(s, [3, 50])
        asked.append({it: n for it, n in counts(workload).items() if it[0] != "edge_vertices"})
    assert asked[0] == asked[1]


def test_calls_from_python_are_told_from_batches() -> None:
    s = build()
    with hem.record(s) as workload:
        for v in (1, 2, 90):
            s.vertex_faces(v)
        s.vertex_faces(np.arange(10))
        s.face_vertices()
        s.find_edge(0, int(s.vertex_vertices(0)[0]))
    found = counts(workload)
    assert found["vertex_faces", PYTHON] == 3
    assert found["vertex_faces", COMPILED] == 10
    assert found["face_vertices", COMPILED] == s.n_faces
    assert found["vertex_edges", PYTHON] == 1


def test_a_vertex_that_is_removed_counts_as_the_faces_at_it() -> None:
    s, at_it = build(), len(build().vertex_faces(7))
    with hem.record(s) as workload:
        s.remove_vertex(7)
        s.face_faces(0)
    assert counts(workload)["remove_face", COMPILED] == at_it
    assert counts(workload)[ANEW, COMPILED] == 1


def test_an_operation_by_its_name_counts_however_it_is_called() -> None:
    s = build()
    with hem.record(s) as workload:
        s.operate("add_vertex", point=(0, 0, 0))
        s.operate(operation="add_vertex", point=(0, 0, 0))
        s.operate("flip_edge", int(s.edges()[0]))
        with pytest.raises(TypeError, match="operation"):
            s.operate()
    told = {("add_vertex", PYTHON): 2, ("flip_edge", PYTHON): 1, (ANEW, COMPILED): 1}
    assert counts(workload) == told


def test_what_polygons_alone_have_is_not_counted_nor_is_what_is_no_structure_recorded() -> None:
    s = build("plankton")
    with hem.record(s) as workload:
        s.operate("merge_faces", int(s.edges()[0]))
    assert (s.n_faces, counts(workload)) == (len(TORUS.triangles) - 1, {})
    with pytest.raises(hem.MeshError, match="not TriangleMesh; build one"), hem.record(TORUS):
        pass


def test_a_recording_is_shown_in_a_line() -> None:
    s = structures.build("half_edge", hem.generate("torus", 100))
    with hem.record(s) as recording:
        assert repr(recording) == "<Recording of nothing>"
        s.vertex_faces(s.vertices())
        s.flip_edge(int(s.edges()[0]))
    assert repr(recording) == "<Recording of 100 × vertex_faces, 1 × flip_edge>"


def test_what_lies_side_by_side_is_in_order_and_what_lies_apart_is_not() -> None:
    s = structures.build(COMPILED_ONE, hem.generate("torus", 2_000))
    with hem.record(s) as workload:
        s.vertex_faces(np.arange(1_000))
        s.face_vertices(np.arange(0, 4_000, 40))
    shares = {it.what: it.in_order for it in workload.rows}
    assert shares["vertex_faces"] == pytest.approx(1, abs=0.01)
    assert shares["face_vertices"] == 0


def test_what_is_refused_or_only_checked_is_no_edit() -> None:
    tetrahedron = hem.TriangleMesh(
        np.vstack([np.zeros(3), np.eye(3)]), [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    s = structures.build(COMPILED_ONE, tetrahedron)
    edge = int(s.edges()[0])
    with hem.record(s) as workload:
        assert not s.can_collapse_edge(edge)
        with pytest.raises(hem.TopologyError):
            s.collapse_edge(edge)
    assert counts(workload) == {(f"{CHECKED}collapse_edge", PYTHON): 2}


def test_neighbors_are_needed_anew_once_after_edits_that_are_followed_by_a_question() -> None:
    s = build()
    with hem.record(s) as workload:
        s.split_face(0, (0, 0, 0))
        s.split_face(1, (0, 0, 0))
        s.face_vertices(0)  # its own corners: no neighbors
        s.vertex_faces(0)
        s.vertex_faces(1)
    assert counts(workload)[ANEW, COMPILED] == 1


def test_afterward_a_mesh_is_as_before() -> None:
    s = build()
    s.vertex_faces(0)
    before = set(vars(s))
    with pytest.raises(hem.MeshError), hem.record(s) as workload:  # noqa: PT012
        s.face_faces(0)
        s.face_faces(-1)
    s.vertex_faces(3)
    assert set(vars(s)) == before
    assert counts(workload) == {("face_faces", PYTHON): 1}


def test_a_mesh_that_is_recorded_already_is_refused_and_goes_on_being_recorded() -> None:
    s = build()
    with hem.record(s) as workload:
        with pytest.raises(hem.MeshError, match="recorded already"), hem.record(s):
            pass
        s.face_faces(0)
    assert counts(workload) == {("face_faces", PYTHON): 1}


def test_a_recording_is_told_per_element_as_csv() -> None:
    s = build()
    with hem.record(s) as workload:
        s.face_vertices(np.arange(50))
    assert workload.text("vertex").splitlines()[1] == "face_vertices,0.5,vertex,0.98,compiled"
    with pytest.raises(hem.MeshError, match=r"no element 'vertices'.* did you mean 'vertex'"):
        workload.text("vertices")


@pytest.mark.parametrize("name", [INTERPRETED, COMPILED_ONE])
def test_what_an_algorithm_edits_counts_though_it_calls_no_operation(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 60))
    n, edges = s.n_vertices, s.n_edges
    with hem.record(s) as found:
        hem.algorithms.smooth(s)
    assert {it.what: it.times for it in found.rows}["move_vertex"] == n
    with hem.record(s) as found:
        hem.algorithms.subdivide(s, "sqrt3")
    counted = {it.what: it.times for it in found.rows}
    assert (counted["flip_edge"], counted["move_vertex"]) == (edges, n)


def test_of_a_batch_what_was_refused_is_no_edit() -> None:
    tetrahedron = hem.TriangleMesh(
        np.vstack([np.zeros(3), np.eye(3)]), [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    s = structures.build(COMPILED_ONE, tetrahedron)
    with hem.record(s) as workload:
        assert not s.collapse_edges(s.edges()).any()
    assert counts(workload) == {(f"{CHECKED}collapse_edge", COMPILED): 6}
    s = build()
    with hem.record(s) as workload:
        done = s.collapse_edges(s.edges())
    told = {"collapse_edge": done.sum(), f"{CHECKED}collapse_edge": (~done).sum()}
    told[ANEW] = done.sum() - 1
    assert counts(workload) == {(what, COMPILED): times for what, times in told.items()}


def test_arguments_by_name_count_as_in_their_places() -> None:
    told = []
    for by_name in (False, True):
        s = structures.build("half_edge", hem.generate("torus", 100))
        points, faces, keep = np.arange(9.0).reshape(3, 3), [1, 50, 100], int(s.edge_vertices(9)[0])
        with hem.record(s) as recording:
            if by_name:
                s.split_faces(points=points, faces=faces)
                s.collapse_edge(keep=keep, edge=9)
            else:
                s.split_faces(faces, points)
                s.collapse_edge(9, keep)
        told.append(recording.rows)
    assert told[0] == told[1]
    assert all(0 <= it.in_order <= 1 for it in told[1])


def test_a_point_is_one_vertex() -> None:
    s = build()
    with hem.record(s) as workload:
        s.operate("add_vertex", point=(0, 0, 0))
    assert counts(workload) == {("add_vertex", PYTHON): 1}


EACH = {
    "add_face": lambda s: s.add_face(*GONE),
    "remove_face": lambda s: s.remove_face(50),
    "remove_faces": lambda s: s.remove_faces([50, 51, 90]),
    "remove_vertex": lambda s: s.remove_vertex(60),
    "split_face": lambda s: s.split_face(50, (0, 0, 0)),
    "split_faces": lambda s: s.split_faces([50, 90], np.zeros((2, 3))),
    "split_edge": lambda s: s.split_edge(int(s.edges()[100]), (0, 0, 0)),
    "split_edges": lambda s: s.split_edges(s.edges()[100::30], np.zeros((7, 3))),
    "collapse_edge": lambda s: s.collapse_edge(int(s.edges()[100])),
    "collapse_edges": lambda s: s.collapse_edges(s.edges()[100::10]),
    "flip_edge": lambda s: s.flip_edge(int(s.edges()[100])),
    "move_vertex": lambda s: s.move_vertex(7, (0, 0, 0)),
    "add_vertex": lambda s: s.add_vertex((0, 0, 0)),
}
GONE = TORUS.triangles[0].tolist()


@pytest.mark.parametrize("do", EACH)
@pytest.mark.parametrize("edited", [False, True])
def test_neighbors_are_needed_anew_as_often_as_a_mesh_that_keeps_them_finds_them(
    do: str, edited: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    s, found = structures.build("indexed_adjacency", TORUS, compiled=False), []
    find = indexed_adjacency.find_neighbors

    def counted(m: Any) -> None:
        found.extend([1] * (not m.standing[0]))
        (find if isinstance(m.standing, np.ndarray) else interpreted(find))(m)

    monkeypatch.setattr(indexed_adjacency, "find_neighbors", counted)
    monkeypatch.setitem(interpreted(indexed_adjacency.row).__globals__, "find_neighbors", counted)
    s.remove_face(0)
    s.vertex_faces(20)
    found.clear()
    with hem.record(s) as workload:
        if edited:
            s.split_face(150, (0, 0, 0))
        EACH[do](s)
        s.vertex_faces(20)
    assert counts(workload).get((ANEW, COMPILED), 0) == len(found)
