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

LARGER = 990
"""Vertices from which on a mesh is spoken of: smaller ones are built and scanned in no time."""

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
    """Elements read to walk around a vertex, triangle-neighbor by half-edge, at every size."""
    evidence = Evidence(run)
    reads = [
        [
            float(np.mean(it))
            for it in evidence.curve("work", "faces", name, "vertex_faces")["samples"]
        ]
        for name in ("triangle_neighbor", "half_edge")
    ]
    yield from (mine / other for mine, other in zip(*reads, strict=True))


def _static(run: Run) -> Iterable[float]:
    """Building alone and a pass over all faces, half-edge by indexed."""
    cells = run.cells[run.cells["family"] == "torus"]
    alone = (cells["experiment"] == "bench_build") & (cells["order"] == "consecutive")
    for wanted in (alone, cells["query"] == "vertex_normals"):
        yield from _by_size(cells[wanted & (cells["reference_bytes"] == 4)])


def _dynamic(run: Run) -> Iterable[float]:
    """The game-like mix of edits and queries, half-edge by indexed, on 1,000 vertices and more."""
    cells = run.cells[(run.cells["query"] == "impacts") & (run.cells["vertices"] >= LARGER)]
    yield from _by_size(cells)


def _by_size(cells: pd.DataFrame) -> Iterable[float]:
    columns = zip(cells["structure"], cells["vertices"], cells["samples"], strict=True)
    medians = {(name, vertices): float(np.median(it)) for name, vertices, it in columns}
    for (name, vertices), seconds in medians.items():
        if name == "half_edge" and ("indexed", vertices) in medians:
            yield seconds / medians["indexed", vertices]


def _edits_per_build(run: Run) -> Iterable[float]:
    """Edge splits per vertex after which the half-edge mesh has overtaken, at the larger sizes."""
    table = break_even(run)
    mine = table[(table["structure"] == "half_edge") & (table["what"] == "split_edge")]
    mine = mine[mine["vertices"] >= LARGER]
    yield from (mine["times"] / mine["vertices"]).tolist()


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


def bounds(statement: Statement) -> str:
    """What the quantity must be, such as ``at least 6``."""
    low, high = statement.low, statement.high
    if low == high:
        return f"{low:g}"
    if np.isinf(low):
        return f"at most {high:g}"
    return f"at least {low:g}" if np.isinf(high) else f"{low:g} to {high:g}"


def span(statement: Statement) -> str:
    """What was found: one value, or the smallest and the largest."""
    values = statement.values
    if not len(values):
        return "–"
    low, high = f"{values.min():.3g}", f"{values.max():.3g}"
    return low if low == high else f"{low} … {high}"


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
