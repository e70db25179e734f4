"""Shaded pictures of meshes, drawn off-screen by PyVista: no display is needed, and no GPU.

And where a mesh is struck unless it is said: where the camera sees it.
"""

import subprocess
import sys
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array, Floats
from hem.errors import NotInstalledError, load_optional
from hem.meshes import TriangleMesh, unit

Image = NDArray[np.uint8]
Size = tuple[int, int]

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
AZIMUTH, ELEVATION = 30.0, 18.0

PAPER = (244, 243, 241)  # sRGB: the floor far away, and what is behind everything
_CREASE = 30.0  # degrees. Sharper edges stay sharp; across all others the shading is smooth
_FIELD_OF_VIEW = 26.0
_CELLS, _SAMPLES = 400, 40_000


_TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.Render()
"""


@cache
def load_pyvista() -> Any:
    """The module pyvista. Raises NotInstalledError, with the way out, where it cannot draw.

    Without drivers VTK ends the process, so that the first time another one tries it: a second.
    """
    pyvista = load_optional("pyvista", "viz")
    trial = subprocess.run([sys.executable, "-c", _TRIAL], capture_output=True, check=False)
    if trial.returncode:
        raise NotInstalledError(
            "PyVista draws the pictures, and the system has no OpenGL for it; on Debian or Ubuntu: "
            "apt-get install libegl1 libgl1 libgl1-mesa-dri"
        )
    pyvista.vtk_verbosity("error")  # that there is no display is no news
    return pyvista


class Picture:
    """A mesh on a floor, seen by a camera. It holds a window off-screen until it is closed.

    points     (n, 3); they may move from one image to the next
    triangles  (m, 3) indices of points
    colors     (3,) for all, or (m, 3) for each face: sRGB in 0 … 1
    up, floor  the floor lies across ``up`` (3,) at this height and shows shadows; none: no floor
    """

    def __init__(
        self, points: Array, triangles: Array, colors: ArrayLike, size: Size,
        up: ArrayLike = AXES["y"], floor: float | None = None, gloss: float = 0.2,
        wires: bool = False,
    ) -> None:  # fmt: skip
        pyvista = load_pyvista()
        self.size, self.up, self.floor = size, np.asarray(up, float), floor
        self.points, self.triangles = np.asarray(points, float), triangles
        mesh = pyvista.PolyData.from_regular_faces(self.points, triangles)
        mesh.point_data["vertex"] = np.arange(len(points))
        each = np.broadcast_to(np.asarray(colors, float), (len(triangles), 3))
        mesh.cell_data["color"] = np.rint(255 * each).astype(np.uint8)
        self.mesh = mesh.compute_normals(
            feature_angle=0.0 if wires else _CREASE, split_vertices=True, consistent_normals=False
        )
        self.length = float(np.linalg.norm(np.ptp(points[np.unique(triangles)], axis=0)))
        self.vertex = np.array(self.mesh.point_data["vertex"])
        self.normals = np.array(self.mesh.point_data["Normals"])
        self.plotter = pyvista.Plotter(off_screen=True, window_size=list(size), lighting="none")
        self.plotter.set_background("white" if floor is None else PAPER)
        self.plotter.add_mesh(
            self.mesh, scalars="color", rgb=True, show_edges=wires, edge_opacity=0.6,
            interpolation="Flat" if wires else "Phong", ambient=0.45, diffuse=0.8,
            specular=gloss, specular_power=30,
        )  # fmt: skip
        self.plotter.enable_anti_aliasing("ssaa")

    def close(self) -> None:
        """Give back the window."""
        self.plotter.close()

    def move(self, points: Array, rotations: Array | None = None) -> None:
        """Put the points elsewhere (n, 3); each has been turned by its rotation (n, 3, 3)."""
        self.points = points
        self.mesh.points = points[self.vertex]
        if rotations is not None:
            turned = np.einsum("nij,nj->ni", rotations[self.vertex], self.normals)
            self.mesh.point_data["Normals"] = turned.astype(np.float32)

    def look_at(
        self, points: Array, azimuth: float = AZIMUTH, elevation: float = ELEVATION
    ) -> None:
        """Stand the camera and the lamps where all points (k, 3) are seen, and as near as can be.

        ``azimuth`` turns the camera around ``up``, ``elevation`` lifts it; both in degrees. O(k).
        """
        pyvista = load_pyvista()
        toward = view_direction(self.up, azimuth, elevation)
        right = unit(np.cross(self.up, toward))
        above = np.cross(toward, right)
        slope = np.tan(np.radians(_FIELD_OF_VIEW) / 2) * (0.84 if self.floor is not None else 0.96)
        depth = points @ -toward
        x, far_x = _apex(points @ right, depth, slope * self.size[0] / self.size[1])
        y, far_y = _apex(points @ above, depth, slope)
        eye = x * right + y * above - min(far_x, far_y) * toward
        flat = points @ _plane(self.up)
        self.low, self.high = flat.min(axis=0) - self.length, flat.max(axis=0) + self.length
        camera = self.plotter.camera
        camera.position, camera.up, camera.view_angle = eye, self.up, _FIELD_OF_VIEW
        camera.focal_point = eye - toward * (depth.mean() - min(far_x, far_y))
        extent, apart = np.ptp(points, axis=0), eye - points.mean(axis=0)
        far = float(np.linalg.norm(extent) + np.linalg.norm(apart))
        camera.clipping_range = (0.01 * far, 10 * far)
        self.light = unit(
            1.25 * self.up - 0.75 * right + 0.55 * unit(toward - (toward @ self.up) * self.up)
        )
        self.plotter.remove_all_lights()
        for way, strength in ((self.light, 0.62), (self.up, 0.2), (toward, 0.24)):
            lamp = pyvista.Light(position=way, focal_point=(0, 0, 0), intensity=strength)
            lamp.positional = False
            self.plotter.add_light(lamp)
        self.plotter.enable_ssao(
            radius=0.07 * self.length, bias=0.008 * self.length, kernel_size=24
        )

    def draw_text(self, text: str) -> None:
        """Put a line of text into the lower left corner, in the place of the one before."""
        self.plotter.add_text(
            text, position=(12, 10), font_size=max(6, self.size[1] // 50), color=(90, 88, 84),
            name="text", render=False,
        )  # fmt: skip

    def image(self) -> Image:
        """What the camera sees: (height, width, 3)."""
        if self.floor is not None:
            self._lay_floor(self.floor)
        self.plotter.render()
        return np.asarray(self.plotter.screenshot(None, return_img=True))[:, :, :3]

    def _lay_floor(self, floor: float) -> None:
        pyvista = load_pyvista()
        low, high, plane = self.low, self.high, _plane(self.up)
        points = _spread(self.points[self.triangles], _SAMPLES)
        dark = shadow(points, self.up, floor, self.light, low, high, self.length)
        tone = np.rint((1 - dark)[..., None] * PAPER).astype(np.uint8)
        corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])]) @ plane.T
        below = floor - 0.003 * self.length  # what lies flat on the floor is seen
        sheet = pyvista.PolyData.from_regular_faces(corners + below * self.up, [(0, 1, 2, 3)])
        sheet.active_texture_coordinates = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
        texture = pyvista.Texture(np.ascontiguousarray(tone.transpose(1, 0, 2)[::-1]))
        texture.interpolate = True
        self.plotter.add_mesh(
            sheet, texture=texture, lighting=False, name="floor", reset_camera=False, render=False
        )


def shadow(
    points: Array, up: Array, floor: float, light: Array, low: Array, high: Array, size: float
) -> Floats:
    """How dark the floor is in each cell of a grid from ``low`` to ``high``: (cells, cells), 0 … 1.

    The points (k, 3) of a thing of this size fall along some directions of the key light and of
    the sky: it is dark where something stands, and softer the higher it is. ``low`` and ``high``
    are (2,), along the two axes after ``up``. O(k + cells²).
    """
    from scipy.ndimage import gaussian_filter

    plane = _plane(up)
    height, cell = np.maximum(points @ up - floor, 0), (high - low) / _CELLS
    flat = np.ascontiguousarray((points @ plane - low).T)  # an axis each: twice as fast as in pairs
    dark = np.zeros((_CELLS, _CELLS))
    for axis, spread, count, blur in ((light, 0.1, 8, 0.012), (up, 0.9, 16, 0.04)):
        hits = np.zeros(_CELLS**2)
        for way in _cone(axis, spread, count):
            fallen = flat - height * (way @ plane / (way @ up))[:, None]
            x, y = np.floor(fallen / cell[:, None]).astype(int)
            inside = (x >= 0) & (x < _CELLS) & (y >= 0) & (y < _CELLS)
            hit = np.zeros(_CELLS**2, bool)
            hit[x[inside] * _CELLS + y[inside]] = True
            hits += hit
        dark += 0.4 * gaussian_filter(hits.reshape(_CELLS, _CELLS) / count, blur * size / cell)
    edge = np.minimum(np.arange(_CELLS), np.arange(_CELLS)[::-1]) / (0.18 * _CELLS)
    fade = np.clip(edge, 0, 1)
    return np.asarray(dark * np.minimum.outer(fade, fade))


def _plane(up: Array) -> Array:
    """The two axes across ``up``: the columns of (3, 2)."""
    return np.stack([np.roll(up, 1), np.roll(up, 2)], axis=1)


def _spread(corners: Array, count: int) -> Array:
    """Points (count, 3) spread over triangles (m, 3, 3), as many on each as its area has part."""
    a, b, c = corners.transpose(1, 0, 2)
    areas = np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1))
    face = np.searchsorted(areas, areas[-1] * (np.arange(count) + 0.5) / count)
    u, v = np.random.default_rng(0).random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return np.asarray(a[face] + u * (b - a)[face] + v * (c - a)[face])


def view_direction(up: ArrayLike, azimuth: float = AZIMUTH, elevation: float = ELEVATION) -> Floats:
    """From what is seen toward the camera: (3,) of length 1. ``up`` is an axis.

    At azimuth 0 it is the next axis: z for y, y for x, x for z.
    """
    top = np.asarray(up, float)
    around, lifted = np.radians(azimuth), np.radians(elevation)
    start = np.roll(top, 1)
    level = np.cos(around) * start + np.sin(around) * np.cross(top, start)
    return np.asarray(np.cos(lifted) * level + np.sin(lifted) * top)


def default_impact(mesh: TriangleMesh, up: str = "y") -> tuple[Array, Array]:
    """A point that the camera sees, to the left of the middle, and the way into it: two (3,)."""
    used = mesh.points[np.unique(mesh.triangles)].astype(float)
    middle = (used.max(axis=0) + used.min(axis=0)) / 2
    way = -view_direction(AXES[up], -5.0, 22.0)
    return first_hit(mesh, middle - float(np.ptp(used, axis=0).sum()) * way, way), way


def first_hit(mesh: TriangleMesh, start: Array, way: Array) -> Array:
    """Where a ray first meets a mesh, or else the vertex nearest to its way: (3,). O(m)."""
    a, b, c = (mesh.points[mesh.triangles].astype(float) - start).transpose(1, 0, 2)
    sides = np.stack([np.cross(a, b) @ way, np.cross(b, c) @ way, np.cross(c, a) @ way])
    normal = np.cross(b - a, c - a)
    slope = normal @ way
    met = ((sides >= 0).all(axis=0) | (sides <= 0).all(axis=0)) & (slope != 0)
    far = np.einsum("ij,ij->i", normal[met], a[met]) / slope[met]
    if (far > 0).any():
        return np.asarray(start + far[far > 0].min() * way)
    off = mesh.points[np.unique(mesh.triangles)].astype(float) - start
    return np.asarray(start + off[np.linalg.norm(np.cross(off, way), axis=1).argmin()])


def _apex(across: Array, depth: Array, slope: float) -> tuple[float, float]:
    """Where the apex of a wedge of this slope stands that just holds all points."""
    left, right = (across - slope * depth).max(), (-across - slope * depth).max()
    return float(left - right) / 2, float(-(left + right) / (2 * slope))


def _cone(axis: Array, spread: float, count: int) -> Array:
    """Directions around an axis within a sine of ``spread``, even over its disk: a sunflower."""
    first = unit(np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    k = np.arange(count) + 0.5
    r, turn = spread * np.sqrt(k / count), k * np.pi * (3 - np.sqrt(5))
    x, y = r * np.cos(turn), r * np.sin(turn)
    return (
        x[:, None] * first + y[:, None] * np.cross(axis, first) + np.sqrt(1 - r * r)[:, None] * axis
    )
