"""A run as it is read: one table of all its cases, and how steady the machine was meanwhile."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from experiments.harness import BUSY, Measurement, disturbed
from experiments.runs import store
from experiments.runs.catalog import PART_OF

if TYPE_CHECKING:  # it takes half a second, and a study has no need of it
    import pandas as pd

RUNS = Path("results/runs")
PEER_RUNS = RUNS / "peers"  # of other libraries: the newest run of nothing else
Found = tuple[str, str, str, Measurement]  # experiment, structure, machine, and what was measured


@dataclass(frozen=True, eq=False)  # judged once per run object
class Run:
    """A run as read: ``meta`` is run.json, ``cases`` has one row per measured case.

    Its fields are those of ``Measurement``, ``samples`` as an array, and ``experiment``,
    ``structure`` and ``machine``: the folder of the machine that measured it, empty where there was
    only one. ``skipped``: the cases that were not measured, with the reason.
    """

    folder: Path
    meta: dict[str, Any]
    cases: pd.DataFrame
    skipped: pd.DataFrame

    @classmethod
    def of(cls, folder: Path, meta: dict[str, Any], found: Iterable[Found]) -> Self:
        """A run of what was found of each case."""
        import pandas as pd

        columns = ["experiment", "structure", "machine", *Measurement.__dataclass_fields__]
        rows = [(*who, *vars(measurement).values()) for *who, measurement in found]
        cases = pd.DataFrame(rows, columns=columns)
        cases["samples"] = cases["samples"].map(lambda samples: np.asarray(samples, float))
        measured = cases["skipped"] == ""
        return cls(folder, meta, cases[measured].reset_index(drop=True), cases[~measured])

    @property
    def machines(self) -> list[str]:
        """The machines that measured it, where they were several: their times do not mix."""
        return list(self.meta.get("machine", {}).get("machines", ()))


def load(folder: Path | str) -> Run:
    """Read a run; ResultsError if there is none, it has another schema, or something was lost."""
    folder = Path(folder)
    meta = store.read_meta(folder)
    paths = store.case_files(folder)
    files = {str(path.relative_to(folder)): store.CaseFile.at(path) for path in paths}
    for name, count in meta.get("files", {}).items():
        if name not in files or len(files[name].measurements) < count:
            missing = f"{folder / name} is {'not whole' if name in files else 'missing'}"
            again = f"measure its cases again with: {store.resume_command(folder)}"
            raise store.DamagedError(f"{missing}; {again}")
    # What a machine left unfinished was measured anew on another: there it is whole.
    whole = {it.path.name: it for it in sorted(files.values(), key=lambda it: len(it.cases))}
    found: list[Found] = []
    for _, file in sorted(whole.items()):
        machine = "" if file.path.parent == folder else file.path.parent.name
        who = PART_OF.get(file.experiment, file.experiment), file.structure, machine
        found += [(*who, case) for case in file.cases.values()]
    return Run.of(folder, meta, found)


def latest(root: Path | str = RUNS, *, unfinished: bool = False) -> Path:
    """The newest run, or the newest that was not finished. Raises ResultsError if there is none."""
    found: list[tuple[str, Path]] = []
    for path in Path(root).glob(f"*/{store.META}"):
        try:
            meta = store.read_meta(path.parent)
        except store.ResultsError as error:
            warnings.warn(f"{error}; it is passed over", stacklevel=2)
            continue
        if not (unfinished and "finished" in meta):
            found.append((str(meta.get("started")), path.parent))
    if found:
        return max(found)[1]
    what = "unfinished run" if unfinished else "run"
    raise store.ResultsError(f"there is no {what} in {root}; start one with: hem study")


class Noise(NamedTuple):
    """Whether a machine was too busy to judge a run by time; and all that is known, in words."""

    too_busy: bool
    words: str


def noise(run: Run) -> Noise:
    """How steady the machine was while a run took times, if it watched."""
    timed = run.cases[(run.cases["kind"] == "time") & run.cases["noise"].map(bool)]
    bad = timed[timed["noise"].map(disturbed).astype(bool)]
    seen = list(timed["noise"])
    share, repeated = len(bad) / max(len(seen), 1), sum(it.get("measured", 1) > 1 for it in seen)
    over = [it[when] / it["fastest"] - 1 for it in seen for when in ("before", "after")]
    found = (
        f"{len(bad):,} of {len(seen):,} timed cases ({share:.0%}) were disturbed, {repeated:,} "
        f"were repeated; a fixed loop took up to {np.quantile(over or [0.0], 0.9):.0%} longer "
        "than at its fastest in nine of ten probes."
    )
    words = f"The machine was steady: {found}"
    if not seen:
        words = "No timed case says how steady the machine was."
    elif share > BUSY:
        worst = (bad["experiment"] + " on " + bad["structure"]).value_counts().head(3)
        most = ", ".join(f"{name} ({count})" for name, count in worst.items())
        words = f"The machine was too busy to judge by time: {found} Most: {most}."
    return Noise(share > BUSY, words + _cache_in_words(run))


def _cache_in_words(run: Run) -> str:
    """That the last cache was not the run's own, where the latencies tell it; else nothing.

    What fits into a quarter of a cache waits for it, less than half as long as for the memory.
    """
    caches = run.meta.get("machine", {}).get("caches", {})
    latency = run.cases[run.cases["experiment"] == "bench_latency"].sort_values("working_set")
    if not caches or latency.empty:
        return ""
    level, size = max(caches.items())
    sets = latency["working_set"] / (1024 * int(size.removesuffix("K")))
    within, beyond = latency[sets <= 1 / 4]["samples"], latency[sets >= 2]["samples"]
    if within.empty or beyond.empty:
        return ""
    inside, outside = (1e9 * float(np.median(samples.iloc[-1])) for samples in (within, beyond))
    if inside < outside / 2:
        return ""
    return (
        f" Others used the {level} cache of {size}: a dependent access to a quarter of that took "
        f"{inside:.0f} ns, to memory {outside:.0f} ns; times at random are higher for it."
    )


def in_words(run: Run) -> str:
    """What a run was, where it was measured, and how calm it was there."""
    meta, it = run.meta, run.meta.get("machine", {})
    caches = ", ".join(f"{level} {size}" for level, size in it.get("caches", {}).items())
    measured_by = (
        f"Measured by {len(run.machines)} machines, whose times are not compared"
        if run.machines
        else f"{it.get('cores')} cores of {it.get('cpu')} ({caches}), "
        f"{it.get('memory_bytes', 0) / 2**30:.0f} GiB, {it.get('platform')}"
    )
    versions = ", ".join(f"{name} {number}" for name, number in meta.get("versions", {}).items())
    changes = " with changes that are not committed" if meta.get("dirty") else ""
    finished = f"to {meta['finished']}" if "finished" in meta else "and not finished"
    return (
        f"Preset {meta.get('preset')}, from {meta.get('started')} {finished}, at commit "
        f"{str(meta.get('commit'))[:10]}{changes}. "
        f"{measured_by}. {versions}. {len(run.cases):,} cases; every query was checked "
        f"against the triangle list before it was measured. {noise(run).words}"
    )
