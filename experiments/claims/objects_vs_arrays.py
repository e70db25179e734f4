"""References against indices: the same half-edge mesh in objects and in arrays, side by side."""

from __future__ import annotations

import numpy as np
import pandas as pd

from experiments.claims.growth import OPERATIONS, title_of
from experiments.claims.judged import Evidence
from experiments.runs.results import Run
from hem.contract import QUERIES

ARRAYS, OBJECTS = "half_edge", "half_edge_objects"


def compared(run: Run) -> pd.DataFrame:
    """Work and time of every query and operation, at the largest size that both were measured at.

    Columns: what, vertices (of the timed mesh), work_arrays, work_objects (elements or fields
    accessed), time_arrays, time_objects (seconds each), slower (time, objects by arrays).
    """
    evidence = Evidence(run)
    rows = []
    for what in (*QUERIES, *OPERATIONS):
        work = _both(evidence, "work", what)
        time = _both(evidence, "time", what)
        rows.append(
            {
                "what": title_of(what),
                "vertices": time[0],
                "work_arrays": work[1],
                "work_objects": work[2],
                "time_arrays": time[1],
                "time_objects": time[2],
                "slower": time[2] / time[1],
            }
        )
    return pd.DataFrame(rows)


def styled(table: pd.DataFrame) -> str:
    """As a table of a page."""
    shown = pd.DataFrame(
        {
            "": table["what"],
            "accesses, arrays": table["work_arrays"].map("{:,.0f}".format),
            "accesses, objects": table["work_objects"].map("{:,.0f}".format),
            "time, arrays (compiled)": table["time_arrays"].map(_seconds),
            "time, objects (Python)": table["time_objects"].map(_seconds),
            "slower": table["slower"].map("{:,.0f} ×".format),
            "vertices": table["vertices"].map("{:,.0f}".format),
        }
    )
    html: str = shown.to_html(index=False, border=0, classes="numbers")
    return f'<div class="wide">{html}</div>'


def _both(evidence: Evidence, measure: str, what: str) -> tuple[float, float, float]:
    """The largest common size in vertices, and the cost there of arrays and of objects."""
    center = np.mean if measure == "work" else np.median
    curves = []
    for structure in (ARRAYS, OBJECTS):
        cases = evidence.curve(measure, "faces", structure, what)
        costs = [float(center(samples)) for samples in cases["samples"]]
        curves.append(dict(zip(cases["vertices"], costs, strict=True)))
    common = set(curves[0]) & set(curves[1])
    if not common:
        return float("nan"), float("nan"), float("nan")
    size = max(common)
    return float(size), curves[0][size], curves[1][size]


def _seconds(seconds: float) -> str:
    return f"{seconds * 1e9:,.0f} ns" if seconds < 1e-6 else f"{seconds * 1e6:,.1f} µs"
