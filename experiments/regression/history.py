"""The history: a file with a line of JSON per run, appended to and never rewritten."""

import json
from dataclasses import dataclass
from datetime import datetime
from math import inf
from pathlib import Path
from typing import Any

from filelock import FileLock

from experiments.regression.snapshots import claim_figures
from experiments.runs import ResultsError, Run, git, machine_id, noise, resume_command
from hem.whole_files import append_whole

SCHEMA = 2
REQUIRED = {"commit": str, "started": str, "profile": str, "machine": dict, "claims": dict}
TEXTS = ("kind", "outcome", "outcome_time")  # of the figures of a claim; all else is numbers
Line = dict[str, Any]


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
        raise ResultsError(
            f"{run.folder} is not finished; go on with: {resume_command(run.folder)}"
        )
    figures = claim_figures(run)
    if not figures:
        raise ResultsError(f"{run.folder} measured nothing of which anything is claimed")
    return {
        "schema": SCHEMA, "run": run.folder.resolve().name,
        "commit": meta["commit"], "committed": commit_date(meta["commit"]), "dirty": meta["dirty"],
        "started": meta["started"], "profile": meta["preset"], "too_busy": noise(run).too_busy,
        "structures": list(meta.get("structures", ())),
        "machine": {"id": machine_id(meta["machine"]), **meta["machine"]},
        "versions": meta["versions"], "claims": figures,
    }  # fmt: skip


def commit_date(commit: str) -> str | None:
    """The date of a commit of this repository, ISO 8601, or None where it is not known."""
    return git("show", "--no-patch", "--format=%cI", f"{commit}^{{commit}}") or None


def read_history(path: Path) -> History:
    """Read a history, if there is one; damaged lines are named and skipped. Raises OSError."""
    return _parse(path.read_bytes() if path.exists() else b"", path)


def append_run(line: Line, path: Path) -> bool:
    """Add a run -> False if it is there already.

    Who adds at the same time waits. The line goes in whole and reaches the disk, or, where there is
    no room, not at all; what is there stays, a line that another crash cut short included.
    """
    # The lock makes the folder, too.
    with FileLock(f"{path}.lock"), path.open("a+b", buffering=0) as file:
        file.seek(0)
        content = file.readall()
        if _identity(line) in map(_identity, _parse(content, path).runs):
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
    return tuple(datetime.fromisoformat(it).astimezone() for it in texts)


def _parse(content: bytes, path: Path) -> History:
    runs, faults = [], []
    for number, raw in enumerate(content.split(b"\n"), 1):
        if raw.strip():
            try:
                runs.append(_line(raw))
            except ValueError as error:
                faults.append(f"{path}, line {number} {error}; it is skipped")
    return History(path, sorted(runs, key=_times), faults)


def _line(raw: bytes) -> Line:
    """A run as a line has it. Raises ValueError with what the line is instead."""
    try:
        line = json.loads(raw, parse_constant=int)  # which refuses NaN and Infinity: they are none
    except (ValueError, RecursionError):
        raise ValueError("is cut short or damaged") from None
    if not isinstance(line, dict) or "schema" not in line:
        raise ValueError("is no run: it has no schema")
    if line["schema"] != SCHEMA:
        raise ValueError(f"has schema {line['schema']!r:.40}, this version knows {SCHEMA}")
    for key, kind in REQUIRED.items():
        if not isinstance(line.get(key), kind):
            raise ValueError(f"is no run: its {key} is {line.get(key)!r:.40}")
    try:
        "".join(_identity(line)), _times(line)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ValueError(f"is no run: {type(error).__name__} {error}") from None
    for name, claim in line["claims"].items():
        if not isinstance(claim, dict) or name.count("/") != 2:
            raise ValueError("is no run: not all of its claims have a whole name and figures")
        for key, value in claim.items():
            if not _is_figure(key, value):
                raise ValueError(f"is no run: {key} of {name} is {value!r:.40}")
    return line


def _is_figure(name: str, value: Any) -> bool:
    """Whether a figure of a claim is of the type that it is written with."""
    if name == "slopes":
        rows = list(value.values()) if isinstance(value, dict) else [()]
        return all(
            isinstance(it, list) and len(it) == 3 and all(map(_is_number, it)) for it in rows
        )
    return isinstance(value, str) if name in TEXTS else _is_number(value)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and abs(value) < inf
