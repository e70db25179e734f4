"""A run compared with the baseline's: counts, claims, slopes, and times.

Rounds of a case are milliseconds apart, so what they differ by within a case says nothing about
what two runs differ by. A curve, one query of one structure at all sizes, is therefore judged as a
whole: it got slower only if most of its cases say so, each by significance and by size, relative to
the calibration loop that ran beside its rounds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from experiments.claims import Outcome
from experiments.harness import Axis
from experiments.regression.baseline import RUN, UPDATE, Measured
from experiments.regression.compare_counters import (
    Compared,
    Pair,
    Said,
    claim_of,
    compare_classes,
    compare_counters,
    compare_counts,
    compare_presence,
    key_of_claim,
    pair_cases,
)
from experiments.regression.findings import CaseKey, Change, Finding, Kind, vote
from experiments.regression.significance import compare_rounds
from experiments.regression.snapshots import LEAST_SLOPE, Figures, describe_claim

FACTOR = 2.0
"""How much slower a curve must be from run to run. Curves of the same code were measured to differ
between runs by up to 1.65 at all sizes, by where the process lies in memory, and by 1.8 at most of
them, by another tenant of the same caches. Two trees timed interleaved show far smaller changes."""

SLOPE_DRIFT = 0.25
"""How far beyond their intervals slopes of times may differ. Between runs of the same code they
were measured to differ by up to 0.17, where one of them took a rise for the memory's and the other
did not; a query that becomes linear moves its slope by 1. Where nothing is claimed they are not
compared."""

MACHINE = {"machine": ("cpu", "cores", "caches", "machines"), "versions": ("numba",)}
"""What must be the same for times to be comparable."""


def compare_runs(before: Measured, after: Measured, factor: float = FACTOR) -> Compared:
    """All that two runs can be compared in. Raises ValueError for a factor of at most 1."""
    pairs, notes = pair_cases(before.run, after.run)
    old, new = before.run.meta, after.run.meta
    alike = old.get("preset") == new.get("preset")
    pairs, findings = _find_gone(pairs)
    if not alike:
        count, pairs = len(pairs), [it for it in pairs if it.before and it.after]
        notes.append(
            f"of two presets {len(pairs):,} cases are compared that both have, "
            f"{count - len(pairs):,} are not, nor are slopes, which are over other sizes"
        )
    findings += compare_counts((it for it in pairs if it.kind != Kind.TIME), RUN)
    claims = [it for it in _compare_claims(before, after) if alike or it.kind != Kind.SLOPE]
    busy = {"the run": new.get("too_busy"), "the baseline": old.get("too_busy")}
    if any(busy.values()):
        which = next(name for name in busy if busy[name])
        claims = [it for it in claims if not it.random]
        findings.append(_no_times(f"the machine was too busy to judge {which} by time"))
    elif other := _other_machine(old, new):
        notes.append(f"times are not compared: {other}")
    else:
        findings += _compare_times([it for it in pairs if it.kind == Kind.TIME], factor)
    return Compared(findings + claims, notes)


def describe_difference(before: Measured, after: Measured) -> list[str]:
    """What would change if the second became the baseline, a line each; times are just counted."""
    findings = [*compare_counters(before, after).findings, *_compare_claims(before, after)]
    changed = [it for it in findings if it.change != Change.SAME]
    lines = [f"{it.kind} {it.where}: {it.difference}" for it in changed]
    times = [it for it in pair_cases(before.run, after.run)[0] if it.kind == Kind.TIME]
    rounds = [[list(row["samples"]) if row else [] for row in it[2:4]] for it in times]
    anew = sum(old != new for old, new in rounds)
    return [*lines, f"times: {anew:,} of {len(times):,} cases anew"] if anew else lines


def _find_gone(pairs: list[Pair]) -> tuple[list[Pair], list[Finding]]:
    """The pairs, and one finding instead of them where the run has none of a process."""
    present = {it.case[:2] for it in pairs if it.after is not None}
    gone: dict[CaseKey, list[Pair]] = {}
    for pair in pairs:
        if pair.case[:2] not in present:
            gone.setdefault(CaseKey(*pair.case[:2]), []).append(pair)
    return [it for it in pairs if it.case[:2] in present], [
        Finding(Change.UNDETERMINED, them[0].kind, key, f"{len(them):,} cases", "none")
        for key, them in gone.items()
    ]


def _other_machine(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Why times of these two runs cannot be compared; empty if they can."""
    if (after.get("machine") or {}).get("machines"):
        return "the run was measured by several machines"
    for part, keys in MACHINE.items():
        for key in keys:
            old, new = ((meta.get(part) or {}).get(key) for meta in (before, after))
            if old != new:
                return f"another machine or compiler ({key}: {new}, the baseline has {old})"
    return ""


def _compare_claims(before: Measured, after: Measured) -> Iterator[Finding]:
    """Per claim: whether its slopes overlap, and what became of it by work and by time.

    Work is exact. By time a claim is lost or won only where a slope says so, too.
    """
    for name in dict.fromkeys((*before.claims, *after.claims)):
        key, text = key_of_claim(name), describe_claim(name)
        old, new = before.claims.get(name), after.claims.get(name)
        if old is None or new is None:
            said = compare_presence(old, new, RUN) or Said(Change.SAME)
            yield Finding(said.change, Kind.CLASS, key, "", "", *said[1:], claim=text)
            continue
        slopes = list(_compare_slopes(key, old, new, text))
        yield from slopes
        for outcome, axis in (("outcome", "by work"), ("outcome_time", "by time")):
            if outcome in old and outcome in new:
                was, now, random = old[outcome], new[outcome], outcome == "outcome_time"
                change, why = compare_classes(("", was), ("", now)), ""
                told = [it.change for it in slopes if it.random]
                if random and change in (Change.WORSE, Change.BETTER) and change not in told:
                    change, why = Change.UNDETERMINED, "its slopes are as before"
                yield Finding(change, Kind.CLASS, key, was, now, why, "", axis, text, random)


def _compare_slopes(key: CaseKey, old: Figures, new: Figures, claim: str) -> Iterator[Finding]:
    """Slopes are apart where their intervals, a drift wider, have nothing in common."""
    for axis in Axis:
        was, now = (it.get("slopes", {}).get(axis.key) for it in (old, new))
        if was and now and (axis.exact or old["outcome"] != Outcome.NO_CLAIM):
            drift = LEAST_SLOPE if axis.exact else SLOPE_DRIFT
            change = Change.WORSE if now[1] > was[2] + drift else Change.SAME
            change = Change.BETTER if now[2] < was[1] - drift else change
            before, after = ("{:.3f} [{:.3f}, {:.3f}]".format(*it) for it in (was, now))
            where, random = f"{axis.symbol}, {axis.label}", not axis.exact
            yield Finding(change, Kind.SLOPE, key, before, after, "", "", where, claim, random)


def _no_times(why: str, command: str = "hem study") -> Finding:
    return Finding(Change.UNDETERMINED, Kind.TIME, CaseKey("all times"), "", "", why, command)


def _compare_times(pairs: Sequence[Pair], factor: float) -> list[Finding]:
    if not any(it.before and it.before["calibration"] for it in pairs):
        return [_no_times("the baseline has no times that can be compared", UPDATE[RUN])]
    if not any(it.after for it in pairs):
        return [_no_times("the run has no times that can be compared")]
    curves: dict[tuple[CaseKey, str], list[Pair]] = {}
    for pair in pairs:
        axis = Axis.TIME_VALENCE if pair.case.valence else Axis.TIME_FACES
        key = CaseKey(*pair.case[:3], order=pair.case.order)
        curves.setdefault((key, axis.symbol), []).append(pair)
    return [_compare_curve(*key, cases, factor) for key, cases in curves.items()]


def _compare_curve(key: CaseKey, axis: str, pairs: list[Pair], factor: float) -> Finding:
    """One curve: decided where more than half of its cases say the same, and none is lost."""
    claim, both = claim_of(key), [(it.before, it.after) for it in pairs if it.before and it.after]
    if not both:
        absent = compare_presence(pairs[0].before, pairs[0].after, RUN, pairs[0].why)
        said = absent or Said(Change.UNDETERMINED)
        return Finding(said.change, Kind.TIME, key, "", "", *said[1:], axis, claim)
    cases = [
        compare_rounds(
            old["samples"], new["samples"], old["calibration"], new["calibration"], factor
        )
        for old, new in both
    ]
    change, why = vote(case.change for case in cases)
    if lost := sum(it.after is None for it in pairs):
        # Perhaps just the largest are slower.
        change = Change.UNDETERMINED if change == Change.SAME else change
        why += f", {lost} not measured"
    ratios = [case.ratio for case in cases]
    middle = np.exp(np.nanmedian(np.log(ratios)))
    ratio = f"× {middle:.2f} ({min(ratios):.2f} … {max(ratios):.2f})"
    return Finding(change, Kind.TIME, key, "", ratio, why, "", axis, claim, random=True)
