"""What the thesis says in sentences: each a quantity that was measured, and what it must be.

The sentences stand in ``statements.toml``. A quantity is a list of values, one per size, query or
the like, and the claim holds if all of them lie within its bounds. It is violated if none does; in
between, or where nothing was measured, it is undetermined.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.resources import files

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from experiments.breakeven import break_even
from experiments.claims import OPERATIONS
from experiments.results import Run
from experiments.verdicts import Evidence, at_largest
from hem.queries import QUERIES

Array = NDArray[np.float64]
Quantity = Callable[[Run], Iterable[float]]


@dataclass(frozen=True)
class Statement:
    """One sentence, what is measured of it, and the verdict."""

    says: str
    source: str
    measured: str
    low: float
    high: float
    values: Array
    outcome: str


def _bytes_ratio(run: Run) -> Iterable[float]:
    evidence = Evidence(run)
    yield evidence.bytes_per_vertex("half_edge") / evidence.bytes_per_vertex("indexed")


def _bytes_winged_half(run: Run) -> Iterable[float]:
    evidence = Evidence(run)
    yield evidence.bytes_per_vertex("winged_edge") / evidence.bytes_per_vertex("half_edge")


def _winged_half(run: Run) -> Iterable[float]:
    """The time of every query and operation at the largest size, winged-edge by half-edge."""
    for what in (*QUERIES, *OPERATIONS):
        pair = [at_largest(run, it, what) for it in ("winged_edge", "half_edge")]
        yield pair[0] / pair[1]


def _steps(run: Run) -> Iterable[float]:
    """Elements read per query around a vertex, triangle-neighbor by half-edge."""
    evidence = Evidence(run)
    for query in ("vertex_vertices", "vertex_edges", "vertex_faces"):
        reads = []
        for name in ("triangle_neighbor", "half_edge"):
            cells = evidence.curve("work", "faces", name, query)
            reads += [float(np.mean(it)) for it in cells["samples"][-1:]]
        if len(reads) == 2:
            yield reads[0] / reads[1]


def _static(run: Run) -> Iterable[float]:
    """Building alone and a pass over all faces, half-edge by indexed."""
    cells = run.cells[run.cells["family"] == "torus"]
    alone = (cells["experiment"] == "bench_build") & (cells["order"] == "consecutive")
    for wanted in (alone, cells["query"] == "vertex_normals"):
        yield from _by_size(cells[wanted & (cells["reference_bytes"] == 4)])


def _dynamic(run: Run) -> Iterable[float]:
    """The game-like mix of edits and queries, half-edge by indexed, on 1,000 vertices and more."""
    cells = run.cells[(run.cells["query"] == "impacts") & (run.cells["vertices"] >= 999)]
    yield from _by_size(cells)


def _by_size(cells: pd.DataFrame) -> Iterable[float]:
    medians = {
        (it.structure, it.vertices): float(np.median(it.samples)) for it in cells.itertuples()
    }
    for (name, vertices), seconds in medians.items():
        if name == "half_edge" and ("indexed", vertices) in medians:
            yield seconds / medians["indexed", vertices]


def _edits_per_build(run: Run) -> Iterable[float]:
    """Edge splits per vertex after which the half-edge mesh has overtaken, at the larger sizes."""
    table = break_even(run)
    mine = table[(table["structure"] == "half_edge") & (table["what"] == "split_edge")]
    for row in mine[mine["vertices"] >= 999].itertuples():
        yield row.count / row.vertices


QUANTITIES: dict[str, Quantity] = {
    "bytes_ratio": _bytes_ratio,
    "bytes_winged_half": _bytes_winged_half,
    "winged_half": _winged_half,
    "steps": _steps,
    "static": _static,
    "dynamic": _dynamic,
    "edits_per_build": _edits_per_build,
}
"""What can be measured of a sentence, by the name that ``statements.toml`` uses."""


def judged(run: Run) -> list[Statement]:
    """Every sentence with its verdict."""
    content = tomllib.loads((files("experiments") / "statements.toml").read_text())
    return [_judge(run, row) for row in content["statement"]]


def _judge(run: Run, row: dict[str, str | float]) -> Statement:
    values = np.array([it for it in QUANTITIES[str(row["quantity"])](run) if not np.isnan(it)])
    low, high = float(row.get("low", -np.inf)), float(row.get("high", np.inf))
    inside = (values >= low) & (values <= high)
    if not len(values):
        outcome = "undetermined"
    elif inside.all():
        outcome = "consistent"
    else:
        outcome = "undetermined" if inside.any() else "violated"
    words = str(row["says"]), str(row["source"]), str(row["measured"])
    return Statement(*words, low, high, values, outcome)
