"""Pictures: what must be seen where, whatever they look like."""

from __future__ import annotations

import subprocess
import sys
from contextlib import closing

import numpy as np
import pytest

import hem
from hem.fracture.show import Picture
from hem.fracture.show.picture import shadow
from tests.pictures import require_pictures


@pytest.fixture(scope="module", autouse=True)
def _pictures() -> None:
    require_pictures()


SIZE = 96, 72
RED = (0.8, 0.1, 0.1)


def sphere(center=(0.0, 0.0, 0.0), radius=1.0) -> hem.TriangleMesh:
    mesh = hem.generate("sphere", 642)
    return hem.TriangleMesh(mesh.points * np.float32(radius) + np.float32(center), mesh.triangles)


def drawn(mesh: hem.TriangleMesh, size=SIZE, seen=None, view=(30, 18), **look) -> np.ndarray:
    with closing(Picture(mesh.points, mesh.triangles, RED, size, **look)) as picture:
        picture.look_at(np.asarray(mesh.points if seen is None else seen, float), *view)
        return picture.image().astype(int)


def red(image: np.ndarray) -> np.ndarray:
    return image[..., 0] > image[..., 1] + 40


def test_the_same_mesh_gives_the_same_picture():
    first, again = (drawn(sphere(), floor=-1.0) for _ in range(2))
    assert first.shape == (72, 96, 3)
    np.testing.assert_array_equal(first, again)


@pytest.mark.parametrize("up", [(1, 0, 0), (0, 1, 0), (0, 0, 1)])
@pytest.mark.parametrize("view", [(0, 0), (130, 25)])
def test_the_camera_frames_the_mesh_with_a_margin_and_no_more(up, view):
    image = drawn(sphere((100, -50, 7), 3), (120, 80), view=view, up=up)
    rows, columns = np.nonzero(red(image))
    assert 1 <= rows.min() <= 4
    assert 75 <= rows.max() <= 78
    assert abs(columns.mean() - 59.5) < 1.5


def test_a_sphere_is_seen_as_the_disk_that_it_is():
    seen = red(drawn(sphere(), (120, 120)))
    height = np.ptp(np.nonzero(seen)[0]) + 1
    assert seen.sum() == pytest.approx(np.pi / 4 * height**2, rel=0.04)


def test_a_sheet_is_seen_from_both_sides():
    sheet = hem.generate("grid", 16)
    for azimuth in (0, 180):
        assert red(drawn(sheet, view=(azimuth, 5))).mean() > 0.2


def test_a_moved_mesh_is_seen_where_it_went():
    mesh = sphere()
    with closing(Picture(mesh.points, mesh.triangles, RED, SIZE)) as picture:
        picture.look_at(np.array([(-3.0, -3, -3), (3, 3, 3)]), 0, 0)
        centers = []
        for shift in (-1.5, 1.5):
            picture.move(mesh.points + np.array([shift, 0, 0]))
            centers.append(np.nonzero(red(picture.image().astype(int)))[1].mean())
    assert centers[1] - centers[0] > 15


def test_normals_turn_with_the_pieces():
    mesh = sphere()
    turn = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    with closing(Picture(mesh.points, mesh.triangles, RED, SIZE)) as picture:
        picture.look_at(mesh.points.astype(float))
        before = picture.image().astype(int)
        picture.move(mesh.points @ turn.T, np.tile(turn, (len(mesh.points), 1, 1)))
        assert np.abs(before - picture.image()).mean() < 3


def test_the_shadow_lies_under_what_stands_and_away_from_the_light():
    up, light = np.array([0.0, 1, 0]), np.array([1.0, 2, 0]) / np.sqrt(5)
    low, high = np.array([-4.0, -4]), np.array([4.0, 4])
    points = hem.generate("sphere", 40_962).points.astype(float)
    dark = shadow(points, up, -1.0, light, low, high, 2.0)
    assert dark.max() > 0.1
    assert np.abs(dark[[0, -1]]).max() == np.abs(dark[:, [0, -1]]).max() == 0
    z, x = np.meshgrid(*np.linspace(low, high, len(dark)).T, indexing="ij")
    assert (dark * x).sum() / dark.sum() < -0.1
    assert abs((dark * z).sum()) / dark.sum() < 0.05


def test_degenerate_faces_and_vertices_without_faces_are_drawn_over():
    mesh = sphere()
    points = np.vstack([mesh.points, mesh.points[:1], [[50, 50, 50]]])
    odd = hem.TriangleMesh(points, np.vstack([mesh.triangles, [[0, 1, 642]]]))
    assert red(drawn(odd, seen=mesh.points, floor=-1.0)).mean() > 0.2


def test_without_pyvista_the_error_names_the_way_out():
    code = (
        "import sys; sys.modules['pyvista'] = None\n"
        "from hem.errors import NotInstalledError\n"
        "from hem.fracture.show import Picture\n"
        "try: Picture([[0, 0, 0]], [[0, 0, 0]], (1, 1, 1), (9, 9))\n"
        "except NotInstalledError as missing: print(missing)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'hem-mesh[viz]'" in run.stdout
