import numpy as np
import pytest

import hem
from hem.fracture.bodies.solid import (
    Body,
    Shell,
    collapsed,
    from_manifold,
    require_body,
    to_manifold,
    with_hollows,
    wrapped,
)
from hem.meshes.manifold import require_manifold
from tests.extent import waiting_for
from tests.hem.fracture.solids import (
    NAMES,
    as_trimesh,
    body,
    box,
    hollow_sphere,
    solid_angles,
    together,
)


@pytest.mark.parametrize("name", waiting_for(["plate", "sphere"], NAMES))
def test_a_body_holds_the_positions_that_its_surface_winds_around(name):
    it = body(name)
    low, high = it.mesh.points.min(axis=0), it.mesh.points.max(axis=0)
    at = low + (high - low) * np.random.default_rng(1).random((300, 3))
    np.testing.assert_array_equal(it.contains(at), solid_angles(it.mesh, at) > 0.5)
    assert it.volume == pytest.approx(as_trimesh(it.mesh).volume, rel=1e-12)


def test_positions_over_edges_and_vertices_are_told_apart_exactly():
    cube = require_body(box(2, 2, 2))
    ticks = np.array([-1.5, -0.5, 0, 0.5, 1.5])
    at = np.stack(np.meshgrid(ticks, ticks, ticks), axis=-1).reshape(-1, 3)
    np.testing.assert_array_equal(cube.contains(at), (np.abs(at) < 1).all(axis=1))


def test_a_body_of_several_components_and_hollows_is_one():
    assert require_body(together(box(1, 1, 1), box(1, 1, 1, at=(3, 0, 0)))).volume == pytest.approx(
        2
    )
    it = require_body(hollow_sphere())
    assert it.volume == pytest.approx(as_trimesh(hem.generate("sphere", 400)).volume * 0.784)
    assert not it.contains([[0, 0, 0]])[0]
    assert it.contains([[0.8, 0, 0]])[0]


def test_vertices_without_faces_do_not_count():
    cube = box(1, 1, 1)
    loose = hem.TriangleMesh(np.concatenate([[(99, 99, 99)], cube.points]), cube.triangles + 1)
    it = require_body(loose)
    assert len(it.mesh.points) == 8
    assert it.diagonal == pytest.approx(np.sqrt(3))


def test_the_empty_mesh_is_no_body():
    for mesh in (hem.TriangleMesh([], []), hem.TriangleMesh([(0, 0, 0)], [])):
        with pytest.raises(hem.MeshError, match="empty"):
            require_body(mesh)


def test_an_open_mesh_names_its_border_and_what_to_do():
    cube = box(1, 1, 1)
    with pytest.raises(hem.MeshError, match=r"3 border edges.*wrapped\(mesh\).*surface") as caught:
        require_body(hem.TriangleMesh(cube.points, cube.triangles[1:]))
    missing = cube.triangles[0]
    truth = {tuple(sorted((int(missing[i]), int(missing[i - 1])))) for i in range(3)}
    assert {tuple(edge) for edge in caught.value.elements["edges"].tolist()} == truth


def test_a_mesh_inside_out_says_how_to_turn_it():
    with pytest.raises(hem.MeshError, match=r"inside out.*flipped"):
        require_body(box(1, 1, 1).flipped())


def test_faces_that_do_not_run_alike_are_named_by_their_edges():
    cube = box(1, 1, 1)
    turned = cube.triangles.copy()
    turned[0] = turned[0][::-1]
    with pytest.raises(hem.MeshError, match="run the same way") as caught:
        require_body(hem.TriangleMesh(cube.points, turned))
    assert len(caught.value.elements["edges"]) == 3


def test_two_cubes_that_meet_in_an_edge_are_no_body():
    both = together(box(1, 1, 1), box(1, 1, 1, at=(1, 1, 0))).welded()
    with pytest.raises(hem.MeshError, match="more than two faces"):
        require_body(both)


def test_a_mesh_that_intersects_itself_names_the_faces():
    crossing = together(
        box(1, 1, 1), box(1, 1, 1, at=(0.5, 0.25, 0.125)), box(1, 1, 1, at=(5, 0, 0))
    )
    with pytest.raises(hem.MeshError, match=r"intersects itself.*wrapped") as caught:
        require_body(crossing)
    faces = caught.value.elements["faces"]
    assert 0 < len(faces) <= 24
    assert faces.max() < 24


def test_a_component_inside_another_is_a_hollow_or_an_error():
    inner, outer = box(1, 1, 1), box(3, 3, 3)
    assert require_body(together(outer, inner.flipped())).volume == pytest.approx(26)
    with pytest.raises(hem.MeshError, match="inside another") as caught:
        require_body(together(outer, inner))
    assert set(caught.value.elements["faces"].tolist()) == set(range(12, 24))
    with pytest.raises(hem.MeshError, match="inside out"):
        require_body(together(outer, box(1, 1, 1, at=(9, 0, 0)).flipped()))


@pytest.mark.parametrize("first", range(8))
def test_components_may_touch_in_a_corner_whichever_vertex_is_the_first(first):
    cube = box(1, 1, 1)
    order = np.argsort(np.arange(8) != first, kind="stable")
    triangles = np.argsort(order)[cube.triangles]
    with_it = np.argsort(triangles.min(axis=1), kind="stable")
    turned = [np.roll(it, -it.argmin()) for it in triangles[with_it]]
    other = hem.TriangleMesh(cube.points[order] - 1, turned)
    assert require_body(together(cube, other)).volume == pytest.approx(2)


def test_a_flat_mesh_is_no_body():
    sheet = [(0, 1, 2), (0, 2, 1)]
    with pytest.raises(hem.MeshError, match="flat"):
        require_body(hem.TriangleMesh(np.eye(3), sheet))


@pytest.mark.parametrize(
    "mesh",
    [hem.sample("teapot"), hem.sample("cow"), hem.generate("grid", 100)],
    ids=["teapot", "cow", "grid"],
)
def test_what_is_no_body_becomes_one_when_wrapped(mesh):
    with pytest.raises(hem.MeshError):
        require_body(mesh)
    it = require_body(wrapped(mesh, detail=0.04, offset=0.01))
    require_manifold(it.mesh)
    grown = 0.02 * it.diagonal
    assert (it.mesh.points.min(axis=0) <= mesh.points.min(axis=0)).all()
    assert (it.mesh.points.min(axis=0) >= mesh.points.min(axis=0) - grown).all()
    assert (it.mesh.points.max(axis=0) <= mesh.points.max(axis=0) + grown).all()


def test_what_cannot_be_wrapped_says_so():
    with pytest.raises(hem.MeshError, match="empty"):
        wrapped(hem.TriangleMesh([], []))
    for detail, offset in ((0, 0.1), (0.1, 0), (1, 0.1), (0.1, 2), (np.nan, 0.1), ("a", 0.1)):
        with pytest.raises(hem.MeshError, match="parts of the diagonal"):
            wrapped(box(1, 1, 1), detail=detail, offset=offset)
    with pytest.raises(hem.MeshError, match="all points of the mesh lie in one place"):
        wrapped(hem.TriangleMesh(np.ones((3, 3)), [(0, 1, 2)]))


@pytest.mark.parametrize("name", NAMES)
def test_a_mesh_comes_back_from_manifold3d_with_its_labels(name):
    it = body(name)
    mesh, labels = from_manifold(it.manifold)
    truth = {str(sorted(corners)): face for face, corners in enumerate(it.corners.tolist())}
    assert sorted(labels.tolist()) == list(range(len(it.mesh.triangles)))
    for face in range(0, len(labels), 97):
        corners = mesh.points.astype(float)[mesh.triangles[face]]
        assert truth[str(sorted(corners.tolist()))] == labels[face]


def test_vertices_that_round_to_one_become_one():
    cube = box(1, 1, 1)
    moved = cube.points.astype(float) + 100
    split = np.concatenate([moved, moved[:1] + 1e-9])  # a ninth vertex next to the first
    around = np.flatnonzero((cube.triangles == 0).any(axis=1))
    # The first corner's fan is opened at an edge, and two faces without area are put in between.
    other = next(
        v
        for v in cube.triangles[around].ravel()
        if v and (cube.triangles[around] == v).any(axis=1).sum() == 2
    )
    triangles = opened(cube.triangles, 0, int(other), 8)
    made = to_manifold(split, triangles, np.arange(len(triangles)))
    mesh, labels = from_manifold(made)
    assert len(mesh.points) == len(np.unique(mesh.points, axis=0)) == 8
    assert len(mesh.triangles) == len(labels) == 12
    assert Body(mesh).volume == pytest.approx(1)


def opened(triangles, at, other, new):
    """A vertex split in two, ``at`` and ``new``: two faces more, and none with an area."""
    triangles = triangles.copy()
    fan = {}
    for row, face in enumerate(triangles.tolist()):
        if at in face:
            i = face.index(at)
            fan[face[(i + 1) % 3]] = (face[(i + 2) % 3], row)
    walk, end = other, None
    for _ in range(2):  # two faces of the fan go over to the new vertex
        end, row = fan[walk]
        triangles[row][triangles[row] == at] = new
        walk = end
    return np.concatenate([triangles, [(at, other, new), (at, new, end)]])


def test_what_has_no_volume_is_a_body_of_its_own_where_there_is_no_other():
    pillow = Shell(hem.TriangleMesh(np.eye(3), [(0, 1, 2), (0, 2, 1)]), np.zeros(2))
    assert with_hollows([pillow]) == [pillow]


def test_bodies_come_the_largest_first_without_their_hollows():
    made = box(3, 3, 3), box(2.9, 2.9, 2.9).flipped(), box(2, 2, 2, at=(9, 0, 0))
    found = with_hollows([Shell(it, np.zeros(12)) for it in made])
    assert [it.mesh.volume() for it in found] == pytest.approx([8, 27 - 2.9**3])


def test_a_hollow_belongs_to_the_smallest_body_around_it():
    dolls = [box(it, it, it) if it % 2 else box(it, it, it).flipped() for it in (9, 8, 7, 6)]
    found = with_hollows([Shell(it, np.zeros(12)) for it in dolls])
    assert [it.mesh.volume() for it in found] == pytest.approx([9**3 - 8**3, 7**3 - 6**3])


@pytest.mark.parametrize(
    "faces",
    [
        [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)],
        [(0, 1, 3), (1, 2, 3), (2, 0, 3), (1, 0, 4), (2, 1, 4), (0, 2, 4)],
    ],
    ids=["a tetrahedron", "two sheets"],
)
def test_an_edge_of_no_length_stays_where_its_end_would_fold_the_surface(faces):
    points = np.array([(0, 0, 0), (0, 0, 0), (1, 0, 0), (0, 0, 1), (0, 0, -1)], float)
    mesh, labels = collapsed(hem.TriangleMesh(points, faces), np.arange(len(faces)))
    assert mesh.triangles.tolist() == [list(face) for face in faces]
    assert labels.tolist() == [*range(len(faces))]
