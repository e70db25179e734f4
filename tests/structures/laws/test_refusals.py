"""What may not be done is refused with its reason and elements, and nothing has changed."""

from __future__ import annotations

from functools import partial
from itertools import combinations

import numpy as np
import pytest

import hem
import structures
from hem.authoring.kernels import VALENCE
from hem.contract import QUERIES
from hem.edit import CHANGED, FACE, VERTEX
from hem.errors import TopologyError
from tests.structures.conftest import (
    HOLDS_ANYTHING,
    NEEDS_MANIFOLD,
    OF_ARRAYS,
    WALKED,
    octahedron,
    other_name,
    strip,
)
from tests.structures.histories.actions import faces_of
from tests.structures.laws.test_operations import TETRAHEDRON

PLANE = np.random.default_rng(1).random((12, 3))
SQUARE = [(0, 1, 2), (0, 2, 3)]
RING = [(0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]
"""A triangular tube 0 1 2 – 3 4 5, open at both ends."""

PILLOW = [(0, 1, 2), (0, 2, 1)]

BOOK = [(0, 1, 2), (1, 0, 3), (0, 1, 4)]
"""Three faces at edge 0 – 1, which only an indexed mesh can hold."""

FAN = [(0, 1, 2), (0, 2, 3), (0, 3, 4)]

CLOSED_AND_APART = [*PILLOW, (3, 4, 5)]
"""A pillow, and a triangle beside it."""

CASES = {
    "collapse in a tetrahedron": (TETRAHEDRON, "collapse_edge", (0, 1), "tetrahedron"),
    "collapse across a tube": (RING, "collapse_edge", (0, 1), "common neighbor"),
    "collapse between two borders": (SQUARE, "collapse_edge", (0, 2), "its other two edges"),
    "collapse of a strip's rung": (strip(4).triangles, "collapse_edge", (2, 3), "both ends lie"),
    "collapse of a lone triangle": ([(0, 1, 2)], "collapse_edge", (0, 1), "other two edges"),
    "collapse with a foreign keep": (octahedron().triangles, "collapse_edge", (0, 1, 5), "not an"),
    "collapse in a pillow": (PILLOW, "collapse_edge", (0, 1), "same three corners"),
    "flip in a pillow": (PILLOW, "flip_edge", (0, 1), "same three corners"),
    "flip on the border": (SQUARE, "flip_edge", (0, 1), "no second face"),
    "flip onto an edge": (TETRAHEDRON, "flip_edge", (0, 1), "joined by an edge already"),
    "add a face with a corner twice": (SQUARE, "add_face", (0, 1, 1), "three different"),
    "add a face that is there": (SQUARE, "add_face", (0, 1, 2), "lies a face already"),
    "add a face from behind": ([(0, 1, 2)], "add_face", (0, 2, 1), "these three corners"),
    "add a face on a full edge": (SQUARE, "add_face", (0, 2, 4), "lies a face already"),
    "add a second fan": (SQUARE, "add_face", (0, 4, 5), "two fans"),
    "remove from within a fan": (FAN, "remove_face", (1,), "between two others"),
}


def call(s: structures.Structure, operation: str, elements: tuple[int, ...]) -> None:
    if operation in ("add_face", "remove_face"):
        getattr(s, operation)(*elements)
    else:
        a, b, *keep = elements
        getattr(s, operation)(s.find_edge(a, b), *keep)


def test_no_edge_of_a_pillow_is_split_and_no_other_in_the_same_batch(name):
    s = structures.build(name, hem.TriangleMesh(PLANE, CLOSED_AND_APART))
    edges, before = [s.find_edge(3, 4), s.find_edge(1, 2)], faces_of(s)
    with pytest.raises(hem.TopologyError, match="same three corners"):
        s.split_edge(edges[1], (0, 0, 0))
    with pytest.raises(hem.TopologyError, match="same three corners"):
        s.split_edges(edges, np.zeros((2, 3)))
    assert faces_of(s) == before
    s.validate()
    s.split_edges(edges[:1], np.zeros((1, 3)))
    s.validate()


@pytest.mark.parametrize("case", CASES)
def test_a_refusal_says_why_and_changes_nothing(name, case):
    triangles, operation, elements, words = CASES[case]
    s, heard = structures.build(name, hem.TriangleMesh(PLANE, triangles)), []
    s.subscribe(heard.append)
    s.vertex_faces()  # finds what is found when first asked
    before = [array.copy() for array in s.arrays]
    counts = (s.n_vertices, s.n_edges, s.n_faces)
    with pytest.raises(hem.TopologyError, match=words) as refusal:
        call(s, operation, elements)
    assert refusal.value.elements
    assert str(refusal.value).startswith(f"cannot {operation}")
    assert (s.n_vertices, s.n_edges, s.n_faces) == counts
    used = [array[: len(kept)] for array, kept in zip(s.arrays, before, strict=True)]
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(used, before, strict=True))
    assert not heard
    if operation in ("collapse_edge", "flip_edge") and len(elements) == 2:
        assert not getattr(s, f"can_{operation}")(s.find_edge(*elements))
    s.validate()


def test_the_extra_common_neighbor_is_named(name):
    s = structures.build(name, hem.TriangleMesh(PLANE, RING))
    with pytest.raises(hem.TopologyError) as refusal:
        s.collapse_edge(s.find_edge(0, 1))
    assert refusal.value.elements["edges"].tolist() == [[0, 1]]
    assert refusal.value.elements["vertices"].tolist() == [2]


@pytest.mark.parametrize("faces", [BOOK, [(0, 1, 2), (0, 1, 3)], [(1, 0, 2), (1, 0, 3)]])
@pytest.mark.parametrize("name", HOLDS_ANYTHING)
def test_an_edge_that_no_surface_has_is_refused_by_the_mesh_that_can_hold_it(name, faces):
    s = structures.build(name, hem.TriangleMesh(PLANE, faces))
    for operation in (s.flip_edge, s.collapse_edge, lambda e: s.split_edge(e, (0, 0, 0))):
        with pytest.raises(hem.TopologyError, match="more faces than a surface"):
            operation(s.find_edge(0, 1))


OPERATIONS = {
    "split_edge": lambda s, h: s.split_edge(h, (0, 0, 0)),
    "collapse_edge": lambda s, h: s.collapse_edge(h),
    "flip_edge": lambda s, h: s.flip_edge(h),
    "can_collapse_edge": lambda s, h: s.can_collapse_edge(h),
    "can_flip_edge": lambda s, h: s.can_flip_edge(h),
    "split_edges": lambda s, h: s.split_edges([h], [(0, 0, 0)]),
    "split_face": lambda s, h: s.split_face(h, (0, 0, 0)),
    "split_faces": lambda s, h: s.split_faces([h], [(0, 0, 0)]),
    "remove_face": lambda s, h: s.remove_face(h),
    "remove_faces": lambda s, h: s.remove_faces([h]),
    "remove_vertex": lambda s, h: s.remove_vertex(h),
    "move_vertex": lambda s, h: s.move_vertex(h, (0, 0, 0)),
    "add_face": lambda s, h: s.add_face(h, 1, 2),
    "add_face, second corner": lambda s, h: s.add_face(0, h, 2),
    "add_face, third corner": lambda s, h: s.add_face(0, 2, h),
}


@pytest.mark.parametrize("operation", OPERATIONS)
def test_a_dead_or_foreign_handle_is_refused(name, operation):
    s = structures.build(name, octahedron())
    gone = s.find_edge(0, 1)
    edit = s.collapse_edge(gone, keep=0)
    dead = {"edge": gone, "face": int(edit.removed_faces[0])}
    dead |= {"faces": dead["face"], "edges": gone, "vertex": 1}
    kind = operation.rpartition("_")[2] if "add_face" not in operation else "vertex"
    before = faces_of(s)
    for handle in (dead[kind], -1, 10_000, 2**40, -(2**40)):
        with pytest.raises(hem.TopologyError, match="no such"):
            OPERATIONS[operation](s, handle)
    assert faces_of(s) == before


@pytest.mark.parametrize("operation", OPERATIONS)
def test_on_a_mesh_without_faces_there_is_nothing_to_operate_on(name, operation):
    for points in ([], np.eye(3)):
        s = structures.build(name, hem.TriangleMesh(points, []))
        with pytest.raises(hem.TopologyError, match="no such"):
            OPERATIONS[operation](s, 7)
        assert not s.collapse_edges([0, 7]).any()
        s.validate()


@pytest.mark.parametrize("operation", OPERATIONS)
def test_what_is_no_handle_is_refused(name, operation):
    s = structures.build(name, octahedron())
    s.remove_face(0)
    s.add_face(*octahedron().triangles[0].tolist())  # no corner of it is taken for one left out
    before = s.copy()
    for wrong in (1.5, "7", None, 2**70, True, [0], np.array([0])):
        with pytest.raises(hem.MeshError, match=r"handle|no such"):
            OPERATIONS[operation](s, wrong)
        assert s.same_as(before), wrong


@pytest.mark.parametrize("wrong", [1.5, "7", None, 2**63, 2**70, True, [1], np.array([1]), -1, 99])
def test_what_is_no_vertex_has_no_edge_and_no_face(name, wrong):
    s = structures.build(name, octahedron())
    for corners in ((wrong, 1), (1, wrong)):
        with pytest.raises(hem.MeshError, match="vertex"):
            s.find_edge(*corners)
    for corners in ((wrong, 1, 2), (0, wrong, 2), (0, 1, wrong)):
        with pytest.raises(hem.MeshError, match="vertex"):
            s.find_face(*corners)


def test_no_operation_takes_what_is_left_out_from_the_one_before(name):
    s = structures.build(name, hem.generate("torus", 100))
    a, b = s.edge_array()[0].tolist()
    s.collapse_edge(s.find_edge(a, b), keep=a)
    edge = next(it for it in s.edges().tolist()[::-1] if s.can_collapse_edge(it))
    for keep in (-1, -2):
        with pytest.raises(hem.TopologyError, match="not an end"):
            s.operate("collapse_edge", edge, keep)
    assert s.operate("collapse_edge", edge).removed_vertices.size == 1
    for corners in ((0, 1, 2, 3), ()):
        with pytest.raises(hem.MeshError, match="one to three"):
            s.operation_work("add_face", *corners)


@pytest.mark.parametrize(
    "point",
    [
        (1, 2),
        (1, 2, 3, 4),
        None,
        "abc",
        (np.nan, 0, 0),
        (0, 0, np.nan),
        7,
        np.inf * np.ones(3),
        [[1, 2, 3]],
    ],
)
def test_what_is_no_position_is_refused(name, point):
    s = structures.build(name, octahedron())
    before = faces_of(s), s.points.copy()
    # To Plankton an integer is another half-edge, to which the face is to be cut.
    refused = hem.TopologyError if name == "plankton" and isinstance(point, int) else hem.MeshError
    for operation in (s.split_face, s.split_edge, s.move_vertex):
        with pytest.raises((hem.MeshError, refused)):
            operation(int(s.edges()[0]) if operation == s.split_edge else 0, point)
    for operation in (s.split_faces, s.split_edges, s.move_vertices):
        with pytest.raises(hem.MeshError):
            operation([int(s.edges()[0]) if operation == s.split_edges else 0], [point, point])
    assert faces_of(s) == before[0]
    assert np.array_equal(s.points, before[1])


@pytest.mark.parametrize("wrong", [np.nan, -np.inf, 1e300])
def test_one_position_that_is_not_finite_refuses_its_batch_and_is_named(name, wrong):
    s, points = structures.build(name, octahedron()), np.zeros((3, 3))
    before, points[1, 2] = s.copy(), wrong
    edges, many = s.edges()[:3], [0, 1, 2]
    for operate, at in ((s.split_faces, many), (s.split_edges, edges), (s.move_vertices, many)):
        with pytest.raises(hem.MeshError, match="must be finite") as refused:
            operate(at, points)
        assert refused.value.elements["rows"].tolist() == [1]
        assert s.same_as(before)


def test_a_batch_is_done_as_a_whole_or_not_at_all(name):
    s = structures.build(name, octahedron())
    before, edges = faces_of(s), s.edges()[:3].tolist()
    points = np.zeros((4, 3))
    for handles in ([0, 1, 2, 99], [0, 1, 2, 2]):
        with pytest.raises(hem.TopologyError):
            s.split_faces(handles, points)
    for last in (10_000, edges[0]):
        with pytest.raises(hem.TopologyError):
            s.split_edges([*edges, last], points)
    with pytest.raises(hem.MeshError, match="one point per handle"):
        s.split_faces([0, 1], points)
    assert faces_of(s) == before
    assert s.split_faces([], []).tolist() == []
    assert s.collapse_edges([]).tolist() == []


@pytest.mark.parametrize("name", WALKED)
def test_both_names_of_an_edge_are_one_edge_to_a_batch(name):
    s = structures.build(name, octahedron())
    e = int(s.edges()[0])
    with pytest.raises(hem.TopologyError, match="each once"):
        s.split_edges([e, other_name(s, e)], np.zeros((2, 3)))


def test_a_query_for_what_is_dead_is_refused(name):
    s = structures.build(name, octahedron())
    edge = s.find_edge(0, 1)
    edit = s.collapse_edge(edge, keep=0)
    for query in ("vertex_faces", "vertex_vertices", "vertex_edges"):
        for handles in (1, [0, 1]):
            with pytest.raises(hem.MeshError, match="no such vertex"):
                getattr(s, query)(handles)
    for query in ("face_vertices", "face_edges", "face_faces"):
        for handles in (int(edit.removed_faces[0]), edit.removed_faces):
            with pytest.raises(hem.MeshError, match="no such face"):
                getattr(s, query)(handles)
    for query in ("edge_edges", "edge_faces"):
        for handles in (edge, [edge]):
            with pytest.raises(hem.MeshError, match="no such edge"):
                getattr(s, query)(handles)


@pytest.mark.parametrize("name", [it for it in NEEDS_MANIFOLD if it in OF_ARRAYS])
def test_a_dead_record_that_something_refers_to_is_found(name):
    s = structures.build(name, octahedron())
    s.collapse_edge(s.find_edge(0, 1), keep=0)
    of_vertex = s.records[1]
    of_vertex[1] = of_vertex[0]
    with pytest.raises(hem.MeshError, match="broken invariant"):
        s.validate()


@pytest.mark.parametrize("query", QUERIES)
def test_no_foreign_handle_reaches_compiled_code(name, query):
    s = structures.build(name, octahedron())
    source = QUERIES[query].source
    for handle in (-1, 10_000, 10**9, 2**40, -(2**40)):
        for ask in (getattr(s, query), partial(s.sweep, query), partial(s.work, query)):
            for handles in ([handle], np.append(s.handles(source), handle)):
                with pytest.raises(hem.MeshError, match=f"no such {source}"):
                    ask(handles)
    for wrong in ([0.5], ["7"], [[0]]):
        with pytest.raises(hem.MeshError, match="1-D array of integers"):
            s.sweep(query, wrong)


EDITS = {
    "a collapse": lambda s: s.collapse_edge(s.find_edge(0, 1), keep=0),
    "growth": lambda s: s.split_face(0, (0, 0, 0)),
    "much growth": lambda s: [s.split_face(0, (0, 0, 0)) for _ in range(40)],
    "a filled hole": lambda s: s.add_face(0, 1, 2),
    "a compaction": lambda s: s.compact(),
}


@pytest.mark.parametrize("edit", EDITS)
def test_a_sweep_is_not_run_once_the_mesh_was_edited(name, edit):
    s = structures.build(name, octahedron())
    if edit in ("a filled hole", "a compaction"):
        s.remove_face(0)
    sweep = s.prepare_sweep("vertex_faces", s.vertices())
    assert (
        sweep.run()
        == sweep.successive(0, s.n_vertices).run()
        == s.sweep("vertex_faces", s.vertices())
    )
    EDITS[edit](s)
    with pytest.raises(hem.MeshError, match="was edited"):
        sweep.run()
    faces = s.faces()
    s.remove_faces(faces)
    with pytest.raises(hem.MeshError, match="no such face"):
        s.sweep("face_vertices", faces)


def test_operations_are_prepared_by_their_first_handle_or_all_three(name):
    s = structures.build(name, octahedron())
    edges = s.edges()
    whole = np.stack([edges, *2 * [np.full_like(edges, -1)]], axis=1)
    assert s.prepare("flip_edge", edges).check().all()
    assert s.prepare("flip_edge", whole).check().all()
    for wrong in (whole[:, :1], whole[:, :2], whole[None], edges + 0.5, ["0"], 0):
        with pytest.raises(hem.MeshError, match=r"takes .*handles"):
            s.prepare("flip_edge", wrong)
    foreign = np.array([-1, 10_000, 10**9, 2**40])
    assert not s.prepare("split_edge", foreign, np.zeros((4, 3))).check().any()


@pytest.mark.parametrize("element", ["vertices", "faces"])
def test_nothing_foreign_is_copied_for_a_render_mesh(name, element):
    s = structures.build(name, octahedron())
    points, indices = np.full((6, 3), 7.0, np.float32), np.full((8, 3), 7, np.int32)
    what = {"vertices": VERTEX, "faces": FACE}[element] + CHANGED
    for index in (-1, 8, 10**9, 2**40):
        with pytest.raises(hem.MeshError, match="no row") as refused:
            s.copy_touched([index << 3 | what], points, indices)
        assert refused.value.elements[element].tolist() == [index]
    for arrays in ((points[:, :2], indices), (points, indices[:, :2]), (points[:0], indices[:0])):
        with pytest.raises(hem.MeshError, match="no row"):
            s.copy_touched([0 << 3 | what], *arrays)
    assert (points == 7).all()
    assert (indices == 7).all()


def fans_on_edges(blades: int = 20, ends: int = 4) -> hem.TriangleMesh:
    """A chain of vertices, each with as many faces at once as every two of its neighbors make."""
    sets = [range(ends + blades * i, ends + blades * (i + 1)) for i in range(ends)]
    faces = [(h, a, b) for h in range(ends) for a, b in combinations(sets[h], 2)]
    for h in range(ends - 1):
        faces += [(h, h + 1, sets[h][0]), (h + 1, h, sets[h][1])]
    points = np.random.default_rng(0).random((ends + blades * ends, 3))
    return hem.TriangleMesh(points, faces)


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
def test_a_vertex_with_more_faces_than_neighbors_is_collapsed_within_its_scratch(name):
    s = structures.build(name, fans_on_edges(), compiled=False)  # bounds are checked
    for h in range(3):
        s.collapse_edge(s.find_edge(h, h + 1), keep=h + 1)
        assert len(s.vertex_faces(h + 1)) <= s.records.counts[VALENCE]
    s.validate()


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
def test_an_edge_of_another_face_that_runs_the_same_way_stays(name):
    mesh = hem.TriangleMesh(np.random.default_rng(0).random((4, 3)), [(0, 1, 2), (0, 1, 3)])
    for remove in (lambda s: s.remove_face(0), lambda s: s.remove_faces([0])):
        s = structures.build(name, mesh)
        remove(s)
        assert s.n_edges == len(s.edges()) == 3


def test_what_takes_a_point_is_not_prepared_without(name):
    s = structures.build(name, octahedron())
    before = s.copy()
    for operation, handle in (("split_face", 0), ("split_edge", int(s.edges()[0]))):
        with pytest.raises(hem.MeshError, match="one point per handle"):
            s.prepare(operation, [handle])
    for operation in ("split_face", "move_vertex"):
        s.prepare(operation, np.zeros(0, np.int64)).run()
    assert s.same_as(before)


@pytest.mark.parametrize(
    "point", [(1, 2), "a", None, (np.nan, 0, 0), [[1, 2, 3]], 7, (1e300, 0, 0)]
)
def test_no_work_is_counted_at_what_is_no_position(name, point):
    s = structures.build(name, octahedron())
    before = s.copy()
    for operation in ("split_face", "move_vertex"):
        with pytest.raises(hem.MeshError):
            s.operation_work(operation, 0, point=point)
    assert s.same_as(before)


@pytest.mark.parametrize("wrong", [10**19, 2**31, -1, 1.5, "7", None, True])
def test_room_is_made_for_a_number_of_splits(name, wrong):
    s = structures.build(name, octahedron())
    with pytest.raises(hem.MeshError, match="reserve takes a number"):
        s.reserve(wrong)


@pytest.mark.parametrize("reference_bytes", [4, 8])
def test_no_room_is_made_for_more_than_indices_can_name(name, reference_bytes):
    s = structures.build(name, octahedron(), reference_bytes)
    for splits in (2**31 - 1, 2**30):
        with pytest.raises(hem.MeshError, match="can name"):
            s.reserve(splits)
    s.validate()


def test_all_fields_are_checked_before_any_takes_memory(monkeypatch):
    def none_left(*_):
        raise MemoryError

    s = structures.build("half_edge", octahedron())
    monkeypatch.setattr("hem.authoring.records.longer", none_left)
    with pytest.raises(hem.MeshError, match=r"can name; build with reference_bytes=8"):
        s.reserve(2**30 - 9)  # as many faces as handles can name, and three times as many records
    s.validate()


def test_more_handles_than_an_operation_can_take_are_refused(name):
    s = structures.build(name, octahedron())
    with pytest.raises(hem.MeshError, match="add_face takes three handles at most, not 4"):
        s.operate("add_face", 0, 1, 2, 3)


def test_a_vertex_that_names_none_is_not_told_by_another_number(name):
    s = structures.build(name, octahedron())
    with pytest.raises(TopologyError, match="end") as refused:
        s.collapse_edge(int(s.edges()[0]), keep=-1)
    assert "-2" not in str(refused.value)
    with pytest.raises(TopologyError, match="no such vertex") as refused:
        s.operate("add_face", 0, 1, -1)
    assert refused.value.elements["vertices"].tolist() == [0, 1, -1]


def test_a_refusal_names_the_method_that_was_called():
    s = structures.build("plankton", hem.generate("torus", 100))
    h = s.face_half_edges(0)
    with pytest.raises(TopologyError, match="cannot split_face"):
        s.split_face(int(h[0]), int(h[1]))


def test_rows_of_several_lengths_and_numbers_beyond_all_are_mesh_errors() -> None:
    s = structures.build("half_edge", hem.generate("grid", 9))
    for ask in (s.vertex_faces, s.is_border, s.collapse_edges, s.remove_faces):
        with pytest.raises(hem.MeshError):
            ask([[1], [2, 3]])
    with pytest.raises(hem.MeshError, match="points as 1 rows of three numbers"):
        s.split_faces([0], [(10**400, 0, 0)])
