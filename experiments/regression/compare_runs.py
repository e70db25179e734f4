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
    Said,
    compare_classes,
    compare_counters,
    compare_counts,
    compare_presence,
    key_of_claim,
)
from experiments.regression.findings import CaseKey, Change, Finding, Kind, count_votes, vote
from experiments.regression.pairs import Pair, Row, claim_of, pair_cases, skip_objects
from experiments.regression.significance import Comparison, compare_rounds
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

DECIDED = (Change.WORSE, Change.BETTER)

MACHINE = {"machine": ("cpu", "cores", "caches"), "versions": ("numba",)}
"""What must be the same for times to be comparable."""


def compare_runs(before: Measured, after: Measured, factor: float = FACTOR) -> Compared:
    """All that two runs can be compared in. Raises ValueError for a factor of at most 1."""
    pairs, notes = skip_objects(pair_cases(before.run, after.run), before.run, after.run)
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
    claims = [it for it in compare_claims(before, after) if alike or it.kind != Kind.SLOPE]
    busy, other = _too_busy(old, new), _other_machine(old, new)
    if busy:
        claims = [it for it in claims if not it.random]
        findings.append(_no_times(busy))
    elif other:
        notes.append(f"times are not compared: {other}")
    else:
        findings += _compare_times([it for it in pairs if it.kind == Kind.TIME], factor)
    return Compared(findings + claims, notes)


def describe_difference(before: Measured, after: Measured) -> list[str]:
    """What would change if the second became the baseline, a line each; times are just counted."""
    findings = [*compare_counters(before, after).findings, *compare_claims(before, after)]
    changed = [it for it in findings if it.change != Change.SAME]
    lines = [f"{it.kind} {it.where}: {it.difference}" for it in changed]
    pairs = [it for it in pair_cases(before.run, after.run) if it.kind == Kind.TIME]
    rounds = [[list(row["samples"]) if row else [] for row in it[2:4]] for it in pairs]
    if anew := sum(old != new for old, new in rounds):
        lines.append(f"times: {anew:,} of {len(pairs):,} cases anew")
    return lines


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


def _too_busy(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Why nothing can be judged by time; empty if it can."""
    for which, meta in (("the run", after), ("the baseline", before)):
        if meta.get("too_busy"):
            return f"the machine was too busy to judge {which} by time; measure it again"
    return ""


def _other_machine(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Why times of these two runs cannot be compared; empty if they can."""
    if any((meta.get("machine") or {}).get("machines") for meta in (before, after)):
        return "they were measured by several machines"
    for part, keys in MACHINE.items():
        for key in keys:
            old, new = ((meta.get(part) or {}).get(key) for meta in (before, after))
            if old != new:
                return f"another machine or compiler ({key}: {new}, the baseline has {old})"
    return ""


def compare_claims(before: Measured, after: Measured) -> Iterator[Finding]:
    """Per claim: whether its slopes overlap, and what became of it by work and by time.

    Work is exact. By time a claim is lost or won only where a slope says so, too.
    """
    for name in dict.fromkeys((*before.claims, *after.claims)):
        key, text = key_of_claim(name), describe_claim(name)
        old, new = before.claims.get(name), after.claims.get(name)
        if old is None or new is None:
            change, why, command = compare_presence(old, new, RUN) or Said(Change.SAME)
            yield Finding(change, Kind.CLASS, key, why=why, next=command, claim=text)
            continue
        slopes = list(_compare_slopes(key, old, new, text))
        yield from slopes
        for outcome, axis in (("outcome", "by work"), ("outcome_time", "by time")):
            if outcome not in old or outcome not in new:
                continue
            change, why = compare_classes(("", old[outcome]), ("", new[outcome])), ""
            random = outcome == "outcome_time"
            if random and change in DECIDED and not any(it.change == change for it in slopes):
                change, why = Change.UNDETERMINED, "its slopes are as before"
            shown = old[outcome], new[outcome]
            yield Finding(
                change, Kind.CLASS, key, *shown, why, axis=axis, claim=text, random=random
            )


def _compare_slopes(key: CaseKey, old: Figures, new: Figures, claim: str) -> Iterator[Finding]:
    """Slopes are apart where their intervals, a drift wider, have nothing in common."""
    for axis in Axis:
        was, now = (it.get("slopes", {}).get(axis.key) for it in (old, new))
        if not was or not now or (not axis.exact and old["outcome"] == Outcome.NO_CLAIM):
            continue
        drift = LEAST_SLOPE if axis.exact else SLOPE_DRIFT
        change = Change.SAME
        if now[1] > was[2] + drift:
            change = Change.WORSE
        elif now[2] < was[1] - drift:
            change = Change.BETTER
        before, after = ("{:.3f} [{:.3f}, {:.3f}]".format(*it) for it in (was, now))
        where = f"{axis.symbol}, {axis.label}"
        random = not axis.exact
        yield Finding(
            change, Kind.SLOPE, key, before, after, axis=where, claim=claim, random=random
        )


def _compare_times(pairs: Sequence[Pair], factor: float) -> list[Finding]:
    if not any(it.before and it.before["calibration"] for it in pairs):
        return [_no_times("the baseline has no times that can be compared", UPDATE[RUN])]
    if not any(it.after for it in pairs):
        return [_no_times("the run has no times that can be compared", "hem study")]
    curves: dict[tuple[CaseKey, str], list[Pair]] = {}
    for pair in pairs:
        axis = Axis.TIME_VALENCE if pair.case.valence else Axis.TIME_FACES
        key = CaseKey(*pair.case[:3], order=pair.case.order)
        curves.setdefault((key, axis.symbol), []).append(pair)
    return [_compare_curve(*key, cases, factor) for key, cases in curves.items()]


def _no_times(why: str, command: str = "") -> Finding:
    key = CaseKey(subject="all that is timed")
    return Finding(Change.UNDETERMINED, Kind.TIME, key, why=why, next=command)


def _compare_curve(key: CaseKey, axis: str, pairs: list[Pair], factor: float) -> Finding:
    """One curve: decided where more than half of its cases say the same, and none is lost."""
    cases = [_compare_case(it.before, it.after, factor) for it in pairs if it.before and it.after]
    claim = claim_of(key)
    if not cases:
        absent = compare_presence(pairs[0].before, pairs[0].after, RUN, pairs[0].why)
        change, why, command = absent or Said(Change.UNDETERMINED)
        return Finding(change, Kind.TIME, key, "", "", why, command, axis, claim)
    changes = [case.change for case in cases]
    change, why = vote(changes), count_votes(changes)
    if lost := sum(it.after is None for it in pairs):
        # Perhaps just the largest are slower.
        change = Change.UNDETERMINED if change == Change.SAME else change
        why += f", {lost} not measured"
    ratios = [case.ratio for case in cases]
    middle = np.exp(np.nanmedian(np.log(ratios)))
    ratio = f"× {middle:.2f} ({min(ratios):.2f} … {max(ratios):.2f})"
    return Finding(change, Kind.TIME, key, "", ratio, why, axis=axis, claim=claim, random=True)


def _compare_case(before: Row, after: Row, factor: float) -> Comparison:
    loops = before["calibration"], after["calibration"]
    return compare_rounds(before["samples"], after["samples"], *loops, factor=factor)
