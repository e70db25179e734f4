"""The history: a file with a line per run, appended to and never rewritten.

Lines are JSON. A line of an older schema is migrated as it is read, and stays as it is in the file.

schema 2, this one
    ``run, commit, committed, dirty, started, profile, structures, machine, versions, claims``, as
    `experiments.regression.snapshots` makes them: claims are named ``table/structure/what``.
schema 1
    ``date`` for ``committed``; a machine without ``id``; no ``run`` and no ``structures``; claims
    named ``structure.what``, with ``outcome``, ``work`` at ``faces``, ``bytes``, and the ``slope``
    in n_t by work, without time.
"""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from experiments.claims.growth import OPERATIONS
from experiments.regression.snapshots import SCHEMA, identified

HISTORY = Path("results/history.jsonl")

Line = dict[str, Any]

HEAD = {
    "commit": str,
    "started": str,
    "profile": str,
    "machine": dict,
    "claims": dict,
}
"""What every line has, and of what type."""


class LineError(ValueError):
    """A line is no run, or of a schema that this version does not know."""


@dataclass(frozen=True)
class History:
    """Runs in the order of their commits, and what is wrong with the file, a sentence each."""

    path: Path
    runs: list[Line]
    faults: list[str]


def read(path: Path = HISTORY) -> History:
    """Read a history; without the file it is empty. Damaged lines are told of and left out.

    Raises OSError if there is something that cannot be read.
    """
    try:
        with _locked(path, os.O_RDONLY, fcntl.LOCK_SH) as file:
            content = _whole(file)
    except FileNotFoundError:
        return History(path, [], [])
    runs, faults = _parsed(content, path)
    return History(path, sorted(runs, key=when), faults)


def append(line: Line, path: Path = HISTORY) -> bool:
    """Add a run -> False if it is there already.

    Who adds at the same time waits. The line goes in whole and reaches the disk, or, where there is
    no room, not at all; what is there stays, a line that another crash cut short included.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with _locked(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, fcntl.LOCK_EX) as file:
        content = _whole(file)
        runs, _ = _parsed(content, path)
        if identity(line) in map(identity, runs):
            return False
        cut_short = content and not content.endswith(b"\n")
        text = json.dumps(line, separators=(",", ":"), allow_nan=False)
        _write(file, (b"\n" if cut_short else b"") + text.encode() + b"\n", len(content))
    return True


def identity(line: Line) -> tuple[str, ...]:
    """What two lines of the same run have in common."""
    return line["started"], line["commit"], line["profile"], line["machine"]["id"]


def when(line: Line) -> tuple[datetime, datetime]:
    """The time of the commit, as far as it is known, and that of the run."""
    started = _time(line["started"])
    return _time(line["committed"]) if line.get("committed") else started, started


def _time(text: str) -> datetime:
    time = datetime.fromisoformat(text)
    return time if time.tzinfo else time.replace(tzinfo=UTC)


@contextmanager
def _locked(path: Path, flags: int, lock: int) -> Iterator[int]:
    file = os.open(path, flags, 0o644)
    try:
        fcntl.flock(file, lock)
        yield file
    finally:
        os.close(file)


def _whole(file: int) -> bytes:
    content = bytearray()
    while part := os.pread(file, 1 << 20, len(content)):
        content += part
    return bytes(content)


def _write(file: int, content: bytes, before: int) -> None:
    try:
        while content:
            content = content[os.write(file, content) :]
        os.fsync(file)
    except OSError:
        os.ftruncate(file, before)
        raise


def _parsed(content: bytes, path: Path) -> tuple[list[Line], list[str]]:
    runs, faults = [], []
    for number, raw in enumerate(content.split(b"\n"), 1):
        if not raw.strip():
            continue
        try:
            runs.append(_line(raw))
        except LineError as error:
            faults.append(f"{path}, line {number} {error}; it is left out")
    return runs, faults


def _line(raw: bytes) -> Line:
    """A line as this version has it. Raises LineError with what it is instead."""
    try:
        line = json.loads(raw, parse_constant=_no_number)
    except (ValueError, RecursionError):
        raise LineError("is cut short or damaged") from None
    if not isinstance(line, dict) or "schema" not in line:
        raise LineError("is no run: it has no schema")
    try:
        line = migrated(line)
        _require_run(line)
    except LineError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise LineError(f"is no run: {type(error).__name__} {error}") from None
    return line


def _require_run(line: Line) -> None:
    for key, kind in HEAD.items():
        if not isinstance(line.get(key), kind):
            raise LineError(f"is no run: its {key} is {line.get(key)!r:.40}")
    identity(line), when(line)
    if not all(isinstance(claim, dict) for claim in line["claims"].values()):
        raise LineError("is no run: not all of its claims have figures")


def _no_number(text: str) -> None:
    raise ValueError(text)


def migrated(line: Line) -> Line:
    """A line of any known schema in the present one. Raises LineError for an unknown schema."""
    while line["schema"] != SCHEMA:
        if line["schema"] not in MIGRATIONS:
            raise LineError(f"has schema {line['schema']!r:.40}, this version knows 1 to {SCHEMA}")
        line = MIGRATIONS[line["schema"]](line)
    return line


def _from_1(old: Line) -> Line:
    claims = {
        f"{'operations' if what in OPERATIONS else 'queries'}/{structure}/{what}": _claim_of_1(it)
        for name, it in old["claims"].items()
        for structure, _, what in [name.partition(".")]
    }
    return {
        **{key: value for key, value in old.items() if key != "date"},
        "schema": 2,
        "run": "",
        "structures": [],
        "committed": old["date"],
        "machine": identified(old["machine"]),
        "claims": claims,
    }


def _claim_of_1(old: Line) -> Line:
    renamed = {"outcome": "outcome", "work": "work", "faces": "work_faces", "bytes": "bytes"}
    claim: Line = {new: old[key] for key, new in renamed.items() if key in old}
    return claim | ({"slopes": {"work_faces": old["slope"]}} if "slope" in old else {})


MIGRATIONS: dict[int, Callable[[Line], Line]] = {1: _from_1}
"""From each older schema to the next."""
