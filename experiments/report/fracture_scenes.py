"""Breaking a model to be looked at: what ``hem fracture``, the demo and the notebook share."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import hem
import structures
from hem.arrays import Array
from hem.fracture import (
    Blow,
    Fracture,
    Material,
    motion,
    shatter,
    tetrahedra,
    voronoi,
    wrapped,
)
from hem.fracture.show import (
    AXES,
    FRAMES_PER_SECOND,
    GRAVITY,
    Flight,
    FractureScene,
    flight,
    view_direction,
)

METHODS = ("voronoi", "tetra", "surface")

PLATE = "plate"
"""Another name of the family ``grid``: a sheet that stands upright."""

UP = {"teapot": "z", "terrain": "z", "cone": "z"}
"""The axis that points up, of the models and families where it is not y."""

EASE = 1.6
"""Animations begin in slow motion: a frame's time is its part of them to this power."""

_SIZE = 2000
_PLATE_SIZE = 144


class Broken(NamedTuple):
    """A model that was struck, what it broke into and how the pieces set off."""

    mesh: hem.TriangleMesh
    fracture: Fracture
    blow: Any
    motion: Any
    up: str

    @property
    def held(self) -> list[int]:
        """The pieces that stay where they are: of a surface the largest part of the rest."""
        shards, rest = len(self.fracture.shards), len(self.fracture.rest)
        return [shards] if rest and not self.fracture.closed else []

    def scene(self) -> FractureScene:
        """How it is drawn."""
        return FractureScene.build(self.fracture, self.mesh, self.up)

    def flight(self, scene: FractureScene, seconds: float, play: float = 3.2) -> Flight:
        """How the pieces fly for so many seconds, in pictures for ``play`` seconds."""
        frames = round(play * FRAMES_PER_SECOND)
        place: dict[str, Any] = {"up": scene.up, "floor": scene.floor}
        return flight(
            self.fracture, self.motion, seconds, frames, **place, held=self.held, ease=EASE
        )


def model(
    name: str, wrap: bool = False, scale: float = 1.0, repair: bool = False
) -> tuple[hem.TriangleMesh, str]:
    """The mesh of a file, a sample, or a family such as ``sphere:2000``; and its axis up.

    What is read is mended first with ``repair``; then it is multiplied by ``scale``, and with
    ``wrap`` it is the body around that. Raises MeshError for what there is not.
    """
    mesh, up = _read(name, repair)
    if not len(mesh.triangles):
        raise hem.MeshError(f"there is nothing to break: {name} has no faces")
    if scale != 1:
        mesh = hem.TriangleMesh(mesh.points * np.float32(scale), mesh.triangles)
    if wrap:
        mesh = wrapped(mesh)
    return mesh, up


def _read(name: str, repair: bool) -> tuple[hem.TriangleMesh, str]:
    family, _, size = name.partition(":")
    if not Path(name).exists():
        if name in hem.SAMPLES:
            return hem.sample(name, **({"repair": True} if repair else {})), UP.get(name, "y")
        if family in (PLATE, *hem.FAMILIES):
            default = _PLATE_SIZE if family == PLATE else _SIZE
            count = _count(name, size) if size else default
            made = "grid" if family == PLATE else family
            return hem.generate(made, count), UP.get(family, "y")
        if not Path(name).suffix:
            every = ", ".join((*hem.SAMPLES, PLATE, *hem.FAMILIES))
            raise hem.MeshError(
                f"there is no model {name!r}: name a file, or one of {every}; families take a "
                "size, as in sphere:2000"
            )
    return hem.load(name, repair, triangulate=True), "y"


def _count(name: str, size: str) -> int:
    if not size.replace("_", "").isascii() or not size.replace("_", "").isdigit():
        raise hem.MeshError(f"{name!r}: after the colon stands a number of vertices")
    return int(size)


def is_closed(mesh: hem.TriangleMesh) -> bool:
    """Whether every edge is in two faces. O(m log m)."""
    return mesh.summary().border_edges == 0


def break_up(
    mesh: hem.TriangleMesh,
    method: str,
    material: Material,
    force: float,
    *,
    impact: ArrayLike | None = None,
    direction: ArrayLike | None = None,
    seed: int = 0,
    structure: str = "half_edge",
    up: str = "y",
) -> Broken:
    """Break a mesh with a blow of ``force`` J/kg, by default where the camera can see it.

    ``structure`` holds the mesh for the methods that begin on its surface: tetra, and surface, in
    which the force decides only how the shards fly. Raises MeshError for unknown methods and
    structures, and for what they refuse.
    """
    if structure not in structures.NAMES:
        known = ", ".join(structures.NAMES)
        raise hem.MeshError(f"there is no structure {structure!r}, only {known}")
    if method not in METHODS:
        raise hem.MeshError(f"there is no method {method!r}, only {', '.join(METHODS)}")
    if impact is None:
        impact, way = default_impact(mesh, up)
        direction = way if direction is None else direction
    # A blow is checked before anything is broken.
    given = Blow(
        np.asarray(impact), np.asarray((0, 0, 1) if direction is None else direction), force
    )
    if method == "voronoi":
        fracture = voronoi(mesh, impact, material, force, seed, direction)
    else:
        held = structures.build(structure, mesh)
        if method == "tetra":
            fracture = tetrahedra(held, impact, material, force, seed)
        else:
            fracture = shatter(held, impact, material, seed)
        if direction is not None:
            fracture = replace(fracture, direction=given.direction)
    blow = Blow(fracture.impact, fracture.direction, force)
    return Broken(mesh, fracture, blow, motion(fracture, blow), up)


def enough_seconds(scene: FractureScene) -> float:
    """Until all has fallen and come to rest, more or less: four times a fall from the top."""
    height = float((scene.points @ scene.up).max()) - scene.floor
    return float(np.clip(4 * np.sqrt(2 * height / GRAVITY), 0.4, 8.0))


def default_impact(mesh: hem.TriangleMesh, up: str = "y") -> tuple[Array, Array]:
    """A point that the camera sees, to the left of the middle, and the way into it: two (3,)."""
    used = mesh.points[np.unique(mesh.triangles)].astype(float)
    middle = (used.max(axis=0) + used.min(axis=0)) / 2
    way = -view_direction(AXES[up], -5.0, 22.0)
    return first_hit(mesh, middle - float(np.ptp(used, axis=0).sum()) * way, way), way


def first_hit(mesh: hem.TriangleMesh, start: Array, way: Array) -> Array:
    """Where a ray first meets a mesh, or else the vertex nearest to its way: (3,). O(m)."""
    a, b, c = (mesh.points[mesh.triangles[:, i]].astype(float) - start for i in range(3))
    sides = np.stack([np.cross(a, b) @ way, np.cross(b, c) @ way, np.cross(c, a) @ way])
    normal = np.cross(b - a, c - a)
    slope = normal @ way
    met = ((sides >= 0).all(axis=0) | (sides <= 0).all(axis=0)) & (slope != 0)
    far = np.einsum("ij,ij->i", normal[met], a[met]) / slope[met]
    if (far > 0).any():
        return np.asarray(start + far[far > 0].min() * way)
    off = mesh.points[np.unique(mesh.triangles)].astype(float) - start
    return np.asarray(start + off[np.linalg.norm(np.cross(off, way), axis=1).argmin()])
