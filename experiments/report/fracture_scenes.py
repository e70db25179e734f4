"""Breaking a model to be looked at: what ``hem fracture``, the demo and the notebook share."""

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import hem
import structures
from hem.fracture import Blow, Fracture, Material, motion, shatter, tetrahedra, voronoi, wrapped
from hem.fracture.show import FRAMES_PER_SECOND, GRAVITY, Flight, FractureScene, default_impact
from hem.fracture.show import flight as fly

METHODS = ("voronoi", "tetra", "surface")
PLATE = "plate"  # another name of the family grid: a sheet that stands upright
UP = {"teapot": "z", "terrain": "z", "cone": "z"}  # where the axis that points up is not y
EASE = 1.6  # animations begin in slow motion: a frame's time is its part of them to this power


class Broken(NamedTuple):
    """A model that was struck, what it broke into and how the pieces set off."""

    mesh: hem.TriangleMesh
    fracture: Fracture
    blow: Any
    motion: Any
    up: str
    held: list[int]
    """The pieces that stay where they are: of a surface the largest part of the rest."""

    def scene(self) -> FractureScene:
        """How it is drawn."""
        return FractureScene.build(self.fracture, self.mesh, self.up)

    def flight(self, scene: FractureScene, seconds: float | None) -> Flight:
        """How the pieces fly for so many seconds, in pictures for some more.

        None: until all has fallen and come to rest, more or less: four times a fall from the top.
        """
        height = float((scene.points @ scene.up).max()) - scene.floor
        seconds = seconds or float(np.clip(4 * np.sqrt(2 * height / GRAVITY), 0.4, 8.0))
        frames = round(3.2 * FRAMES_PER_SECOND)
        options: Any = {"up": scene.up, "floor": scene.floor, "held": self.held, "ease": EASE}
        return fly(self.fracture, self.motion, seconds, frames, **options)


def model(
    name: str, wrap: bool = False, scale: float = 1.0, repair: bool = False
) -> tuple[hem.TriangleMesh, str]:
    """The mesh of a file, a sample, or a family such as ``sphere:2000``; and its axis up.

    What is read is mended first with ``repair``; then it is multiplied by ``scale``, and with
    ``wrap`` it is the body around that. Raises MeshError for what there is not.
    """
    family, colon, size = name.partition(":")
    is_file = Path(name).is_file()
    kind = f"grid:{size if colon else 144}" if family == PLATE and not is_file else name
    mesh = hem.find_mesh(kind, repair, triangulate=True)
    up = "y" if is_file else UP.get(family, "y")
    if not len(mesh.triangles):
        raise hem.MeshError(f"there is nothing to break: {name} has no faces")
    if scale != 1:
        mesh = hem.TriangleMesh(mesh.points * np.float32(scale), mesh.triangles)
    return (wrapped(mesh) if wrap else mesh), up


def break_up(
    mesh: hem.TriangleMesh, method: str, material: Material, force: float, *,
    impact: ArrayLike | None = None, direction: ArrayLike | None = None, seed: int = 0,
    structure: str = "half_edge", up: str = "y",
) -> Broken:  # fmt: skip
    """Break a mesh with a blow of ``force`` J/kg, by default where the camera can see it.

    ``structure`` holds the mesh for the methods that begin on its surface: tetra, and surface, in
    which the force decides only how the shards fly. Raises MeshError for unknown methods and
    structures, and for what they refuse.
    """
    known = ("structure", structure, structures.NAMES), ("method", method, METHODS)
    for what, name, names in known:
        if name not in names:
            raise hem.MeshError(f"there is no {what} {name!r}, only {', '.join(names)}")
    if impact is None:
        impact, way = default_impact(mesh, up)
        direction = way if direction is None else direction
    toward = np.asarray((0, 0, 1) if direction is None else direction)
    given = Blow(np.asarray(impact), toward, force)  # checked before all is broken
    if method == "voronoi":
        fracture = voronoi(mesh, impact, material, force, seed, direction)
    elif method == "tetra":
        fracture = tetrahedra(structures.build(structure, mesh), impact, material, force, seed)
    else:
        fracture = shatter(structures.build(structure, mesh), impact, material, seed)
    if direction is not None:
        fracture = replace(fracture, direction=given.direction)
    blow = Blow(fracture.impact, fracture.direction, force)
    held = [len(fracture.shards)] if fracture.rest and not fracture.closed else []
    return Broken(mesh, fracture, blow, motion(fracture, blow, held=held), up, held)
