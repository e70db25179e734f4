"""A study: every experiment on every structure, one process each, into one run folder.

The processes run one after the other, because what runs beside a measurement is measured with it.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path

from experiments.profiles import PROFILES
from experiments.provenance import describe, now
from experiments.results import RUNS, ResultFile, latest, read_json, write_json
from structures import NAMED

EXPERIMENTS = (
    "bench_latency",
    "bench_memory",
    "bench_work",
    "bench_build",
    "bench_valence",
    "bench_queries",
    "bench_operation_work",
    "bench_operations",
    "bench_workloads",
    "bench_printed",
    "bench_fracture",
)
"""The experiments in the order they run. A new one is a file of this name beside this one."""

POLL_SECONDS = 0.25


@dataclass(frozen=True)
class Process:
    """One experiment on one structure."""

    experiment: str
    structure: str
    cells: frozenset[str]

    def done(self, folder: Path) -> int:
        """How many of its cells are on disk."""
        finished = ResultFile(folder, self.experiment, self.structure).finished
        return len(self.cells & finished)


class StudyFailedError(RuntimeError):
    """Some cells failed; the message names the processes and shows what they printed."""


def begin(profile: str, root: Path = RUNS, structures: Sequence[str] = ()) -> Path:
    """A new run folder, named by the time and the profile, with what is known before it runs.

    ``structures``: just these; all of them for none. Raises ValueError for one there is not.
    """
    for name in structures:
        if name not in NAMED:
            raise ValueError(f"no structure is called {name!r}; there are {', '.join(NAMED)}")
    stamp = datetime.now(UTC).strftime("%Y%m%d-%H%M%S")
    folder = root / f"{stamp}-{profile}"
    write_json(folder / "run.json", {**describe(profile), "structures": list(structures)})
    return folder


def resume(root: Path = RUNS) -> tuple[Path, str, list[str]]:
    """The newest unfinished run, its profile and structures. Raises ResultsError without any."""
    folder = latest(root, unfinished=True)
    meta = read_json(folder / "run.json")
    return folder, str(meta["profile"]), list(meta.get("structures", ()))


def processes(profile: str, structures: Sequence[str] = ()) -> list[Process]:
    """All processes of a profile, with the cells that each will leave behind."""
    return [
        Process(experiment, structure, frozenset(cell.id for cell in cells))
        for experiment in EXPERIMENTS
        for module in [import_module(f"experiments.{experiment}")]
        for structure in module.STRUCTURES
        if not structures or structure in structures or structure not in NAMED
        for cells in [module.cells(PROFILES[profile].of(structure), structure)]
    ]


def run(
    folder: Path,
    profile: str,
    report: Callable[[Process, int], None],
    structures: Sequence[str] = (),
) -> None:
    """Run what the folder lacks, and mark it finished.

    ``report(process, done)`` is called as cells come in. Raises StudyFailedError when everything
    else has run, and KeyboardInterrupt as it comes; what is finished stays in either case.
    """
    failures = []
    for process in processes(profile, structures):
        if process.done(folder) < len(process.cells):
            output = _run_one(folder, profile, process, report)
            if process.done(folder) < len(process.cells):
                failures.append(f"{process.experiment} on {process.structure}:\n{output}")
        report(process, process.done(folder))
    if failures:
        raise StudyFailedError("\n\n".join(failures))
    write_json(folder / "run.json", {**read_json(folder / "run.json"), "finished": now()})


def _run_one(
    folder: Path, profile: str, process: Process, report: Callable[[Process, int], None]
) -> str:
    """Run one process to its end -> the end of what it printed."""
    file = Path(str(import_module(f"experiments.{process.experiment}").__file__))
    command = [sys.executable, "-m", "pytest", str(file), "-q", "--no-header", "--tb=short"]
    command += ["-p", "no:cacheprovider", "--benchmark-quiet", "--profile", profile]
    command += ["--structure", process.structure, "--run", str(folder.resolve())]
    command += ["--study", str(os.getpid())]
    log = folder / "logs" / f"{process.experiment}.{process.structure}.txt"
    log.parent.mkdir(exist_ok=True)
    with log.open("w") as output:
        child = subprocess.Popen(
            command, cwd=file.parent.parent, env=_own(), stdout=output, stderr=subprocess.STDOUT
        )
        try:
            for _ in _until_it_ends(child):
                report(process, process.done(folder))
        except KeyboardInterrupt:
            child.terminate()
            child.wait()
            raise
    return "\n".join(log.read_text().splitlines()[-15:])


def _own() -> dict[str, str]:
    """The environment without what concerns another pytest, which might turn measuring off."""
    return {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}


def _until_it_ends(child: subprocess.Popen[bytes]) -> Iterator[None]:
    while True:
        try:
            child.wait(POLL_SECONDS)
        except subprocess.TimeoutExpired:
            yield
        else:
            return
