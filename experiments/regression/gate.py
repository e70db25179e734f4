"""All that `hem check` compares, and what `hem reference update` would change."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from experiments.claims.judged import judged, save
from experiments.regression import baseline, compare_runs, interleaved, significance
from experiments.regression import counters as exact
from experiments.regression.baseline import Measured
from experiments.regression.findings import Finding, compare_exact
from experiments.runs.results import Run, load
from structures import NAMED

HERE = Path(__file__).parents[2]
"""The tree that this is."""


def compare_all(
    run: Path | None,
    beside: Path | None,
    structures: list[str],
    factor: float | None,
    folder: Path,
) -> tuple[list[Finding], list[str]]:
    """The findings and what else is to be said. Raises ValueError for what a user can mend."""
    for name in structures:
        if name not in NAMED:
            raise ValueError(f"no structure is called {name!r}; there are {', '.join(NAMED)}")
    before = baseline.load_exact(folder)  # before anything is measured
    given = load(run) if run else None
    if given and given.cases.empty:
        raise ValueError(f"{run} holds no case; go on with: hem study --resume --run {run}")
    held = baseline.load_measured(folder) if given else None
    after, notes = exact.measure(structures), []
    if structures:
        notes.append(f"just {', '.join(structures)} was measured")
        before.cases = {k: v for k, v in before.cases.items() if k.split("/")[1] in structures}
    if before.python != after.python:
        notes.append(
            f"Python {after.python}, the reference has {before.python}: "
            "the bytes of its objects are not compared"
        )
    findings = compare_exact(before, after)
    if given and held:
        compared = compare_runs.compare_runs(
            held, baseline.measured(given), factor or compare_runs.FACTOR
        )
        findings += compared.findings
        notes += compared.notes
    else:
        notes.append("just what is exact was compared; all of a run with: hem check RUN")
    if beside:
        findings += interleaved.compare_trees(
            beside, HERE, structures, factor or significance.FACTOR
        )
    return findings, notes


@dataclass
class Update:
    """A reference to be written: what is exact, and a run if there is one."""

    folder: Path
    exact: exact.Exact
    run: Run | None
    measured: Measured | None

    @classmethod
    def prepare(cls, run: Path | None, folder: Path) -> Self:
        """Measure; raises ValueError where anything that is exact cannot be measured."""
        loaded = load(run) if run else None
        if loaded is not None and "finished" not in loaded.meta:
            raise ValueError(f"{run} is not finished; go on with: hem study --resume")
        fresh = exact.measure()
        if fresh.failed:
            key, why = next(iter(fresh.failed.items()))
            raise ValueError(f"{key} could not be measured, so there is nothing to keep: {why}")
        found = baseline.measured(loaded) if loaded else None
        if found is not None and not found.times:
            raise ValueError(f"{run} has no times to compare with: measure a larger profile")
        return cls(folder, fresh, loaded, found)

    def doubts(self) -> list[str]:
        """What speaks against this run as a reference."""
        head = self.measured.head if self.measured else {}
        words = {
            "dirty": "it ran with changes that are not committed",
            "too_busy": "the machine was too busy to judge by time",
        }
        return [text for key, text in words.items() if head.get(key)]

    def difference(self) -> list[tuple[str, str]]:
        """What would change, as signs and lines: - as it is, + as it would be, ± in numbers."""
        try:
            old: dict[str, Any] = baseline.load_exact(self.folder).cases
        except ValueError:
            old = {}  # what cannot be read is replaced
        lines = _changes(old, self.exact.cases)
        if self.measured is None:
            return lines
        try:
            before = baseline.load_measured(self.folder)
        except ValueError:
            before = Measured({})
        lines += _changes(before.exact, self.measured.exact)
        lines += _verdict_changes(before, self.measured)
        changed = sum(before.times.get(k) != v for k, v in self.measured.times.items())
        gone = len(before.times.keys() - self.measured.times.keys())
        if changed or gone:
            lines.append(("±", f"times.json: {changed:,} cases anew, {gone:,} gone"))
        for key, value in self.measured.head.items():
            if before.head.get(key) != value:
                lines.append(("±", f"run.json, {key}: {before.head.get(key)} → {value}"))
        return lines

    def write(self) -> None:
        """Write the files."""
        baseline.save_exact(self.exact, self.folder)
        if self.run is not None and self.measured is not None:
            baseline.save_measured(self.measured, self.folder)
            save(self.run, judged(self.run), self.folder)


def _changes(before: dict[str, Any], after: dict[str, Any]) -> list[tuple[str, str]]:
    lines = []
    for key in sorted(before.keys() | after.keys()):
        if before.get(key) != after.get(key):
            lines += [
                (sign, f"{key}: {cases[key]}")
                for sign, cases in (("-", before), ("+", after))
                if key in cases
            ]
    return lines


def _verdict_changes(before: Measured, after: Measured) -> list[tuple[str, str]]:
    lines = []
    for key in sorted(before.verdicts.keys() | after.verdicts.keys()):
        for what in ("outcome", "outcome_time"):
            old, new = (it.verdicts.get(key, {}).get(what) for it in (before, after))
            if old != new:
                lines.append(("±", f"verdicts.json, {'/'.join(key)}, {what}: {old} → {new}"))
    return lines
