"""What can be handed in for a mesh, and what is said of all else."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import trimesh

import hem
import structures

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]], np.float32)
QUAD = [[0, 1, 2, 3], [3, 2, 4]]
TRIANGLES = [[0, 1, 2], [0, 2, 3]]


def blocks(*faces: tuple[str, Any], points: np.ndarray = POINTS) -> SimpleNamespace:
    """A mesh as meshio has it."""
    return SimpleNamespace(
        points=points,
        cells=[SimpleNamespace(type=kind, data=np.array(rows)) for kind, rows in faces],
    )


def of_triangles(folder: Path) -> dict[str, Any]:
    mesh = hem.TriangleMesh(POINTS, TRIANGLES)
    hem.save(mesh, folder / "mesh.ply")
    return {
        "mesh": mesh,
        "polygons": hem.PolygonMesh(POINTS, TRIANGLES),
        "path": folder / "mesh.ply",
        "str": str(folder / "mesh.ply"),
        "pair": (POINTS, np.array(TRIANGLES)),
        "lists": [POINTS.tolist(), TRIANGLES],
        "trimesh": trimesh.Trimesh(POINTS, TRIANGLES, process=False),
        "pyvista": SimpleNamespace(points=POINTS, faces=np.array([3, 0, 1, 2, 3, 0, 2, 3])),
        "open3d": SimpleNamespace(vertices=POINTS.tolist(), triangles=TRIANGLES),
        "meshio": blocks(("triangle", TRIANGLES)),
        "meshio in the plane": blocks(("triangle", TRIANGLES), points=POINTS[:, :2]),
        **{name: structures.build(name, mesh) for name in structures.NAMES},
    }


def of_polygons(folder: Path) -> dict[str, Any]:
    mesh = hem.PolygonMesh(POINTS, QUAD)
    hem.save(mesh, folder / "mesh.obj")
    return {
        "polygons": mesh,
        "path": folder / "mesh.obj",
        "pair": (POINTS, QUAD),
        "rows": (POINTS, mesh.faces),
        "pyvista": SimpleNamespace(points=POINTS, faces=np.array([4, 0, 1, 2, 3, 3, 3, 2, 4])),
        "meshio": blocks(("quad", QUAD[:1]), ("triangle", QUAD[1:])),
        "plankton": structures.build("plankton", mesh),
    }


def test_triangles_are_taken_from_wherever_they_are(tmp_path: Path) -> None:
    for name, given in of_triangles(tmp_path).items():
        mesh = hem.as_mesh(given)
        assert isinstance(mesh, hem.TriangleMesh), name
        assert np.array_equal(mesh.points, POINTS), name
        turned = [np.roll(row, -int(np.argmin(row))).tolist() for row in mesh.triangles]
        assert turned == TRIANGLES, name
        assert structures.build("half_edge", given).n_faces == 2
        hem.save(given, tmp_path / "again.off")
        assert np.array_equal(hem.load(tmp_path / "again.off").triangles, mesh.triangles)


def test_polygons_are_taken_from_wherever_they_are(tmp_path: Path) -> None:
    for name, given in of_polygons(tmp_path).items():
        mesh = hem.as_mesh(given)
        assert isinstance(mesh, hem.PolygonMesh), name
        assert np.array_equal(mesh.points, POINTS), name
        turned = [np.roll(row, -int(np.argmin(row))).tolist() for row in mesh.faces]
        assert turned == [[0, 1, 2, 3], [2, 4, 3]], name
        assert structures.build("plankton", given).n_faces == 2
        hem.save(given, tmp_path / "again.off")
        assert hem.load_polygons(tmp_path / "again.off").faces.to_list() == mesh.faces.to_list()
        with pytest.raises(hem.MeshError, match="build plankton"):
            structures.build("half_edge", given)


@pytest.mark.parametrize(
    "given",
    [
        3, None, np.eye(3), (1, 2, 3), object(), hem.TriangleMesh,
        SimpleNamespace(points=POINTS), trimesh.Scene(), trimesh.PointCloud(POINTS),
    ],
)  # fmt: skip
def test_what_is_no_mesh_is_named_with_what_would_be_taken(given: Any, tmp_path: Path) -> None:
    words = f"cannot be made of {type(given)}; taken are a TriangleMesh,.* a path"
    with pytest.raises(hem.MeshError, match=words):
        structures.build("indexed", given)
    with pytest.raises(hem.MeshError, match=f"cannot save .*{words}"):
        hem.save(given, tmp_path / "mesh.ply")


def test_what_looks_like_a_mesh_and_is_none_is_a_mesh_error(tmp_path: Path) -> None:
    for given in ([1, 2], (POINTS, [[0, 1, 9]]), ("points", "faces")):
        with pytest.raises(hem.MeshError):
            hem.as_mesh(given)
    with pytest.raises(hem.MeshError, match=r"there are cells that are \['tetra'\]"):
        hem.as_mesh(blocks(("tetra", [[0, 1, 2, 3]])))  # as many corners as a quad has
    flat = SimpleNamespace(points=POINTS, faces=np.array([0, 1, 2, -1, 0, 2, 3, -1]))
    with pytest.raises(hem.MeshError, match=r"corners behind their count.*number 3 is -1"):
        hem.as_mesh(flat)
    short = SimpleNamespace(points=POINTS, faces=np.array([3, 0, 1, 2, 4, 0, 1, 2]))
    with pytest.raises(hem.MeshError, match=r"corners behind their count.*number 4 is 4"):
        hem.as_mesh(short)
    strips = SimpleNamespace(points=POINTS, faces=np.zeros(0, np.int64), n_strips=1)
    with pytest.raises(hem.MeshError, match="triangle strips are no faces"):
        hem.as_mesh(strips)
    with pytest.raises(hem.MeshError, match=r"cannot load .*nowhere\.ply"):
        structures.build("indexed", tmp_path / "nowhere.ply")
