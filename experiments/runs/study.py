"""A study: every experiment on every structure, one process each, into one run folder.

The processes run one after the other, because what runs beside a measurement is measured with it.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from typing import Any

from experiments.harness.presets import PRESETS
from experiments.runs import steadiness, worker
from experiments.runs.locks import held
from experiments.runs.provenance import describe, now, resumed, source
from experiments.runs.results import (
    RUNS,
    CannotWriteError,
    DamagedError,
    ResultFile,
    ResultsError,
    latest,
    load,
    read_json,
    result_files,
    write_sealed,
)
from experiments.runs.storage import cannot_write, set_aside
from experiments.runs.worker import CANNOT_WRITE, DEFAULT_SEED, How
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

ROOM_BYTES = 1 << 16
"""What must be free in a folder for it to be worth measuring into."""

Report = Callable[["Process", int], None]


@dataclass(frozen=True)
class Process:
    """One experiment on one structure."""

    experiment: str
    structure: str
    cases: frozenset[str]

    def done(self, folder: Path) -> int:
        """How many of its cases are on disk; none of a file that is damaged."""
        try:
            finished = ResultFile(folder, self.experiment, self.structure).finished
        except DamagedError:
            return 0
        return len(self.cases & finished)


class StudyFailedError(RuntimeError):
    """Some cases failed; the message names the processes and shows what they printed."""


def begin(
    profile: str,
    root: Path = RUNS,
    structures: Sequence[str] = (),
    *,
    seed: int = DEFAULT_SEED,
    pin: bool = True,
) -> Path:
    """A new run folder, named by the time and the profile, with what is known before it runs.

    ``structures``: just these; all of them for none. ``seed``: of the order of the cases; ``pin``:
    whether to stay on one core. Raises ValueError for a structure there is not, CannotWriteError.
    """
    for name in structures:
        if name not in NAMED:
            raise ValueError(f"no structure is called {name!r}; there are {', '.join(NAMED)}")
    folder = _new_folder(root, f"{datetime.now(UTC).strftime('%Y%m%d-%H%M%S')}-{profile}")
    about = {"structures": list(structures), "seed": seed, "pin": pin}
    try:
        write_sealed(folder / "run.json", {**describe(profile), **about})
    except CannotWriteError:
        with suppress(OSError):
            folder.rmdir()
        raise
    return folder


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


def resume(root: Path = RUNS, folder: Path | None = None) -> tuple[Path, str, list[str]]:
    """The newest unfinished run, its profile and structures. Raises ResultsError without any.

    ``folder``: this one instead, finished or not.
    """
    folder = folder or latest(root, unfinished=True)
    if not (folder / "run.json").exists():
        raise ResultsError(f"{folder} holds no run to go on with: there is no run.json in it")
    meta = read_json(folder / "run.json")
    return folder, str(meta["profile"]), list(meta.get("structures", ()))


def how(folder: Path) -> How:
    """How a run was begun, and is to go on."""
    meta = read_json(folder / "run.json")
    seed, pin = meta.get("seed", DEFAULT_SEED), meta.get("pin", True)
    return How(str(meta["profile"]), int(seed), bool(pin))


def processes(profile: str, structures: Sequence[str] = ()) -> list[Process]:
    """All processes of a profile, with the cases that each will leave behind."""
    return [
        Process(experiment, structure, frozenset(case.id for case in cases))
        for experiment in EXPERIMENTS
        for module in [import_module(f"experiments.{experiment}")]
        for structure in module.EXPERIMENT.structures
        if not structures or structure in structures or structure not in NAMED
        for cases in [module.cases(PRESETS[profile].of(structure), structure)]
    ]


def run(
    folder: Path,
    profile: str,
    report: Report,
    structures: Sequence[str] = (),
    say: Callable[[str], None] = warnings.warn,
) -> None:
    """Run what the folder lacks, and mark it finished.

    ``report(process, done)`` is called as cases come in; ``say``: for what was found damaged and
    set aside. Raises StudyFailedError when everything else has run, InUseError if another process
    measures into the folder, CannotWriteError once results cannot be kept, and KeyboardInterrupt as
    it comes; what is finished stays in any case.
    """
    with prepared(folder, say):
        failures = []
        for process in processes(profile, structures):
            if process.done(folder) < len(process.cases):
                output = _run_one(folder, process, report)
                if process.done(folder) < len(process.cases):
                    failures.append(f"{process.experiment} on {process.structure}:\n{output}")
            report(process, process.done(folder))
        if failures:
            raise StudyFailedError("\n\n".join(failures))
        finish(folder)


@contextmanager
def prepared(folder: Path, say: Callable[[str], None]) -> Iterator[None]:
    """Have a folder for oneself, with room in it and nothing damaged."""
    with held(folder):
        require_room(folder)
        begun = bool(result_files(folder))
        for path in set_aside_damaged(folder):
            say(f"{path.name} was damaged and is set aside; its cases are measured again")
        meta = read_json(folder / "run.json")
        if begun:
            _require_same_code(folder, meta)
            meta = {**meta, "resumed": [*meta.get("resumed", []), resumed()]}
            write_sealed(folder / "run.json", meta)
        yield


def _require_same_code(folder: Path, meta: dict[str, Any]) -> None:
    """Raise ResultsError if a run would be gone on with by other code than it was begun with."""
    was, now = meta.get("commit"), source()["commit"]
    if was and was != now:
        raise ResultsError(
            f"{folder} was begun at commit {was[:12]}, and this is {now[:12]}: what they measure "
            "does not belong together; check that commit out, or begin a new run"
        )


def finish(folder: Path, machine: dict[str, Any] | None = None) -> None:
    """Mark a run as finished, with what it consists of and how steady the machine was.

    ``machine``: what measured it, if it was not this one.
    """
    files = [str(path.relative_to(folder)) for path in result_files(folder)]
    cores = {name: read_json(folder / name).get("core") for name in files}
    more = {"finished": now(), "files": files, "cores": cores, "noise": _steadiness(folder)}
    meta = {**read_json(folder / "run.json"), **more}
    write_sealed(folder / "run.json", {**meta, "machine": machine or meta["machine"]})


def _steadiness(folder: Path) -> dict[str, Any]:
    found = steadiness.noise(load(folder))
    return {**asdict(found), "share": found.share, "too_busy": found.too_busy}


def set_aside_damaged(folder: Path) -> list[Path]:
    """Rename the damaged files of a run, so that their cases are measured again -> where they are.

    Raises CannotWriteError.
    """
    kept = []
    for path in result_files(folder):
        experiment, structure, _ = path.name.split(".")
        try:
            ResultFile(path.parent, experiment, structure)
        except DamagedError:
            kept.append(set_aside(path))
    return kept


def require_room(folder: Path) -> None:
    """Raise CannotWriteError unless something can be written into a folder."""
    trial = folder / ".room"
    try:
        trial.write_bytes(bytes(ROOM_BYTES))
    except OSError as error:
        raise cannot_write(folder, error) from error
    finally:
        with suppress(OSError):
            trial.unlink()


def _run_one(folder: Path, process: Process, report: Report) -> str:
    """Run one process to its end -> the end of what it printed."""
    code, output = worker.measure(
        folder,
        process.experiment,
        process.structure,
        how(folder),
        lambda: report(process, process.done(folder)),
    )
    if code == CANNOT_WRITE:
        require_room(folder)
        raise CannotWriteError(f"{folder}: {output}")
    return output
