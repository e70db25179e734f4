"""The demo of breaking meshes: ``make demo`` makes some animations and a page to watch them on."""

import json
import tomllib
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from experiments.cli import app
from experiments.cli.console import console
from experiments.report import pages

OUT = Path("report/demo")
SIZE = 480, 360
Case = dict[str, Any]  # of demo.toml

_TEXT = Path(__file__).with_name("demo.toml").read_text("utf-8")
CASES: list[Case] = tomllib.loads(_TEXT)["case"]


def write(folder: Path, cases: list[Case] = CASES, size: tuple[int, int] = SIZE) -> Path:
    """Run the commands, and write a page that shows what they made, without a network -> it."""
    shown = [(case, [_strike(case, it, size, folder) for it in case["forces"]]) for case in cases]
    (folder / "index.html").write_text(pages.page("demo.html.j2", shown=shown, size=size), "utf-8")
    return folder / "index.html"


def _strike(case: Case, force: float, size: tuple[int, int], folder: Path) -> dict[str, Any]:
    """Strike once -> what the page says of it."""
    name = f"{case['title']}-{force:g}".lower().replace(" ", "-").replace(".", "_")
    size_and_place = ["--size", f"{size[0]}x{size[1]}", "--out", str(folder / name)]
    words = ["fracture", *case["command"].split(), "--force", f"{force:g}", *size_and_place]
    if code := app(words, standalone_mode=False):
        raise SystemExit(code)
    told = json.loads((folder / name / "fracture.json").read_text("utf-8"))
    speeds = np.linalg.norm([piece["velocity_m_s"] for piece in told["pieces"]], axis=1)
    return {**told, "folder": name, "fastest": speeds.max()}


if __name__ == "__main__":
    begun = perf_counter()
    made = write(OUT).resolve().as_uri()
    console.print(f"Done in {perf_counter() - begun:.0f} s. Open {made}", soft_wrap=True)
