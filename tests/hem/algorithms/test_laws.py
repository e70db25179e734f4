"""What holds for every algorithm: it gives the same everywhere, and all that follows is in step."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from hem.algorithms import parts
from hem.algorithms.loop import Plan, splitting
from hem.algorithms.parts import NO_WORK, change
from hem.contract import Navigable, Structure
from tests.extent import EVERYTHING, OF_EACH_KIND
from tests.hem.algorithms.meshes import MESHES, dented, used
from tests.structures.conftest import HOLDS_ANYTHING

ALGORITHMS: dict[str, Callable[[Structure], Any]] = {
    **algorithms.SIX,
    "vertex normals": algorithms.vertex_normals,
    "taubin": lambda s: algorithms.smooth(s, 2, "taubin"),
    "loop": lambda s: algorithms.subdivide(s, "loop"),
    "quadrics": lambda s: algorithms.simplify(s, vertices=30),
    "shortest edge": lambda s: algorithms.simplify(s, faces=80, by="shortest_edge"),
    "remesh": lambda s: algorithms.remesh(s, 0.6, iterations=2),
    "impacts": lambda s: algorithms.impacts(s, s.faces()[::3] if isinstance(s, Structure) else []),
    "sqrt3 twice": lambda s: algorithms.subdivide(s, "sqrt3", times=2),
}
CHANGING = [it for it in ALGORITHMS if it not in ("circulator", "normals", "vertex normals")]
MOVING = "barycenter", "smoothing", "taubin"  # in one step
DONE_BY_ALL = "circulator", "smoothing", "collapse", *(["loop"] if EVERYTHING else [])
"""Of each kind: what asks, moves, splits and collapses; where nobody waits what flips, too."""


def is_done(algorithm: str, name: str) -> bool:
    """Whether a structure does it here: compiling all algorithms for several takes too long."""
    all_of_them = EVERYTHING or name == "half_edge" or not structures.REGISTRY[name].compiled
    return all_of_them or algorithm in DONE_BY_ALL


EACH_WITH_EACH_KIND = [
    (name, it)
    for name in OF_EACH_KIND
    for it in CHANGING
    if it in DONE_BY_ALL or name == "half_edge"
]


def corners_of(s: Structure) -> list[tuple[int, ...]]:
    """The corners of every live face, from the smallest on."""
    rows = s.triangles().tolist()
    return [tuple(row[(i := row.index(min(row))) :] + row[:i]) for row in rows]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("mesh", MESHES)
def test_every_structure_gives_the_same_to_the_last_bit(algorithm: str, mesh: str) -> None:
    expected = None
    for name in [it for it in OF_EACH_KIND if is_done(algorithm, it)]:
        s = used(name, MESHES[mesh]())
        told = ALGORITHMS[algorithm](s)
        s.validate()
        found = told, s.points.copy(), s.faces(), corners_of(s)
        expected = expected or found
        for mine, others in zip(found, expected, strict=True):
            assert np.array_equal(mine, others, equal_nan=mine is not None), name


@pytest.mark.parametrize(("name", "algorithm"), EACH_WITH_EACH_KIND)
def test_who_follows_is_in_step(algorithm: str, name: str) -> None:
    s = used(name, MESHES["grid"]())
    ids = s.vertex_attribute("id", np.int64, on_split="default", default=-1)
    ids[s.vertices()] = s.vertices()
    render = hem.RenderMesh(s)
    before = len(s.points)
    ALGORITHMS[algorithm](s)
    afresh = hem.RenderMesh(s)
    assert np.array_equal(render.points, afresh.points)
    assert np.array_equal(render.indices, afresh.indices)
    if algorithm != "collapse":  # which compacts
        old = s.vertices()[s.vertices() < before]
        assert np.array_equal(ids[old], old)


@pytest.mark.parametrize(("name", "algorithm"), EACH_WITH_EACH_KIND)
def test_a_copy_is_changed_and_the_original_is_not(algorithm: str, name: str) -> None:
    s = structures.build(name, MESHES["torus"]())
    before, copy = s.copy(), s.copy()
    ALGORITHMS[algorithm](copy)
    assert s.same_as(before)


@pytest.mark.parametrize("algorithm", CHANGING)
def test_an_algorithm_that_is_counted_does_what_it_does_otherwise(algorithm: str) -> None:
    plain, counted = (structures.build("half_edge", dented("grid", 64)) for _ in "12")
    ALGORITHMS[algorithm](plain)
    with hem.record(counted) as recording:
        ALGORITHMS[algorithm](counted)
    assert counted.same_as(plain)
    assert any(it.times for it in recording.rows)


def follow(edit: hem.Edit, s: Structure, one: Structure) -> None:
    """Do the single operation that an edit of s tells of to another structure."""

    def edge_between(a: int, b: int) -> int:
        edge = one.find_edge(a, b)
        assert edge is not None
        return edge

    if edit.remapping is not None:
        one.compact()
        return
    changed, removed = edit.changed_faces, edit.removed_vertices.tolist()
    for v, parents in zip(edit.created_vertices.tolist(), edit.vertex_parents, strict=True):
        if len(parents) == 3:
            assert one.split_face(int(edit.face_parents[0]), s.points[v]).vertex == v
        else:
            assert one.split_edge(edge_between(*parents.tolist()), s.points[v]).vertex == v
    for v in removed:
        new = np.setdiff1d(s.face_vertices(changed).values, one.face_vertices(changed).values)
        (left,) = (new if len(new) else edit.changed_vertices).tolist()
        one.collapse_edge(edge_between(v, left), keep=left)
    if len(changed) and not removed and not len(edit.created_vertices):
        left, right = one.face_vertices(changed)
        one.flip_edge(edge_between(*np.intersect1d(left, right).tolist()))
    moved = edit.changed_vertices
    one.move_vertices(moved, s.points[moved])


@pytest.mark.parametrize(("name", "element", "algorithm"), [
    *(("half_edge", "corner", it) for it in CHANGING if it != "sqrt3 twice"),
    *(("half_edge", "half_edge", it) for it in ("quadrics", "shortest edge", "impacts")),
    ("half_edge_objects", "corner", "quadrics"),
])  # fmt: skip
def test_values_at_a_seam_are_those_that_single_operations_give(
    algorithm: str, element: str, name: str
) -> None:
    many, one = (structures.build(name, MESHES["grid"]()) for _ in "12")
    values = []
    for s in (many, one):
        values.append(getattr(s, f"{element}_attribute")("value", np.int64))
        assert isinstance(s, Navigable)
        handles = s.faces() if element == "corner" else s.half_edges()
        size = values[-1][handles].size
        values[-1][handles] = np.random.default_rng(5).permutation(size)
    many.subscribe(lambda edit: follow(edit, many, one))
    ALGORITHMS[algorithm](many)
    assert np.array_equal(many.triangles(), one.triangles())
    assert np.array_equal(values[0].values, values[1].values)


class Stop(BaseException):
    """An interrupt."""


@pytest.mark.parametrize(("name", "algorithm"), EACH_WITH_EACH_KIND)
def test_an_interrupt_leaves_a_whole_mesh_that_works(algorithm: str, name: str) -> None:
    s = structures.build(name, MESHES["torus"]())
    render = hem.RenderMesh(s)

    def stop(edit: hem.Edit) -> None:
        raise Stop

    end = s.subscribe(stop)
    with pytest.raises(Stop):
        ALGORITHMS[algorithm](s)
    end()
    s.validate()
    assert np.array_equal(render.indices, hem.RenderMesh(s).indices)
    ALGORITHMS[algorithm](s)
    s.validate()


def require_whole(s: structures.Structure, render: hem.RenderMesh, algorithm: str) -> None:
    """After an interrupt a mesh is sound, a render mesh in step, and the algorithm goes on."""
    s.validate()
    afresh = hem.RenderMesh(s)
    assert np.array_equal(render.points, afresh.points)
    assert np.array_equal(render.indices, afresh.indices)
    ALGORITHMS[algorithm](s)
    s.validate()


@pytest.mark.parametrize("algorithm", [it for it in CHANGING if it not in MOVING])
def test_an_interrupt_between_two_steps_leaves_what_was_told(monkeypatch, algorithm: str) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    render, counts, step = hem.RenderMesh(s), [], parts.step

    def stop(*args: Any) -> int:
        counts.append(s.n_faces)
        if len(counts) == 4:
            raise KeyboardInterrupt
        return step(*args)

    monkeypatch.setattr(parts, "STEP", 30)
    monkeypatch.setattr(parts, "step", stop)
    with pytest.raises(KeyboardInterrupt):
        ALGORITHMS[algorithm](s)
    assert len(set(counts)) > 1
    require_whole(s, render, algorithm)


def test_an_interrupt_after_the_last_step_leaves_what_was_told(monkeypatch) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    render, scratch = hem.RenderMesh(s), s.scratch

    def stop(*given: Any) -> Any:
        if given[:2] == (0, 0):  # no more room is wanted
            raise KeyboardInterrupt
        return scratch(*given)

    monkeypatch.setattr(s, "scratch", stop)
    with pytest.raises(KeyboardInterrupt):
        ALGORITHMS["impacts"](s)
    monkeypatch.undo()
    require_whole(s, render, "impacts")


@pytest.mark.parametrize(("change_it", "reached"), [
    (ALGORITHMS["quadrics"], parts.tell),
    (ALGORITHMS["impacts"], parts.tell),
    (lambda s: s.split_all_faces(), hem.Edit.__init__),
    (lambda s: s.collapse_edges(s.edges()[::5]), hem.Edit.__init__),
])  # fmt: skip
def test_an_interrupt_just_before_others_are_told_does_not_keep_it_from_them(
    change_it: Callable[[Structure], Any], reached: Any
) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    render, tracing = hem.RenderMesh(s), sys.gettrace()
    change_it(s.copy())  # compiles, which takes long where it is traced

    def stop(frame: Any, event: str, arg: Any) -> None:
        if frame.f_code is reached.__code__:
            raise KeyboardInterrupt  # once, as this ends the tracing

    try:
        sys.settrace(stop)
        with pytest.raises(KeyboardInterrupt):
            change_it(s)
    finally:
        sys.settrace(tracing)
    s.validate()
    afresh = hem.RenderMesh(s)
    assert s.n_faces != len(MESHES["torus"]().triangles)
    assert np.array_equal(render.points, afresh.points)
    assert np.array_equal(render.indices, afresh.indices)


@pytest.mark.parametrize("scheme", algorithms.SCHEMES)
def test_what_a_subscriber_raises_ends_it_after_the_edit_that_all_are_told_of(scheme: str) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    told: list[hem.Edit] = []

    def fail(edit: hem.Edit) -> None:
        raise ZeroDivisionError

    s.subscribe(fail)
    s.subscribe(told.append)
    render = hem.RenderMesh(s)
    with pytest.raises(ZeroDivisionError):
        algorithms.subdivide(s, scheme)
    s.validate()
    assert len(told) == 1
    assert np.array_equal(render.indices, hem.RenderMesh(s).indices)


@pytest.mark.parametrize("algorithm", ["loop", "sqrt3 twice", "quadrics", "remesh"])
def test_a_subscriber_that_edits_ends_an_algorithm_and_the_mesh_is_whole(algorithm: str) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    s.corner_attribute("any")  # so that every operation is told on its own

    def edit_too(edit: hem.Edit) -> None:
        if edit.kind != "split_face":
            s.split_face(int(s.faces()[-1]), (0, 0, 0))

    s.subscribe(edit_too)
    with pytest.raises(hem.MeshError, match="a subscriber edited the mesh"):
        ALGORITHMS[algorithm](s)
    s.validate()


@pytest.mark.parametrize("algorithm", ["quadrics", "shortest edge"])
def test_an_interrupt_in_the_midst_of_an_operation_leaves_what_was_told(algorithm: str) -> None:
    """Python stops anywhere: here where the first vertex is moved, or the tenth."""
    for nth in (1, 10):
        s = structures.build("half_edge_objects", MESHES["torus"]())
        render, moves = hem.RenderMesh(s), []

        def stop(vertex: Any, moves: list[Any] = moves, nth: int = nth) -> None:
            moves.append(vertex)
            if len(moves) == nth:
                raise Stop

        for vertex in s.records.vertices.items:
            vertex.subscribe(stop)
        with pytest.raises(Stop):
            ALGORITHMS[algorithm](s)
        require_whole(s, render, algorithm)


def test_an_algorithm_that_needs_more_room_than_it_says_is_ended() -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    ends = np.sort(s.edge_array(), axis=1).astype(np.int64)
    points = np.zeros((len(ends), 3), np.float32)
    start = np.array([len(s.points)]), np.zeros(1, np.int64), NO_WORK
    with pytest.raises(hem.MeshError, match="room for 1 split"):
        change(s, "split", splitting, Plan(ends, points, *start), 1)
    s.validate()


@pytest.mark.parametrize("call", [
    lambda s: algorithms.smooth(s, -1),
    lambda s: algorithms.smooth(s, 1.5),
    lambda s: algorithms.smooth(s, True),
    lambda s: algorithms.smooth(s, 1, "gauss"),
    lambda s: algorithms.subdivide(s, "catmull"),
    lambda s: algorithms.subdivide(s, times=-1),
    lambda s: algorithms.subdivide(s, times=12),
    lambda s: algorithms.subdivide(s, "sqrt3", 10**400),
    lambda s: algorithms.simplify(s),
    lambda s: algorithms.remesh(s, 0.0),
    lambda s: algorithms.remesh(s, -0.1),
    lambda s: algorithms.remesh(s, float("inf")),
    lambda s: algorithms.remesh(s, "short"),
    lambda s: algorithms.remesh(s, iterations=-1),
    lambda s: algorithms.impacts(s, [0, 1, s.n_faces]),
    lambda s: algorithms.impacts(s, [0.5]),
    lambda s: algorithms.impacts(s, [-1]),
    lambda s: algorithms.impacts(s, 3),
    lambda s: algorithms.remesh(s, 1e-200),
    lambda s: algorithms.remesh(s, 10**400),
    lambda s: algorithms.remesh(s, True),
    lambda s: algorithms.simplify(s, error=10**400),
    lambda s: algorithms.simplify(s, error=1 + 0j),
    lambda s: algorithms.simplify(s, vertices=-1),
    lambda s: algorithms.simplify(s, faces=10.0),
    lambda s: algorithms.simplify(s, error=float("nan")),
    lambda s: algorithms.simplify(s, error="small"),
    lambda s: algorithms.simplify(s, 10, by="volume"),
])  # fmt: skip
def test_a_bad_argument_is_refused_before_anything_changes(call: Callable[[Any], None]) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    before = s.copy()
    with pytest.raises(hem.MeshError):
        call(s)
    assert s.same_as(before)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_polygons_and_what_is_no_structure_are_refused(algorithm: str) -> None:
    square = hem.PolygonMesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    polygonal = next(it for it in structures.NAMES if structures.REGISTRY[it].holds_polygons)
    s = structures.build(polygonal, square)
    with pytest.raises(hem.MeshError, match="triangles only") as error:
        ALGORITHMS[algorithm](s)
    assert error.value.elements["faces"].tolist() == [0]
    with pytest.raises(hem.MeshError, match="takes a structure"):
        ALGORITHMS[algorithm](MESHES["torus"]())  # type: ignore[arg-type]


EDITING = {
    **{it: partial(algorithms.subdivide, scheme=it) for it in algorithms.SCHEMES},
    "sqrt3 of the six": algorithms.SIX["subdivision"],
    "collapse": algorithms.split_and_collapse,
    "remesh": algorithms.remesh,
}


@pytest.mark.parametrize("name", OF_EACH_KIND)
@pytest.mark.parametrize("algorithm", EDITING)
def test_two_faces_with_the_same_corners_are_refused(algorithm: str, name: str) -> None:
    s = structures.build(name, hem.TriangleMesh(np.eye(3), [(0, 1, 2), (0, 2, 1)]))
    with pytest.raises(hem.TopologyError, match="same three corners"):
        EDITING[algorithm](s)
    assert s.n_vertices == 3


@pytest.mark.parametrize("algorithm", EDITING)
def test_an_edge_in_three_faces_is_refused(algorithm: str) -> None:
    points = [(0, 0, 0), (4, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
    mesh = hem.TriangleMesh(points, [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    s = structures.build("indexed", mesh)
    with pytest.raises(hem.TopologyError, match="more than two faces"):
        EDITING[algorithm](s)
    assert s.n_vertices == 5


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
@pytest.mark.parametrize("algorithm", EDITING)
def test_an_edge_that_two_faces_pass_the_same_way_is_refused(algorithm: str, name: str) -> None:
    points = [(0, 0, 0), (4, 0, 0), (0, 1, 0), (0, -1, 0)]
    s = structures.build(name, hem.TriangleMesh(points, [(0, 1, 2), (0, 1, 3)]))
    with pytest.raises(hem.TopologyError, match="pass them the same way") as error:
        EDITING[algorithm](s)
    assert error.value.elements["edges"].tolist() == [[0, 1]]
    assert s.n_vertices == 4


@pytest.mark.parametrize("algorithm", ["loop", "subdivision", "smoothing", "taubin"])
def test_after_deletions_followers_are_told_of_what_moved_and_of_nothing_else(
    algorithm: str,
) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    for v in (0, 30, 66):
        s.remove_vertex(v)
    old, told = {*s.vertices().tolist()}, list[hem.Edit]()
    s.subscribe(told.append)
    ALGORITHMS[algorithm](s)
    moved = set().union(*(edit.changed_vertices.tolist() for edit in told))
    assert len(moved) > 100
    assert moved <= old
