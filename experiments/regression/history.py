"""The history: a file with a line per run, appended to and never rewritten.

Lines are JSON. A line of an older schema is migrated as it is read, and stays as it is in the file.

schema 2, this one
    What `record_run` gives: claims are named ``table/structure/subject``.
schema 1
    ``date`` for ``committed``; a machine without ``id``; no ``run`` and no ``structures``; claims
    named ``structure.subject``, with ``outcome``, ``work`` at ``faces``, ``bytes``, and the
    ``slope`` in n_t by work, without time.
"""

import json
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from filelock import FileLock

from experiments.harness import OPERATIONS
from experiments.regression.snapshots import claim_figures
from experiments.runs import ResultsError, Run, git, machine_id
from hem.whole_files import append_whole

SCHEMA = 2

REQUIRED = {"commit": str, "started": str, "profile": str, "machine": dict, "claims": dict}
"""What every line has, and of what type."""

Line = dict[str, Any]


class LineError(Exception):
    """A line is no run, or of a schema that this version does not know."""


@dataclass(frozen=True)
class History:
    """Runs in the order of their commits, and what is wrong with the file, a sentence each."""

    path: Path
    runs: list[Line]
    faults: list[str]


def record_run(run: Run) -> Line:
    """The line that the history keeps of a run. Raises ResultsError if it is not finished."""
    meta = run.meta
    if "finished" not in meta:
        raise ResultsError(f"{run.folder} is not finished; go on with: hem study --resume")
    return {
        "schema": SCHEMA,
        "run": run.folder.resolve().name,
        "commit": meta["commit"],
        "committed": commit_date(meta["commit"]),
        "dirty": meta["dirty"],
        "started": meta["started"],
        "profile": meta["preset"],
        "structures": list(meta.get("structures", ())),
        "machine": {"id": machine_id(meta["machine"]), **meta["machine"]},
        "versions": meta["versions"],
        "claims": claim_figures(run),
    }


def commit_date(commit: str) -> str | None:
    """The date of a commit of this repository, ISO 8601, or None where it is not known."""
    return git("show", "--no-patch", "--format=%cI", f"{commit}^{{commit}}") or None


def read_history(path: Path) -> History:
    """Read a history; without the file it is empty. Damaged lines are named and skipped.

    Raises OSError if there is something that cannot be read.
    """
    runs, faults = _parse(path.read_bytes(), path) if path.exists() else ([], [])
    return History(path, sorted(runs, key=_times), faults)


def append_run(line: Line, path: Path) -> bool:
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
        append_whole(file, (b"\n" if cut_short else b"") + text.encode() + b"\n", len(content))
    return True


def _identity(line: Line) -> tuple[str, ...]:
    """What two lines of the same run have in common."""
    return line["started"], line["commit"], line["profile"], line["machine"]["id"]


def _times(line: Line) -> tuple[datetime, ...]:
    """The time of the commit, as far as it is known, and that of the run."""
    texts = line.get("committed") or line["started"], line["started"]
    times = map(datetime.fromisoformat, texts)
    return tuple(it if it.tzinfo else it.replace(tzinfo=UTC) for it in times)


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
        for key, kind in REQUIRED.items():
            if not isinstance(line.get(key), kind):
                raise LineError(f"is no run: its {key} is {line.get(key)!r:.40}")
        _identity(line), _times(line)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise LineError(f"is no run: {type(error).__name__} {error}") from None
    if not all(isinstance(claim, dict) for claim in line["claims"].values()):
        raise LineError("is no run: not all of its claims have figures")
    return line


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
    line = {key: value for key, value in old.items() if key != "date"}
    line |= {"schema": 2, "run": "", "structures": [], "committed": old["date"], "claims": {}}
    line["machine"] = {"id": machine_id(old["machine"]), **old["machine"]}
    for name, figures in old["claims"].items():
        structure, _, what = name.partition(".")
        table = "operations" if what in OPERATIONS else "queries"
        renamed = {"work_faces" if key == "faces" else key: it for key, it in figures.items()}
        if "slope" in renamed:
            renamed["slopes"] = {"work_faces": renamed.pop("slope")}
        line["claims"][f"{table}/{structure}/{what}"] = renamed
    return line


MIGRATIONS: dict[int, Callable[[Line], Line]] = {1: _from_1}
"""From each older schema to the next."""
