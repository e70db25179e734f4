"""What `hem check` compares with: the small text files in ``results/reference/``.

``exact.json`` holds what `regression.counters` measures, ``run.json`` a run and its exact cases,
``times.json`` its rounds, and ``verdicts.json`` what they say about each claim. One line is one
case, so that a change reads as one.
"""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from experiments.regression.counters import Exact, Value
from experiments.runs.results import ResultsError, Run
from experiments.runs.steadiness import noise

FOLDER = Path("results/reference")
SCHEMA = 2

TIMED = {
    "bench_queries": ("consecutive", "random"),
    "bench_valence": ("random",),
    "bench_operations": ("batched",),
    "bench_printed": ("timed",),
}
"""Whose times are compared: those that claims are judged by, in these orders."""

HEAD = ("preset", "structures", "commit", "dirty", "machine", "versions", "started")
"""What is kept of the head of a run, besides its name, and whether it can be judged by time."""

LEAST_ROUNDS = 9
"""Rounds on either side with which a comparison of times can decide at all."""

UPDATE = "hem reference update"

Verdicts = dict[tuple[str, str, str], dict[str, Any]]
"""The rows of ``verdicts.json`` by table, structure and query."""


@dataclass
class Measured:
    """The exact cases and the rounds of a run, by key.

    ``times`` holds per case its ``samples`` in seconds, and ``probe``: the seconds of a fixed loop
    before and after it.
    """

    head: dict[str, Any]
    exact: dict[str, Value] = field(default_factory=dict)
    times: dict[str, dict[str, Any]] = field(default_factory=dict)
    verdicts: Verdicts = field(default_factory=dict)


def measured(run: Run) -> Measured:
    """What a run holds that can be compared; judges it, which takes some seconds."""
    found = Measured({key: run.meta.get(key) for key in HEAD})
    found.head |= {"run": run.folder.resolve().name, "too_busy": noise(run).too_busy}
    for case in run.cases.to_dict("records"):
        name = f"{case['experiment']}/{case['structure']}/{case['id']}"
        if case["kind"] in ("work", "bytes"):
            found.exact[name] = [int(it) for it in case["samples"]]
        elif _comparable(case):
            samples = [_short(it) for it in case["samples"]]
            probe = [_short(case["noise"][when]) for when in ("before", "after")]
            found.times[name] = {"samples": samples, "probe": probe}
    found.verdicts = _verdicts_of(run)
    return found


def _comparable(case: dict[Any, Any]) -> bool:
    """Whether the times of a case can be compared, and are to be."""
    wanted = case["order"] in TIMED.get(case["experiment"], ())
    return wanted and bool(case["noise"]) and len(case["samples"]) >= LEAST_ROUNDS


def _verdicts_of(run: Run) -> Verdicts:
    from experiments.claims.judged import judged, save

    with tempfile.TemporaryDirectory() as beside:
        return _by_claim(json.loads(save(run, judged(run), Path(beside)).read_text()))


def _by_claim(content: dict[str, Any]) -> Verdicts:
    return {(it["table"], it["structure"], it["subject"]): it for it in content["claims"]}


def _short(seconds: float) -> float:
    return float(f"{seconds:.4g}")


def load_exact(folder: Path = FOLDER) -> Exact:
    """The exact part of the reference. Raises ResultsError that names the file and the way out."""
    content = _read(folder / "exact.json", UPDATE)
    return Exact(content["cases"], python=str(content.get("python", "")))


def load_measured(folder: Path = FOLDER) -> Measured:
    """The run of the reference. Raises ResultsError that names the file and the way out."""
    update = f"{UPDATE} RUN"
    run = _read(folder / "run.json", update)
    times = _read(folder / "times.json", update)
    verdicts = _read(folder / "verdicts.json", update, schema=None, within="claims")
    if verdicts.get("run") != run.get("run"):
        raise ResultsError(f"{folder} holds parts of two runs; make it anew: {update}")
    head = {key: run.get(key) for key in (*HEAD, "run", "too_busy")}
    return Measured(head, run["cases"], times["cases"], _by_claim(verdicts))


def save_exact(exact: Exact, folder: Path = FOLDER) -> None:
    """Write ``exact.json``."""
    head = {
        "schema": SCHEMA,
        "holds": "what experiments/exact.py measures; reads per handle, bytes, classes by work",
        "python": exact.python,
    }
    _write(folder / "exact.json", head, exact.cases)


def save_measured(run: Measured, folder: Path = FOLDER) -> None:
    """Write ``run.json`` and ``times.json``; the verdicts are `judged.save`'s."""
    _write(folder / "run.json", {"schema": SCHEMA, **run.head}, run.exact)
    holds = "seconds per query and round, and of a fixed loop before and after"
    _write(folder / "times.json", {"schema": SCHEMA, "holds": holds}, run.times)


def _write(path: Path, head: dict[str, Any], cases: dict[str, Any]) -> None:
    """One line per entry of the head and per case, all at once."""
    lines = [f"{json.dumps(key)}: {json.dumps(cases[key])}" for key in sorted(cases)]
    top = [f"{json.dumps(key)}: {json.dumps(value)},\n" for key, value in head.items()]
    text = "{\n" + "".join(top) + '"cases": {\n' + ",\n".join(lines) + "\n}\n}\n"
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_suffix(".part")
    beside.write_text(text, "utf-8")
    beside.replace(path)


def _read(
    path: Path, update: str, schema: int | None = SCHEMA, within: str = "cases"
) -> dict[str, Any]:
    if not path.exists():
        raise ResultsError(f"{path} is not there, so there is nothing to compare with; {update}")
    try:
        content: Any = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise ResultsError(f"{path} cannot be read: {error}; make it anew: {update}") from error
    if not isinstance(content, dict) or within not in content:
        raise ResultsError(f"{path} holds no {within}; make it anew: {update}")
    if schema is not None and content.get("schema") != schema:
        found = content.get("schema")
        raise ResultsError(
            f"{path} has schema {found}, this version reads {schema}; make it anew: {update}"
        )
    return content
