"""How quickly things break: ``python -m experiments.validation.fracture_budgets``. Linux only."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import count
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

import hem
import structures
from experiments.bench_fracture import BREAKING
from experiments.validation.budgets import Budget, Task, print_budgets, time_interleaved
from hem.fracture import MATERIALS, Material, require_body, shatter, voronoi

VERTICES = 100_000
NARROW = BREAKING[True]
WIDE = replace(NARROW, scale=MATERIALS["glass"].scale)
INDEXED_ROUNDS = 2
"""On the indexed mesh a round takes seconds."""


def measure_surface() -> list[Budget]:
    """Break a torus at a thousand points, at another face each round."""
    mesh = hem.generate("torus", VERTICES)
    near, far = time_interleaved([_shatter("half_edge", mesh, it) for it in (NARROW, WIDE)])
    (searched,) = time_interleaved([_shatter("indexed", mesh, NARROW)], INDEXED_ROUNDS)
    what = f"1,000 break points, torus of {VERTICES:,} vertices, half-edge"
    ratio = searched / near
    return [
        Budget(what, "< 50 ms", f"{1e3 * near:.1f} ms", near < 0.05),
        Budget(f"{what}, as far apart as in glass", "< 50 ms", f"{1e3 * far:.1f} ms", far < 0.05),
        Budget(f"{what}, against indexed", "≥ 20 ×", f"{ratio:,.0f} ×", ratio >= 20),
    ]


def _shatter(name: str, mesh: hem.TriangleMesh, material: Material) -> Task:
    original, seeds = structures.build(name, mesh), count()

    def setup() -> tuple[Any, ...]:
        seed = next(seeds)
        corners = original.face_vertices(int(original.faces()[1_000 * seed]))
        return original.copy(), original.points[corners].mean(axis=0), material, seed

    return Task(lambda given: shatter(*given), setup)


def measure_body() -> list[Budget]:
    """Break the bunny, in a process of its own, so that its memory can be told."""
    budgets = []
    for cells, asked, limit in ((100, "< 10 s", 10.0), (500, "memory for it", np.inf)):
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            shards, seconds, error, peak = pool.submit(_break_bunny, cells).result()
        measured = f"{seconds:.1f} s, {peak / 2**20:,.0f} MiB, volume {error:+.1e}"
        what = f"bunny (28,088 vertices) in {cells} cells, {shards} shards"
        budgets.append(Budget(what, asked, measured, seconds < limit and abs(error) < 1e-6))
    return budgets


def _break_bunny(cells: int) -> tuple[int, float, float, int]:
    """Shards, seconds, the relative error of their volumes' sum, and the process' most bytes."""
    body, random = require_body(hem.sample("bunny")), np.random.default_rng(0)
    low, high = body.mesh.points.min(axis=0), body.mesh.points.max(axis=0)
    sites = low + random.random((40 * cells, 3)) * (high - low)
    sites = sites[body.contains(sites)][:cells]
    begin = perf_counter()
    broken = voronoi(body, body.mesh.points[0], "stone", sites=sites)
    seconds = perf_counter() - begin
    lines = Path("/proc/self/status").read_text().splitlines()
    status = dict(line.split(":", 1) for line in lines)
    peak = 1024 * int(status["VmHWM"].split()[0])
    return len(broken.shards), seconds, float(broken.mass.volumes.sum() / body.volume - 1), peak


if __name__ == "__main__":
    print_budgets("Breaking surfaces", measure_surface())
    print_budgets("Breaking bodies", measure_body())
