"""The baseline: committed measurements that others are held against, in ``results/reference/``.

Two reduced runs in the run's own format: ``counters``, what `regression.counters` measures, and
``run``, of a whole run what can be compared. Beside the cases of each, ``claims.jsonl`` holds what
they said of every claim when they were measured, a line per claim.
"""

import json
import shlex
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
import pandas as pd

from experiments.harness import NO_STRUCTURE, Measurement
from experiments.regression.snapshots import ClaimName, Figures, claim_figures
from experiments.runs import CaseFile, ResultsError, Run, experiments, load, noise, write_meta
from hem.whole_files import write_whole

FOLDER = Path("results/reference")
COUNTERS, RUN = "counters", "run"
CLAIMS = "claims.jsonl"
UPDATE = {COUNTERS: "hem baseline update", RUN: "hem baseline update RUN"}

HEAD = (
    *("schema", "preset", "structures", "commit", "dirty", "machine", "versions"),
    *("started", "finished", "run", "too_busy"),
)
"""What is kept of the head of a run."""
KEPT = (
    *("id", "kind", "subject", "order", "family", "vertices", "edges", "faces"),
    *("valence_max", "working_set", "latency", "reference"),
)
"""What is kept of a case besides its samples and the calibration loop's readings."""
LEAST_ROUNDS = 9  # rounds on either side with which a comparison of times can decide at all


@dataclass(frozen=True)
class Measured:
    """A run, and what it said of every claim."""

    run: Run
    claims: dict[str, Figures]

    def only(self, structures: list[str]) -> Self:
        """What is of these structures."""
        run, every = self.run, self.claims.items()
        parts = (rows[rows["structure"].isin(structures)] for rows in (run.cases, run.skipped))
        claims = {name: it for name, it in every if ClaimName.read(name).structure in structures}
        return type(self)(Run(run.folder, run.meta, *parts), claims)


def reduce_run(run: Run) -> Measured:
    """What of a run can be compared: counts, named times, the latency. Judges it, for seconds."""
    meta = {**run.meta, "run": run.folder.resolve().name, "too_busy": noise(run).too_busy}
    cases = run.cases[[_is_kept(case) for case in run.cases.to_dict("records")]].copy()
    timed = cases["kind"] == "time"
    for column in ("samples", "calibration"):  # four digits are more than a clock tells
        short = cases.loc[timed, column].map(lambda rounds: [float(f"{it:.4g}") for it in rounds])
        cases.loc[timed, column] = short
    cases["samples"] = cases["samples"].map(np.asarray)
    kept = Run(run.folder, {key: meta.get(key) for key in HEAD}, cases, run.skipped[:0])
    return Measured(kept, claim_figures(run))


def _is_kept(case: Mapping[Any, Any]) -> bool:
    if case["kind"] != "time" or case["structure"] == NO_STRUCTURE:
        return True
    declared = experiments().get(case["experiment"])
    wanted = declared is not None and case["order"] in declared.baseline_orders
    return wanted and len(case["calibration"]) > 0 and len(case["samples"]) >= LEAST_ROUNDS


def load_baseline(part: str, folder: Path = FOLDER) -> Measured:
    """The counters or the run of the baseline. Raises ResultsError that names the way out."""
    kept, old = folder / part, folder / f"{part}.old"
    if old.exists() and not kept.exists():  # a save was killed between its two renames
        kept = old
    try:
        run, lines = load(kept), (kept / CLAIMS).read_text("utf-8").splitlines()
        return Measured(run, {claim.pop("claim"): claim for claim in map(json.loads, lines)})
    except (ValueError, OSError, KeyError) as error:
        where = "" if folder == FOLDER else f" --baseline {shlex.quote(str(folder))}"
        told = f"the baseline cannot be read: {error}. Make it anew: {UPDATE[part]}{where}"
        raise ResultsError(told) from error


def save_baseline(part: str, measured: Measured, folder: Path = FOLDER) -> None:
    """Put it in the place of what there is. Raises OSError, and leaves that as it was."""
    beside = folder / f"{part}.part"
    shutil.rmtree(beside, ignore_errors=True)
    for (experiment, structure), rows in measured.run.cases.groupby(["experiment", "structure"]):
        file = CaseFile(beside, str(experiment), str(structure))
        file.add(*map(_reduced, rows.sort_values("id").to_dict("records")))
    write_meta(beside, measured.run.meta)
    lines = (json.dumps({"claim": name, **it}) + "\n" for name, it in measured.claims.items())
    write_whole(beside / CLAIMS, "".join(lines))
    target, old = folder / part, folder / f"{part}.old"
    if target.exists():
        shutil.rmtree(old, ignore_errors=True)
        target.rename(old)
    try:
        beside.rename(target)
    except BaseException:
        if old.exists():
            old.rename(target)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _reduced(case: Mapping[Any, Any]) -> Measurement:
    """A row of a run as a line of the baseline."""
    values: dict[str, Any] = {key: None if pd.isna(case[key]) else case[key] for key in KEPT}
    return Measurement(
        **values,
        valence=None if pd.isna(case["valence"]) else int(case["valence"]),
        reference_bytes=int(case["reference_bytes"]),
        samples=[it if case["kind"] == "time" else int(it) for it in case["samples"]],
        calibration=list(case["calibration"]),
    )
