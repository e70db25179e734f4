"""How quickly things break: ``python -m experiments.validation.fracture_budgets``."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from time import perf_counter
from typing import Any

import numpy as np

import hem
import structures
from experiments.bench_fracture import BREAKING
from experiments.validation.budgets import (
    Budget,
    Task,
    peak_bytes,
    print_budgets,
    run_in_new_process,
    time_interleaved,
)
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
    return [
        Budget(what, "< 50 ms", f"{1e3 * near:.1f} ms", near < 0.05),
        Budget(f"{what}, as far apart as in glass", "< 50 ms", f"{1e3 * far:.1f} ms", far < 0.05),
        Budget(
            f"{what}, against indexed", ">= 20 ×", f"{searched / near:,.0f} ×", searched > 20 * near
        ),
    ]


def _shatter(name: str, mesh: hem.TriangleMesh, material: Material) -> Task:
    original, rounds = structures.build(name, mesh), count()

    def fresh() -> tuple[Any, Any, int]:
        seed = next(rounds)
        corners = original.face_vertices(int(original.faces()[1_000 * seed]))
        return original.copy(), original.points[corners].mean(axis=0), seed

    return Task(lambda given: shatter(given[0], given[1], material, given[2]), fresh)


def measure_body() -> list[Budget]:
    """Break the bunny, in a process of its own, so that its memory can be told."""
    budgets = []
    for cells, asked, limit in ((100, "< 10 s", 10.0), (500, "memory for it", np.inf)):
        shards, seconds, error, peak = run_in_new_process(_break_bunny, cells)
        measured = f"{seconds:.1f} s, {peak / 2**20:,.0f} MiB, volume {error:+.1e}"
        what = f"bunny (28,088 vertices) in {cells} cells, {shards} shards"
        budgets.append(Budget(what, asked, measured, seconds < limit and abs(error) < 1e-6))
    return budgets


def _break_bunny(cells: int) -> tuple[int, float, float, int]:
    """Shards, seconds, the relative error of their volumes' sum, and the most bytes it took."""
    body, random = require_body(hem.sample("bunny")), np.random.default_rng(0)
    low, high = body.mesh.points.min(axis=0), body.mesh.points.max(axis=0)
    sites = low + random.random((40 * cells, 3)) * (high - low)
    sites = sites[body.contains(sites)][:cells]
    begin = perf_counter()
    broken, peak = peak_bytes(lambda: voronoi(body, body.mesh.points[0], "stone", sites=sites))
    seconds = perf_counter() - begin
    return len(broken.shards), seconds, float(broken.mass.volumes.sum() / body.volume - 1), peak


if __name__ == "__main__":
    print_budgets("Breaking surfaces", measure_surface())
    print_budgets("Breaking bodies", measure_body())
