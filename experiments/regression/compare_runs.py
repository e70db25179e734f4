"""A run compared with the reference run: exact cases, classes, slopes, and times.

Rounds of a case are milliseconds apart, so what they differ by within a case says nothing about
what two runs differ by. A curve, one query of one structure at all sizes, is therefore judged as a
whole: it got slower only if most of its cases say so, each by significance and by size, relative to
a fixed loop that the run timed before and after the case (`experiments.harness.steadiness`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from experiments.claims.growth import TABLES, load_claims
from experiments.claims.judged import LEAST_SLOPE, SOURCES
from experiments.regression.baseline import Measured
from experiments.regression.counters import named
from experiments.regression.findings import Finding, Outcome, claim_of, compare_cases, reclassed
from experiments.regression.significance import compare

FACTOR = 2.0
"""How much slower a curve must be from run to run. Curves of the same code were measured to differ
between runs by up to 1.65 at all sizes, by where the process lies in memory, and by 1.8 at most of
them, by a neighbor on the same caches. Two trees timed by turns show far smaller slow-downs."""

SLOPE_DRIFT = 0.25
"""How far beyond their intervals slopes of times may differ. Between runs of the same code they
were measured to differ by up to 0.17, where one of them took a rise for the memory's and the other
did not; a query that becomes linear moves its slope by 1. Where nothing is claimed they are not
compared."""

STRAYS = 1
"""Cases of a curve that may be slower while it is as before: somebody else was at work."""

MACHINE = ("cpu", "cores", "caches")
"""What must be the same for times to be comparable."""


class Compared(NamedTuple):
    """The findings, and what could not be compared at all and need not be, in words."""

    findings: list[Finding]
    notes: list[str]


def compare_runs(before: Measured, after: Measured, factor: float = FACTOR) -> Compared:
    """All that two runs can be compared in. Raises ValueError for a factor of at most 1."""
    notes: list[str] = []
    exact, missing = _in_scope(before, after, before.exact, after.exact, notes, "work and bytes")
    python = _python(before) != _python(after)
    if python:
        notes.append("another Python: the bytes of its objects are not compared")
    findings = [*missing, *compare_cases(*exact, other_python=python)]
    busy = _too_busy(before.head, after.head)
    alike = _profile(before) == _profile(after)
    if not alike:
        notes.append("slopes are not compared: another profile takes them over other sizes")
    verdicts = _verdicts(before, after)
    findings += [
        it for it in verdicts if (alike or it.kind != "slope") and not (busy and it.by_chance)
    ]
    reason = _other_machine(before.head, after.head)
    if busy:
        findings.append(Finding("undetermined", "time", "all that is timed", "", "", busy))
    elif reason:
        notes.append(f"times are not compared: {reason}")
    else:
        times, missing = _in_scope(before, after, before.times, after.times, notes, "times")
        findings += [*missing, *_times(*times, factor)]
        if not times[0] or not times[1]:
            why = "one of the runs has no times that can be compared"
            findings.append(Finding("undetermined", "time", "all that is timed", "", "", why))
    return Compared(findings, notes)


def _profile(run: Measured) -> Any:
    return run.head.get("preset", run.head.get("profile"))


def _too_busy(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Why nothing can be judged by time; empty if it can."""
    for which, head in (("the run", after), ("the reference", before)):
        if head.get("too_busy"):
            return f"the machine was too busy to judge {which} by time; measure it again"
    return ""


def _python(run: Measured) -> str:
    return str((run.head.get("versions") or {}).get("python", "")).rpartition(".")[0]


def _other_machine(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Why times of these two runs cannot be compared; empty if they can."""
    if any((it.get("machine") or {}).get("machines") for it in (before, after)):
        return "they were measured by several machines"
    for key in MACHINE:
        old, new = ((it.get("machine") or {}).get(key) for it in (before, after))
        if old != new:
            return f"another machine ({key}: {new}, the reference has {old})"
    old, new = ((it.get("versions") or {}).get("numba") for it in (before, after))
    return "" if old == new else f"another compiler (numba {new}, the reference has {old})"


def _in_scope(
    before: Measured,
    after: Measured,
    old: dict[str, Any],
    new: dict[str, Any],
    notes: list[str],
    what: str,
) -> tuple[tuple[dict[str, Any], dict[str, Any]], list[Finding]]:
    """The cases that both should have, and a finding for every process without any in the run.

    Runs of one profile should have the same cases. Of another one they share what they share.
    """
    lacking = Counter(_process(key) for key in old.keys() - new.keys())
    present = {_process(key) for key in new}
    gone = {it for it in lacking if it not in present}
    findings = [
        Finding("undetermined", _kind(it), it, f"{lacking[it]:,} cases", "none", "was not measured")
        for it in sorted(gone)
    ]  # fmt: skip
    old = {key: case for key, case in old.items() if _process(key) not in gone}
    if _profile(before) == _profile(after):
        return (old, new), findings
    every, both = old.keys() | new.keys(), old.keys() & new.keys()
    alone = {_curve(key) for key in every} - {_curve(key) for key in both}
    notes.append(
        f"{what}: {len(both):,} cases are compared; {len(every) - len(both):,} are of one profile "
        f"only ({_profile(before)}, {_profile(after)}), among them all of {len(alone):,} curves"
    )
    return ({key: old[key] for key in both}, {key: new[key] for key in both}), findings


def _process(key: str) -> str:
    return "/".join(key.split("/")[:2])


def _curve(key: str) -> str:
    """Experiment, structure, query, whether the valence varies, and order: ``…/by valence/…``."""
    experiment, structure, what, *rest = key.split("/")
    by = ["by valence"] if any(it.startswith("valence") for it in rest) else []
    order = [it for it in rest[-1:] if not it.isdigit()]
    return "/".join([experiment, structure, what, *by, *order])


def _kind(key: str) -> str:
    head = key.partition("/")[0]
    return "bytes" if head == "bench_memory" else "work" if head.endswith("work") else "time"


def _verdicts(before: Measured, after: Measured) -> Iterator[Finding]:
    """Per claim: whether its slopes overlap, and what became of it by work and by time.

    Work is exact. By time a claim is lost or won only where a slope says so, too.
    """
    for claim in load_claims():
        key = claim.table, claim.structure, claim.subject
        old, new = before.verdicts.get(key), after.verdicts.get(key)
        where = f"{claim.structure}/{claim.subject}"
        text = f"{TABLES[claim.table]}, {claim.title}: {claim.printed}; {claim.source}"
        if old is None or new is None:
            lacks = "not in the reference" if old is None else "was not judged"
            yield Finding("undetermined", "class", where, "", "", lacks, text)
            continue
        slopes = list(_slopes(where, old, new, text, bool(claim.expected)))
        yield from slopes
        for measure in ("work", "time"):
            was, now = (it.get(f"outcome_{measure}") for it in (old, new))
            if not (was or now):
                continue
            outcome, why = reclassed(named("", str(was)), named("", str(now))), ""
            apart = any(it.outcome == outcome for it in slopes)
            if outcome in ("worse", "better") and measure == "time" and not apart:
                outcome, why = "undetermined", "its slopes are as before"
            yield Finding(outcome, "class", f"{where} by {measure}", str(was), str(now), why, text)


def _slopes(
    where: str, old: dict[str, Any], new: dict[str, Any], claim: str, claimed: bool
) -> Iterator[Finding]:
    for measure, variable in SOURCES:
        was, now = (it.get(f"{measure}_{variable}") for it in (old, new))
        exact = measure == "work"
        if was and now and (exact or claimed):
            drift = LEAST_SLOPE if exact else SLOPE_DRIFT
            yield _slope(f"{where} by {measure} and {variable}", was, now, claim, drift)


def _slope(
    where: str, old: dict[str, Any], new: dict[str, Any], claim: str, drift: float
) -> Finding:
    """Slopes are apart where their intervals, ``drift`` wider, have nothing in common."""
    outcome: Outcome = "same"
    if None in (*_interval(old), *_interval(new)):
        outcome = "undetermined"
    elif new["slope_low"] > old["slope_high"] + drift:
        outcome = "worse"
    elif new["slope_high"] < old["slope_low"] - drift:
        outcome = "better"
    return Finding(outcome, "slope", where, _span(old), _span(new), "", claim)


def _interval(verdict: dict[str, Any]) -> tuple[Any, Any]:
    return verdict.get("slope_low"), verdict.get("slope_high")


def _span(verdict: dict[str, Any]) -> str:
    low, high = (0.0 if it is None else it for it in _interval(verdict))
    return f"{verdict.get('slope') or 0.0:.3f} [{low:.3f}, {high:.3f}]"


def _times(
    before: dict[str, dict[str, Any]], after: dict[str, dict[str, Any]], factor: float
) -> list[Finding]:
    curves: dict[str, list[str]] = {}
    for key in sorted(before.keys() | after.keys()):
        curves.setdefault(_curve(key), []).append(key)
    return [_timed(curve, keys, before, after, factor) for curve, keys in curves.items()]


def _timed(
    curve: str,
    keys: list[str],
    before: dict[str, dict[str, Any]],
    after: dict[str, dict[str, Any]],
    factor: float,
) -> Finding:
    """One curve: decided where more than half of its cases say the same, and none is lost."""
    both = [key for key in keys if key in before and key in after]
    if not both:
        lacks = "not in the reference" if keys[0] in after else "was not measured"
        return Finding("undetermined", "time", curve, "", "", lacks, claim_of(curve))
    cases = [
        compare(
            before[it]["samples"], after[it]["samples"],
            before[it]["probe"], after[it]["probe"], factor,
        )
        for it in both
    ]  # fmt: skip
    said = Counter(case.outcome for case in cases)
    outcome, most = said.most_common(1)[0]
    lost = sum(key not in after for key in keys)
    ratio = float(np.exp(np.nanmedian([np.log(case.ratio) for case in cases])))
    text = ", ".join(f"{count} {it}" for it, count in said.most_common())
    text += f", {lost} not measured" if lost else ""
    low, high = min(case.ratio for case in cases), max(case.ratio for case in cases)
    decided = outcome if 2 * most > len(cases) else "undetermined"
    if decided == "same" and (lost or said["worse"] > STRAYS):
        decided = "undetermined"  # perhaps just the largest are slower
    slower = f"× {ratio:.2f} ({low:.2f} … {high:.2f})"
    return Finding(decided, "time", curve, "", slower, f"cases: {text}", claim_of(curve))
