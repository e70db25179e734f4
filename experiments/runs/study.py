"""A study: every experiment on every structure, into one run folder.

First what the experiments need is compiled, and what is only counted is counted, on all cores. Then
workers take times, one structure after the other, because what runs beside is timed with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from threading import Event
from time import monotonic
from typing import Any

from experiments.harness import PRESETS
from experiments.harness.steadiness import REPEATS
from experiments.runs.catalog import experiments
from experiments.runs.compiling import compile_and_count
from experiments.runs.provenance import describe, now, source
from experiments.runs.run import RUNS, latest, load
from experiments.runs.steadiness import noise
from experiments.runs.store import (
    CannotWriteError,
    CaseFile,
    ResultsError,
    cannot_write,
    case_files,
    lock_run,
    read_meta,
    require_room,
    set_aside_damaged,
    write_meta,
)
from experiments.runs.worker import (
    AGAIN,
    DEFAULT_SEED,
    Job,
    Options,
    WorkerDiedError,
    end_of_log,
    log_of,
    perform,
)
from structures import NAMED

REPEATING_SHARE = 0.5
"""Disturbed cases are measured again for at most this part of the time that all cases took."""


class Observer:
    """Is told how a study goes on; this one keeps it to itself."""

    def compiled(self, structure: str, done: int, total: int) -> None:
        """The kernels of a structure are compiled, of ``done`` out of ``total`` by now."""

    def measured(self, job: Job, done: int) -> None:
        """So many cases of a job are finished."""

    def say(self, text: str) -> None:
        """Something a user should know."""


class StudyFailedError(RuntimeError):
    """Some cases failed; the message names the jobs and shows what they printed."""


def begin(
    preset: str,
    root: Path = RUNS,
    structures: Sequence[str] = (),
    experiments: Sequence[str] = (),
    *,
    seed: int = DEFAULT_SEED,
    pin: bool = True,
) -> Path:
    """A new run folder, named by the time and the preset, with what is known before it runs.

    ``structures``, ``experiments``: just these; all of them for none. ``seed``: of the order of the
    cases; ``pin``: whether to stay on one core. Raises ValueError for a name that there is not,
    CannotWriteError.
    """
    chosen = {"structures": list(structures), "experiments": [_full_name(it) for it in experiments]}
    for name in structures:
        if name not in NAMED:
            raise ValueError(f"no structure is called {name!r}; there are {', '.join(NAMED)}")
    if preset not in PRESETS:
        raise ValueError(f"no preset is called {preset!r}; there are {', '.join(PRESETS)}")
    folder = _new_folder(root, f"{datetime.now(UTC).strftime('%Y%m%d-%H%M%S')}-{preset}")
    try:
        write_meta(folder, {**describe(preset), **chosen, "seed": seed, "pin": pin})
    except CannotWriteError:
        with suppress(OSError):
            folder.rmdir()
        raise
    return folder


def _full_name(experiment: str) -> str:
    """The name of an experiment's module, given with or without ``bench_``."""
    known = {name.removeprefix("bench_"): name for name in experiments()}
    short = experiment.removeprefix("bench_")
    if short not in known:
        raise ValueError(f"no experiment is called {short!r}; there are {', '.join(known)}")
    return known[short]


def _new_folder(root: Path, name: str) -> Path:
    """A folder that nobody else has: of two studies in one second the later gets a number."""
    try:
        root.mkdir(parents=True, exist_ok=True)
        for suffix in ("", *(f"-{k}" for k in range(2, 1_000))):
            with suppress(FileExistsError):
                (root / f"{name}{suffix}").mkdir()
                return root / f"{name}{suffix}"
    except OSError as error:
        raise cannot_write(root, error) from error
    raise CannotWriteError(f"{root} has a thousand runs called {name}: clear it up")


def options_of(meta: dict[str, Any]) -> Options:
    """How a run was begun, and is to go on."""
    return Options(str(meta["preset"]), int(meta["seed"]), bool(meta["pin"]))


def plan(folder: Path) -> list[Job]:
    """All jobs of a run, in the order of the experiments."""
    meta = read_meta(folder)
    chosen, options = meta["structures"], options_of(meta)
    jobs = [
        Job(name, structure, options)
        for name, declared in experiments().items()
        if name in (meta["experiments"] or _usual(options.preset))
        for structure in declared.structures
        if not chosen or structure in chosen or structure not in NAMED
    ]
    return [job for job in jobs if job.ids]


def _usual(preset: str) -> list[str]:
    """The experiments of a preset, where none are asked for by name."""
    return [name for name in experiments() if name not in PRESETS[preset].skipped]


def run(folder: Path, observer: Observer | None = None) -> None:
    """Measure what the folder lacks, and mark the run finished.

    Raises StudyFailedError when everything else is measured, InUseError if another process measures
    into the folder, CannotWriteError once results cannot be kept, and KeyboardInterrupt as it
    comes; what is finished stays in any case.
    """
    observer = observer or Observer()
    with prepared(folder, observer.say):
        jobs = [job for job in plan(folder) if job.left(folder)]
        failures: list[str] = []

        def measure(group: list[Job], stop: Event) -> None:
            failures.extend(_measure(folder, group, observer, stop))

        compile_and_count(folder, jobs, observer.compiled, measure)
        timed = [job for job in jobs if job.timed]
        for structure in dict.fromkeys(job.structure for job in timed):
            measure([job for job in timed if job.structure == structure], Event())
        if failures:
            raise StudyFailedError("\n\n".join(failures))
        finish(folder)


def _measure(folder: Path, jobs: list[Job], observer: Observer, stop: Event) -> list[str]:
    """Measure jobs of one structure -> which failed, and why."""
    begin, failures, left = monotonic(), [], jobs
    while left:
        try:
            _measure_once(folder, left, observer, stop)
        except WorkerDiedError as error:
            left = [job for job in left if job.left(folder)]
            failures += [f"{job}:\n{error}" for job in left[:1]]
            left = left[1:]  # what killed the worker does not keep the others from being measured
        else:
            names = ", ".join(str(job) for job in left if job.left(folder))
            failures += [f"{names}:\n{end_of_log(log_of(folder, left[0]))}"] if names else []
            left = []
    now = monotonic()
    if stop.is_set():
        return []
    with suppress(WorkerDiedError):
        _measure_again(folder, jobs, now + REPEATING_SHARE * (now - begin))
    return failures


def _measure_once(folder: Path, jobs: list[Job], observer: Observer, stop: Event) -> None:
    done = {job: len(job.ids) - len(job.left(folder)) for job in jobs}
    by_name = {job.experiment: job for job in jobs}
    with closing(perform(folder, jobs)) as finished:
        for experiment in finished:
            job = by_name[experiment]
            done[job] += 1
            observer.measured(job, done[job])
            if stop.is_set():
                return


def _measure_again(folder: Path, jobs: list[Job], until: float) -> None:
    """Measure disturbed cases once more, each time in a new process, while there is time."""
    for _ in range(REPEATS):
        again = [job for job in jobs if job.disturbed(folder)]
        if not again:
            return
        with closing(perform(folder, again, AGAIN)) as finished:
            for _ in finished:
                if monotonic() > until:
                    return


@contextmanager
def prepared(folder: Path, say: Callable[[str], None]) -> Iterator[None]:
    """Have a folder for oneself, with room in it and nothing damaged."""
    with lock_run(folder):
        require_room(folder)
        begun = bool(case_files(folder))
        for path in set_aside_damaged(folder):
            say(f"{path.name} was damaged and is set aside; its cases are measured again")
        meta = read_meta(folder)
        if begun:
            _require_same_code(folder, meta)
            again = {"at": now(), **source()}
            write_meta(folder, {**meta, "resumed": [*meta.get("resumed", []), again]})
        yield


def _require_same_code(folder: Path, meta: dict[str, Any]) -> None:
    """Raise ResultsError if a run would be resumed by other code than it was begun with."""
    was, here = meta.get("commit"), source()["commit"]
    if was and was != here:
        raise ResultsError(
            f"{folder} was begun at commit {was[:12]}, and this is {here[:12]}: what they measure "
            "does not belong together; check that commit out, or begin a new run"
        )


def finish(folder: Path, machine: dict[str, Any] | None = None) -> None:
    """Mark a run as finished, with what it consists of and how steady the machine was.

    ``machine``: what measured it, if it was not this one.
    """
    files = {
        str(path.relative_to(folder)): len(CaseFile.at(path).measurements)
        for path in case_files(folder)
    }
    seen = noise(load(folder))
    steadiness = {**asdict(seen), "share": seen.share, "too_busy": seen.too_busy}
    meta = read_meta(folder)
    more = {"finished": now(), "files": files, "noise": steadiness}
    write_meta(folder, {**meta, **more, "machine": machine or meta["machine"]})


def resume(root: Path = RUNS, folder: Path | None = None) -> Path:
    """The newest unfinished run, or ``folder``, finished or not. Raises ResultsError."""
    folder = folder or latest(root, unfinished=True)
    read_meta(folder)
    return folder
