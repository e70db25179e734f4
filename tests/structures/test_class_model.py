"""The thesis' class model: objects that refer to each other, and agree with the arrays."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

import hem
import structures
from structures.half_edge_objects import HalfEdgeMesh
from structures.object_tools import (
    EdgeSplittingBehaviour,
    FaceSplittingBehaviour,
    HalfEdgeMeshBuilder,
)
from structures.objects.class_model import HalfEdge
from tests.structures.conftest import MESHES, octahedron, shuffled
from tests.structures.histories.actions import KINDS, NUMBERS, Action, aim, perform, surface_of


def objects(mesh: hem.TriangleMesh) -> HalfEdgeMesh:
    return cast(HalfEdgeMesh, structures.build("half_edge_objects", mesh))


@pytest.mark.parametrize("mesh", MESHES)
def test_every_object_stands_at_its_index_and_walks_back_to_itself(mesh):
    s = objects(MESHES[mesh]())
    for vertex in s.vertices:
        assert s.vertices[vertex.index] is vertex
        assert vertex.half_edge is None or vertex.half_edge.origin is vertex
    for h in s.half_edges:
        assert s.half_edges[h.index] is h
        assert h.next.next.next is h
        assert h.previous.next is h
        assert h.face.index in s.faces()
        if h.opposite is not None:
            assert h.opposite.opposite is h
            assert h.opposite.end is h.origin
    for face in s.faces:
        assert face.half_edge.face is face
    assert len(s.faces) == s.n_faces
    assert len(s.half_edges) == 3 * s.n_faces


def test_objects_and_handles_give_the_same_neighbors():
    s = objects(hem.generate("grid", 49))
    for vertex in s.vertices:
        around = s.vertices.circulator(vertex)
        assert [h.face.index for h in around] == s.vertex_faces(vertex.index).tolist()
        assert all(h.origin is vertex for h in around)
    assert s.half_edges[3].next.opposite is not None
    assert s.half_edges[3].next.opposite.face.index in s.faces()


def test_any_operations_leave_the_same_records_as_on_arrays():
    """Not only the same mesh: the same indices of half-edges, faces and vertices throughout."""
    rng = np.random.default_rng(11)
    mesh = shuffled(hem.generate("grid", 64))
    mine, arrays = objects(mesh), structures.build("half_edge", mesh)
    for _ in range(250):
        action = Action(str(rng.choice(KINDS)), *rng.integers(0, NUMBERS, 3).tolist())
        aimed = aim(surface_of(arrays), action)
        if aimed is None:
            break
        assert perform(mine, aimed) == perform(arrays, aimed)
        mine.validate()
        for a, b in zip(mine.snapshot().records[1:-1], arrays.records[1:-1], strict=True):
            used = b[: len(a)]
            live = a >= 0 if a.ndim == 1 else a[:, 1] >= 0
            assert np.array_equal(a[live], used[live])


def test_the_face_circulator_gives_the_order_of_the_render_mesh():
    s = HalfEdgeMesh.create((0, 0, 0), (0, 1, 0), (1, 0, 0))  # clockwise from above
    face = s.faces[0]
    clockwise = [h.origin.index for h in s.faces.circulator(face)]
    forward = [face.half_edge.origin.index, face.half_edge.end.index]
    assert clockwise == [0, 1, 2]
    assert forward == [0, 2]
    assert hem.RenderMesh(s).indices.tolist() == clockwise


def test_a_mesh_grows_from_three_points_by_faces():
    s = HalfEdgeMesh.create((0, 0, 0), (0, 1, 0), (1, 0, 0))
    new = s.add_vertex((1, 1, 0)).vertex
    s.add_face(1, 2, new)
    s.validate()
    assert (s.n_vertices, s.n_edges, s.n_faces) == (4, 5, 2)
    assert s.vertices[new].half_edge is not None


def test_the_builder_welds_turns_and_gives_back_what_it_was_given():
    square = [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 0)]  # a seam
    s = HalfEdgeMeshBuilder.from_render_mesh(square, [0, 1, 2, 3, 4, 5])
    assert (s.n_vertices, s.n_edges, s.n_faces) == (4, 5, 2)
    points, indices = HalfEdgeMeshBuilder.to_render_mesh(s)
    assert points.reshape(-1, 3)[indices].tolist() == [list(map(float, it)) for it in square]
    mesh = hem.generate("sphere", 42)
    points, indices = HalfEdgeMeshBuilder.to_render_mesh(objects(mesh))
    again = HalfEdgeMeshBuilder.from_render_mesh(points, indices)
    assert np.array_equal(again.to_triangles().points, mesh.points)


def test_a_vertex_tells_when_it_has_moved():
    s, heard = objects(octahedron()), []
    stop = s.vertices[2].subscribe(lambda vertex: heard.append((vertex.index, vertex.point)))
    s.vertices[2].point = (0.0, 0.0, 2.0)
    s.move_vertex(2, (0, 0, 3))
    s.move_vertex(3, (9, 9, 9))
    stop()
    s.vertices[2].point = (0.0, 0.0, 4.0)
    assert heard == [(2, (0.0, 0.0, 2.0)), (2, (0.0, 0.0, 3.0))]
    assert s.points[2].tolist() == [0, 0, 4]


def test_what_follows_the_mesh_follows_a_point_that_is_set():
    s, edits = objects(octahedron()), []
    s.vertices[1].subscribe(lambda vertex: None)
    render, told = hem.RenderMesh(s), []
    render.subscribe(told.append)
    s.subscribe(edits.append)
    new = s.split_face(0, (0, 0, 0)).vertex
    for v in (1, 2, new):
        s.vertices[v].point = (0.0, 5.0, float(v))
        assert render.points[3 * v : 3 * v + 3].tolist() == [0, 5, v]
        assert told[-1].vertices.tolist() == [[v, v + 1]]
        assert edits[-1].changed_vertices.tolist() == [v]


def test_behaviors_split_and_remember_what_they_made():
    s = objects(octahedron())
    edges, faces = EdgeSplittingBehaviour(s), FaceSplittingBehaviour(s)
    vertex = edges.split_half_edge(s.half_edges[0], (1, 1, 0))
    assert (vertex.index, vertex.point) == (6, (1.0, 1.0, 0.0))
    assert [it.index for it in edges.created_faces] == [8, 9]
    center = faces.split_face(s.faces[0], (0, 0, 0))
    around = {h.face.index for h in s.vertices.circulator(center)}
    assert around == {0, *(it.index for it in faces.created_faces)}
    assert len(faces.split_all_faces()) == 12
    assert (s.n_faces, len(faces.created_faces)) == (36, 26)
    s.validate()


def test_a_dead_or_foreign_element_is_refused_by_name():
    s = objects(octahedron())
    edit = s.collapse_edge(s.find_edge(0, 1), keep=0)
    for elements, index in (
        (s.vertices, 1), (s.faces, int(edit.removed_faces[0])), (s.half_edges, 999), (s.faces, -1),
    ):  # fmt: skip
        with pytest.raises(hem.MeshError, match="no such"):
            elements[index]
    assert len(s.vertices) == 5
    assert [it.index for it in s.faces] == s.faces().tolist()


def _swap_next(s: HalfEdgeMesh) -> None:
    s.half_edges[4].next = s.half_edges[9]


def _foreign_origin(s: HalfEdgeMesh) -> None:
    s.half_edges[4].origin = objects(octahedron()).vertices[1]


def _lose_opposite(s: HalfEdgeMesh) -> None:
    s.half_edges[4].opposite = None


def _wrong_index(s: HalfEdgeMesh) -> None:
    s.faces[3].index = 4


def _dead_half_edge(s: HalfEdgeMesh) -> None:
    s.vertices[2].half_edge = HalfEdge(3, s.vertices[2])


def _not_finite(s: HalfEdgeMesh) -> None:
    s.vertices[2].place((0.0, float("inf"), 0.0))


@pytest.mark.parametrize(
    "damage",
    [_swap_next, _foreign_origin, _lose_opposite, _wrong_index, _dead_half_edge, _not_finite],
)
def test_any_damage_to_the_objects_is_found(damage: Any):
    s = objects(octahedron())
    s.validate()
    damage(s)
    with pytest.raises(hem.MeshError, match="broken invariant"):
        s.validate()


def test_the_model_of_the_runtime_counts_what_the_classes_declare():
    """Headers of 16, references of 8, an int of 4, a Vector3 of 12, padded to 8 (by hand)."""
    s = objects(hem.generate("torus", 100))
    taken = s.clr_memory()
    assert sum(taken.values()) == 100 * (48 + 8) + 600 * (56 + 8) + 200 * (32 + 8)
    assert taken["half_edge.padding"] == 4 * 600
    assert sum(v for k, v in taken.items() if k.split(".")[1] in THESIS_FIELDS) == 228 * 100


THESIS_FIELDS = ("point", "half_edge", "origin", "face", "next", "opposite")


def test_objects_weigh_what_python_hands_out():
    import tracemalloc

    mesh = hem.generate("torus", 2500)
    objects(mesh)
    tracemalloc.start()
    s = objects(mesh)
    traced, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert sum(s.memory().values()) == pytest.approx(traced, rel=0.15)


def test_who_follows_the_mesh_is_told_though_a_subscriber_of_the_vertex_raises():
    s, edits = objects(octahedron()), []
    s.subscribe(edits.append)

    def refuse(vertex: Any) -> None:
        raise ValueError("not this one")

    s.vertices[1].subscribe(refuse)
    with pytest.raises(ValueError, match="not this one"):
        s.vertices[1].point = (0.0, 5.0, 0.0)
    assert edits[-1].changed_vertices.tolist() == [1]


LARGEST = float(np.finfo(np.float32).max)
BEYOND = (0, 0, LARGEST + 2.0**103)  # what rounds to infinity, and nothing less does


@pytest.mark.parametrize("wrong", [(1, 2), (np.nan, 0, 0), (0, -1e300, 0), BEYOND, "abc", None])
def test_a_point_that_is_no_position_moves_nothing(wrong: Any) -> None:
    s = cast("HalfEdgeMesh", structures.build("half_edge_objects", octahedron()))
    before = s.points.copy()
    with pytest.raises(hem.MeshError, match="a position is three finite numbers"):
        s.vertices[1].point = wrong
    assert np.array_equal(s.points, before)


def test_a_point_that_is_set_is_the_position_that_a_copy_and_a_moved_vertex_have() -> None:
    s = cast("HalfEdgeMesh", structures.build("half_edge_objects", octahedron()))
    moved, point = s.copy(), (0.1, 0.2, 0.3)  # none of which is a float32
    s.vertices[1].point = point
    moved.move_vertex(1, point)
    assert s.vertices[1].point == moved.vertices[1].point == s.copy().vertices[1].point


def test_a_point_as_large_as_float32_holds_is_a_position() -> None:
    s = cast("HalfEdgeMesh", structures.build("half_edge_objects", octahedron()))
    s.vertices[1].point = (0, 0, np.nextafter(LARGEST + 2.0**103, 0))
    assert s.points[1].tolist() == [0, 0, LARGEST]
    s.validate()
