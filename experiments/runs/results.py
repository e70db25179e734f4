"""The names of before, until the last import of them is gone."""

import json
from pathlib import Path
from typing import Any

from experiments.harness import Measurement
from experiments.runs.run import RUNS, Run, latest, load
from experiments.runs.store import CannotWriteError, DamagedError, ResultsError
from hem.whole_files import write_whole

__all__ = [
    "RUNS",
    "CannotWriteError",
    "DamagedError",
    "Measurement",
    "ResultsError",
    "Run",
    "latest",
    "load",
    "read_json",
    "write_json",
]


def write_json(path: Path, content: Any) -> None:
    """Write a file whole."""
    write_whole(path, json.dumps(content, indent=1))


def read_json(path: Path) -> Any:
    """Read a file."""
    return json.loads(path.read_text())
