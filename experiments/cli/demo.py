"""The demo of breaking meshes: ``make demo`` makes some animations and a page to watch them on."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from experiments.cli.console import console
from experiments.report.fracture_scenes import Broken, break_up, enough_seconds, model
from hem.fracture.show.scene import FRAMES_A_SECOND, frames

Image = NDArray[np.uint8]

OUT = Path("report/demo")
SIZE = 560, 392
SECONDS = 2.4
"""How long an animation plays at its usual speed."""

COLUMNS = 6
"""How many frames stand beside each other in the picture that holds them all."""


class Scene(NamedTuple):
    """What is broken, of what, by which method and at which forces; and what to look at."""

    name: str
    title: str
    model: str
    material: str
    method: str
    forces: tuple[float, ...]
    what: str
    wrap: bool = False
    scale: float = 1.0
    seed: int = 0
    impact: tuple[float, float, float] | None = None
    direction: tuple[float, float, float] | None = None


SCENES = (
    Scene(
        "bunny", "Glass bunny", "bunny", "glass", "voronoi", (2, 10, 40),
        "The Stanford bunny as a solid of glass, broken into Voronoi cells that gather around the "
        "impact. A stronger blow makes more and smaller cells, and reaches farther.",
    ),
    Scene(
        "teapot", "Ceramic teapot", "teapot", "ceramic", "voronoi", (1, 5, 25),
        "The Utah teapot is an open surface, so a body is wrapped around it first. It is solid "
        "inside; ceramic breaks into fewer and larger pieces than glass.",
        wrap=True, scale=0.05,
    ),
    Scene(
        "sphere", "Stone sphere", "sphere:162", "stone", "tetra", (1, 6, 20),
        "A ball of stone out of which tetrahedra break: the triangles around the impact are split "
        "as in the thesis, and each takes a wedge of the body under it along.",
        scale=0.2, impact=(0.08, 0.13, 0.13), direction=(0, -1, 0),
    ),
    Scene(
        "plate", "Glass plate", "plate:144", "glass", "surface", (0.3, 3),
        "The thesis' own method (4.4): a sheet, broken on its surface. The triangles around the "
        "impact are split at scattered break points and taken out; the rest of the plate is held.",
    ),
)  # fmt: skip


def main() -> None:
    """Make all animations and the page."""
    begun = perf_counter()
    page = write(OUT, say=lambda line: console.print(line, highlight=False))
    console.print(
        f"Done in {perf_counter() - begun:.0f} s. Open {page.resolve().as_uri()}", soft_wrap=True
    )


def write(
    folder: Path,
    scenes: tuple[Scene, ...] = SCENES,
    size: tuple[int, int] = SIZE,
    seconds: float = SECONDS,
    say: Callable[[str], None] = lambda line: None,
) -> Path:
    """Make the scenes and the page that plays them -> the page. It needs no network.

    Everything is made beside the folder and moved there at the end.
    """
    from hem.fracture.files import whole

    shown = []
    with whole(folder) as beside:
        for scene in scenes:
            mesh, up = model(scene.model, scene.wrap, scene.scale)
            takes = []
            for force in scene.forces:
                begun = perf_counter()
                broken = _struck(scene, mesh, up, force)
                takes.append(_take(scene, broken, force, size, seconds, beside))
                pieces = len(broken.fracture.pieces)
                took = perf_counter() - begun
                say(f"{scene.title}, {force:g} J/kg: {pieces} pieces, {took:.0f} s")
            shown.append({**_told(scene), "takes": takes})
        (beside / "index.html").write_text(_page(shown, size), encoding="utf-8")
    made = {take["frames"] for told in shown for take in told["takes"]}
    for path in folder.glob("*.webp"):  # of scenes that there are no more
        if path.name not in made:
            path.unlink()
    return folder / "index.html"


def _struck(scene: Scene, mesh: Any, up: str, force: float) -> Broken:
    from hem.fracture import material

    return break_up(
        mesh,
        scene.method,
        material(scene.material),
        force,
        impact=scene.impact,
        direction=scene.direction,
        seed=scene.seed,
        up=up,
    )


def _take(
    scene: Scene, broken: Broken, force: float, size: tuple[int, int], seconds: float, folder: Path
) -> dict[str, Any]:
    """Write the frames of one blow as one picture -> what the page says of it."""
    from hem.fracture.blow import kinetic_energy

    stage = broken.stage()
    flight = broken.flight(stage, enough_seconds(stage), seconds)
    name = f"{scene.name}-{force:g}".replace(".", "_")
    _save(_sheet(list(frames(stage, flight, size))), folder / f"{name}.webp")
    mass = broken.fracture.mass
    return {
        "force": force,
        "frames": f"{name}.webp",
        "times": flight.times.round(4).tolist(),
        "pieces": len(broken.fracture.pieces),
        "mass": float(mass.masses.sum()),
        "largest": float(mass.masses.max()),
        "smallest": float(mass.masses.min()),
        "energy": kinetic_energy(mass, broken.motion),
        "given": force * float(mass.masses.sum()),
        "fastest": float(np.linalg.norm(broken.motion.velocities, axis=1).max()),
    }


def _told(scene: Scene) -> dict[str, Any]:
    method = f"--method {scene.method}" + (" --wrap" if scene.wrap else "")
    method += f" --scale {scene.scale:g}" if scene.scale != 1 else ""
    for option, at in (("--impact", scene.impact), ("--direction", scene.direction)):
        method += f" {option} {','.join(f'{it:g}' for it in at)}" if at else ""
    return {
        "name": scene.name,
        "title": scene.title,
        "what": scene.what,
        "command": f"hem fracture {scene.model} --material {scene.material} {method} --force",
    }


def _sheet(images: list[Image]) -> Image:
    """All frames in rows of COLUMNS, the last row filled up."""
    height, width = images[0].shape[:2]
    rows = -(-len(images) // COLUMNS)
    sheet = np.full((rows * height, COLUMNS * width, 3), 242, np.uint8)
    for i, image in enumerate(images):
        row, column = divmod(i, COLUMNS)
        sheet[row * height :][:height, column * width :][:, :width] = image
    return sheet


def _save(sheet: Image, path: Path) -> None:
    from PIL import Image as Pillow

    Pillow.fromarray(sheet).save(path, quality=80, method=4)


def _page(scenes: list[dict[str, Any]], size: tuple[int, int]) -> str:
    told = {
        "scenes": scenes,
        "width": size[0],
        "height": size[1],
        "columns": COLUMNS,
        "rate": FRAMES_A_SECOND,
    }
    template = (Path(__file__).parents[1] / "report" / "static" / "demo.html").read_text(
        encoding="utf-8"
    )
    return template.replace("__TOLD__", json.dumps(told).replace("</", "<\\/"))


if __name__ == "__main__":
    main()
