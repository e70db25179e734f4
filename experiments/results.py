"""What a run leaves on disk, written and read in one place.

A run is a folder: ``run.json`` says what ran where, and every process, that is one experiment on
one structure, has a file ``<experiment>.<structure>.json`` with its cells. A file is written beside
and renamed after each cell, so that whoever is killed loses the cell in flight and nothing else.
Raw samples are never rewritten; what is derived from them lives in ``derived/``.
"""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

SCHEMA = 1
RUNS = Path("results/runs")


class ResultsError(ValueError):
    """A run folder is missing, incomplete or of another schema."""


@dataclass
class CellResult:
    """One measured cell.

    ``samples``: seconds per query and round (``kind`` "time"), reads per query and handle ("work"),
    or bytes ("bytes"). ``handles``: queries per sample. ``working_set``: bytes of the structure's
    live records, or of the chased array in the latency experiment. ``valence``: that of the queried
    vertices where the experiment varies it. ``latency``: seconds per memory access in the working
    set, measured beside the cell. ``left_out``: why nothing was measured, else empty.
    """

    id: str
    kind: str
    query: str | None = None
    order: str | None = None
    family: str | None = None
    seed: int = 0
    vertices: int = 0
    edges: int = 0
    faces: int = 0
    valence_max: int = 0
    valence: int | None = None
    reference_bytes: int = 4
    working_set: int = 0
    handles: int = 0
    checked: bool = False
    latency: float | None = None
    samples: list[float] = field(default_factory=list)
    left_out: str = ""
    detail: dict[str, Any] = field(default_factory=dict)


class ResultFile:
    """The cells of one process, kept on disk from one cell to the next."""

    def __init__(self, folder: Path, experiment: str, structure: str) -> None:
        self.path = folder / f"{experiment}.{structure}.json"
        self.head = {"schema": SCHEMA, "experiment": experiment, "structure": structure}
        self.cells = read_json(self.path)["cells"] if self.path.exists() else []

    @property
    def finished(self) -> set[str]:
        """The ids of the cells that are on disk."""
        return {cell["id"] for cell in self.cells}

    def add(self, cell: CellResult) -> None:
        """Keep one more cell."""
        self.cells.append(asdict(cell))
        write_json(self.path, {**self.head, "cells": self.cells})


@dataclass(frozen=True)
class Run:
    """A run as read: ``meta`` is run.json, ``cells`` has one row per measured cell.

    ``cells`` has the fields of ``CellResult``, ``samples`` as an array, besides ``experiment`` and
    ``structure``. ``left_out``: the cells that were not measured, with the reason.
    """

    folder: Path
    meta: dict[str, Any]
    cells: pd.DataFrame
    left_out: pd.DataFrame


def load(folder: Path | str) -> Run:
    """Read a run. Raises ResultsError if there is none in ``folder``, or of another schema."""
    import pandas as pd

    folder = Path(folder)
    if not (folder / "run.json").exists():
        raise ResultsError(f"{folder} holds no run: there is no run.json in it")
    meta = _of_this_schema(folder / "run.json")
    rows = []
    for path in sorted(folder.glob("*.*.json")):
        content = _of_this_schema(path)
        owner = {key: content[key] for key in ("experiment", "structure")}
        rows += [{**owner, **cell} for cell in content["cells"]]
    columns = ["experiment", "structure", *CellResult.__dataclass_fields__]
    cells = pd.DataFrame(rows, columns=columns)
    cells["samples"] = cells["samples"].map(lambda samples: np.asarray(samples, float))
    measured = cells["left_out"] == ""
    return Run(folder, meta, cells[measured].reset_index(drop=True), cells[~measured])


def latest(root: Path | str = RUNS, *, unfinished: bool = False) -> Path:
    """The newest run, or the newest that was not finished. Raises ResultsError if there is none."""
    runs = sorted(Path(root).glob("*/run.json"), key=lambda path: path.parent.name)
    wanted = [path for path in runs if not (unfinished and "finished" in read_json(path))]
    if not wanted:
        what = "unfinished run" if unfinished else "run"
        raise ResultsError(f"there is no {what} in {root}; start one with: hem study")
    return wanted[-1].parent


def read_json(path: Path) -> dict[str, Any]:
    """Read a file of a run. Raises ResultsError naming the file if it is not JSON."""
    try:
        content: dict[str, Any] = json.loads(path.read_text())
    except (OSError, json.JSONDecodeError) as error:
        raise ResultsError(f"{path} cannot be read: {error}") from error
    return content


def write_json(path: Path, content: Any) -> None:
    """Write beside and rename: at any time the file is whole, as it was or as it will be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_suffix(".part")
    with beside.open("w") as file:
        json.dump(content, file, indent=1)
        file.flush()
        os.fsync(file.fileno())
    beside.replace(path)


def _of_this_schema(path: Path) -> dict[str, Any]:
    content = read_json(path)
    if content.get("schema") != SCHEMA:
        found = content.get("schema")
        raise ResultsError(f"{path} has schema {found}, this version reads {SCHEMA}: run it anew")
    return content
