"""The history: a file with a line per run, appended to and never rewritten.

Lines are JSON. A line of an older schema is migrated as it is read, and stays as it is in the file.

schema 2, this one
    ``run, commit, committed, dirty, started, profile, structures, machine, versions, claims``, as
    `experiments.regression.snapshots` makes them: claims are named ``table/structure/subject``.
schema 1
    ``date`` for ``committed``; a machine without ``id``; no ``run`` and no ``structures``; claims
    named ``structure.subject``, with ``outcome``, ``work`` at ``faces``, ``bytes``, and the
    ``slope`` in n_t by work, without time.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, BinaryIO

from filelock import FileLock

from experiments.harness import OPERATIONS
from experiments.regression.snapshots import SCHEMA
from experiments.runs import machine_id

HISTORY = Path("results/history.jsonl")

Line = dict[str, Any]

REQUIRED = {"commit": str, "started": str, "profile": str, "machine": dict, "claims": dict}
"""What every line has, and of what type."""


class LineError(ValueError):
    """A line is no run, or of a schema that this version does not know."""


@dataclass(frozen=True)
class History:
    """Runs in the order of their commits, and what is wrong with the file, a sentence each."""

    path: Path
    runs: list[Line]
    faults: list[str]


def read_history(path: Path = HISTORY) -> History:
    """Read a history; without the file it is empty. Damaged lines are named and skipped.

    Raises OSError if there is something that cannot be read.
    """
    try:
        runs, faults = _parse(path.read_bytes(), path)
    except FileNotFoundError:
        return History(path, [], [])
    return History(path, sorted(runs, key=_times), faults)


def append_run(line: Line, path: Path = HISTORY) -> bool:
    """Add a run -> False if it is there already.

    Who adds at the same time waits. The line goes in whole and reaches the disk, or, where there is
    no room, not at all; what is there stays, a line that another crash cut short included.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with FileLock(f"{path}.lock"), path.open("a+b", buffering=0) as file:
        file.seek(0)
        content = file.readall()
        runs, _ = _parse(content, path)
        if _identity(line) in map(_identity, runs):
            return False
        cut_short = content and not content.endswith(b"\n")
        text = json.dumps(line, separators=(",", ":"), allow_nan=False)
        _write(file, (b"\n" if cut_short else b"") + text.encode() + b"\n", len(content))
    return True


def _write(file: BinaryIO, content: bytes, before: int) -> None:
    try:
        while content:
            content = content[file.write(content) :]
        os.fsync(file.fileno())
    except OSError:
        file.truncate(before)
        raise


def _identity(line: Line) -> tuple[str, ...]:
    """What two lines of the same run have in common."""
    return line["started"], line["commit"], line["profile"], line["machine"]["id"]


def _times(line: Line) -> tuple[datetime, datetime]:
    """The time of the commit, as far as it is known, and that of the run."""
    started = _time(line["started"])
    return _time(line["committed"]) if line.get("committed") else started, started


def _time(text: str) -> datetime:
    time = datetime.fromisoformat(text)
    return time if time.tzinfo else time.replace(tzinfo=UTC)


def _parse(content: bytes, path: Path) -> tuple[list[Line], list[str]]:
    runs, faults = [], []
    for number, raw in enumerate(content.split(b"\n"), 1):
        if raw.strip():
            try:
                runs.append(_line(raw))
            except LineError as error:
                faults.append(f"{path}, line {number} {error}; it is skipped")
    return runs, faults


def _line(raw: bytes) -> Line:
    """A line as this version has it. Raises LineError with what it is instead."""
    try:
        line = json.loads(raw, parse_constant=_refuse)
    except (ValueError, RecursionError):
        raise LineError("is cut short or damaged") from None
    if not isinstance(line, dict) or "schema" not in line:
        raise LineError("is no run: it has no schema")
    try:
        line = migrate(line)
        _require_run(line)
    except LineError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise LineError(f"is no run: {type(error).__name__} {error}") from None
    return line


def _require_run(line: Line) -> None:
    for key, kind in REQUIRED.items():
        if not isinstance(line.get(key), kind):
            raise LineError(f"is no run: its {key} is {line.get(key)!r:.40}")
    _identity(line), _times(line)
    if not all(isinstance(claim, dict) for claim in line["claims"].values()):
        raise LineError("is no run: not all of its claims have figures")


def _refuse(text: str) -> None:
    raise ValueError(text)  # NaN and Infinity are no JSON


def migrate(line: Line) -> Line:
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
        "machine": {"id": machine_id(old["machine"]), **old["machine"]},
        "claims": claims,
    }


def _claim_of_1(old: Line) -> Line:
    renamed = {"outcome": "outcome", "work": "work", "faces": "work_faces", "bytes": "bytes"}
    claim: Line = {new: old[key] for key, new in renamed.items() if key in old}
    return claim | ({"slopes": {"work_faces": old["slope"]}} if "slope" in old else {})


MIGRATIONS: dict[int, Callable[[Line], Line]] = {1: _from_1}
"""From each older schema to the next."""
