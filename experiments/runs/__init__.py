"""All cases into a folder, and a folder into a table.

``study.begin`` makes a run's folder and ``study.run`` (``hem study``) fills it, ``load`` reads it
as a ``Run``: a table of cases. ``worker`` is a process that measures, ``store`` what is on disk. Of
the files ``study`` and ``cluster`` are asked for by name.
"""

from experiments.runs.catalog import experiments, tables
from experiments.runs.provenance import describe, git, machine, machine_id
from experiments.runs.run import PEER_RUNS, RUNS, Run, in_words, latest, load, noise
from experiments.runs.store import (
    CannotWriteError,
    CaseFile,
    ResultsError,
    read_meta,
    resume_command,
    write_meta,
)
from experiments.runs.worker import AGAIN, COMPILE, DEFAULT_SEED, MEASURE, Job

__all__ = [
    "AGAIN", "COMPILE", "DEFAULT_SEED", "MEASURE", "PEER_RUNS", "RUNS", "CannotWriteError",
    "CaseFile", "Job", "ResultsError", "Run", "describe", "experiments", "git", "in_words",
    "latest", "load", "machine", "machine_id", "noise", "read_meta", "resume_command", "tables",
    "write_meta",
]  # fmt: skip
