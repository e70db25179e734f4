"""The demo of breaking meshes: ``make demo`` makes some animations and a page to watch them on."""

import json
import shlex
from importlib.resources import files
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from experiments.cli import app
from experiments.cli.console import console

OUT = Path("report/demo")
SIZE = 480, 360


class DemoCase(NamedTuple):
    """A call of ``hem fracture``, and the forces to strike with; and what to look at."""

    title: str
    command: str
    forces: tuple[float, ...]
    what: str


CASES = (
    DemoCase(
        "Glass bunny", "bunny --material glass --method voronoi", (2, 10, 40),
        "The Stanford bunny as a solid of glass, broken into Voronoi cells that gather around the "
        "impact. A stronger blow makes more and smaller cells, and reaches farther.",
    ),
    DemoCase(
        "Ceramic teapot", "teapot --material ceramic --method voronoi --wrap --scale 0.05",
        (1, 5, 25),
        "The Utah teapot is an open surface, so a body is wrapped around it first. It is solid "
        "inside; ceramic breaks into fewer and larger pieces than glass.",
    ),
    DemoCase(
        "Stone sphere",
        "sphere:162 --material stone --method tetra --scale 0.2 --impact 0.08,0.13,0.13 "
        "--direction 0,-1,0",
        (1, 6, 20),
        "A ball of stone out of which tetrahedra break: the triangles around the impact are split "
        "as in the thesis, and each takes a wedge of the body under it along.",
    ),
    DemoCase(
        "Glass plate", "plate:144 --material glass --method surface", (0.3, 3),
        "The thesis' own method (4.4): a sheet, broken on its surface. The triangles around the "
        "impact are split at scattered break points and taken out; the rest of the plate is held.",
    ),
)  # fmt: skip


def write(folder: Path, cases: tuple[DemoCase, ...] = CASES, size: tuple[int, int] = SIZE) -> Path:
    """Run the commands, and write a page that shows what they made, without a network -> it."""
    from jinja2 import Environment

    shown = [(case, [_strike(case, it, size, folder) for it in case.forces]) for case in cases]
    template = (files("experiments.report") / "static" / "demo.html").read_text("utf-8")
    page = Environment(autoescape=True).from_string(template).render(shown=shown, size=size)
    (folder / "index.html").write_text(page, "utf-8")
    return folder / "index.html"


def _strike(case: DemoCase, force: float, size: tuple[int, int], folder: Path) -> dict[str, Any]:
    """Strike once -> what the page says of it."""
    name = f"{case.title}-{force:g}".lower().replace(" ", "-").replace(".", "_")
    options = (
        f"--force {force:g} --size {size[0]}x{size[1]} --out {shlex.quote(str(folder / name))}"
    )
    if code := app(["fracture", *shlex.split(f"{case.command} {options}")], standalone_mode=False):
        raise SystemExit(code)
    told = json.loads((folder / name / "fracture.json").read_text("utf-8"))
    speeds = np.linalg.norm([piece["velocity_m_s"] for piece in told["pieces"]], axis=1)
    return {**told, "folder": name, "fastest": speeds.max()}


if __name__ == "__main__":
    begun = perf_counter()
    page = write(OUT).resolve().as_uri()
    console.print(f"Done in {perf_counter() - begun:.0f} s. Open {page}", soft_wrap=True)
