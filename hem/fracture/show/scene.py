"""Pictures and animations of a fracture: its pieces in place, moved apart, and flying."""

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from hem.arrays import Array, Bools
from hem.fracture.pieces import Fracture
from hem.fracture.show.flight import Flight
from hem.fracture.show.picture import AXES, Image, Picture, Size, load_pyvista
from hem.meshes import TriangleMesh, joined

FRAMES_PER_SECOND = 25
_GAP = 0.018
_GLOSS = {"glass": 0.5, "ice": 0.4, "ceramic": 0.3, "stone": 0.05, "wood": 0.05}


@dataclass(frozen=True)
class FractureScene:
    """The pieces of a fracture as they are drawn, all in one mesh, and the floor they stand on."""

    fracture: Fracture
    up: Array
    floor: float
    points: Array
    triangles: Array
    colors: Array  # (m, 3): sRGB in 0 … 1
    piece: Array  # (n,): of each point

    @classmethod
    def build(cls, fracture: Fracture, mesh: TriangleMesh, up: str = "y") -> Self:
        """How the pieces of ``mesh`` look: its skin in the material's color, cuts darker."""
        pieces = fracture.pieces
        points, triangles = joined((each.points, each.triangles) for each in pieces)
        points = points.astype(float)
        piece = np.repeat(np.arange(len(pieces)), [len(each.points) for each in pieces])
        skin = on_surface(points[triangles], mesh) if fracture.closed else True
        floor = float((mesh.points[np.unique(mesh.triangles)] @ np.array(AXES[up])).min())
        colors = _colors(fracture, np.broadcast_to(skin, len(triangles)), piece[triangles[:, 0]])
        return cls(fracture, np.array(AXES[up]), floor, points, triangles, colors, piece)

    def placed(
        self, positions: Array, rotations: Array | None = None, shrink: float = 0.0
    ) -> Array:
        """The points (n, 3) of pieces whose centers of mass (p, 3) are elsewhere, turned so."""
        arms = (self.points - self.fracture.mass.centers[self.piece]) * (1 - shrink)
        if rotations is not None:
            arms = np.einsum("nij,nj->ni", rotations[self.piece], arms)
        return np.asarray(positions[self.piece] + arms)

    def exploded(self, factor: float = 0.4) -> Array:
        """Centers (p, 3) moved apart: each away from the middle of all, none below the floor."""
        mass, broken = self.fracture.mass, self.fracture
        if not broken.closed:  # in front of the surface, beside the hole rather than before it
            moved = mass.centers + factor * 0.5 * (mass.centers - broken.impact)
            moved -= factor * 1.5 * broken.diagonal * broken.direction
            moved[len(broken.shards) :] = mass.centers[len(broken.shards) :]
            return moved
        middle = np.average(mass.centers, axis=0, weights=np.maximum(mass.masses, 1e-12))
        moved = mass.centers + factor * (mass.centers - middle)
        lowest = np.full(len(moved), np.inf)
        np.minimum.at(lowest, self.piece, self.placed(moved) @ self.up)
        return np.asarray(moved + np.maximum(self.floor - lowest, 0)[:, None] * self.up)

    def still(self, size: Size = (640, 480)) -> Image:
        """Two pictures of a size side by side: where it broke, and the pieces moved apart."""
        images = []
        with closing(self._picture(size)) as picture:
            for points in (self._whole(_GAP), self.placed(self.exploded())):
                picture.move(points)
                picture.look_at(points)
                images.append(picture.image())
        return np.hstack(images)

    def frames(self, flight: Flight, size: Size = (640, 480), caption: str = "") -> Iterator[Image]:
        """A picture of each frame of a flight, all by one camera that sees where pieces end up."""
        with closing(self._picture(size)) as picture:
            picture.look_at(self._stays(flight))
            for time, positions, rotations in zip(*flight[:3], strict=True):
                moved = self.placed(positions, rotations, _GAP)
                picture.move(moved, rotations[self.piece])
                picture.draw_text(f"{caption}, {time:.2f} s after the blow" if caption else "")
                yield picture.image()

    def _whole(self, shrink: float = 0.0) -> Array:
        return self.placed(self.fracture.mass.centers, shrink=shrink)

    def _picture(self, size: Size) -> Picture:
        gloss = _GLOSS.get(self.fracture.material.name, 0.2)
        return Picture(
            self.points, self.triangles, self.colors, size, self.up, self.floor, gloss=gloss
        )

    def _stays(self, flight: Flight) -> Array:
        """The model and the ways of its pieces, as far as they stay near: what the camera shows.

        It follows the pieces that make up most of the mass farther than it does crumbs.
        """
        masses = self.fracture.mass.masses
        order = np.argsort(-masses)
        most = np.searchsorted(np.cumsum(masses[order]), 0.95 * masses.sum())
        heavy = np.isin(self.piece, order[: 1 + most])
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        poses = zip(flight.positions[::8], flight.rotations[::8], strict=True)
        ways = np.stack([self.placed(at, turned) for at, turned in poses])
        kept = [self.points]
        for part, room in ((heavy, 0.36), (~heavy, 0.16)):
            far = room * float(np.linalg.norm(high - low))
            near = np.clip(
                ways[:, part], low - far * (1 - self.up), high + far * (1 - 0.6 * self.up)
            )
            kept.append(near.reshape(-1, 3))
        return np.vstack(kept)


def on_surface(corners: Array, mesh: TriangleMesh) -> Bools:
    """Which triangles (m, 3, 3) lie on the surface of a mesh, and as it does: (m,)."""
    pyvista = load_pyvista()
    surface = pyvista.PolyData.from_regular_faces(mesh.points.astype(float), mesh.triangles)
    surface.cell_data["normal"] = surface.face_normals
    triangles = np.arange(3 * len(corners)).reshape(-1, 3)
    across = pyvista.PolyData.from_regular_faces(corners.reshape(-1, 3), triangles).face_normals
    middles = pyvista.PolyData(corners.mean(axis=1))
    found = middles.sample(surface, tolerance=3e-4 * surface.length)  # finds all in one call
    facing = np.abs(np.einsum("ij,ij->i", found["normal"], across)) > 0.9
    return np.asarray(facing & (found["vtkValidPointMask"] > 0))


def save_animation(
    images: Sequence[Image], path: Path, hold: tuple[float, float] = (0.5, 1.2)
) -> None:
    """Write pictures as a gif of one palette, or as webp; held for seconds at start and end."""
    from PIL import Image as Pillow

    frames = [Pillow.fromarray(image) for image in images]
    if path.suffix == ".gif":
        sample = Pillow.fromarray(np.hstack(images[:: max(1, len(images) // 6)]))
        palette = sample.quantize(255, method=Pillow.Quantize.MEDIANCUT)
        frames = [frame.quantize(palette=palette, dither=Pillow.Dither.NONE) for frame in frames]
    spans = [1000 // FRAMES_PER_SECOND] * len(frames)
    spans[0], spans[-1] = int(hold[0] * 1000), int(hold[1] * 1000)
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=spans, loop=0, quality=80,
    )  # fmt: skip


def _colors(fracture: Fracture, skin: Array, piece: Array) -> Array:
    """(m, 3): the material's, darker and richer inside, every piece a little different."""
    base = np.array([*fracture.material.rgb]) / 255
    tint = 1 + (0.07 if fracture.closed else 0.25) * ((piece * 0.6180339887) % 1 - 0.5)
    return np.clip(np.where(skin[:, None], base, 0.8 * base**1.4) * tint[:, None], 0, 1)
