"""Tables of numbers: objects against arrays, and what it takes to break a surface."""

from __future__ import annotations

import numpy as np
import pandas as pd

from experiments.bench_fracture import FIND, SHATTER, VISITED, WAYS
from experiments.claims import MIXES, Curve, curves
from experiments.harness import BASE, OPERATIONS, Axis
from experiments.report.pages import Heads, Html, digits, duration, numbers
from experiments.runs import Run
from hem.complexity import Verdict, judge
from hem.contract import QUERIES
from structures import NAMES, REGISTRY

ARRAYS, OBJECTS = "half_edge", "half_edge_objects"


def objects_against_arrays(run: Run) -> Html:
    """Work and time of every query and operation, at the largest size that both were measured at.

    Raises MissingError where nothing was.
    """
    titles = {**{name: query.title for name, query in QUERIES.items()}, **OPERATIONS}
    rows = []
    for subject, title in titles.items():
        work, time = (
            _both(*(curves(run).curve(axis, name, subject) for name in (ARRAYS, OBJECTS)))
            for axis in (Axis.WORK_FACES, Axis.TIME_FACES)
        )
        if work[0] or time[0]:
            rows.append((title, *work[1:], *time[1:], time[2] / time[1], time[0]))
    heads: Heads = {
        "": str,
        "accesses, arrays": _count,
        "accesses, objects": _count,
        "time, arrays (compiled)": duration,
        "time, objects (Python)": duration,
        "slower": lambda value: f"{digits(value)} ×",
        "vertices": _count,
    }
    return numbers(rows, heads)


def shattering(run: Run) -> Html:
    """Breaking a surface, each structure at the largest size that the indexed mesh has, too.

    Raises MissingError where nothing was measured.
    """
    measured = {name: curves(run).named("bench_fracture", name, SHATTER) for name in NAMES}
    base = measured[BASE].by_size
    rows = []
    for name, curve in measured.items():
        costs = {size: it for size, it in curve.by_size.items() if not base or size <= max(base)}
        if costs:
            size = max(costs)
            shards = int(curve.cases[curve.cases["vertices"] == size]["handles"].iloc[0])
            faster = base.get(size, np.nan) / costs[size]
            rows.append(
                (REGISTRY[name].title, size, shards, shards * costs[size], 1 / costs[size], faster)
            )
    heads: Heads = {
        "": str, "vertices": _count, "shards": _count, "in all": duration,
        "shards per second": _count, "times faster than indexed": digits,
    }  # fmt: skip
    return numbers(rows, heads)


def face_finding(run: Run, structure: str = ARRAYS) -> Html:
    """How the ways to find a face grow with the number of faces, one row each.

    Raises MissingError where nothing was measured.
    """
    rows = []
    for way in WAYS:
        counted, timed = (
            curves(run).named("bench_fracture", structure, FIND, order)
            for order in (f"{way}, {VISITED}", way)
        )
        if len(counted) and len(timed):
            work = judge(counted.sizes, counted.samples, exact=True)
            latency = timed.cases["latency"].astype(float)
            time = judge(timed.sizes, timed.samples, latency=latency)
            looked_at = float(np.median(counted.samples[-1]))
            rows.append((way, _slope(work), _slope(time), looked_at, timed.largest))
    heads: Heads = {
        "": str, "faces looked at: slope": str, "time: slope": str,
        "faces, largest mesh, median": _count, "time, largest mesh": duration,
    }  # fmt: skip
    return numbers(rows, heads)


def overtaking(table: pd.DataFrame) -> Html:
    """After how many queries or edits per build a structure overtakes, on the largest mesh."""
    largest = table[table["vertices"] == table.groupby("subject")["vertices"].transform("max")]
    rows = [
        (MIXES[subject], REGISTRY[structure].title, vertices, times, times / vertices)
        for subject, structure, vertices, times in largest.to_numpy()
    ]
    heads: Heads = {
        "": str, "structure": str, "vertices": _count, "per build": digits,
        "per build and vertex": digits,
    }  # fmt: skip
    return numbers(rows, heads)


def _both(mine: Curve, other: Curve) -> tuple[float, float, float]:
    """The largest common size in vertices, 0 without one, and the cost of each there."""
    costs, others = mine.by_size, other.by_size
    size = max(costs.keys() & others.keys(), default=0)
    return size, costs.get(size, np.nan), others.get(size, np.nan)


def _count(value: float) -> str:
    return f"{value:,.0f}" if value == value else "–"


def _slope(verdict: Verdict) -> str:
    low, high = verdict.slope_low, verdict.slope_high
    return f"{verdict.slope:.2f} ({low:.2f} … {high:.2f}), {verdict.best}"
