"""The demo of breaking meshes: ``make demo`` makes some animations and a page to watch them on."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from experiments.cli.console import console, user_errors
from experiments.report.fracture_scenes import Broken, break_up, enough_seconds, model

OUT = Path("report/demo")
SIZE = 480, 360
SECONDS = 2.4
"""How long an animation plays."""


class DemoCase(NamedTuple):
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


CASES = (
    DemoCase(
        "bunny", "Glass bunny", "bunny", "glass", "voronoi", (2, 10, 40),
        "The Stanford bunny as a solid of glass, broken into Voronoi cells that gather around the "
        "impact. A stronger blow makes more and smaller cells, and reaches farther.",
    ),
    DemoCase(
        "teapot", "Ceramic teapot", "teapot", "ceramic", "voronoi", (1, 5, 25),
        "The Utah teapot is an open surface, so a body is wrapped around it first. It is solid "
        "inside; ceramic breaks into fewer and larger pieces than glass.",
        wrap=True, scale=0.05,
    ),
    DemoCase(
        "sphere", "Stone sphere", "sphere:162", "stone", "tetra", (1, 6, 20),
        "A ball of stone out of which tetrahedra break: the triangles around the impact are split "
        "as in the thesis, and each takes a wedge of the body under it along.",
        scale=0.2, impact=(0.08, 0.13, 0.13), direction=(0, -1, 0),
    ),
    DemoCase(
        "plate", "Glass plate", "plate:144", "glass", "surface", (0.3, 3),
        "The thesis' own method (4.4): a sheet, broken on its surface. The triangles around the "
        "impact are split at scattered break points and taken out; the rest of the plate is held.",
    ),
)  # fmt: skip


def main() -> None:
    """Make all animations and the page."""
    begun = perf_counter()
    with user_errors():
        page = write(OUT, say=lambda line: console.print(line, highlight=False))
        console.print(
            f"Done in {perf_counter() - begun:.0f} s. Open {page.resolve().as_uri()}",
            soft_wrap=True,
        )


def write(
    folder: Path,
    cases: tuple[DemoCase, ...] = CASES,
    size: tuple[int, int] = SIZE,
    seconds: float = SECONDS,
    say: Callable[[str], None] = lambda line: None,
) -> Path:
    """Make the animations and the page that shows them -> the page. It needs no network.

    Everything is made beside the folder and moved there at the end.
    """
    from jinja2 import Environment

    from hem.fracture import whole

    shown = []
    with whole(folder) as beside:
        for case in cases:
            mesh, up = model(case.model, case.wrap, case.scale)
            blows = []
            for force in case.forces:
                begun = perf_counter()
                blows.append(_animate(case, _strike(case, mesh, up, force), size, seconds, beside))
                took = perf_counter() - begun
                say(f"{case.title}, {force:g} J/kg: {blows[-1]['pieces']} pieces, {took:.0f} s")
            shown.append({"case": case, "command": _command(case), "blows": blows})
        template = (files("experiments.report") / "static" / "demo.html").read_text("utf-8")
        page = Environment(autoescape=True).from_string(template).render(shown=shown, size=size)
        (beside / "index.html").write_text(page, "utf-8")
    return folder / "index.html"


def _strike(case: DemoCase, mesh: Any, up: str, force: float) -> Broken:
    from hem.fracture import material

    return break_up(
        mesh, case.method, material(case.material), force,
        impact=case.impact, direction=case.direction, seed=case.seed, up=up,
    )  # fmt: skip


def _animate(
    case: DemoCase, broken: Broken, size: tuple[int, int], seconds: float, folder: Path
) -> dict[str, Any]:
    """Write the animation of one blow -> what the page says of it."""
    from hem.fracture import kinetic_energy
    from hem.fracture.show import save_animation

    scene, force, mass = broken.scene(), broken.blow.force, broken.fracture.mass
    flight = broken.flight(scene, enough_seconds(scene), seconds)
    name = f"{case.name}-{force:g}".replace(".", "_") + ".webp"
    save_animation(list(scene.frames(flight, size, f"{force:g} J/kg")), folder / name)
    return {
        "force": force,
        "file": name,
        "pieces": len(broken.fracture.pieces),
        "mass": mass.masses.sum(),
        "largest": mass.masses.max(),
        "given": force * mass.masses.sum(),
        "moving": kinetic_energy(mass, broken.motion),
        "fastest": np.linalg.norm(broken.motion.velocities, axis=1).max(),
    }


def _command(case: DemoCase) -> str:
    words = f"hem fracture {case.model} --material {case.material} --method {case.method}"
    words += " --wrap" if case.wrap else ""
    words += f" --scale {case.scale:g}" if case.scale != 1 else ""
    for option, at in (("--impact", case.impact), ("--direction", case.direction)):
        words += f" {option} {','.join(f'{part:g}' for part in at)}" if at else ""
    return f"{words} --force {case.forces[0]:g}"


if __name__ == "__main__":
    main()
