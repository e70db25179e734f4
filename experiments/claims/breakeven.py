"""After how many queries or edits per build a structure overtakes the indexed mesh.

A structure takes longer to build and answers faster. After k queries or edits it has caught up:
build + k · cost = the indexed mesh's build + k · its cost.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from experiments.claims.growth import OPERATIONS
from experiments.runs.results import Run
from structures import NAMES, REGISTRY

BASE = "indexed"
MIXES = {
    "vertex_faces": "faces around a vertex",
    "face_faces": "faces beside a face",
    "split_edge": "edge splits",
    "collapse_edge": "edge collapses",
}
"""What is done after building, one query or operation each."""


def break_even(run: Run) -> pd.DataFrame:
    """How many queries or edits per build it takes, by structure and size.

    Columns: what, structure, vertices, times: 0 where the structure is ahead from the beginning,
    infinite where it never catches up.
    """
    rows = []
    for what in MIXES:
        for structure in (name for name in NAMES if name != BASE and REGISTRY[name].compiled):
            mine, base = _costs(run, structure, what), _costs(run, BASE, what)
            both = mine.add_suffix("_mine").join(base.add_suffix("_base"), how="inner")
            gain = (both["each_base"] - both["each_mine"]).to_numpy(float)
            lead = (both["build_mine"] - both["build_base"]).to_numpy(float).clip(min=0)
            times = np.where(gain > 0, lead / np.where(gain > 0, gain, 1), np.inf)
            rows += [
                (what, structure, int(vertices), float(it))
                for vertices, it in zip(both.index, times, strict=True)
            ]
    return pd.DataFrame(rows, columns=["what", "structure", "vertices", "times"])


def _costs(run: Run, structure: str, what: str) -> pd.DataFrame:
    """Seconds to build and per query or edit, by number of vertices."""
    cases = run.cases[(run.cases["structure"] == structure) & run.cases["valence"].isna()]
    cases = cases[(cases["family"] == "torus") & (cases["reference_bytes"] == 4)]
    built = cases[(cases["experiment"] == "bench_build") & (cases["order"] == "consecutive")]
    experiment, order = (
        ("bench_operations", "batched") if what in OPERATIONS else ("bench_queries", "random")
    )
    wanted = (cases["experiment"] == experiment) & (cases["subject"] == what)
    asked = cases[wanted & (cases["order"] == order)]
    return pd.DataFrame({"build": _medians(built), "each": _medians(asked)}).dropna()


def _medians(cases: pd.DataFrame) -> pd.Series:
    return pd.Series(
        [float(np.median(it)) for it in cases["samples"]], index=cases["vertices"], dtype=float
    )
