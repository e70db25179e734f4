"""What holds of every structure beside its answers: copies, dead handles, threads, interrupts."""

from __future__ import annotations

import copy
import gc
import importlib
import pickle
import sys
import tracemalloc
import weakref
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import partial
from threading import Event
from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem.authoring import VALENCE
from hem.contract import QUERIES, STEPS, Attribute, Navigable, Structure
from hem.contract.state import State
from hem.errors import MeshError, TopologyError
from hem.ragged import Ragged
from tests.structures.conftest import WALKED, octahedron, other_name
from tests.structures.histories.actions import faces_of
from tests.structures.test_polygons import CUBE, mixed, plankton, sheet

COPIES: dict[str, Callable[[Structure], Structure]] = {
    "copy": lambda s: s.copy(),
    "copy.copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda s: pickle.loads(pickle.dumps(s)),
}


def collapsible(s: Structure) -> int:
    """The first edge that may be collapsed."""
    return next(edge for edge in s.edges().tolist() if s.can_collapse_edge(edge))


def answers(s: Structure) -> dict[str, list[list[int]]]:
    """Every answer to every query, singly."""
    return {
        name: [getattr(s, name)(handle).tolist() for handle in s.handles(query.source).tolist()]
        for name, query in QUERIES.items()
    }


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("edited", [False, True])
def test_a_copy_answers_for_itself(name: str, how: str, edited: bool) -> None:
    s = structures.build(name, hem.generate("grid", 25))
    s.vertex_faces(0)
    if edited:
        s.split_face(0, (0, 0, 0))
        s.collapse_edge(collapsible(s))
    before = answers(s)
    other = COPIES[how](s)
    other.validate()
    assert answers(other) == before
    other.split_face(int(other.faces()[1]), (0, 0, 0))
    other.collapse_edge(collapsible(other))
    other.validate()
    assert answers(s) == before
    assert answers(other) != before
    s.split_face(int(s.faces()[0]), (0, 0, 0))
    s.validate()


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_of_nothing_or_of_polygons_is_its_own(name: str, how: str) -> None:
    polygons = [CUBE, mixed()] if structures.REGISTRY[name].holds_polygons else []
    for mesh in (hem.TriangleMesh([], []), *polygons):
        s = structures.build(name, mesh)
        before = answers(s)
        other = COPIES[how](s)
        assert other.same_as(s)
        other.add_vertex((1, 2, 3))
        other.split_all_faces()
        other.validate()
        assert not other.same_as(s)
        assert answers(s) == before


def test_a_mesh_is_pickled_and_copied_read_only() -> None:
    for mesh in (hem.generate("grid", 9), CUBE):
        for how in (copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))):
            other: Any = how(mesh)
            assert not other.points.flags.writeable
            np.testing.assert_array_equal(other.points, mesh.points)
            assert other.summary() == mesh.summary()


def test_a_mesh_does_not_change_with_the_arrays_it_was_made_of() -> None:
    points, triangles = np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.int32)
    mesh = hem.TriangleMesh(points, triangles)
    points[0], triangles[0] = 7, 99
    assert mesh.points[0].tolist() == [1, 0, 0]
    assert mesh.triangles.tolist() == [[0, 1, 2]]
    with pytest.raises(AttributeError, match="do not change"):
        mesh.points = points


def test_a_dead_handle_is_refused_whatever_died_with_it(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    edge = collapsible(s)
    drop, _ = s.edge_vertices(edge).tolist()
    faces = s.edge_faces(edge).tolist()
    s.collapse_edge(edge)
    for query, handle in (("vertex_faces", drop), *(("face_vertices", face) for face in faces)):
        for asked in (handle, np.int32(handle), [handle], np.array([50, handle])):
            with pytest.raises(MeshError, match="no such"):
                getattr(s, query)(asked)
    with pytest.raises(MeshError, match="no such"):
        s.find_edge(drop, 50)


@pytest.mark.parametrize("died", ["collapse_edge", "merge_faces"])
def test_an_edge_that_died_without_a_face_is_refused(died: str) -> None:
    s = plankton(sheet())
    edge = s.find_edge(14, 15)
    assert edge is not None
    getattr(s, died)(edge)
    s.validate()
    for asked in (edge, [edge]):
        for query in ("edge_vertices", "edge_edges", "edge_faces"):
            with pytest.raises(MeshError, match="no such edge"):
                getattr(s, query)(asked)
    of_half_edges = [name for name, step in STEPS.items() if step.source == "half_edge"]
    for half_edge in (edge, edge ^ 1):
        for step in of_half_edges:
            for asked in (half_edge, [half_edge]):
                with pytest.raises(MeshError, match="no such half-edge"):
                    getattr(s, step)(asked)


@pytest.mark.parametrize("name", [it for it, kind in structures.REGISTRY.items() if kind.emulated])
def test_of_what_is_no_edge_its_name_tells_the_ends_and_all_else_is_refused(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    far = int(np.setdiff1d(s.vertices(), [0, *s.vertex_vertices(0)])[0])
    assert s.find_edge(0, far) is None
    assert s.edge_vertices(far).tolist() == [0, far]  # 0 stands in the upper half
    for query in ("edge_faces", "edge_edges"):
        with pytest.raises(MeshError, match="no such edge"):
            getattr(s, query)(far)


def test_a_handle_is_checked_by_its_own_record_whatever_died_before(name: str) -> None:
    """What is allocated meanwhile is as little on a large mesh: no mark of another is looked at."""
    peaks = []
    for n in (100, 2_500):
        s = structures.build(name, hem.generate("torus", n))
        s.collapse_edge(collapsible(s))
        edge, half_edge = s.find_edge(50, 51), s.edges()[-1:]
        asked: list[Callable[[], Any]] = [
            lambda s=s: s.find_edge(50, 51),
            lambda s=s: s.vertex_faces(np.array([50, 51])),
            lambda s=s: s.face_vertices([70]),
            lambda s=s, e=edge: s.edge_vertices([e]),
        ]
        if isinstance(s, Navigable):
            asked.append(lambda s=s, h=half_edge: s.origin(s.face_half_edge([70])))
        for ask in asked:
            ask()  # finds what is found when first asked
        tracemalloc.start()
        for ask in asked:
            ask()
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < peaks[0] + 1_000


def test_split_edges_of_polygons_is_refused_as_a_whole() -> None:
    mesh = hem.PolygonMesh(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]],
        [[0, 1, 2], [0, 2, 3], [1, 4, 5, 2]],
    )
    s = plankton(mesh)
    before, edits = answers(s), []
    s.subscribe(edits.append)
    edges = [s.find_edge(0, 2), s.find_edge(1, 2), s.find_edge(0, 1)]
    with pytest.raises(TopologyError, match="more than three corners"):
        s.split_edges(edges, [[0.5, 0.5, 0], [1, 0.5, 0], [0.5, 0, 0]])
    assert answers(s) == before
    assert not edits
    assert len(s.split_edges(edges[::2], [[0.5, 0.5, 0], [0.5, 0, 0]])) == 2
    s.validate()


def test_no_edge_joins_a_vertex_to_itself_and_none_is_found_for_a_fraction(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    assert s.find_edge(3, 3) is None
    for a in (0.9, "0", True, None):
        with pytest.raises(MeshError, match="takes a vertex handle"):
            s.find_edge(a, 1)  # type: ignore[arg-type]


def test_numpy_integers_are_handles_and_take_the_way_of_pythons(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    s = structures.build(name, hem.generate("grid", 25))

    def unexpected(*_: Any) -> None:
        raise AssertionError("they go the way of arrays")

    for query in QUERIES:
        handle = s.handles(QUERIES[query].source)[1]
        expected = getattr(s, query)(int(handle)).tolist()
        kinds = (np.int32, np.int64, np.uint8, np.uint64)
        with monkeypatch.context() as patched:
            patched.setattr(s._queries, "_ask_many", unexpected)
            for kind in (it for it in kinds if handle <= np.iinfo(it).max):
                assert getattr(s, query)(kind(handle)).tolist() == expected
    for wrong in (True, np.bool_(True), 1.0, "1", 2**70):
        with pytest.raises(MeshError):
            s.vertex_faces(wrong)  # type: ignore[call-overload]


@contextmanager
def switching_often() -> Iterator[None]:
    """Have Python change threads as often as it can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


def test_threads_that_only_read_get_their_own_answers(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 400))
    vertices = s.vertices().tolist()
    expected = {v: s.vertex_faces(v).tolist() for v in vertices}
    edges = {v: s.find_edge(v, int(s.vertex_vertices(v)[0])) for v in vertices}
    rounds = 40 if s.compiled else 4

    def read(seed: int) -> int:
        order = np.random.default_rng(seed).permutation(vertices).tolist() * rounds
        return sum(
            s.vertex_faces(v).tolist() != expected[v]
            or s.find_edge(v, int(s.vertex_vertices(v)[0])) != edges[v]
            for v in order
        )

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(read, range(4))) == [0] * 4


def test_threads_that_ask_what_may_be_done_get_their_own_answers(name: str) -> None:
    s = structures.build(name, hem.generate("grid", 49))
    edges, before = s.edges().tolist(), s.copy()
    asked = [(ask, e) for ask in (s.can_flip_edge, s.can_collapse_edge) for e in edges]
    expected = {it: it[0](it[1]) for it in asked}

    def wrong(seed: int) -> int:
        order = np.random.default_rng(seed).permutation(len(asked)).tolist()
        order *= 100 if s.compiled and not s.searches else 2
        return sum(asked[i][0](asked[i][1]) != expected[asked[i]] for i in order)

    with switching_often(), ThreadPoolExecutor(4) as pool:
        assert list(pool.map(wrong, range(4))) == [0] * 4
    assert s.same_as(before)


def test_a_sweep_in_one_thread_leaves_the_answers_in_others_alone(name: str) -> None:
    if not structures.REGISTRY[name].compiled:
        return  # a sweep lets no other thread run
    s = structures.build(name, hem.generate("torus", 1_000))
    vertices = s.vertices()
    expected, checksum = s.vertex_faces(vertices).to_list(), s.sweep("vertex_faces", vertices)
    end = Event()

    def sweeps() -> bool:
        right = True
        while not end.is_set():
            right = right and s.sweep("vertex_faces", vertices) == checksum
        return right

    with switching_often(), ThreadPoolExecutor(1) as pool:
        swept = pool.submit(sweeps)
        try:
            order = vertices.tolist() * (1 if s.searches else 20)
            assert all(s.vertex_faces(v).tolist() == expected[v] for v in order)
        finally:
            end.set()
        assert swept.result()


def test_a_mesh_that_is_dropped_is_freed_at_once(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    s.vertex_faces(7)
    s.vertex_faces()
    s.find_edge(0, 1)
    s.collapse_edge(collapsible(s))
    s.split_faces(s.faces()[:1], [(0, 0, 0)])
    s.compact()
    parts = [weakref.ref(part) for part in (s, *s.arrays)]
    gc.disable()  # reference cycles would wait for it, and large meshes with them
    try:
        del s
        assert all(part() is None for part in parts)
    finally:
        gc.enable()


def test_an_interrupted_question_leaves_the_mesh_ready(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    edge = collapsible(s.copy())

    def interrupted(operation: str) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(s._operations, "make_way", interrupted)
        with pytest.raises(KeyboardInterrupt):
            s.can_collapse_edge(edge)
    vertices = s.n_vertices
    s.collapse_edge(edge)
    assert s.n_vertices == vertices - 1
    s.validate()


def test_an_interrupt_while_room_is_made_leaves_the_mesh_ready(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = (structures.build(name, hem.generate("torus", 100)) for _ in range(2))
    for s in (one, other):
        s.split_face(0, (0, 0, 0))

    def interrupted(state: State) -> None:
        monkeypatch.undo()
        raise KeyboardInterrupt

    monkeypatch.setattr(State, "_repin", interrupted)
    with pytest.raises(KeyboardInterrupt):
        one.reserve(100_000)
    for s in (one, other):
        s.split_face(1, (0, 0, 0))
        s.collapse_edge(collapsible(s.copy()))
    assert answers(one) == answers(other)
    assert one.same_as(other)
    one.validate()


@pytest.mark.parametrize("element", ["vertex", "face", "corner"])
def test_an_interrupted_compact_renumbers_neither_elements_nor_their_values(
    name: str, element: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not structures.REGISTRY[name].compiled:
        return  # objects are renumbered in their place
    s = structures.build(name, hem.generate("torus", 100))
    for kind in ("vertex", "face", "corner"):
        made = getattr(s, f"{kind}_attribute")("number")
        made.values[...] = np.arange(made.values.size).reshape(made.values.shape)
    for edge in s.edges()[:50].tolist():
        with suppress(TopologyError):
            s.collapse_edge(edge)
    before, values = s.copy(), [it.values.copy() for it in s.attributes()]
    follow = Attribute.follow

    def interrupted(attribute: Attribute, edit: hem.Edit) -> None:
        follow(attribute, edit)
        if attribute.element == element:
            raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(Attribute, "follow", interrupted)
        with pytest.raises(KeyboardInterrupt):
            s.compact()
    assert s.same_as(before)
    assert answers(s) == answers(before)
    assert all(map(np.array_equal, values, (it.values for it in s.attributes())))
    s.validate()
    s.compact()
    before.compact()
    assert s.same_as(before)
    pairs = zip(s.attributes(), before.attributes(), strict=True)
    assert all(np.array_equal(one.values, other.values) for one, other in pairs)


def test_what_is_restored_counts_on(name: str) -> None:
    s = structures.build(name, hem.generate("grid", 25))
    expected = hem.generate("grid", 25).summary().edges
    s.reserve(10)
    fresh = s.snapshot()
    s.split_face(0, (0, 0, 0))
    s.restore(fresh)
    assert s.n_edges == expected
    s.split_face(0, (0, 0, 0))
    assert s.n_edges == expected + 3
    s.validate()
    s = structures.build(name, hem.generate("torus", 100))
    fresh, edge = s.snapshot(), collapsible(s.copy())
    s.collapse_edge(edge)
    s.restore(fresh)
    s.collapse_edge(edge)
    assert s.n_edges == 300 - 3


def test_the_vertex_to_keep_is_an_end(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    edge = collapsible(s)
    for keep in (-1, -5, 99):
        with pytest.raises(TopologyError, match="not an end"):
            s.collapse_edge(edge, keep)
    for keep in (np.array([1, 2]), np.array([-1]), [1, 2]):
        for collapse in (s.collapse_edge, partial(s.operate, "collapse_edge")):
            with pytest.raises(MeshError, match="takes handles"):
                collapse(edge, keep)
    assert not s.collapse_edges([edge], [-1]).any()
    assert s.collapse_edge(edge).vertex >= 0


def test_nothing_is_left_and_compacted_twice(name: str) -> None:
    s = structures.build(name, hem.TriangleMesh([[0, 0, 0]], []))
    s.compact()
    s.validate()
    s = structures.build(name, hem.generate("grid", 9))
    s.remove_faces(s.faces())
    s.compact()
    s.compact()
    s.validate()
    assert (s.n_faces, s.n_edges) == (0, 0)


def test_a_remapping_knows_no_edge_before_the_first(name: str) -> None:
    s = structures.build(name, hem.generate("grid", 25))
    s.collapse_edge(collapsible(s))
    remapping = s.compact()
    assert remapping.edges([-1, -5, 1 << 40]).tolist() == [-1, -1, -1]
    assert remapping.edges([]).tolist() == []
    for wrong in ([0.5], ["0"], 0, [[0]], [True]):
        with pytest.raises(MeshError, match="handles"):
            remapping.edges(wrong)


@pytest.mark.parametrize("name", WALKED)
def test_either_half_edge_names_its_edge(name: str) -> None:
    s: Any = structures.build(name, hem.generate("torus", 100))
    for edge in s.edges()[::9].tolist():
        for query in ("edge_vertices", "edge_edges", "edge_faces"):
            answer, same = (getattr(s, query)(it) for it in (edge, other_name(s, edge)))
            assert sorted(same.tolist()) == sorted(answer.tolist()), query


def test_every_face_of_a_cube_is_split_at_its_middle() -> None:
    s = plankton(CUBE)
    new = s.split_all_faces()
    s.validate()
    assert (s.n_vertices, s.n_faces) == (14, 24)
    assert sorted(map(tuple, s.points[new].tolist())) == sorted(
        tuple(0.5 if i != axis else float(side) for i in range(3))
        for axis in range(3)
        for side in (0, 1)
    )


def test_a_mesh_that_once_had_a_quad_is_rendered() -> None:
    s = plankton(CUBE)
    with pytest.raises(MeshError, match="triangles only"):
        hem.RenderMesh(s)
    s.split_all_faces()
    assert hem.RenderMesh(s).to_triangles().summary().faces == 24
    s.compact()
    assert s.most_corners == 3


def test_a_render_mesh_that_meets_a_polygon_follows_no_longer() -> None:
    s = plankton(CUBE)
    s.split_all_faces()
    shown = hem.RenderMesh(s)
    edge = int(s.edges()[0])
    with pytest.raises(MeshError, match="no longer"):
        s.split_edge(edge, (0, 0, 0), triangles=False)
    s.validate()
    faces = shown.to_triangles().summary().faces
    s.split_face(int(s.faces()[-1]), (0, 0, 0))
    assert shown.to_triangles().summary().faces == faces


def test_a_triangle_in_the_notch_of_a_pentagon_loses_its_edge() -> None:
    points = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 0]]
    for a, b in ((1, 4), (0, 4)):
        s = plankton(hem.PolygonMesh(points, [[1, 4, 0], [1, 2, 3, 0, 4]]))
        edge = s.find_edge(a, b)
        assert edge is not None
        assert s.can_collapse_edge(edge)
        s.collapse_edge(edge, a)
        s.validate()
        assert sorted(s.to_polygons().faces[0].tolist()) == [0, 1, 2, 3]


def test_listeners_of_a_render_mesh_are_all_called_and_end_more_than_once() -> None:
    s = structures.build("half_edge", hem.generate("torus", 100))
    shown, heard = hem.RenderMesh(s), []

    def fails(upload: Any) -> None:
        raise ValueError("the first one fails")

    end = shown.subscribe(fails)
    shown.subscribe(heard.append)
    with pytest.raises(ValueError, match="first one"):
        s.split_face(0, (0, 0, 0))
    assert len(heard) == 1
    end()
    end()
    s.split_face(0, (0, 0, 0))
    assert len(heard) == 2


def test_who_listens_twice_is_told_once_after_ending_one_of_them_twice() -> None:
    s, heard = structures.build("half_edge", hem.generate("torus", 100)), []
    ends = [s.subscribe(heard.append) for _ in "12"]
    ends[0]()
    ends[0]()
    s.split_face(0, (0, 0, 0))
    assert len(heard) == 1
    ends[1]()
    s.split_face(0, (0, 0, 0))
    assert len(heard) == 1


def test_offsets_that_do_not_fit_are_refused() -> None:
    for offsets in ([0, 5], [1, 3], [], [0, 5, 3], [0, 2, 1, 3], [[0, 3]], [0.0, 3.0]):
        rows = Ragged(np.array(offsets), np.array([0, 1, 2]))
        with pytest.raises(MeshError, match=r"offsets|three corners"):
            hem.PolygonMesh(np.eye(3), rows)
    of_lists: Any = [0, 3], [0, 1, 2]
    assert hem.PolygonMesh(np.eye(3), Ragged(*of_lists)).faces.to_list() == [[0, 1, 2]]


def test_what_is_written_to_the_points_moves_vertices_or_is_refused(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    if s.points.flags.writeable:
        s.points[7] = 1, 2, 3
        assert s.points[7].tolist() == s.to_triangles().points[7].tolist() == [1, 2, 3]
    else:
        with pytest.raises(ValueError, match="read-only"):
            s.points[7] = 1, 2, 3
    assert len(s.vertex_faces(7))
    s.validate()


def test_an_answer_keeps_little_alive_beside_itself(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 100))
    s.vertex_faces()
    s._state._valence_counted = s.records.counts[VALENCE] = 20_000  # as after so many flips
    for query in QUERIES.values():
        handles = s.handles(query.source)
        for asked in (handles[:1], handles):
            values = getattr(s, query.name)(asked).values
            owner = values if values.base is None else values.base
            assert owner.nbytes <= max(2 * values.nbytes, 1 << 16), query.name


ALGORITHM = """
from typing import NamedTuple
import numpy as np
from hem.authoring import kernel

class Plan(NamedTuple):
    room: np.ndarray

def first(queries, operations):
    @kernel
    def algorithm(m, plan):
        return 1
    return algorithm

def second(queries, operations):
    @kernel
    def algorithm(m, plan):
        return 2
    return algorithm

def closing_over(number):
    def make(queries, operations):
        @kernel
        def algorithm(m, plan):
            return number
        return algorithm
    return make
"""


@pytest.mark.parametrize("process", [1, 2])
def test_algorithms_of_one_name_are_told_apart(
    process: int, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path_factory.getbasetemp() / "algorithms_of_one_name"
    folder.mkdir(exist_ok=True)
    (folder / "algorithms.py").write_text(ALGORITHM)
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.delitem(sys.modules, "algorithms", raising=False)
    made = importlib.import_module("algorithms")
    s = structures.build("half_edge", hem.generate("grid", 9))
    plan = made.Plan(np.zeros(1))
    makers = (made.first, made.second, made.closing_over(3), made.closing_over(4))
    assert [s.run(make, plan) for make in makers] == [1, 2, 3, 4]


def test_what_is_taken_beside_the_elements_is_told(name: str) -> None:
    s = structures.build(
        name, hem.generate("torus", 10_000 if name != "half_edge_objects" else 900)
    )
    bare = sum(s.memory().values())
    s.collapse_edge(collapsible(s))
    s.vertex_faces(5)
    beside = s.memory(room=True)
    assert {it: beside[it] for it in s.memory()} == s.memory()
    assert 0 < beside["scratch"] < bare / 10
    arrays = sum(array.nbytes for array in s.records) if s.compiled else 0
    live = sum(s.memory(names=True).values())
    assert beside["dead and room to grow"] == (arrays - live if s.compiled else 8 * (1 + 2 + 6))


def test_no_edit_after_reserve_makes_room(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    s = structures.build(name, hem.generate("torus", 400))
    s.reserve(50)

    def unexpected(*_: Any) -> None:
        raise AssertionError("room is made")

    monkeypatch.setattr(s._operations, "make_way", unexpected)
    s.split_face(0, (0, 0, 0))
    s.flip_edge(int(s.edges()[40]))
    for _ in range(24):
        s.split_edge(int(s.edges()[7]), (0, 0, 0))
        s.collapse_edge(collapsible(s))


def test_the_first_splits_move_no_record_and_what_was_read_is_read_on(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 1_600))
    for own in (s, s.copy()):
        before, points = [it.ctypes.data for it in own.arrays], own.points
        new = own.split_faces(range(100), np.ones((100, 3)))
        if own.compiled:
            assert [it.ctypes.data for it in own.arrays] == before
            own.move_vertex(3, (7, 8, 9))
            assert points[3].tolist() == [7, 8, 9]
        assert new.tolist() == list(range(1_600, 1_700))
        own.validate()


@pytest.mark.parametrize(
    "name", [it for it in structures.NAMES if structures.REGISTRY[it].compiled]
)
def test_a_pickle_holds_no_room(name: str) -> None:
    s = structures.build(name, hem.generate("torus", 1_600))
    assert len(pickle.dumps(s)) < sum(s.memory(names=True).values()) + 10_000


def test_a_mesh_that_has_grown_is_not_restored_by_half(name: str) -> None:
    s = structures.build(name, octahedron())
    before, fresh = s.n_faces, s.snapshot()
    for _ in range(50):
        s.split_face(int(s.faces()[0]), (0, 0, 0))
    after = faces_of(s)
    if s.compiled:
        with pytest.raises(MeshError, match="grown since the snapshot"):
            s.restore(fresh)
        assert faces_of(s) == after
    else:  # objects have no room
        s.restore(fresh)
        assert s.n_faces == before
    s.validate()


@pytest.mark.parametrize("operation", ["split_face", "flip_edge", "remove_face"])
def test_what_is_counted_uncompiled_counts_edges_and_names_vertices(name: str, operation) -> None:
    s, heard = structures.build(name, hem.generate("torus", 100)), []
    s.subscribe(heard.append)
    handle = 0
    if operation == "flip_edge":
        handle = next(int(e) for e in s.edges() if s.can_flip_edge(int(e)))
    s.operation_work(operation, handle)
    assert s.n_edges == len(s.edges())
    assert heard[0].vertex == (100 if operation == "split_face" else -1)
