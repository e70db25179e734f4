"""Deterministic counters compared with the baseline: every count, and every class they show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from experiments.harness import Axis
from experiments.regression.baseline import COUNTERS, UPDATE, Measured
from experiments.regression.findings import CaseKey, Change, Finding, Kind
from experiments.regression.pairs import Pair, Row, claim_of, pair_cases, skip_objects
from experiments.regression.snapshots import describe_claim
from hem.complexity import NAMES as CLASSES

OUTCOMES = {
    ("consistent", "violated"): Change.WORSE,
    ("undetermined", "violated"): Change.WORSE,
    ("violated", "consistent"): Change.BETTER,
    ("undetermined", "consistent"): Change.BETTER,
}
"""What it means that a claim's outcome changed; what is not here is undetermined."""


class Said(NamedTuple):
    """What became of something, why, and the command that mends it."""

    change: Change
    why: str = ""
    next: str = ""


class Compared(NamedTuple):
    """The findings, and what could not be compared at all and need not be, in words."""

    findings: list[Finding]
    notes: list[str]


def compare_counters(before: Measured, after: Measured) -> Compared:
    """All counters, exactly; what only one of them has cannot be told."""
    pairs, notes = skip_objects(pair_cases(before.run, after.run), before.run, after.run)
    counts = (it for it in pairs if it.kind != Kind.TIME)
    classes = _compare_classes(before, after)
    return Compared([*compare_counts(counts, COUNTERS), *classes], notes)


def compare_counts(pairs: Iterable[Pair], part: str) -> Iterator[Finding]:
    """Work and bytes, to the last count. ``part``: the part of the baseline."""
    for pair in pairs:
        old, new = (_counts(row) for row in (pair.before, pair.after))
        absent = compare_presence(pair.before, pair.after, part, pair.why)
        change, why, command = absent or compare_values(old, new)
        yield Finding(
            change, pair.kind, pair.case, show_values(old), show_values(new), why, command,
            claim=claim_of(pair.case),
        )  # fmt: skip


def compare_presence(old: Any, new: Any, part: str, why: str = "") -> Said | None:
    """What it means that one side is missing; None if none is."""
    if new is None:
        return Said(Change.UNDETERMINED, why or "was not measured")
    if old is None:
        return Said(Change.UNDETERMINED, "not in the baseline", UPDATE[part])
    return None


def _counts(row: Row | None) -> list[int]:
    return [] if row is None else [int(it) for it in row["samples"]]


def compare_values(old: Sequence[int], new: Sequence[int]) -> Said:
    """Any count that is larger is worse.

    Of storage that grows: room in excess shows in one step, growth by a constant in their sum.
    """
    if old == new:
        return Said(Change.SAME)
    more = any(before < after for before, after in zip(old, new, strict=False))
    if len(old) == len(new):
        return Said(Change.WORSE if more else Change.BETTER)
    more |= sum(new) > sum(old)
    why = f"{len(new)} instead of {len(old)} values"
    return Said(Change.WORSE if more else Change.BETTER, why)


def show_values(values: Sequence[int]) -> str:
    """Counts as text: all of them if they are few, else their sum."""
    few = ", ".join(f"{it:,}" for it in values)
    return few if len(values) <= 3 else f"{sum(values):,} in {len(values)}"


def _compare_classes(before: Measured, after: Measured) -> Iterator[Finding]:
    for name in dict.fromkeys((*before.claims, *after.claims)):
        old, new = (it.claims.get(name, {}).get("classes", {}) for it in (before, after))
        for key in dict.fromkeys((*old, *new)):
            absent = compare_presence(old.get(key), new.get(key), COUNTERS)
            said = absent or Said(compare_classes(old[key], new[key]))
            was, now = (", ".join(it.get(key, ())) for it in (old, new))
            axis, claim = Axis[key.upper()].symbol, describe_claim(name)
            yield Finding(
                said.change, Kind.CLASS, key_of_claim(name), was, now, said.why, said.next, axis,
                claim,
            )  # fmt: skip


def compare_classes(before: Sequence[str], after: Sequence[str]) -> Change:
    """By what became of the claim, and where that is the same by the rank of the class.

    Either is a class and an outcome. A query that got faster than it is claimed to be breaks the
    claim, too: so does an index that is hidden in a structure without one.
    """
    (old, was), (new, now) = before, after
    if (old, was) == (new, now):
        return Change.SAME
    if was != now:
        return OUTCOMES.get((was, now), Change.UNDETERMINED)
    if was == "undetermined" or old not in CLASSES or new not in CLASSES:
        return Change.UNDETERMINED
    return Change.WORSE if CLASSES.index(new) > CLASSES.index(old) else Change.BETTER


def key_of_claim(name: str) -> CaseKey:
    """The key of what a claim ``table/structure/subject`` is about."""
    _, structure, subject = name.split("/")
    return CaseKey(structure=structure, subject=subject)
