"""A worker: one process that measures experiments on one structure, and says when a case is done.

It writes a line to its standard output after every case, so that the study need not look into what
is being measured, and ends when its standard input does: with the study, however that ends. What
pytest prints goes to a log.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import Any, TextIO

from experiments.harness import PRESETS, Experiment
from experiments.runs.catalog import experiments
from experiments.runs.store import CaseFile, cannot_write, require_room

ENDING_SECONDS = 5
"""How long a worker may take to end before it is killed."""
LINES_SHOWN = 15
DEFAULT_SEED = 1
MEASURE, AGAIN, COMPILE = "measure", "again", "compile"
"""What a worker does with a case: measure what is missing, or what was disturbed; or just compile
what one case of each kind needs."""


@dataclass(frozen=True)
class Options:
    """How a study measures: its preset, the seed of the order of cases, and whether on one core."""

    preset: str
    seed: int = DEFAULT_SEED
    pin: bool = True


@dataclass(frozen=True)
class Job:
    """One experiment on one structure."""

    experiment: str
    structure: str
    options: Options

    def __str__(self) -> str:
        return f"{self.experiment.removeprefix('bench_')} on {self.structure}"

    @property
    def timed(self) -> bool:
        """Whether it takes times; what is only counted does not mind what runs beside it."""
        return experiments()[self.experiment].kind == "time"

    @cached_property
    def ids(self) -> frozenset[str]:
        """The ids of the cases that it leaves behind."""
        declared: Experiment = experiments()[self.experiment]
        preset = PRESETS[self.options.preset].of(self.structure)
        return frozenset(case.id for case in declared.cases(preset, self.structure))

    def left(self, folder: Path) -> frozenset[str]:
        """The ids of the cases that a folder lacks."""
        return self.ids - CaseFile(folder, self.experiment, self.structure).cases.keys()

    def disturbed(self, folder: Path) -> bool:
        """Whether cases were disturbed that may be measured again."""
        return bool(CaseFile(folder, self.experiment, self.structure).disturbed)


class WorkerDiedError(RuntimeError):
    """A worker ended before its time; the message is the end of its log."""


def perform(folder: Path, jobs: Sequence[Job], action: str = MEASURE) -> Generator[str]:
    """Perform jobs on one structure in a process of their own -> after each case its experiment.

    Closing the iterator ends the process. Raises WorkerDiedError if it dies, CannotWriteError if
    there is no more room for results.
    """
    log = log_of(folder, jobs[0], action)
    task = {
        "experiments": [job.experiment for job in jobs],
        "structure": jobs[0].structure,
        "run": str(folder.resolve()),
        "action": action,
        **vars(jobs[0].options),
        "pin": jobs[0].options.pin and jobs[0].timed and action != COMPILE,
    }
    try:
        log.parent.mkdir(exist_ok=True)
        with log.open("ab") as output:
            child = _start(task, output)
    except OSError as error:
        raise cannot_write(log, error) from error
    try:
        for line in child.stdout or ():
            yield json.loads(line)["experiment"]
        code = child.wait()
    finally:
        _end(child)
    require_room(folder)
    if code not in (0, 1):  # pytest's: all passed, and some failed
        raise WorkerDiedError(end_of_log(log) or f"it ended with exit code {code}")


def log_of(folder: Path, job: Job, action: str = MEASURE) -> Path:
    """Where the workers of a job's structure print."""
    what = action if action != MEASURE or job.timed else "count"
    return folder / "logs" / f"{job.structure}.{what}.txt"


def end_of_log(log: Path) -> str:
    """The last lines of what a worker printed."""
    text = log.read_text(errors="replace") if log.exists() else ""
    return "".join(text.splitlines(keepends=True)[-LINES_SHOWN:])


def _start(task: dict[str, Any], output: Any) -> subprocess.Popen[str]:
    """A worker for a task, without what concerns another pytest."""
    clean = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}
    return subprocess.Popen(
        [sys.executable, "-m", "experiments.runs", json.dumps(task)],
        cwd=Path(str(import_module("experiments").__file__)).parent.parent,
        env={**clean, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=output, text=True,
    )  # fmt: skip


def _end(child: subprocess.Popen[str]) -> None:
    if child.poll() is None:
        child.terminate()
        try:
            child.wait(ENDING_SECONDS)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
    for pipe in (child.stdin, child.stdout):
        if pipe:
            pipe.close()


class _Progress:
    """A plugin of pytest that says which experiment a finished case belongs to."""

    def __init__(self, study: TextIO) -> None:
        self._study = study

    def pytest_runtest_logfinish(self, location: tuple[str, int | None, str]) -> None:
        print(json.dumps({"experiment": Path(location[0]).stem}), file=self._study, flush=True)


def main(task: dict[str, Any]) -> int:
    """Run pytest on a task -> its exit code."""
    import pytest

    Thread(target=_end_with_study, args=(os.dup(0),), daemon=True).start()
    study = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what is printed goes to the log
    here = Path(str(import_module("experiments").__file__)).parent
    command = [str(here / f"{name}.py") for name in task["experiments"]]
    command += ["-p", "pytest_benchmark.plugin", "-p", "no:cacheprovider", "--benchmark-quiet"]
    command += ["-q", "--no-header", "--tb=short", "--benchmark-disable-gc"]
    command += ["--preset", task["preset"], "--structure", task["structure"]]
    command += ["--case-seed", str(task["seed"]), "--action", task["action"]]
    command += ["--pin"] if task["pin"] else []
    if task["action"] == COMPILE:
        command += ["--benchmark-disable"]
    else:
        command += ["--run", task["run"]]
    return int(pytest.main(command, plugins=[_Progress(study)]))


def _end_with_study(study: int) -> None:
    """End this process when the one that began it has ended, and its end of the pipe is closed."""
    os.read(study, 1)
    os._exit(1)
