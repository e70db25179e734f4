"""Geometry and conversions, against trimesh and by going there and back."""

from __future__ import annotations

import sys
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

import hem
from hem.errors import MeshError
from tests.pictures import require_pictures
from tests.structures.test_polygons import CUBE, mixed

trimesh = pytest.importorskip("trimesh")


@pytest.fixture(params=["sphere", "torus", "cow"])
def mesh(request: pytest.FixtureRequest) -> hem.TriangleMesh:
    if request.param in hem.SAMPLES:
        return hem.sample(request.param)
    return hem.generate(request.param, 500)


def test_geometry_is_that_of_trimesh(mesh: hem.TriangleMesh) -> None:
    other = trimesh.Trimesh(mesh.points.astype(float), mesh.triangles, process=False)
    np.testing.assert_allclose(mesh.bounds, other.bounds)
    np.testing.assert_allclose(mesh.face_areas(), other.area_faces, atol=1e-12)
    np.testing.assert_allclose(mesh.area(), other.area)
    np.testing.assert_allclose(mesh.centroid(), other.centroid, atol=1e-9)
    areas = mesh.face_areas() > 1e-12
    np.testing.assert_allclose(mesh.face_normals()[areas], other.face_normals[areas], atol=1e-6)
    if other.is_watertight:
        np.testing.assert_allclose(mesh.volume(), other.volume)
    else:
        with pytest.raises(MeshError, match="borders"):
            mesh.volume()


def test_a_volume_is_that_of_a_closed_surface_wherever_it_lies() -> None:
    box = trimesh.creation.box((1, 2, 3))
    far = hem.TriangleMesh(box.vertices + 2.0**33, box.faces, np.float64)
    assert far.volume() == 6
    with pytest.raises(MeshError, match="borders encloses no volume"):
        hem.TriangleMesh(far.points, far.triangles[1:], np.float64).volume()


def test_vertex_normals_weigh_by_area() -> None:
    mesh = hem.generate("sphere", 500)
    outward = mesh.points / np.linalg.norm(mesh.points, axis=1, keepdims=True)
    assert (np.einsum("ij,ij->i", mesh.vertex_normals(), outward) > 0.99).all()
    other = trimesh.Trimesh(mesh.points.astype(float), mesh.triangles, process=False)
    summed = np.zeros((len(mesh.points), 3))
    for face, corners in enumerate(mesh.triangles):
        summed[corners] += other.area_faces[face] * other.face_normals[face]
    expected = summed / np.linalg.norm(summed, axis=1, keepdims=True)
    np.testing.assert_allclose(mesh.vertex_normals(), expected, atol=1e-9)


def test_a_mesh_without_area_has_no_direction() -> None:
    mesh = hem.TriangleMesh([[0, 0, 0], [1, 1, 1], [2, 2, 2]], [[0, 1, 2]])
    assert not mesh.face_normals().any()
    assert not mesh.vertex_normals().any()
    with warnings.catch_warnings(action="error"):
        assert np.isnan(mesh.centroid()).all()
    points_alone = hem.TriangleMesh([(0, 0, 0), (1, 0, 0)], [])
    for it, n in ((points_alone, 2), (hem.TriangleMesh([], []), 0)):
        assert np.array_equal(it.vertex_normals(), np.zeros((n, 3)))
        assert it.vertex_normals().dtype == it.face_normals().dtype == np.float64
    assert hem.TriangleMesh([], []).face_normals().shape == (0, 3)
    assert [it.tolist() for it in hem.TriangleMesh([], []).bounds] == [3 * [np.inf], 3 * [-np.inf]]


@pytest.fixture
def meshio(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it is not installed, what stands in for it: its mesh, as its documentation says."""

    def mesh(points: np.ndarray, cells: list[tuple[str, np.ndarray]]) -> SimpleNamespace:
        blocks = [SimpleNamespace(type=kind, data=np.asarray(rows)) for kind, rows in cells]
        return SimpleNamespace(points=points, cells=blocks)

    if not importable("meshio"):
        monkeypatch.setitem(sys.modules, "meshio", SimpleNamespace(Mesh=mesh))


@pytest.mark.usefixtures("meshio")
def test_there_and_back_is_the_same_mesh(mesh: hem.TriangleMesh) -> None:
    back = [hem.from_trimesh(mesh.to_trimesh()), hem.from_meshio(mesh.to_meshio())]
    if importable("pyvista"):
        back.append(hem.from_pyvista(mesh.to_pyvista()))
    for other in back:
        np.testing.assert_array_equal(other.points, mesh.points)
        np.testing.assert_array_equal(other.triangles, mesh.triangles)


@pytest.mark.usefixtures("meshio")
def test_polygons_there_and_back() -> None:
    for mesh in (CUBE, mixed()):
        for library in ("pyvista", "meshio"):
            if not importable(library):
                continue
            other = getattr(hem, f"from_{library}")(getattr(mesh, f"to_{library}")())
            np.testing.assert_array_equal(other.points, mesh.points)
            assert other.faces.to_list() == mesh.faces.to_list()


@pytest.mark.usefixtures("meshio")
def test_meshio_is_told_faces_by_its_names_of_them_a_block_for_every_run() -> None:
    faces = [(0, 1, 2), (2, 3, 0), (0, 1, 2, 3), (0, 1, 2, 3, 4), (4, 1, 2)]
    blocks = hem.PolygonMesh(np.eye(5)[:, :3], faces).to_meshio().cells
    assert [it.type for it in blocks] == ["triangle", "quad", "polygon", "triangle"]
    assert [tuple(row) for it in blocks for row in np.asarray(it.data).tolist()] == faces


@pytest.mark.parametrize("name", ["trimesh", "pyvista", "meshio"])
def test_a_library_that_is_not_there_is_named_with_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=f"{name} is not installed; pip install {name}"):
        getattr(hem.TriangleMesh([], []), f"to_{name}")()


def test_no_polygons_have_three_corners_at_most() -> None:
    for none in ([], np.zeros((0, 4), int)):
        mesh = hem.PolygonMesh(np.eye(3), none)
        assert (mesh.most_corners, mesh.face_rows().to_list()) == (3, [])
        assert isinstance(hem.as_mesh(mesh), hem.TriangleMesh)


def test_a_mesh_is_shown_as_a_picture() -> None:
    require_pictures()
    for mesh in (hem.generate("sphere", 42), CUBE):
        image = mesh.plot(
            off_screen=True, screenshot=True, notebook=False, window_size=(80, 60), color="red"
        )
        assert image.shape == (60, 80, 3)
        assert (image[..., 0] > image[..., 1] + 100).any()


def importable(name: str) -> bool:
    try:
        __import__(name)
    except ImportError:
        return False
    return True


@pytest.mark.usefixtures("meshio")
def test_the_empty_mesh_has_no_cells_and_what_is_given_is_the_callers() -> None:
    assert not hem.TriangleMesh([], []).to_meshio().cells
    mesh = hem.generate("torus", 100)
    given = mesh.to_meshio()
    given.points *= 2
    assert np.array_equal(given.points, 2 * mesh.points)
