"""A worker: one process that measures experiments on structures, and says when a case is done.

It writes a line to its standard output after every case, and ends when its standard input does:
with the study, however that ends. What pytest prints goes to a log.
"""

import os
import subprocess
import sys
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from threading import Event, Thread
from typing import Any, TextIO

from experiments.harness import PRESETS, Case
from experiments.runs.catalog import experiments
from experiments.runs.store import CaseFile, require_room, writing

ENDING_SECONDS = 5  # how long a worker may take to end before it is killed
LINES_SHOWN = 15
NOT_PASSED_ON = "PYTEST_", "MALLOC_"  # variables; by Dask's a worker would free memory at once
DEFAULT_SEED = 1
MEASURE, AGAIN, COMPILE = "measure", "again", "compile"
"""What a worker does with a case: measure what is missing, or what was disturbed; or just compile
what one case of each kind needs."""

EXPERIMENTS = Path(__file__).parents[1]
PYTEST = (
    *("-p", "pytest_benchmark.plugin", "-p", "no:cacheprovider", "--benchmark-quiet"),
    *("-q", "--no-header", "--tb=short", "--benchmark-disable-gc"),
)


@dataclass(frozen=True)
class Job:
    """One experiment on one structure, its cases in a seeded order; ``mesh``: one's own."""

    experiment: str
    structure: str
    preset: str
    seed: int = DEFAULT_SEED
    pin: bool = True
    mesh: tuple[str, tuple[int, ...]] | None = None

    def __str__(self) -> str:
        return f"{self.experiment.removeprefix('bench_')} on {self.structure}"

    @property
    def timed(self) -> bool:
        """Whether it takes times; what is only counted does not mind what runs beside it."""
        return experiments()[self.experiment].kind == "time"

    @cached_property
    def ids(self) -> frozenset[str]:
        """The ids of the cases that it leaves behind."""
        preset = PRESETS[self.preset].on(*self.mesh) if self.mesh else PRESETS[self.preset]
        cases = experiments()[self.experiment].cases(preset.of(self.structure), self.structure)
        return frozenset(case.id for case in cases)

    def file(self, folder: Path) -> CaseFile:
        """Its measurements in a folder."""
        return CaseFile(folder, self.experiment, self.structure)

    def left(self, folder: Path) -> frozenset[str]:
        """The ids of the cases that a folder lacks."""
        return self.ids - self.file(folder).cases.keys()


class WorkerDiedError(RuntimeError):
    """A worker ended before its time; the message is the end of its log."""


def perform(
    folder: Path, jobs: Sequence[Job], action: str = MEASURE, stop: Event | None = None
) -> Generator[Job]:
    """Perform jobs in a process of their own -> after each case its job.

    They are performed in the order of the experiments, and every experiment on all structures that
    one of the jobs is about: what is left of those. Closing the iterator ends the process, and so
    does ``stop``, amid a case. Raises WorkerDiedError if it dies, CannotWriteError if there is no
    more room for results.
    """
    first, by_name = jobs[0], {f"{job.experiment} {job.structure}": job for job in jobs}
    log = _log(folder, first, action)
    mine = {key: value for key, value in os.environ.items() if not key.startswith(NOT_PASSED_ON)}
    with writing(log):
        log.parent.mkdir(exist_ok=True)
        with log.open("ab") as output:
            worker = subprocess.Popen(
                [sys.executable, "-m", __name__, *_asked(folder, jobs, action)],
                cwd=EXPERIMENTS.parent, env={**mine, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=output, text=True,
            )  # fmt: skip
    with worker:
        if stop:
            Thread(target=_end_at, args=(stop, worker), daemon=True).start()
        try:
            names = map(str.strip, worker.stdout or ())  # it compiles for jobs that are done, too
            yield from (by_name[name] for name in names if name in by_name)
            code = worker.wait()
        finally:
            worker.terminate()
            try:
                worker.wait(ENDING_SECONDS)
            except subprocess.TimeoutExpired:
                worker.kill()
    require_room(folder)
    if code not in (0, 1):  # pytest's: all passed, and some failed
        said = end_of_log(folder, first, action)
        raise WorkerDiedError(said or f"it ended with exit code {code}")


def _end_at(stop: Event, worker: subprocess.Popen[str]) -> None:
    stop.wait()
    worker.terminate()  # which does nothing to one that has ended


def _asked(folder: Path, jobs: Sequence[Job], action: str) -> list[str]:
    """What a worker is told to do."""
    first = jobs[0]
    asked = [str(EXPERIMENTS / f"{it}.py") for it in dict.fromkeys(it.experiment for it in jobs)]
    asked += [f"--structure={name}" for name in dict.fromkeys(it.structure for it in jobs)]
    asked += ["--preset", first.preset, "--case-seed", str(first.seed), "--action", action]
    asked += ["--run", str(folder.resolve())]
    # Whose project it is installed in, that one has settings and a conftest.py of its own.
    asked += ["-c", os.devnull, f"--rootdir={EXPERIMENTS}", f"--confcutdir={EXPERIMENTS}"]
    if action == COMPILE:
        return [*asked, "--benchmark-disable"]
    return [*asked, "--pin"] if first.pin and first.timed else asked


def _log(folder: Path, job: Job, action: str) -> Path:
    return folder / "logs" / f"{job.experiment}.{job.structure}.{action}.txt"


def end_of_log(folder: Path, job: Job, action: str = MEASURE) -> str:
    """The last lines of what workers printed whose first job it was."""
    log = _log(folder, job, action)
    lines = log.read_text(errors="replace").splitlines(keepends=True) if log.exists() else []
    return "".join(lines[-LINES_SHOWN:])


@dataclass(eq=False)  # pytest keeps plugins by their hash
class _Progress:
    """A plugin of pytest that says which experiment and structure a finished case belongs to."""

    study: TextIO

    def pytest_runtest_teardown(self, item: Any) -> None:
        case = item.callspec.params["case"]
        if isinstance(case, Case):  # and not what stands for none
            print(item.path.stem, case.structure, file=self.study, flush=True)


def main(command: list[str]) -> int:
    """Run pytest as a worker -> its exit code."""
    import pytest

    asked = os.dup(0)

    def end_with_study() -> None:  # it has ended when its end of the pipe is closed
        os.read(asked, 1)
        os._exit(1)

    Thread(target=end_with_study, daemon=True).start()
    study = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what is printed goes to the log
    return int(pytest.main([*command, *PYTEST], plugins=[_Progress(study)]))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
