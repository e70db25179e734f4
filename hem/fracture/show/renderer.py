"""Shaded pictures of meshes by casting rays on the CPU: no GPU, no display, the same every time.

A picture is a list of `Shape`, a `Camera` and, if wanted, a `Floor`. The key light casts shadows,
the sky lights from above and the floor from below; edges of all kinds are smoothed by casting four
rays where neighboring pixels differ.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.fracture.show.camera import AXES, Camera, frame, unit

Array = NDArray[Any]

_PAPER = np.array([0.905, 0.900, 0.885])
"""The floor far away and what is behind everything: linear light, a warm near-white."""

_KEY, _SKY, _GROUND = 0.84, 0.42, 0.2
_CONTRAST = 0.035
_GAMMA = 2.2
_ROUND_KEY, _ROUND_SKY = 12, 20
_FADE = 0.18


class Shape(NamedTuple):
    """A mesh to be seen, from both sides.

    points     (n, 3)
    triangles  (m, 3) indices of points
    color      (3,) for all or (m, 3) for each face: sRGB in 0 … 1
    normals    (m, 3, 3) one per corner, of length 1, or none for flat faces
    gloss      (m,) or one number: how strongly the light is mirrored
    """

    points: Array
    triangles: Array
    color: ArrayLike
    normals: Array | None = None
    gloss: ArrayLike = 0.15


class Floor(NamedTuple):
    """A plane across ``up`` at a height: it only shows the shadows that fall on it."""

    height: float
    up: ArrayLike = AXES["y"]


def render(
    shapes: Sequence[Shape],
    camera: Camera,
    size: tuple[int, int] = (960, 720),
    floor: Floor | None = None,
    light: ArrayLike | None = None,
) -> NDArray[np.uint8]:
    """The picture (height, width, 3) of shapes: one ray a pixel, four where it needs smoothing.

    ``light`` is the direction toward the key light; by default it comes over the camera's left
    shoulder. Cost: O(faces log faces) to prepare, then O(log faces) a ray; 480 × 360 of 60,000
    faces take some 0.2 s.
    """
    up = unit(np.asarray(camera.up if floor is None else floor.up, float))
    right, _, forward = camera.axes()
    toward = unit(np.asarray(light, float)) if light is not None else _light(right, forward, up)
    world = _World(shapes, camera, floor, up, toward, cells=min(max(size[0] // 3, 96), 260))
    width, height = size
    y, x = (it.ravel() + 0.5 for it in np.mgrid[0:height, 0:width])
    image = world.seen(camera.rays(x, y, size)).reshape(height, width, 3)
    rough = _rough(image)
    rows, columns = np.nonzero(rough)
    parts = [
        world.seen(camera.rays(columns + dx, rows + dy, size))
        for dx, dy in ((0.375, 0.125), (0.875, 0.375), (0.125, 0.625), (0.625, 0.875))
    ]
    image[rows, columns] = np.mean(parts, axis=0)
    return np.rint(image * 255).astype(np.uint8)


def creased_normals(points: ArrayLike, triangles: Array, angle: float = 35.0) -> Array:
    """Normals (m, 3, 3) of faces' corners, smooth but across edges sharper than ``angle`` degrees.

    A corner's normal is the mean, by area, of the normals of the faces at its vertex that lie
    within ``angle`` of its own face. Cost O(sum of squared valences).
    """
    p = np.asarray(points, float)
    a, b, c = (p[triangles[:, i]] for i in range(3))
    crosses = np.cross(b - a, c - a)
    normals = unit(crosses)
    vertex = triangles.ravel()
    order = np.argsort(vertex, kind="stable")
    count = np.bincount(vertex, minlength=len(p))
    start = np.cumsum(count) - count
    many = count[vertex]  # corners at the vertex of each corner: every pair of them is looked at
    corner = np.repeat(np.arange(len(vertex)), many)
    place = np.arange(len(corner)) - np.repeat(np.cumsum(many) - many, many)
    other = order[start[vertex[corner]] + place] // 3
    near = np.einsum("ij,ij->i", normals[corner // 3], normals[other]) > np.cos(np.radians(angle))
    corner, other = corner[near], other[near]
    summed = [np.bincount(corner, crosses[other, axis], minlength=len(vertex)) for axis in range(3)]
    found = np.stack(summed, axis=1).reshape(-1, 3, 3)
    flat = ~(np.linalg.norm(found, axis=2) > 0).all(axis=1)
    found[flat] = normals[flat][:, None]
    return unit(found)


def srgb(color: str) -> Array:
    """The color (3,) in 0 … 1 of a text such as ``#9fd3d6``."""
    return np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255


class _World:
    """What rays meet, in units and at a place where float32 is exact enough."""

    def __init__(
        self,
        shapes: Sequence[Shape],
        camera: Camera,
        floor: Floor | None,
        up: Array,
        light: Array,
        cells: int,
    ) -> None:
        corners = [np.asarray(s.points, float)[s.triangles] for s in shapes if len(s.triangles)]
        triangles = np.concatenate([np.zeros((0, 3, 3)), *corners])
        ends = triangles.reshape(-1, 3) if len(triangles) else np.zeros((1, 3))
        self.middle = (ends.min(axis=0) + ends.max(axis=0)) / 2
        self.scale = 1 / max(float(np.ptp(ends, axis=0).max()), 1e-30)
        triangles = (triangles - self.middle) * self.scale
        self.flat = unit(
            np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        ).astype(np.float32)
        self.normals, self.colors, self.gloss = _surface(shapes, self.flat)
        self.scene = _embree(triangles.astype(np.float32))
        self.eye = self._here(camera.position)
        self.light, self.up = light.astype(np.float32), up.astype(np.float32)
        self.shadows = None
        if floor is not None:
            place = self.middle + (floor.height - self.middle @ up) * up
            self.floor = float(self._here(place) @ up)
            self.shadows = _Shadows(self.scene, triangles, self.floor, up, light, cells)

    def _here(self, point: Array) -> Array:
        return (point - self.middle) * self.scale

    def seen(self, directions: Array) -> Array:
        """The colors (k, 3) in the directions (k, 3) from the camera: sRGB in 0 … 1."""
        directions = np.ascontiguousarray(directions, np.float32)
        origins = np.broadcast_to(self.eye.astype(np.float32), directions.shape).copy()
        hit = self.scene.run(origins, directions, query="INTERSECT", output=True)
        face, far = hit["primID"], hit["tfar"]
        linear = np.tile(_PAPER, (len(directions), 1))
        if self.shadows is not None:
            self._show_floor(linear, directions, np.where(face < 0, np.inf, far))
            down = directions @ self.up
            reach = (self.floor - float(self.eye @ self.up)) / np.where(down == 0, 1e-9, down)
            face = np.where((reach > 0) & (reach < far - 1e-4), -1, face)
        met = np.flatnonzero(face >= 0)
        if len(met):
            where = origins[met] + far[met, None] * directions[met]
            linear[met] = self._shaded(
                face[met], hit["u"][met], hit["v"][met], where, directions[met]
            )
        return np.clip(linear, 0, 1) ** (1 / _GAMMA)

    def _show_floor(self, linear: Array, directions: Array, far: Array) -> None:
        assert self.shadows is not None
        down = directions @ self.up
        reach = (self.floor - float(self.eye @ self.up)) / np.where(down == 0, 1e-9, down)
        on = np.flatnonzero((reach > 0) & (reach < far))
        where = self.eye + reach[on, None] * directions[on]
        linear[on] *= 1 - self.shadows.at(where)[:, None]

    def _shaded(self, face: Array, u: Array, v: Array, where: Array, ray: Array) -> Array:
        flat, corner = self.flat[face], self.normals[face]
        back = np.where(np.einsum("ij,ij->i", flat, ray) > 0, -1.0, 1.0).astype(np.float32)
        flat = flat * back[:, None]
        weights = np.stack([1 - u - v, u, v], axis=1) * back[:, None]
        normal = unit(np.einsum("ic,icx->ix", weights, corner))
        facing = normal @ self.light
        lit = (facing > 0) & (flat @ self.light > 0)
        rows = np.flatnonzero(lit)
        lit[rows] = ~self._shadowed(where[rows] + 1e-3 * flat[rows])
        key = np.where(lit, facing, 0)[:, None]
        height = (normal @ self.up)[:, None]
        ambient = _GROUND + (_SKY - _GROUND) * (0.5 + 0.5 * height)
        halfway = unit(self.light - ray)
        shine = np.clip(np.einsum("ij,ij->i", normal, halfway), 0, 1) ** 48 * lit
        rim = (1 - np.clip(-np.einsum("ij,ij->i", normal, ray), 0, 1)) ** 4
        mirrored = (self.gloss[face] * (1.1 * shine + 0.8 * rim))[:, None]
        diffuse = self.colors[face] * (_KEY * key + ambient) * np.where(back < 0, 0.8, 1)[:, None]
        return diffuse + mirrored

    def _shadowed(self, where: Array) -> Array:
        return _occluded(self.scene, where, self.light)


class _Shadows:
    """How much of the light is kept from the floor, on a grid of cells around what stands on it.

    The key light and the sky are each a handful of directions, so that shadows are soft, softer
    the higher up what casts them, and dark where something touches the floor.
    """

    def __init__(
        self, scene: Any, triangles: Array, floor: float, up: Array, light: Array, cells: int
    ) -> None:
        from scipy.ndimage import gaussian_filter

        self.right, self.front = frame(up)
        key = _cone(light, 0.10, _ROUND_KEY)
        sky = _cone(up, 0.95, _ROUND_SKY)
        ends = triangles.reshape(-1, 3) if len(triangles) else np.zeros((1, 3))
        ends = np.vstack([ends.min(axis=0), ends.max(axis=0)])
        ends = np.stack([it.ravel() for it in np.meshgrid(*ends.T)], axis=1)
        drop = np.maximum(ends @ up - floor, 0)[:, None]
        cast = np.vstack([ends, ends - drop / max(float(light @ up), 0.2) * light])
        plane = np.stack([cast @ self.right, cast @ self.front], axis=1)
        room = 0.35
        self.low, high = plane.min(axis=0) - room, plane.max(axis=0) + room
        self.cell = (high - self.low) / (cells - 1)
        i, j = (it.ravel() for it in np.mgrid[0:cells, 0:cells])
        x, y = self.low[0] + i * self.cell[0], self.low[1] + j * self.cell[1]
        spots = x[:, None] * self.right + y[:, None] * self.front + (floor + 1e-4) * up
        sharp, wide = (_kept(scene, spots, it).reshape(cells, cells) for it in (key, sky))
        self.dark = 0.42 * gaussian_filter(sharp, 0.004 * cells) + 0.42 * gaussian_filter(
            wide, 0.014 * cells
        )
        ends_at = np.clip(
            np.minimum(np.arange(cells), np.arange(cells)[::-1]) / (_FADE * cells), 0, 1
        )
        self.dark *= np.minimum.outer(ends_at, ends_at)

    def at(self, where: Array) -> Array:
        """The part of the light that is kept from places (k, 3) on the floor."""
        from scipy.ndimage import map_coordinates

        plane = np.stack([where @ self.right, where @ self.front])
        inside = (plane - self.low[:, None]) / self.cell[:, None]
        return map_coordinates(self.dark, inside, order=1, mode="constant", cval=0.0)


def _surface(shapes: Sequence[Shape], flat: Array) -> tuple[Array, Array, Array]:
    """Corner normals (m, 3, 3), linear colors (m, 3) and gloss (m,) of all faces of all shapes."""
    normals = np.repeat(flat[:, None], 3, axis=1)
    colors, gloss = np.empty((len(flat), 3), np.float32), np.empty(len(flat), np.float32)
    end = 0
    for shape in shapes:
        begin, end = end, end + len(shape.triangles)
        if shape.normals is not None:
            normals[begin:end] = shape.normals
        colors[begin:end] = np.asarray(shape.color, float) ** _GAMMA
        gloss[begin:end] = shape.gloss
    return normals, colors, gloss


def _embree(triangles: Array) -> Any:
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    scene = rtcore_scene.EmbreeScene()
    if len(triangles):
        TriangleMesh(scene, np.ascontiguousarray(triangles))
    return scene


def _occluded(scene: Any, where: Array, toward: Array) -> Array:
    origins = np.ascontiguousarray(where, np.float32)
    directions = np.ascontiguousarray(np.broadcast_to(toward, origins.shape), np.float32)
    return scene.run(origins, directions, query="OCCLUDED") >= 0


def _kept(scene: Any, spots: Array, directions: Array) -> Array:
    """The part of the directions in which something is in the way of each spot."""
    return np.mean([_occluded(scene, spots, it) for it in directions], axis=0)


def _cone(axis: Array, spread: float, count: int) -> Array:
    """Directions around an axis within a sine of ``spread``, even over its disk: a sunflower."""
    right, front = frame(axis)
    k = np.arange(count) + 0.5
    r, turn = spread * np.sqrt(k / count), k * np.pi * (3 - np.sqrt(5))
    x, y = r * np.cos(turn), r * np.sin(turn)
    return x[:, None] * right + y[:, None] * front + np.sqrt(1 - r * r)[:, None] * axis


def _rough(image: Array) -> Array:
    """Which pixels differ from one of their neighbors by more than the eye lets pass."""
    from scipy.ndimage import maximum_filter, minimum_filter

    size = (3, 3, 1)
    span = maximum_filter(image, size) - minimum_filter(image, size)
    return span.max(axis=2) > _CONTRAST


def _light(right: Array, forward: Array, up: Array) -> Array:
    level = unit(forward - (forward @ up) * up)
    return unit(1.25 * up - 0.75 * right - 0.55 * level)
