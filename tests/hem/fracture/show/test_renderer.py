"""Pictures: what must be seen where, whatever they look like."""

from __future__ import annotations

import numpy as np
import pytest

import hem
from hem.fracture.show.camera import AXES, Camera
from hem.fracture.show.renderer import Floor, Shape, creased_normals, render, srgb

SIZE = 96, 72
RED = (0.8, 0.1, 0.1)


def sphere(center=(0.0, 0.0, 0.0), radius=1.0) -> hem.TriangleMesh:
    mesh = hem.generate("sphere", 642)
    return hem.TriangleMesh(mesh.points * np.float32(radius) + np.float32(center), mesh.triangles)


def shape(mesh: hem.TriangleMesh, color=RED, normals=None) -> Shape:
    return Shape(mesh.points, mesh.triangles, color, normals)


def red(image: np.ndarray) -> np.ndarray:
    """Which pixels show something red."""
    signed = image.astype(int)
    return signed[..., 0] > signed[..., 1] + 40


def test_nothing_shows_paper_and_the_same_scene_the_same_picture():
    camera = Camera.around(sphere().points)
    empty = render([], camera, SIZE)
    assert empty.shape == (72, 96, 3)
    assert empty.dtype == np.uint8
    assert (empty == empty[0, 0]).all()
    assert empty.min() > 200
    first, again = (render([shape(sphere())], camera, SIZE, Floor(-1)) for _ in range(2))
    np.testing.assert_array_equal(first, again)


@pytest.mark.parametrize("up", "xyz")
@pytest.mark.parametrize("azimuth", [0, 130])
@pytest.mark.parametrize("elevation", [0, 25, 90])
def test_the_camera_frames_all_points_and_no_more_than_that(up, azimuth, elevation):
    random = np.random.default_rng(7)
    points = random.normal(size=(50, 3)) * (5, 0.3, 1) + 100
    camera = Camera.around(points, azimuth, elevation, AXES[up], aspect=1.5, margin=0.1)
    right, above, forward = camera.axes()
    off = points - camera.position
    depth = off @ forward
    tall = np.tan(np.radians(camera.field_of_view) / 2)
    across, height = off @ right / depth / tall / 1.5, off @ above / depth / tall
    assert (depth > 0).all()
    assert max(abs(across).max(), abs(height).max()) == pytest.approx(0.8)


def test_a_sphere_is_seen_as_the_disk_that_it_is():
    camera = Camera(np.array([0, 0, 6.0]), np.zeros(3), np.array([0, 1.0, 0]), 30.0)
    seen = red(render([shape(sphere())], camera, (120, 120)))
    radius = np.tan(np.arcsin(1 / 6)) / np.tan(np.radians(15)) * 60
    assert seen.sum() == pytest.approx(np.pi * radius**2, rel=0.03)
    rows, columns = np.nonzero(seen)
    assert abs(rows.mean() - 59.5) < 0.5
    assert abs(columns.mean() - 59.5) < 0.5


def test_what_is_in_front_hides_what_is_behind_wherever_the_scene_is():
    for origin in (np.zeros(3), np.array([1e4, -2e4, 5e3])):
        front, back = sphere(origin), sphere(origin - (0, 0, 4), 1.2)
        camera = Camera(origin + np.array([0, 0, 6]), origin, np.array([0, 1.0, 0]), 25.0)
        image = render([shape(back, (0.1, 0.1, 0.8)), shape(front)], camera, SIZE)
        assert red(image)[36, 48]


def test_a_sheet_is_seen_from_both_sides():
    sheet = hem.generate("grid", 16)
    middle = sheet.points.mean(axis=0)
    for side in (-3.0, 3.0):
        camera = Camera(middle + np.array([0, 0, side]), middle, np.array([0, 1.0, 0]))
        assert red(render([shape(sheet)], camera, SIZE)).mean() > 0.2


def test_the_floor_is_dark_where_something_stands_and_light_far_off():
    camera = Camera.around(sphere().points, 0, 20, margin=0.2)
    floor = Floor(-1.0)
    bare = render([], camera, SIZE, floor).astype(int)
    shown = render([shape(sphere())], camera, SIZE, floor).astype(int)
    darker = (bare - shown).max(axis=2)
    beside = darker[~red(shown)]
    assert beside.max() > 40
    assert np.abs(darker[:5]).max() <= 2


def test_the_lit_side_is_brighter_than_the_one_away_from_the_light():
    camera = Camera(np.array([0, 0, 6.0]), np.zeros(3), np.array([0, 1.0, 0]), 25.0)
    image = render([shape(sphere())], camera, SIZE, light=(1, 0, 0.2)).astype(int)
    assert image[36, 62, 0] > image[36, 34, 0] + 30
    other = render([shape(sphere())], camera, SIZE, light=(-1, 0, 0.2)).astype(int)
    assert other[36, 34, 0] > other[36, 62, 0] + 30


def test_a_body_throws_its_shadow_on_another():
    ball, below = sphere(), sphere((0, -6, 0), 4.0)
    camera = Camera(np.array([0, 3.0, 14]), np.array([0, -2.0, 0]), np.array([0, 1.0, 0]), 40.0)
    alone = render([shape(below)], camera, SIZE, light=(0, 1, 0.01)).astype(int)
    both = render([shape(below), shape(ball, (0.1, 0.1, 0.8))], camera, SIZE, light=(0, 1, 0.01))
    both = both.astype(int)
    darker = red(alone) & red(both) & ((alone - both)[..., 0] > 30)
    assert darker.sum() > 20


def test_edges_are_smoothed():
    camera = Camera(np.array([0, 0, 6.0]), np.zeros(3), np.array([0, 1.0, 0]), 30.0)
    image = render([shape(sphere(), (0.0, 0.0, 0.0))], camera, SIZE)
    assert len(np.unique(image[..., 0])) > 12


def test_normals_are_round_on_a_sphere_and_flat_on_a_cube():
    ball = sphere()
    found = creased_normals(ball.points, ball.triangles, 40)
    exact = ball.points / np.linalg.norm(ball.points, axis=1, keepdims=True)
    np.testing.assert_allclose(found, exact[ball.triangles], atol=0.02)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    a, b, c = (corners[triangles[:, i]] for i in range(3))
    flat = np.cross(b - a, c - a)
    found = creased_normals(corners, triangles, 40)
    np.testing.assert_allclose(found, np.repeat(flat[:, None], 3, axis=1), atol=1e-12)


def test_degenerate_faces_and_vertices_without_faces_are_drawn_over():
    mesh = sphere()
    points = np.vstack([mesh.points, [[50, 50, 50]]])
    triangles = np.vstack([mesh.triangles, [[0, 1, 1]]])
    normals = creased_normals(points, triangles)
    assert np.isfinite(normals).all()
    camera = Camera.around(mesh.points)
    image = render([Shape(points, triangles, RED, normals)], camera, SIZE, Floor(-1))
    assert red(image).mean() > 0.2


def test_colors_are_read_from_text():
    np.testing.assert_allclose(srgb("#ff8000"), (1, 128 / 255, 0))
