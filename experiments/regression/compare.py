"""Two measured runs compared: every count and class exactly, slopes by intervals, times by curve.

Rounds of a case are milliseconds apart, and say nothing about what two runs differ by. So a curve,
one query of one structure at all sizes, is judged as a whole: it got slower only if most of its
cases say so, or all large ones, by significance and size, relative to the loop beside the rounds.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from operator import lt
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from experiments.claims import MEMORY, Outcome
from experiments.harness import NO_STRUCTURE, Axis
from experiments.regression.baseline import COUNTERS, RUN, UPDATE, Measured
from experiments.regression.findings import STRAY, CaseKey, Change, Finding, Kind, vote
from experiments.regression.significance import Comparison, compare_rounds
from experiments.regression.snapshots import LEAST_SLOPE, ClaimName, Figures, describe_claim
from experiments.runs import Run, experiments
from hem.complexity import NAMES as CLASSES
from structures import REGISTRY

FACTOR = 2.0
"""How much slower a curve must be from run to run. Curves of the same code were measured to differ
by up to 1.65 at all sizes, by where the process lies in memory, and by 1.8 at most of them, by
another tenant of the same caches. Two trees timed interleaved show far smaller changes."""

LARGE = 3
"""Cases, the largest of a curve, that make it slower though most of it, the smaller ones, is not.
No two of three standard runs had a curve of which even two of them were slower."""

SLOPE_DRIFT = 0.25
"""How far beyond their intervals slopes of times may differ. Of the same code they were measured to
differ by up to 0.17, where one run took a rise for the memory's and the other did not; a query that
becomes linear moves its slope by 1. Where nothing is claimed they are not compared."""

MACHINE = [("machine", it) for it in ("cpu", "cores", "caches", "machines")]
MACHINE += [("versions", "numba")]  # what must be the same for times to be comparable
Row = Mapping[Any, Any]  # a case as a row of a run


class Pair(NamedTuple):
    """A case of two runs; None where one of them has none of it. ``why``: the reason, if known."""

    case: CaseKey
    kind: Kind
    before: Row | None
    after: Row | None
    why: str = ""


class Compared(NamedTuple):
    """The findings, and what could not be compared at all and need not be, in words."""

    findings: list[Finding]
    notes: list[str]


def compare_counters(before: Measured, after: Measured) -> Compared:
    """All counters, exactly; what only one of them has cannot be told."""
    pairs, notes = _pair_cases(before.run, after.run)
    return Compared([*_compare_counts(pairs, COUNTERS), *_compare_classes(before, after)], notes)


def compare_runs(before: Measured, after: Measured, factor: float = FACTOR) -> Compared:
    """All that two runs can be compared in. Raises ValueError for a factor of at most 1."""
    pairs, notes = _pair_cases(before.run, after.run)
    old, new = before.run.meta, after.run.meta
    alike = old.get("preset") == new.get("preset")
    claims = list(_compare_claims(before, after))
    if alike:
        findings, pairs = _find_gone(pairs)
    else:
        findings, count, pairs = [], len(pairs), [it for it in pairs if it.before and it.after]
        claims = [it for it in claims if it.before and it.after and it.kind != Kind.SLOPE]
        notes.append(
            f"of two presets {len(pairs):,} cases are compared that both have, "
            f"{count - len(pairs):,} are not, nor are slopes, which are over other sizes"
        )
    findings += _compare_counts(pairs, RUN)
    busy = [name for name, it in (("run", new), ("baseline", old)) if it.get("too_busy")]
    if busy:
        claims = [it for it in claims if not it.random]
        why = f"the machine was too busy to judge the {busy[0]} by time"
        findings.append(_no_times(why, UPDATE[RUN] if busy == ["baseline"] else "hem study"))
    elif other := _other_machine(old, new):
        notes.append(f"times are not compared: {other}; from now on they are: {UPDATE[RUN]}")
    else:
        findings += _compare_times([it for it in pairs if it.kind == Kind.TIME], factor)
    return Compared(findings + claims, notes)


def describe_difference(before: Measured, after: Measured) -> list[str]:
    """What would change if the second became the baseline, a line each; times are just counted."""
    findings = [*compare_counters(before, after).findings, *_compare_claims(before, after)]
    changed = (it for it in findings if it.change != Change.SAME)
    lines = [f"{it.kind} {it.where}: {it.difference}" for it in changed]
    times = [it for it in _pair_cases(before.run, after.run)[0] if it.kind == Kind.TIME]
    rounds = [[list(row["samples"]) if row else [] for row in it[2:4]] for it in times]
    lost = sum(not new for _, new in rounds)
    anew = sum(old != new for old, new in rounds) - lost
    told = [f"{anew:,} of {len(times):,} cases anew"] + [f"{lost:,} lost"] * bool(lost)
    return [*lines, f"times: {', '.join(told)}"] if anew or lost else lines


def _pair_cases(before: Run, after: Run) -> tuple[list[Pair], list[str]]:
    """A pair per case of either run; bytes of objects only from the same Python. And notes."""
    old, new, skipped = (
        {(row["experiment"], row["structure"], row["id"]): row for row in rows.to_dict("records")}
        for rows in (before.cases, after.cases, after.skipped)
    )
    was, now = (str((it.meta.get("versions") or {}).get("python", "")) for it in (before, after))
    other = was.rpartition(".")[0] != now.rpartition(".")[0]
    objects = {name for name, it in REGISTRY.items() if other and not it.compiled}
    pairs, named = [], ("experiment", "structure", "subject", "family", "order")
    for key in sorted({*old, *new, *skipped}):
        row = new.get(key) or old.get(key) or skipped[key]
        why = str(skipped[key]["skipped"]) if key in skipped else ""
        of_objects = row["kind"] == Kind.BYTES and row["structure"] in objects
        if row["structure"] != NO_STRUCTURE and not of_objects:
            of_case = {name: row[name] for name in named if not pd.isna(row[name])}
            valence = 0 if pd.isna(row["valence"]) else int(row["valence"])
            case = CaseKey(**of_case, size=int(row["faces"]), valence=valence)
            case = case._replace(reference_bytes=int(row["reference_bytes"]))
            pairs.append(Pair(case, Kind(row["kind"]), old.get(key), new.get(key), why))
    note = f"Python {now}, the baseline has {was}: the bytes of its objects are not compared"
    return pairs, [note] if other else []


def claim_of(case: CaseKey) -> str:
    """The claim that a case bears on, in words: of its table, or on memory; empty if none."""
    declared, table, subject = experiments().get(case.experiment), "queries", MEMORY
    if declared and declared.table:
        table, subject = declared.table.name, case.subject
    elif declared and declared.kind != Kind.BYTES:
        return ""
    return describe_claim(str(ClaimName(table, case.structure, subject)))[0]


def _finding(
    kind: Kind, case: CaseKey, old: Any, new: Any, part: str, why: str = "", **more: Any
) -> Finding:
    """One thing compared exactly, of a ``part`` of the baseline; what one side lacks is open."""
    change, command = Change.UNDETERMINED, ""
    if new is None:
        why = why or "was not measured"
    elif old is None:
        why, command = "not in the baseline", UPDATE[part]
    else:
        change, why = (compare_classes if kind == Kind.CLASS else compare_values)(old, new)
    return Finding(change, kind, case, _show(old or ()), _show(new or ()), why, command, **more)


def _show(values: Sequence[Any]) -> str:
    few = ", ".join(it if isinstance(it, str) else f"{it:,}" for it in values)
    return few if len(values) <= 3 else f"{sum(values):,} in {len(values)}"


def _compare_counts(pairs: Iterable[Pair], part: str) -> Iterator[Finding]:
    for case, kind, before, after, why in pairs:
        if kind != Kind.TIME:
            old, new = (row and [int(it) for it in row["samples"]] for row in (before, after))
            yield _finding(kind, case, old, new, part, why, claim=claim_of(case))


def compare_values(old: Sequence[int], new: Sequence[int]) -> tuple[Change, str]:
    """Any count that is larger is worse -> what became of them, and why.

    Of storage that grows: room in excess shows in one step, growth by a constant in their sum.
    """
    if old == new:
        return Change.SAME, ""
    why = f"{len(new)} instead of {len(old)} values" if len(old) != len(new) else ""
    more = any(map(lt, old, new)) or sum(new) > sum(old)
    return Change.WORSE if more else Change.BETTER, why


def _pair_claims(
    before: Measured, after: Measured
) -> Iterator[tuple[CaseKey, dict[str, str], Any, Any]]:
    """Every claim of either: what it is about, in words and by kind, and the figures of both."""
    for name in dict.fromkeys((*before.claims, *after.claims)):
        key = CaseKey("", *ClaimName.read(name)[1:])
        said = dict(zip(("claim", "claimed"), describe_claim(name), strict=True))
        yield key, said, before.claims.get(name), after.claims.get(name)


def _compare_classes(before: Measured, after: Measured) -> Iterator[Finding]:
    for case, said, *figures in _pair_claims(before, after):
        old, new = ((it or {}).get("classes", {}) for it in figures)
        for key in dict.fromkeys((*old, *new)):
            axis, both = Axis[key.upper()].symbol, (old.get(key), new.get(key))
            yield _finding(Kind.CLASS, case, *both, COUNTERS, axis=axis, **said)


def compare_classes(before: Sequence[str], after: Sequence[str]) -> tuple[Change, str]:
    """By what became of the claim, and where that is the same by the rank of the class.

    Either is a class and an outcome. A query that got faster than it is claimed to be breaks the
    claim, too: so does an index that is hidden in a structure without one.
    """
    (old, was), (new, now) = before, after
    change = Change.UNDETERMINED
    if (old, was) == (new, now):
        change = Change.SAME
    elif was != now and was != Outcome.NO_CLAIM:
        change = {"violated": Change.WORSE, "consistent": Change.BETTER}.get(now, change)
    elif was == now != Outcome.UNDETERMINED and old in CLASSES and new in CLASSES:
        change = Change.WORSE if CLASSES.index(new) > CLASSES.index(old) else Change.BETTER
    return change, ""


def _compare_claims(before: Measured, after: Measured) -> Iterator[Finding]:
    """Per claim: whether its slopes overlap, and what became of it by work and by time.

    Work is exact. By time a claim is lost or won only where a slope says so, too.
    """
    for key, said, old, new in _pair_claims(before, after):
        if old is None or new is None:
            was, now = (None if it is None else () for it in (old, new))
            yield _finding(Kind.CLASS, key, was, now, RUN, **said)
            continue
        slopes = list(_compare_slopes(key, old, new, said["claim"]))
        yield from slopes
        for outcome, axis in (("outcome", "by work"), ("outcome_time", "by time")):
            if outcome in old and outcome in new:
                was, now, random = old[outcome], new[outcome], outcome == "outcome_time"
                change, why = compare_classes(("", was), ("", now))
                told = [it.change for it in slopes if it.random]
                if random and change in (Change.WORSE, Change.BETTER) and change not in told:
                    change, why = Change.UNDETERMINED, "its slopes are as before"
                yield Finding(
                    change, Kind.CLASS, key, was, now, why, "", axis, **said, random=random
                )


def _compare_slopes(key: CaseKey, old: Figures, new: Figures, claim: str) -> Iterator[Finding]:
    """Slopes are apart where their intervals, a drift wider, have nothing in common."""
    for axis in Axis:
        was, now = (it.get("slopes", {}).get(axis.key) for it in (old, new))
        if was and now and (axis.exact or old.get("outcome") != Outcome.NO_CLAIM):
            drift = LEAST_SLOPE if axis.exact else SLOPE_DRIFT
            change = Change.WORSE if now[1] > was[2] + drift else Change.SAME
            change = Change.BETTER if now[2] < was[1] - drift else change
            before, after = ("{:.3f} [{:.3f}, {:.3f}]".format(*it) for it in (was, now))
            about = {"axis": f"{axis.symbol}, {axis.label}", "claim": claim}
            yield Finding(change, Kind.SLOPE, key, before, after, **about, random=not axis.exact)


def _find_gone(pairs: Iterable[Pair]) -> tuple[list[Finding], list[Pair]]:
    """A finding for each experiment on a structure of which the run has no case; the others."""
    findings, others = [], []
    for key, group in groupby(pairs, lambda it: it.case[:2]):
        cases = list(group)
        if any(it.after for it in cases):
            others += cases
        else:
            gone = cases[0].kind, CaseKey(*key), f"{len(cases):,} cases", "none"
            findings.append(Finding(Change.UNDETERMINED, *gone))
    return findings, others


def _other_machine(before: Row, after: Row) -> str:
    """Why times of two runs with these heads cannot be compared; empty if they can."""
    if (after.get("machine") or {}).get("machines"):
        return "the run was measured by several machines"
    for part, key in MACHINE:
        old, new = ((meta.get(part) or {}).get(key) for meta in (before, after))
        if old != new:
            return f"another machine or compiler ({key}: {new}, the baseline has {old})"
    return ""


def _no_times(why: str, command: str = "hem study") -> Finding:
    return Finding(Change.UNDETERMINED, Kind.TIME, CaseKey("all times"), "", "", why, command)


def _compare_times(pairs: Sequence[Pair], factor: float) -> list[Finding]:
    if not any(it.before and it.before["calibration"] for it in pairs):
        return [_no_times("the baseline has no times that can be compared", UPDATE[RUN])]
    if not any(it.after for it in pairs):
        return [_no_times("the run has no times that can be compared")]
    curves: dict[tuple[CaseKey, Axis], list[Pair]] = defaultdict(list)
    for pair in pairs:
        axis = Axis.TIME_VALENCE if pair.case.valence else Axis.TIME_FACES
        curves[CaseKey(*pair.case[:3], order=pair.case.order), axis].append(pair)
    return [_compare_curve(*key, cases, factor) for key, cases in curves.items()]


def _all_slower_from(sizes: list[float], cases: Sequence[Comparison]) -> float:
    """The size from which on all of at least `LARGE` cases are slower; 0 where there is none."""
    slower = pd.Series([case.change == Change.WORSE for case in cases], sizes)
    so_far = slower.groupby(level=0).all()[::-1].cummin()
    least = so_far.index[so_far].min()  # nan where the largest is not
    return float(least) if (slower.index >= least).sum() >= LARGE else 0.0


def _compare_curve(key: CaseKey, axis: Axis, pairs: list[Pair], factor: float) -> Finding:
    """One curve: decided where more than half of its cases, or all large ones, say the same."""
    claim, both = claim_of(key), [(it.before, it.after) for it in pairs if it.before and it.after]
    if not both:
        was, now = (None if it is None else () for it in pairs[0][2:4])
        return _finding(Kind.TIME, key, was, now, RUN, pairs[0].why, axis=axis.symbol, claim=claim)
    cases = [
        compare_rounds(
            old["samples"], new["samples"], old["calibration"], new["calibration"], factor
        )
        for old, new in both
    ]
    change, why = vote(case.change for case in cases)
    sizes = [float(old[axis.variable]) for old, _ in both]
    if change != Change.WORSE and (least := _all_slower_from(sizes, cases)):
        change, why = Change.WORSE, f"{why}, all from {least:,.0f} {axis.symbol} on"
    if change == Change.SAME and max(case.low for case in cases) > STRAY:
        change = Change.UNDETERMINED
    if lost := sum(it.after is None for it in pairs):  # perhaps just the largest are slower
        change = Change.UNDETERMINED if change == Change.SAME else change
        why += f", {lost} not measured"
    ratios = [case.ratio for case in cases]
    middle = np.exp(np.nanmedian(np.log(ratios)))
    ratio = f"× {middle:.2f} ({min(ratios):.2f} … {max(ratios):.2f})"
    return Finding(change, Kind.TIME, key, "", ratio, why, "", axis.symbol, claim, random=True)
