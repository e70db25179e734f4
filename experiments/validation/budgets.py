"""Budgets: what was asked of the speed, what was measured, and whether that is enough.

``python -m experiments.validation.budgets`` says how quickly things break; Linux only.
"""

import gc
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import count
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import hem
import structures
from experiments.bench_fracture import BREAKING
from hem.fracture import MATERIALS, Material, require_body, shatter, voronoi

ROUNDS = 5
SECONDS = 4.0  # after so long no further round begins: fewer of them tell apart what takes seconds
VERTICES = 100_000
NARROW = BREAKING[True]
WIDE = replace(NARROW, scale=MATERIALS["glass"].scale)
INDEXED_ROUNDS = 2  # on the indexed mesh a round takes seconds

Budget = tuple[bool, str, str, str]  # whether it is met, what it is of, what was measured and asked


class Task(NamedTuple):
    """What is timed: ``call`` gets what ``setup``, which is not timed, makes for each round."""

    call: Callable[..., Any]
    setup: Callable[[], tuple[Any, ...]] = tuple


def print_budgets(title: str, budgets: Iterable[Budget]) -> None:
    """Print a table, as wide as the terminal or 80 columns."""
    table = Table("", "what", "measured", "asked", title=title, title_justify="left")
    for met, *cells in budgets:
        table.add_row("✓" if met else "✗", *cells)
    Console().print(table)


def time_interleaved(tasks: Sequence[Task], rounds: int = ROUNDS) -> list[float]:
    """Median seconds of each task; in turn, as a machine that slows down slows all of them."""
    samples: list[list[float]] = [[] for _ in tasks]
    started = perf_counter()
    for turn in range(rounds + 1):
        if turn > 1 and perf_counter() - started > SECONDS:
            break
        for task, kept in zip(tasks, samples, strict=True):
            given = task.setup()
            gc.collect()
            begin = perf_counter()
            result = task.call(*given)  # held, so that freeing it is not timed
            kept.append(perf_counter() - begin)
            del given, result
    return [float(np.median(kept[1:])) for kept in samples]


def measure_surface() -> list[Budget]:
    """Break a torus at a thousand points, at another face each round."""
    mesh = hem.generate("torus", VERTICES)
    near, far = time_interleaved([_shatter("half_edge", mesh, it) for it in (NARROW, WIDE)])
    (searched,) = time_interleaved([_shatter("indexed", mesh, NARROW)], INDEXED_ROUNDS)
    what = f"1,000 break points, torus of {VERTICES:,} vertices, half-edge"
    ratio = searched / near
    return [
        (near < 0.05, what, f"{1e3 * near:.1f} ms", "< 50 ms"),
        (far < 0.05, f"{what}, as far apart as in glass", f"{1e3 * far:.1f} ms", "< 50 ms"),
        (ratio >= 20, f"{what}, against indexed", f"{ratio:,.0f} ×", "≥ 20 ×"),
    ]


def _shatter(name: str, mesh: hem.TriangleMesh, material: Material) -> Task:
    original, seeds = structures.build(name, mesh), count()

    def setup() -> tuple[Any, ...]:
        seed = next(seeds)
        corners = original.face_vertices(int(original.faces()[1_000 * seed]))
        return original.copy(), original.points[corners].mean(axis=0), material, seed

    return Task(shatter, setup)


def measure_body() -> list[Budget]:
    """Break the bunny, in a process of its own, so that its memory can be told."""
    budgets = []
    for cells, asked, limit in ((100, "< 10 s", 10.0), (500, "memory for it", np.inf)):
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            shards, seconds, error, peak = pool.submit(_break_bunny, cells).result()
        measured = f"{seconds:.1f} s, {peak / 2**20:,.0f} MiB, volume {error:+.1e}"
        what = f"bunny (28,088 vertices) in {cells} cells, {shards} shards"
        budgets.append((seconds < limit and abs(error) < 1e-6, what, measured, asked))
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
    peak = Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()[0]  # KiB
    error = float(broken.mass.volumes.sum() / body.volume - 1)
    return len(broken.shards), seconds, error, 1024 * int(peak)


if __name__ == "__main__":
    print_budgets("Breaking surfaces", measure_surface())
    print_budgets("Breaking bodies", measure_body())
