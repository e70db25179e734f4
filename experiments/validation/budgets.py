"""How quickly things break, beside what was asked: ``python -m experiments.validation.budgets``."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

import hem
import structures
from experiments.bench_fracture import BREAKING
from hem.fracture import MATERIALS, Material, shatter

VERTICES = 100_000
ROUNDS = 9
WIDE = replace(BREAKING[True], scale=MATERIALS["glass"].scale)
SEARCHES = 2
"""Rounds on the indexed mesh, each of which takes seconds."""

BREAK_BUNNY = (
    "import json, sys, resource, hem\n"
    "from time import perf_counter\n"
    "import numpy as np\n"
    "from hem.fracture import require_body, voronoi\n"
    "body = require_body(hem.sample('bunny'))\n"
    "random, count = np.random.default_rng(0), int(sys.argv[1])\n"
    "low, high = body.mesh.points.min(axis=0), body.mesh.points.max(axis=0)\n"
    "at = low + random.random((40 * count, 3)) * (high - low)\n"
    "at = at[body.contains(at)][:count]\n"
    "begin = perf_counter()\n"
    "broken = voronoi(body, body.mesh.points[0], 'stone', sites=at)\n"
    "seconds = perf_counter() - begin\n"
    "error = broken.mass.volumes.sum() / body.volume - 1\n"
    "peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024\n"
    "print(json.dumps([len(at), len(broken.shards), seconds, error, peak]))\n"
)


class Bar(NamedTuple):
    """One line: what, what was asked, what was measured, and whether that is enough."""

    what: str
    asked: str
    measured: str
    met: bool


def surface_bars() -> list[Bar]:
    """A thousand break points on a torus of 100,000 vertices, on two structures by turns."""
    mesh = hem.generate("torus", VERTICES)
    seconds: dict[str, list[float]] = {}
    for name, rounds in (("half_edge", ROUNDS), ("indexed", SEARCHES)):
        original = structures.build(name, mesh)
        shatter(original.copy(), mesh.points[0], BREAKING[True])  # compiles
        seconds[name] = [_shattering(original, seed) for seed in range(rounds)]
        if name == "half_edge":
            apart = [_shattering(original, seed, WIDE) for seed in range(rounds)]
    ours, searched = (float(np.median(it)) for it in seconds.values())
    wide = float(np.median(apart))
    what = f"1,000 break points, torus of {VERTICES:,} vertices"
    return [
        Bar(f"{what}, half-edge", "< 50 ms", f"{1e3 * ours:.1f} ms", ours < 0.05),
        Bar("as far apart as in glass, half-edge", "< 50 ms", f"{1e3 * wide:.1f} ms", wide < 0.05),
        Bar(
            f"{what}, against indexed", ">= 20 x", f"{searched / ours:,.0f} x", searched > 20 * ours
        ),
    ]


def _shattering(original: Any, seed: int, material: Material = BREAKING[True]) -> float:
    s = original.copy()
    at = s.points[s.face_vertices(int(s.faces()[1_000 * seed]))].mean(axis=0)
    begin = perf_counter()
    shatter(s, at, material, seed)
    return perf_counter() - begin


def body_bars() -> list[Bar]:
    """The bunny in a process of its own, so that its memory can be told."""
    bars = []
    for count, asked, limit in ((100, "< 10 s", 10.0), (500, "memory for it", np.inf)):
        command = [sys.executable, "-c", BREAK_BUNNY, str(count)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        cases, shards, seconds, error, peak = json.loads(done.stdout)
        measured = f"{seconds:.1f} s, {peak / 2**20:,.0f} MiB, volume {error:+.1e}"
        what = f"bunny (28,088 vertices) in {cases} cases, {shards} shards"
        bars.append(Bar(what, asked, measured, seconds < limit and abs(error) < 1e-6))
    return bars


def main() -> None:
    """Measure, and print a table."""
    table = Table("what", "asked", "measured", "", title="Destruction")
    for bar in (*surface_bars(), *body_bars()):
        table.add_row(bar.what, bar.asked, bar.measured, "✓" if bar.met else "✗")
    Console().print(table)


if __name__ == "__main__":
    typer.run(main)
