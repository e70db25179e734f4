"""What is its own in the indexed mesh with adjacency: when neighbors are found, and forgotten."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem.authoring import OPERATIONS
from hem.contract import QUERIES, Structure
from tests.extent import waiting_for
from tests.structures.test_build import NON_MANIFOLD

NAME = "indexed_adjacency"
FIND = [it for it in QUERIES if it not in ("edge_vertices", "face_vertices", "face_edges")]


def built(n: int = 100, family: str = "torus") -> Structure:
    return structures.build(NAME, hem.generate(family, n))


def answers(s: Structure) -> dict[str, list[list[int]]]:
    """All answers, each sorted."""
    asked = {name: getattr(s, name)(s.handles(it.source)) for name, it in QUERIES.items()}
    return {name: [sorted(row.tolist()) for row in rows] for name, rows in asked.items()}


def as_searched(s: Structure) -> dict[str, list[list[int]]]:
    """The answers of an indexed mesh with the same records, which searches for each."""
    records = type(structures.build("indexed", hem.generate("torus", 9)).records)
    other = structures.REGISTRY["indexed"](records(*s.arrays[:2], s.records.counts))
    return answers(other.copy())


def edge(s: Structure, k: int = 7) -> int:
    return int(s.edges()[k])


EDITS: dict[str, Callable[[Structure], Any]] = {
    "split_edge": lambda s: s.split_edge(edge(s), (0, 0, 0)),
    "split_face": lambda s: s.split_face(7, (0, 0, 0)),
    "collapse_edge": lambda s: s.collapse_edge(edge(s)),
    "flip_edge": lambda s: s.flip_edge(edge(s)),
    "remove_face": lambda s: s.remove_face(4),
    "add_face": lambda s: s.add_face(*s.add_face_again),
    "add_vertex": lambda s: s.add_vertex((0, 0, 0)),
    "split_edges": lambda s: s.split_edges(s.edges()[:20], np.zeros((20, 3))),
    "split_faces": lambda s: s.split_faces(s.faces()[:20], np.zeros((20, 3))),
    "split_all_faces": lambda s: s.split_all_faces(),
    "collapse_edges": lambda s: s.collapse_edges(s.edges()[:20]),
    "remove_faces": lambda s: s.remove_faces([30, *s.face_faces(30)]),
    "remove_vertex": lambda s: s.remove_vertex(20),
    "compact": lambda s: s.compact(),
    "reserve and split": lambda s: (s.reserve(1000), s.split_face(7, (0, 0, 0))),
    "impacts": lambda s: hem.algorithms.impacts(s, s.faces()[:20]),
    "an algorithm that collapses": lambda s: hem.algorithms.simplify(s, vertices=50),
}
ALGORITHMS = "impacts", "an algorithm that collapses"
ASKING_AGAIN = "collapse_edges", *ALGORITHMS
"""Edits that ask for neighbors after their last change."""
STAYS = {"move_vertex": lambda s: s.move_vertex(3, (0, 0, 0))}


@pytest.mark.parametrize("edit", waiting_for(EDITS.keys() - ALGORITHMS, EDITS))
def test_an_edit_throws_away_what_was_found_and_nothing_stale_is_answered(edit: str) -> None:
    s = built()
    s.collapse_edge(edge(s, 40))
    if edit == "add_face":
        s.add_face_again = s.face_vertices(9).tolist()
        s.remove_face(9)
    answers(s)
    s.validate()
    assert s.records.standing[0]
    EDITS[edit](s)
    if edit not in ASKING_AGAIN:
        assert not s.records.standing[0]
    assert answers(s) == as_searched(s)
    s.validate()


def test_every_operation_is_tried_above() -> None:
    assert {*OPERATIONS} <= {*EDITS, *STAYS}


def test_what_was_found_stands_when_a_vertex_moves_and_when_an_edit_is_refused() -> None:
    s = structures.build(NAME, hem.generate("grid", 25))
    answers(s)
    STAYS["move_vertex"](s)
    border = next(e for e in s.edges().tolist() if len(s.edge_faces(e)) == 1)
    with pytest.raises(hem.TopologyError):
        s.flip_edge(border)
    assert s.records.standing[0]
    assert answers(s) == as_searched(s)


@pytest.mark.parametrize("query", FIND)
def test_the_first_question_reads_the_mesh_and_the_second_does_not(query: str) -> None:
    first, second = [], []
    for n in (100, 900):
        s = built(n)
        handle = s.handles(QUERIES[query].source)[[7]]
        first.append(int(s.work(query, handle)[0]))
        second.append(int(s.work(query, handle)[0]))
        s.validate()
    assert first[1] > 8 * first[0]
    assert max(second) < 200
    assert second[1] <= second[0] + 10  # rows are hashed otherwise


def test_each_of_many_edits_finds_all_neighbors_anew_but_the_split_of_a_face() -> None:
    for operation, grows in (("split_edge", True), ("flip_edge", True), ("split_face", False)):
        work = []
        for n in (100, 900):
            s = built(n)
            one, other = (7, 70) if operation == "split_face" else (edge(s, 7), edge(s, 70))
            s.operation_work(operation, one)
            work.append(s.operation_work(operation, other))
        assert (work[1] > 8 * work[0]) == grows


def test_faces_are_found_at_an_edge_whatever_the_valence_of_its_ends() -> None:
    work = []
    for n in (50, 5_000):
        s = built(n, "cone")
        apex = int(np.bincount(s.triangles().ravel()).argmax())
        edges = s.vertex_edges(apex)[:: n // 50]
        work.append(s.work("edge_faces", edges).mean())
    assert work[1] < 1.5 * work[0]


def test_a_copy_begins_without_and_finds_for_itself() -> None:
    s = built()
    expected = answers(s)
    other = s.copy()
    assert not other.records.standing[0]
    assert answers(other) == expected
    assert not any(np.shares_memory(*pair) for pair in zip(s.records, other.records, strict=True))
    other.split_face(3, (0, 0, 0))
    assert s.records.standing[0]
    s.validate()


def test_what_is_restored_was_not_found_before() -> None:
    s = built()
    snapshot, expected = s.snapshot(), answers(s)
    s.flip_edge(edge(s))
    assert answers(s) != expected
    s.restore(snapshot)
    assert not s.records.standing[0]
    assert answers(s) == expected


def test_faces_and_edges_are_known_without_a_search() -> None:
    s = built()
    s.edges(), s.triangles(), s.to_triangles(), s.face_edges(), s.face_vertices(3)
    hem.RenderMesh(s)
    assert not s.records.standing[0]


@pytest.mark.parametrize("case", NON_MANIFOLD)
def test_what_is_not_manifold_is_answered_as_by_search(case: str) -> None:
    points = np.random.default_rng(0).random((6, 3))
    s = structures.build(NAME, hem.TriangleMesh(points, NON_MANIFOLD[case][0]))
    assert answers(s) == as_searched(s)


@pytest.mark.parametrize("array", ["row_end", "row_face", "slot_first", "slot_next"])
def test_whatever_is_wrong_while_it_stands_is_found(array: str) -> None:
    s, rng = built(), np.random.default_rng(5)
    s.vertex_faces(0)
    values = getattr(s.records, array)
    for place in rng.integers(len(values), size=20):
        values[place] += 1
        with pytest.raises(hem.MeshError, match="broken invariant"):
            s.validate()
        values[place] -= 1
    s.validate()
    s.records.triangle[3] = np.roll(s.records.triangle[3], 1)  # another half-edge is where it was
    with pytest.raises(hem.MeshError, match="broken invariant"):
        s.validate()


@pytest.fixture
def switching() -> Iterator[None]:
    """Threads that take turns as often as they can."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(interval)


@pytest.mark.parametrize("asked", ["vertex_faces", "find_edge"])
def test_uncompiled_all_neighbors_are_found_in_one_go_before_another_thread_may_ask(
    asked: str,
) -> None:
    """In compiled code: a profiler is not told of the slots that it hashes to."""
    s, called = structures.build(NAME, hem.generate("torus", 100), compiled=False), set()
    ask, handles = getattr(s, asked), s.edge_array()[7] if asked == "find_edge" else [7]
    s.copy().vertex_faces([7])  # loads what is compiled
    sys.setprofile(lambda frame, *_: called.add(frame.f_code.co_name))
    try:
        answer = ask(*handles)
    finally:
        sys.setprofile(None)
    assert "slot" not in called
    assert np.array_equal(answer, getattr(built(), asked)(*handles))
    s.validate()


def test_threads_that_ask_first_at_the_same_time_get_their_own_answers(switching: None) -> None:
    """So many vertices that to find all neighbors takes longer than to wake the other threads."""
    mesh, rng = hem.generate("torus", 200_000), np.random.default_rng(4)
    s = structures.build(NAME, mesh)
    handles = {name: rng.choice(s.handles(QUERIES[name].source), 300) for name in FIND}
    expected = {name: getattr(s, name)(handles[name]).to_list() for name in FIND}

    def ask(s: Structure, name: str, together: Barrier) -> bool:
        together.wait()
        if name == "edge_faces":
            return [getattr(s, name)(int(it)).tolist() for it in handles[name]] == expected[name]
        return bool(getattr(s, name)(handles[name]).to_list() == expected[name])

    with ThreadPoolExecutor(len(FIND)) as pool:
        for _ in range(5):
            fresh, together = structures.build(NAME, mesh), Barrier(len(FIND))
            tasks = [pool.submit(ask, fresh, name, together) for name in FIND]
            assert all(task.result() for task in tasks)
            fresh.validate()
