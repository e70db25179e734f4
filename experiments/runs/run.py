"""A run as it is read: one table of all its cases."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from experiments.harness import Measurement
from experiments.runs.store import (
    META,
    CaseFile,
    DamagedError,
    ResultsError,
    case_files,
    read_meta,
    resuming,
)

if TYPE_CHECKING:  # it takes half a second, and a study has no need of it
    import pandas as pd

RUNS = Path("results/runs")


@dataclass(frozen=True, eq=False)  # judged once per run object
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
    meta = read_meta(folder)
    files = {str(path.relative_to(folder)): CaseFile.at(path) for path in case_files(folder)}
    for name, count in meta.get("files", {}).items():
        if name not in files or len(files[name].measurements) < count:
            missing = f"{folder / name} is {'not whole' if name in files else 'missing'}"
            raise DamagedError(
                f"{missing}; measure its cases again with: {resuming(folder / name)}"
            )
    rows = [
        {
            "experiment": file.experiment,
            "structure": file.structure,
            "machine": "" if file.path.parent == folder else file.path.parent.name,
            **vars(case),
        }
        for file in files.values()
        for case in file.cases.values()
    ]
    columns = ["experiment", "structure", "machine", *Measurement.__dataclass_fields__]
    cases = pd.DataFrame(rows, columns=columns)
    cases["samples"] = cases["samples"].map(lambda samples: np.asarray(samples, float))
    measured = cases["skipped"] == ""
    return Run(folder, meta, cases[measured].reset_index(drop=True), cases[~measured])


def latest(root: Path | str = RUNS, *, unfinished: bool = False) -> Path:
    """The newest run, or the newest that was not finished. Raises ResultsError if there is none."""
    runs = sorted(Path(root).glob(f"*/{META}"), key=lambda path: path.parent.name, reverse=True)
    for path in runs:
        if not (unfinished and "finished" in read_meta(path.parent)):
            return path.parent
    what = "unfinished run" if unfinished else "run"
    raise ResultsError(f"there is no {what} in {root}; start one with: hem study")
