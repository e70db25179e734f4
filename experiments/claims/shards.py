"""What breaking a surface costs, as tables: structure by structure, and how its face is found."""

from __future__ import annotations

import numpy as np
import pandas as pd

from experiments.bench_fracture import FIND, SHATTER, VISITED, WAYS
from experiments.runs.results import Run
from hem.complexity import Verdict, judge
from structures import NAMES, REGISTRY

ASKED = "indexed"
"""What the others are compared with."""


def shattered(run: Run) -> pd.DataFrame:
    """Breaking a surface, each structure at the largest size that the indexed mesh was measured at.

    Columns: structure, vertices, shards, milliseconds (of the whole fracture), per_second (shards),
    faster (than the indexed mesh).
    """
    cases = _cases(run, SHATTER)
    rows = []
    most = cases[cases["structure"] == ASKED]["vertices"].max()
    for name in NAMES:
        mine = cases[(cases["structure"] == name) & (cases["vertices"] <= most)]
        if len(mine):
            case = mine.loc[mine["vertices"].idxmax()]
            seconds = float(np.median(case["samples"]))
            asked = cases[(cases["structure"] == ASKED) & (cases["vertices"] == case["vertices"])]
            searched = float(np.median(asked["samples"].iloc[0])) if len(asked) else np.nan
            rows.append(
                {
                    "structure": REGISTRY[name].title,
                    "vertices": case["vertices"],
                    "shards": case["handles"],
                    "milliseconds": 1e3 * seconds * case["handles"],
                    "per_second": 1 / seconds,
                    "faster": searched / seconds,
                }
            )
    return pd.DataFrame(rows, columns=[*SHATTERED])


def found(run: Run, structure: str = "half_edge") -> pd.DataFrame:
    """How the ways to find a face grow with the number of faces, one row each.

    Columns: way, visited and time (the slopes with their intervals, and the class that explains
    them best), faces and microseconds (looked at and taken, at the largest size).
    """
    cases = _cases(run, FIND)
    cases = cases[cases["structure"] == structure].sort_values("faces")
    rows = []
    for way in WAYS:
        counted, timed = (cases[cases["order"] == it] for it in (f"{way}, {VISITED}", way))
        if counted.empty or timed.empty:
            continue
        work = judge(counted["faces"], list(counted["samples"]), exact=True)
        time = judge(timed["faces"], list(timed["samples"]), latency=timed["latency"].astype(float))
        rows.append(
            {
                "way": way,
                "visited": _slope(work),
                "time": _slope(time),
                "faces": float(np.median(counted["samples"].iloc[-1])),
                "microseconds": 1e6 * float(np.median(timed["samples"].iloc[-1])),
            }
        )
    return pd.DataFrame(rows, columns=[*FOUND])


def styled(table: pd.DataFrame, heads: dict[str, tuple[str, str]]) -> str:
    """As a table of a page; ``heads``: by column what stands above it, and the format of a case."""
    shown = pd.DataFrame(
        {head: table[column].map(pattern.format) for column, (head, pattern) in heads.items()}
    )
    html: str = shown.to_html(index=False, border=0, classes="numbers")
    return f'<div class="wide">{html}</div>'


SHATTERED = {
    "structure": ("", "{}"),
    "vertices": ("vertices", "{:,}"),
    "shards": ("shards", "{:,}"),
    "milliseconds": ("ms in all", "{:,.1f}"),
    "per_second": ("shards per second", "{:,.0f}"),
    "faster": ("times faster than indexed", "{:,.1f}"),
}

FOUND = {
    "way": ("", "{}"),
    "visited": ("faces looked at: slope", "{}"),
    "time": ("time: slope", "{}"),
    "faces": ("faces, largest mesh, median", "{:,.0f}"),
    "microseconds": ("µs, largest mesh", "{:,.1f}"),
}


def _cases(run: Run, query: str) -> pd.DataFrame:
    cases = run.cases[run.cases["experiment"] == "bench_fracture"]
    return cases[cases["subject"] == query]


def _slope(verdict: Verdict) -> str:
    low, high = verdict.slope_low, verdict.slope_high
    return f"{verdict.slope:.2f} ({low:.2f} … {high:.2f}), {verdict.best}"
