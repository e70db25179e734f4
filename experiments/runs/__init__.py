"""All cases into a folder, and a folder into a table.

``begin`` makes a run's folder and ``measure`` (``hem study``) fills it, ``load`` reads it as a
``Run``: a table of cases. ``study`` says what a study does, ``worker`` how a process of it
measures, ``store`` what is on disk. A cluster (``runs.cluster``) is asked for by name.
"""

from experiments.runs.catalog import experiments, tables
from experiments.runs.provenance import describe, git, in_words, machine, machine_id
from experiments.runs.run import RUNS, Run, latest, load
from experiments.runs.steadiness import Noise, noise
from experiments.runs.store import (
    CannotWriteError,
    CaseFile,
    DamagedError,
    InUseError,
    ResultsError,
    read_meta,
    write_meta,
)

__all__ = [
    "RUNS",
    "CannotWriteError",
    "CaseFile",
    "DamagedError",
    "InUseError",
    "Noise",
    "ResultsError",
    "Run",
    "describe",
    "experiments",
    "git",
    "in_words",
    "latest",
    "load",
    "machine",
    "machine_id",
    "noise",
    "read_meta",
    "tables",
    "write_meta",
]
