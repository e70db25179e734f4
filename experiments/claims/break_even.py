"""After how many queries or edits per build a structure overtakes the base structure.

A structure takes longer to build and answers faster. After k queries or edits it has caught up:
build + k · cost = the base's build + k · its cost.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from experiments.claims.curves import Curves
from experiments.harness import BASE
from structures import NAMES, REGISTRY

MIXES = {
    "vertex_faces": "faces around a vertex",
    "face_faces": "faces beside a face",
    "split_edge": "edge splits",
    "collapse_edge": "edge collapses",
}
"""What is done after building, one query or operation each."""

SOURCES = (("bench_queries", "random"), ("bench_operations", "batched"))


def break_even(of_run: Curves) -> pd.DataFrame:
    """How many queries or edits per build it takes, by structure and size.

    Columns: subject, structure, vertices, times: 0 where the structure is ahead from the beginning,
    infinite where it never catches up.
    """
    rows = [
        (subject, structure, vertices, times)
        for subject in MIXES
        for structure in NAMES
        if structure != BASE and REGISTRY[structure].compiled
        for vertices, times in _times(of_run, structure, subject)
    ]
    return pd.DataFrame(rows, columns=["subject", "structure", "vertices", "times"])


def _times(of_run: Curves, structure: str, subject: str) -> list[tuple[int, float]]:
    """By size, from what both structures take to build and per query or edit."""
    mine, base = _costs(of_run, structure, subject), _costs(of_run, BASE, subject)
    rows = []
    for vertices in sorted(mine.keys() & base.keys()):
        lead = max(mine[vertices][0] - base[vertices][0], 0.0)
        gain = base[vertices][1] - mine[vertices][1]
        rows.append((vertices, lead / gain if gain > 0 else np.inf))
    return rows


def _costs(of_run: Curves, structure: str, subject: str) -> dict[int, tuple[float, float]]:
    """Seconds to build and per query or edit, by number of vertices."""
    built = of_run.named("bench_build", structure, order="consecutive").by_size
    each = {}
    for experiment, order in SOURCES:
        each.update(of_run.named(experiment, structure, subject, order).by_size)
    return {n: (built[n], each[n]) for n in built.keys() & each.keys()}
