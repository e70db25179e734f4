"""Two runs case by case; and deterministic counters: every count, and every class they show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from experiments.harness import Axis
from experiments.regression.baseline import COUNTERS, UPDATE, Measured
from experiments.regression.findings import CaseKey, Change, Finding, Kind
from experiments.regression.snapshots import describe_claim
from experiments.runs import Run, experiments
from hem.complexity import NAMES as CLASSES
from structures import NAMED

OUTCOMES = {
    ("consistent", "violated"): Change.WORSE,
    ("undetermined", "violated"): Change.WORSE,
    ("violated", "consistent"): Change.BETTER,
    ("undetermined", "consistent"): Change.BETTER,
}
"""What it means that a claim's outcome changed; what is not here is undetermined."""

Row = Mapping[Any, Any]
"""A case as a row of a run."""


class Pair(NamedTuple):
    """A case of two runs; None where one of them has none of it. ``why``: the reason, if known."""

    case: CaseKey
    kind: Kind
    before: Row | None
    after: Row | None
    why: str = ""


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
    pairs, notes = pair_cases(before.run, after.run)
    counts = compare_counts((it for it in pairs if it.kind != Kind.TIME), COUNTERS)
    return Compared([*counts, *_compare_classes(before, after)], notes)


def pair_cases(before: Run, after: Run) -> tuple[list[Pair], list[str]]:
    """A pair for every case of either, or that the second run skipped; and notes.

    Python's own objects take other bytes in another Python, so these are not compared then.
    """
    old, new, skipped = (_by_id(rows) for rows in (before.cases, after.cases, after.skipped))
    was, now = (str((it.meta.get("versions") or {}).get("python", "")) for it in (before, after))
    other = was.rpartition(".")[0] != now.rpartition(".")[0]
    pairs = []
    for key in sorted({*old, *new, *skipped}):
        row = new.get(key) or old.get(key) or skipped[key]
        why = str(skipped[key]["skipped"]) if key in skipped else ""
        pair = Pair(_case_of(row), Kind(row["kind"]), old.get(key), new.get(key), why)
        if not (other and pair.kind == Kind.BYTES and _is_of_objects(pair.case.structure)):
            pairs.append(pair)
    note = f"Python {now}, the baseline has {was}: the bytes of its objects are not compared"
    return pairs, [note] if other else []


def _by_id(cases: Any) -> dict[tuple[str, ...], Row]:
    rows = cases.to_dict("records")
    return {(row["experiment"], row["structure"], row["id"]): row for row in rows}


def _case_of(row: Row) -> CaseKey:
    columns = ("experiment", "structure", "subject", "family", "faces", "valence", "order")
    known = {name: row[name] for name in columns if row[name] and row[name] == row[name]}  # no NaN
    size, valence = (int(known.pop(name, 0)) for name in ("faces", "valence"))
    return CaseKey(**known, size=size, valence=valence, reference_bytes=int(row["reference_bytes"]))


def _is_of_objects(structure: str) -> bool:
    return structure in NAMED and not NAMED[structure].compiled


def claim_of(case: CaseKey) -> str:
    """The claim that a case bears on, in words: of its table, or on its structure's memory."""
    declared = experiments().get(case.experiment)
    if declared is None or declared.table is None:
        return describe_claim(f"queries/{case.structure}/memory")
    return describe_claim(f"{declared.table.name}/{case.structure}/{case.subject}")


def compare_counts(pairs: Iterable[Pair], part: str) -> Iterator[Finding]:
    """Work and bytes, to the last count. ``part``: the part of the baseline."""
    for case, kind, before, after, why in pairs:
        old, new = ([int(it) for it in row["samples"]] if row else [] for row in (before, after))
        said = compare_presence(before, after, part, why) or compare_values(old, new)
        claim = claim_of(case)
        yield Finding(said.change, kind, case, _show(old), _show(new), *said[1:], claim=claim)


def compare_presence(old: Any, new: Any, part: str, why: str = "") -> Said | None:
    """What it means that one side is missing; None if none is."""
    if new is None:
        return Said(Change.UNDETERMINED, why or "was not measured")
    return Said(Change.UNDETERMINED, "not in the baseline", UPDATE[part]) if old is None else None


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


def _show(values: Sequence[int]) -> str:
    few = ", ".join(f"{it:,}" for it in values)
    return few if len(values) <= 3 else f"{sum(values):,} in {len(values)}"


def _compare_classes(before: Measured, after: Measured) -> Iterator[Finding]:
    for name in dict.fromkeys((*before.claims, *after.claims)):
        old, new = (it.claims.get(name, {}).get("classes", {}) for it in (before, after))
        for key in dict.fromkeys((*old, *new)):
            absent = compare_presence(old.get(key), new.get(key), COUNTERS)
            said = absent or Said(compare_classes(old[key], new[key]))
            case, axis, claim = key_of_claim(name), Axis[key.upper()].symbol, describe_claim(name)
            was, now = (", ".join(it.get(key, ())) for it in (old, new))
            yield Finding(said.change, Kind.CLASS, case, was, now, *said[1:], axis, claim)


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
    return CaseKey("", structure, subject)
