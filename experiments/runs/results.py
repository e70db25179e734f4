"""What a run leaves on disk, written and read in one place.

A run is a folder: ``run.json`` says what ran where, and every process, that is one experiment on
one structure, has a file ``<experiment>.<structure>.json`` with its cases. A file is written beside
and renamed after each case, so that whoever is killed loses the case in flight and nothing else; it
carries a checksum, so that what is damaged later is not read as measured. A run on several machines
has a folder ``machine-…`` for each, with a ``run.json`` of its own. Raw samples are never
rewritten; what is derived from them lives in ``derived/``.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from experiments.harness import Measurement
from experiments.runs.storage import (
    SEAL,
    CannotWriteError,
    DamagedError,
    ResultsError,
    again,
    read_json,
    write_json,
    write_sealed,
)

if TYPE_CHECKING:
    import pandas as pd

SCHEMA = 2
READABLE = (1, SCHEMA)
"""Schemas that are understood: 1 had neither checksums nor noise."""

RUNS = Path("results/runs")
MACHINES = "machine-*"

__all__ = [
    "MACHINES",
    "READABLE",
    "RUNS",
    "SCHEMA",
    "CannotWriteError",
    "DamagedError",
    "Measurement",
    "ResultFile",
    "ResultsError",
    "Run",
    "latest",
    "load",
    "read_json",
    "result_files",
    "write_json",
    "write_sealed",
]  # fmt: skip


class ResultFile:
    """The cases of one process, kept on disk from one case to the next.

    Raises DamagedError where the file is not what was written.
    """

    def __init__(self, folder: Path, experiment: str, structure: str) -> None:
        self.path = folder / f"{experiment}.{structure}.json"
        self.head = {"schema": SCHEMA, "experiment": experiment, "structure": structure}
        self.cases = _cases_of(self.path)["cases"] if self.path.exists() else []

    @property
    def finished(self) -> set[str]:
        """The ids of the cases that are on disk."""
        return {case["id"] for case in self.cases}

    def add(self, case: Measurement) -> None:
        """Keep one more case, or another result of one. Raises CannotWriteError, and keeps less."""
        others = [kept for kept in self.cases if kept["id"] != case.id]
        write_sealed(self.path, {**self.head, "cases": [*others, asdict(case)]})
        self.cases = [*others, asdict(case)]

    def get(self, case_id: str) -> dict[str, Any] | None:
        """A case as it is on disk, None if it is not."""
        return next((case for case in self.cases if case["id"] == case_id), None)


@dataclass(frozen=True, eq=False)
class Run:
    """A run as read: ``meta`` is run.json, ``cases`` has one row per measured case.

    ``cases`` has the fields of ``Measurement``, ``samples`` as an array, besides ``experiment``,
    ``structure`` and ``machine``: the folder of the machine that measured it, empty where there was
    only one. ``skipped``: the cases that were not measured, with the reason.
    """

    folder: Path
    meta: dict[str, Any]
    cases: pd.DataFrame
    skipped: pd.DataFrame

    @property
    def machines(self) -> list[str]:
        """The machines that measured it, where they were several: their times do not mix."""
        return list(self.meta.get("machine", {}).get("machines", ()))


def load(folder: Path | str) -> Run:
    """Read a run. Raises ResultsError if there is none in ``folder``, or of another schema.

    Of a damaged or missing file too: nothing is read as a run that is not all of what was measured.
    """
    import pandas as pd

    folder = Path(folder)
    if not (folder / "run.json").exists():
        raise ResultsError(f"{folder} holds no run: there is no run.json in it")
    meta = _of_this_schema(folder / "run.json")
    _require_all(folder, meta)
    rows = []
    for path in result_files(folder):
        content = _cases_of(path)
        owner = {key: content[key] for key in ("experiment", "structure")}
        owner["machine"] = "" if path.parent == folder else path.parent.name
        rows += [{**owner, "noise": {}, **case} for case in content["cases"]]
    columns = ["experiment", "structure", "machine", *Measurement.__dataclass_fields__]
    cases = pd.DataFrame(rows, columns=columns)
    cases["samples"] = cases["samples"].map(lambda samples: np.asarray(samples, float))
    measured = cases["skipped"] == ""
    return Run(folder, meta, cases[measured].reset_index(drop=True), cases[~measured])


def result_files(folder: Path) -> list[Path]:
    """The files with the cases of a run, those of every machine; copies beside them are not."""
    every = [*sorted(folder.glob("*.*.json")), *sorted(folder.glob(f"{MACHINES}/*.*.json"))]
    return [path for path in every if path.name.count(".") == 2]


def latest(root: Path | str = RUNS, *, unfinished: bool = False) -> Path:
    """The newest run, or the newest that was not finished. Raises ResultsError if there is none."""
    runs = sorted(Path(root).glob("*/run.json"), key=lambda path: path.parent.name, reverse=True)
    for path in runs:
        if not (unfinished and "finished" in read_json(path)):
            return path.parent
    what = "unfinished run" if unfinished else "run"
    raise ResultsError(f"there is no {what} in {root}; start one with: hem study")


def _of_this_schema(path: Path) -> dict[str, Any]:
    content = read_json(path)
    if content.get("schema") not in READABLE:
        found = content.get("schema")
        raise ResultsError(f"{path} has schema {found}, this version reads {SCHEMA}: run it anew")
    return content


def _cases_of(path: Path) -> dict[str, Any]:
    """A file of cases. Since schema 2 one that lost its checksum is damaged as well."""
    content = _of_this_schema(path)
    sealed = content["schema"] == 1 or SEAL in content
    if not sealed or not {"experiment", "structure", "cases"} <= set(content):
        way_out = f"measure its cases again with: {again(path)}"
        raise DamagedError(f"{path} is not as it was written; {way_out}")
    return content


def _require_all(folder: Path, meta: dict[str, Any]) -> None:
    """Raise DamagedError if a file is gone that was there when the run was finished."""
    gone = [name for name in meta.get("files", ()) if not (folder / name).exists()]
    if gone:
        missing = folder / gone[0]
        raise DamagedError(f"{missing} is missing; measure its cases again with: {again(missing)}")
