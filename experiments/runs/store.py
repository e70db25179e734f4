"""What a run leaves on disk: lines that are appended, each with its checksum, and one lock.

``run.json`` says what ran where. Each experiment on each structure has a file of JSON lines,
``<experiment>.<structure>.jsonl``: a head, then a synced line per finished measurement. A torn last
line is a case to measure again; anything else that is not as it was written raises DamagedError.
"""

import errno
import hashlib
import json
import os
import shlex
import socket
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

from filelock import FileLock, Timeout

from experiments.harness import REPEATS, Measurement, badness, disturbed
from hem.whole_files import append_whole, write_whole

SCHEMA = 3
META = "run.json"

HINTS = {
    (errno.ENOSPC, errno.EDQUOT): "make room there",
    (errno.EROFS, errno.EACCES, errno.EPERM): "choose another folder, or make this one writable",
    (errno.ENOTDIR, errno.EEXIST): "choose another folder: a file is in its place",
    (errno.EFBIG,): "allow for larger files there",
}
"""What to do about an error of the system."""
ROOM_BYTES = 1 << 16  # what must be free in a folder for it to be worth measuring into

DEFAULTS = vars(Measurement("", ""))


class ResultsError(ValueError):
    """A run folder is missing, incomplete, damaged, in use or of another schema."""


class DamagedError(ResultsError):
    """A file of a run is not what was written."""


class InUseError(ResultsError):
    """Another process measures into the folder."""


class CannotWriteError(OSError):
    """A file of a run cannot be written; the message says which, why, and what to do."""


class CaseFile:
    """Measurements of one experiment on one structure; raises DamagedError or ResultsError."""

    def __init__(self, folder: Path, experiment: str, structure: str) -> None:
        self.path = folder / f"{experiment}.{structure}.jsonl"
        self.experiment, self.structure = experiment, structure
        self.measurements: list[Measurement] = []
        self._head = {"schema": SCHEMA, "experiment": experiment, "structure": structure}
        self._bytes = 0
        if self.path.exists():
            self._read()

    @classmethod
    def at(cls, path: Path) -> Self:
        """The file of that path."""
        return cls(path.parent, *path.stem.split("."))

    @property
    def cases(self) -> dict[str, Measurement]:
        """By id the calmest measurement of every case; its noise says how often it was measured."""
        often, cases = Counter(it.id for it in self.measurements), dict[str, Measurement]()
        fastest = min((it.noise["fastest"] for it in self.measurements if it.noise), default=0.0)
        for it in self.measurements:  # the fastest of all processes
            noise = it.noise and {**it.noise, "fastest": fastest, "measured": often[it.id]}
            if it.id not in cases or badness(noise) < badness(cases[it.id].noise):
                cases[it.id] = replace(it, noise=noise)
        return cases

    @property
    def disturbed(self) -> set[str]:
        """The ids of timed cases that were disturbed each time, and may be measured once more."""
        timed = {key: it.noise for key, it in self.cases.items() if it.kind == "time"}
        return {it for it, seen in timed.items() if disturbed(seen) and seen["measured"] <= REPEATS}

    def add(self, *measurements: Measurement) -> None:
        """Append measurements. Raises CannotWriteError, and leaves the file as it was."""
        changed = (
            {name: value for name, value in vars(it).items() if value != DEFAULTS[name]}
            for it in measurements
        )
        lines = [*([] if self._bytes else [self._head]), *changed]
        data = "".join(f"{_compact(_sealed(line))}\n" for line in lines).encode()
        with writing(self.path):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with self.path.open("ab", buffering=0) as file:
                file.truncate(self._bytes)
                append_whole(file, data, self._bytes)
        self._bytes += len(data)
        self.measurements += measurements

    def _read(self) -> None:
        *lines, _torn = self.path.read_bytes().split(b"\n")
        again = f"measure its cases again with: {resume_command(self.path.parent)}"
        for number, line in enumerate(lines):
            where = f"{self.path}, line {number + 1},"
            content = _unsealed(line, where, again)
            if number:
                try:
                    self.measurements.append(Measurement(**content))
                except TypeError as error:  # as of a head that stands there twice
                    told = f"{where} is no measurement ({error}): {again}"
                    raise DamagedError(told) from error
            elif content != self._head:
                other = f"{where} is the head of another file, {content}"
                raise ResultsError(f"{other}: move the file away")
            self._bytes += len(line) + 1


def write_meta(folder: Path, meta: dict[str, Any]) -> None:
    """Write a run's ``run.json`` whole, with its checksum. Raises CannotWriteError."""
    with writing(folder / META):
        write_whole(folder / META, json.dumps(_sealed(meta), indent=1) + "\n")


def read_meta(folder: Path) -> dict[str, Any]:
    """What ``run.json`` says. Raises ResultsError if there is none, is damaged, or of old times."""
    path = folder / META
    if not path.exists():
        raise ResultsError(f"{folder} holds no run: there is no {META} in it")
    meta = _unsealed(path.read_bytes(), str(path), f"move {folder} away, or put back a copy")
    if meta.get("schema") != SCHEMA:
        differ = f"{path} has schema {meta.get('schema')}, this version reads {SCHEMA}"
        raise ResultsError(f"{differ}: measure it again with: hem study")
    return meta


def case_files(folder: Path) -> list[Path]:
    """The files with the cases of a run, those of every machine; copies beside them are not."""
    every = [*sorted(folder.glob("*.jsonl")), *sorted(folder.glob("machine-*/*.jsonl"))]
    return [path for path in every if path.name.count(".") == 2]


def set_aside_damaged(folder: Path) -> Iterator[Path]:
    """Rename the damaged files of a run, to be measured again -> which. Raises CannotWriteError."""
    for path in case_files(folder):
        try:
            CaseFile.at(path)
        except DamagedError:
            names = (path.with_name(f"{path.name}.damaged{k or ''}") for k in range(1_000))
            with writing(path):
                path.rename(next(name for name in names if not name.exists()))
            yield path


@contextmanager
def lock_run(folder: Path) -> Iterator[None]:
    """Keep a run folder for as long as this process lives. InUseError names who has it."""
    lock, holder = FileLock(folder / ".lock", timeout=0), folder / ".holder"
    with writing(folder):
        try:
            lock.acquire()
        except Timeout:
            name = holder.read_text() if holder.exists() else "another process"
            raise InUseError(
                f"{folder} is being measured into by {name}: wait until that has ended, "
                "or end it; or begin a run of its own with: hem study"
            ) from None
        holder.write_text(f"process {os.getpid()} on {socket.gethostname()}")
    with lock:
        yield


def require_room(folder: Path) -> None:
    """Raise CannotWriteError unless something can be written into a folder."""
    trial = folder / ".room"
    try:
        with writing(folder):
            trial.write_bytes(bytes(ROOM_BYTES))
    finally:
        with suppress(OSError):
            trial.unlink()


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Raise CannotWriteError, with what to do, where ``path`` cannot be written."""
    try:
        yield
    except OSError as error:
        hints = (hint for numbers, hint in HINTS.items() if error.errno in numbers)
        told = f"{path} cannot be written ({error.strerror or error})"
        raise CannotWriteError(f"{told}: {next(hints, 'see to the disk')}") from error


def resume_command(folder: Path) -> str:
    """The command that goes on with a run, or with that which a machine measured a part of."""
    run = folder.parent if folder.name.startswith("machine-") else folder
    return f"hem study --resume --run {shlex.quote(str(run))}"


def _compact(content: dict[str, Any]) -> str:
    return json.dumps(content, separators=(",", ":"))


def _sealed(content: dict[str, Any]) -> dict[str, Any]:
    """With its checksum: 32 hexadecimal digits, of everything else."""
    digest = hashlib.sha256(_compact(content).encode()).hexdigest()
    return {**content, "checksum": digest[:32]}


def _unsealed(text: bytes, where: str, hint: str) -> dict[str, Any]:
    """The content of a sealed object. Raises DamagedError unless it is as it was written."""
    try:
        sealed = json.loads(text)
        content = {name: value for name, value in sealed.items() if name != "checksum"}
        if sealed != _sealed(content):
            raise ValueError("its checksum does not fit")
    except (ValueError, AttributeError, RecursionError) as error:
        raise DamagedError(f"{where} is damaged ({error}): {hint}") from error
    return content
