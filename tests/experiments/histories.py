"""Histories made up for tests, of runs that are made up as well."""

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np

from experiments.regression import append_run

CLAIM = "queries/half_edge/vertex_faces"
MACHINES = ("aaaa1111", "bbbb2222")


def line(base: dict[str, Any], k: int, machine: str = MACHINES[0]) -> dict[str, Any]:
    """The k-th run of a history: as ``base``, a day later each."""
    made = copy.deepcopy(base)
    made["commit"] = f"{k:03x}{37 * 'c'}"
    made["committed"] = f"2026-{1 + k // 28:02}-{1 + k % 28:02}T12:00:00+00:00"
    made["started"] = f"2026-{1 + k // 28:02}-{1 + k % 28:02}T13:00:00Z"
    made["dirty"] = False
    made["machine"]["id"] = machine
    return made


def stepped(path: Path, base: dict[str, Any], count: int = 30, step: int = 15) -> Path:
    """A history with 3 % noise in the times, and from ``step`` on more work, time and a fault.

    The noise is that of the run, so that another claim more does not draw another history.
    """
    noise = np.random.default_rng(11).normal(1, 0.03, count)
    for k in range(count):
        made = line(base, k)
        for claim in made["claims"].values():
            if "relative" in claim:
                claim["relative"] *= float(noise[k])
        if k >= step:
            made["claims"][CLAIM]["work"] += 4
            made["claims"][CLAIM]["relative"] *= 1.3
            made["claims"][CLAIM]["outcome"] = "violated"
        append_run(made, path)
    return path


def lines(path: Path) -> list[dict[str, Any]]:
    """What is in the file, read plainly."""
    return [json.loads(text) for text in path.read_text().splitlines()]
