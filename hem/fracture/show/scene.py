"""Pictures and animations of a fracture: its pieces in place, moved apart, and flying."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hem
from hem.fracture import Fracture
from hem.fracture.show.camera import AXES, Camera, unit
from hem.fracture.show.flight import Flight
from hem.fracture.show.renderer import Floor, Shape, creased_normals, render, srgb

Array = NDArray[Any]
Image = NDArray[np.uint8]
Size = tuple[int, int]

AZIMUTH, ELEVATION = 30.0, 18.0
FRAMES_A_SECOND = 25
_CREASE = 40.0
_GAP = 0.018
_GLOSS = {"glass": 0.75, "ice": 0.6, "ceramic": 0.45, "stone": 0.05, "wood": 0.08}


@dataclass(frozen=True)
class Stage:
    """The pieces of a fracture as they are drawn, each in its own place, and what they stand on."""

    fracture: Fracture
    up: Array
    height: float
    points: Array
    triangles: Array
    normals: Array
    colors: Array
    gloss: Array
    vertex_piece: Array
    face_piece: Array

    @classmethod
    def of(cls, fracture: Fracture, mesh: hem.TriangleMesh, up: str = "y") -> Stage:
        """How the pieces of ``mesh`` look: its skin smooth, the walls of the cuts flat and darker.

        Cost O(faces log faces).
        """
        pieces = fracture.pieces
        starts = np.cumsum([0, *(len(it.points) for it in pieces)])
        points = np.concatenate([it.points for it in pieces]).astype(float)
        triangles = np.concatenate(
            [it.triangles + start for it, start in zip(pieces, starts, strict=False)]
        )
        vertex_piece = np.repeat(np.arange(len(pieces)), np.diff(starts))
        face_piece = vertex_piece[triangles[:, 0]]
        top = np.array(AXES[up])
        used = mesh.points[np.unique(mesh.triangles)]
        skin = np.ones(len(triangles), bool)
        if fracture.closed:
            skin = on_surface(points[triangles], mesh, fracture.diagonal)
        return cls(
            fracture=fracture,
            up=top,
            height=float((used @ top).min()),
            points=points,
            triangles=triangles,
            normals=creased_normals(points, triangles, _CREASE),
            colors=_colors(fracture, skin, face_piece),
            gloss=_GLOSS.get(fracture.material.name, 0.25) * np.where(skin, 1.0, 0.35),
            vertex_piece=vertex_piece,
            face_piece=face_piece,
        )

    def shape(self, positions: Array, rotations: Array | None = None, shrink: float = 0.0) -> Shape:
        """All pieces with their centers of mass (n, 3) elsewhere, turned and perhaps shrunken."""
        piece, faces = self.vertex_piece, self.face_piece
        arms = (self.points - self.fracture.mass.centers[piece]) * (1 - shrink)
        normals = self.normals
        if rotations is not None:
            arms = np.einsum("nij,nj->ni", rotations[piece], arms)
            normals = np.einsum("nij,ncj->nci", rotations[faces], normals)
        return Shape(positions[piece] + arms, self.triangles, self.colors, normals, self.gloss)

    def exploded(self, factor: float = 0.4) -> Array:
        """Centers (n, 3) moved apart: each away from the middle of all, none below the floor."""
        mass, found = self.fracture.mass, self.fracture
        if not found.closed:  # shards come out of a surface toward whom it is struck by
            moved = mass.centers + factor * (mass.centers - found.impact)
            moved -= factor * 0.4 * found.diagonal * found.direction
            moved[len(found.shards) :] = mass.centers[len(found.shards) :]
            return moved
        middle = np.average(mass.centers, axis=0, weights=np.maximum(mass.masses, 1e-12))
        moved = mass.centers + factor * (mass.centers - middle)
        below = self.height - np.minimum.reduceat(
            (self.shape(moved).points @ self.up), self._first_vertices()
        )
        return np.asarray(moved + max(float(below.max()), 0.0) * self.up)

    def _first_vertices(self) -> Array:
        return np.searchsorted(self.vertex_piece, np.arange(len(self.fracture.pieces)))


def on_surface(corners: Array, mesh: hem.TriangleMesh, diagonal: float) -> NDArray[np.bool_]:
    """Which triangles (m, 3, 3) lie on the surface of a mesh, facing as it does: (m,).

    A ray from just above the middle of each must meet the surface just below. O(m log faces).
    """
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    middle = (mesh.points.max(axis=0) + mesh.points.min(axis=0)) / 2.0
    scene = rtcore_scene.EmbreeScene()
    TriangleMesh(
        scene, np.ascontiguousarray(((mesh.points - middle) / diagonal)[mesh.triangles], np.float32)
    )
    placed = (corners - middle) / diagonal
    normal = np.cross(placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / np.where(length > 0, length, 1)
    lifted = 5e-4
    hit = scene.run(
        np.ascontiguousarray(placed.mean(axis=1) + lifted * normal, np.float32),
        np.ascontiguousarray(-normal, np.float32),
        query="INTERSECT",
        output=True,
    )
    met = hit["primID"] >= 0
    facing = np.einsum("ij,ij->i", unit(hit["Ng"]), normal)
    found: NDArray[np.bool_] = met & (hit["tfar"] < 2 * lifted) & (np.abs(facing) > 0.9)
    return found


def still(stage: Stage, size: Size = (640, 480)) -> Image:
    """Two pictures of a size side by side: where it broke, and the pieces moved apart."""
    floor = Floor(stage.height, stage.up)
    pictures = []
    for shape in (
        stage.shape(stage.fracture.mass.centers, shrink=_GAP),
        stage.shape(stage.exploded()),
    ):
        camera = _camera(shape.points, stage.up, size)
        pictures.append(render([shape], camera, size, floor))
    return np.hstack(pictures)


def frames(stage: Stage, flight: Flight, size: Size = (640, 480)) -> Iterator[Image]:
    """A picture of every frame of a flight, all by one camera that sees where pieces end up."""
    from concurrent.futures import ThreadPoolExecutor

    camera = _camera(_stays(stage, flight), stage.up, size)
    floor = Floor(stage.height, stage.up)

    def picture(frame: int) -> Image:
        shape = stage.shape(flight.positions[frame], flight.rotations[frame], _GAP / 3)
        return render([shape], camera, size, floor)

    # Casting rays lets other threads run.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield from pool.map(picture, range(len(flight.times)))


def _camera(points: Array, up: Array, size: Size) -> Camera:
    return Camera.around(points, AZIMUTH, ELEVATION, up, aspect=size[0] / size[1])


def _stays(stage: Stage, flight: Flight) -> Array:
    """The model and the ways of its pieces, as far as they stay near: what the camera shows.

    It follows the pieces that make up most of the mass farther than it does crumbs.
    """
    masses = stage.fracture.mass.masses
    order = np.argsort(-masses)
    heavy = np.zeros(len(masses), bool)
    heavy[order[: 1 + np.searchsorted(np.cumsum(masses[order]), 0.95 * masses.sum())]] = True
    low, high = stage.points.min(axis=0), stage.points.max(axis=0)
    poses = zip(flight.positions[::8], flight.rotations[::8], strict=True)
    moments = np.stack([stage.shape(*pose).points for pose in poses])
    kept = [stage.points]
    for pieces, room in ((heavy, 0.36), (~heavy, 0.16)):
        far = room * float(np.linalg.norm(high - low))
        ways = moments[:, pieces[stage.vertex_piece]].reshape(-1, 3)
        ways = np.clip(ways, low - far, high + far * (1 - 0.6 * np.abs(stage.up)))
        sunk = np.maximum(stage.height - ways @ stage.up, 0)
        kept.append(ways + sunk[:, None] * stage.up)
    return np.vstack(kept)


def caption(image: Image, text: str) -> Image:
    """The picture with a line of text in its lower left corner."""
    import matplotlib
    from PIL import Image as Pillow
    from PIL import ImageDraw, ImageFont

    picture = Pillow.fromarray(image)
    size = max(11, image.shape[0] // 30)
    place = (size, image.shape[0] - 2 * size)
    file = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    font = ImageFont.truetype(str(file), size)
    ImageDraw.Draw(picture).text(place, text, fill=(90, 88, 84), font=font)
    return np.asarray(picture)


def save_gif(images: Sequence[Image], path: Path, hold: tuple[float, float] = (0.5, 1.2)) -> None:
    """An animation of one palette, 25 pictures a second, held for seconds at start and end."""
    from PIL import Image as Pillow

    every = [Pillow.fromarray(it) for it in images]
    sample = np.hstack(images[:: max(1, len(images) // 6)])
    palette = Pillow.fromarray(sample).quantize(255, method=Pillow.Quantize.MEDIANCUT)
    flat = [it.quantize(palette=palette, dither=Pillow.Dither.NONE) for it in every]
    spans = [1000 // FRAMES_A_SECOND] * len(flat)
    spans[0], spans[-1] = int(hold[0] * 1000), int(hold[1] * 1000)
    flat[0].save(path, save_all=True, append_images=flat[1:], duration=spans, loop=0, disposal=1)


def made(
    stage: Stage, flight: Flight, size: Size, text: str, report: Callable[[int], None]
) -> list[Image]:
    """The pictures of a flight with a caption each; ``report`` hears how many are done."""
    images = []
    for image, time in zip(frames(stage, flight, size), flight.times, strict=True):
        images.append(caption(image, f"{text}, {time:.2f} s after the blow"))
        report(len(images))
    return images


def _colors(fracture: Fracture, skin: Array, face_piece: Array) -> Array:
    """(m, 3): the material's, darker and richer inside, every piece a little different."""
    base = srgb(fracture.material.color)
    inside = base**1.4 * 0.9
    tint = 1 + (0.07 if fracture.closed else 0.25) * (((face_piece * 0.6180339887) % 1) - 0.5)
    return np.clip(np.where(skin[:, None], base, inside) * tint[:, None], 0, 1)
