"""Whether something got worse: what is measured, compared with the reference, finding by finding.

Counts and bytes are compared exactly, classes by their rank, slopes by whether their intervals
overlap, and times only by significance and size. What is not there to be compared is a finding as
well: nothing passes because nobody looked.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Literal

from experiments.claims.growth import NO_CLAIM, TABLES, load_claims
from experiments.regression.counters import Exact, Value
from hem.complexity import NAMES as CLASSES

Outcome = Literal["worse", "better", "undetermined", "same"]

TITLES: dict[Outcome, str] = {
    "worse": "Worse",
    "undetermined": "Cannot be told",
    "better": "Better",
    "same": "As before",
}
"""The outcomes in the order that a reader needs them."""

MOST_OPEN = 0.1
"""Part of what chance has a say in that may be left open, and one in any case if it is not all:
machines are never quiet all the time, and a gate that is never passed is not looked at. Of all else
nothing may be."""

VERDICTS: dict[tuple[str, str], Outcome] = {
    ("consistent", "violated"): "worse",
    ("undetermined", "violated"): "worse",
    ("violated", "consistent"): "better",
    ("undetermined", "consistent"): "better",
}
"""What it means that a claim's verdict changed; what is not here cannot be told."""

OBJECTS = "half_edge_objects"
"""Python's own objects are weighed here, and they take other sizes in other versions."""


@dataclass(frozen=True)
class Finding:
    """One thing that was compared.

    ``kind``: work, bytes, class, slope or time. ``where``: the case, slash by slash. ``before`` and
    ``after``: the numbers as text, empty where there is none. ``claim``: what it touches.
    """

    outcome: Outcome
    kind: str
    where: str
    before: str
    after: str
    why: str = ""
    claim: str = ""

    @property
    def by_chance(self) -> bool:
        """Whether it was measured on both sides and chance has a say in it, as in all times."""
        timed = self.kind == "time" or " by time" in self.where or " by random" in self.where
        return timed and bool(self.after)

    def __str__(self) -> str:
        """One line."""
        change = f"{self.before} → {self.after}" if self.before or self.after else ""
        parts = f"{self.kind} {self.where}", change, self.why, self.claim
        return ": ".join(part for part in parts[:2] if part) + "".join(
            f" ({part})" for part in parts[2:] if part
        )


def code(findings: Iterable[Finding]) -> int:
    """The exit code: 1 where anything got worse; 2 where it cannot be told whether, else 0.

    It cannot be told where anything was not measured, or too much was left open by chance.
    """
    found = list(findings)
    if any(it.outcome == "worse" for it in found):
        return 1
    doubtful = [it for it in found if it.outcome == "undetermined"]
    left_open, chances = (sum(it.by_chance for it in some) for some in (doubtful, found))
    too_many = left_open > max(MOST_OPEN * chances, min(1, chances - 1))
    return 2 if left_open < len(doubtful) or too_many else 0


def compare_exact(before: Exact, after: Exact) -> list[Finding]:
    """Every value of either; what only one of them has cannot be told."""
    failed = [
        Finding("undetermined", "work" if key.startswith("work") else "bytes", key, "", "", why)
        for key, why in after.failed.items()
    ]
    known = {it.where for it in failed}
    return failed + [
        it
        for it in compare_cases(before.cases, after.cases, before.python != after.python)
        if it.where not in known
    ]


def compare_cases(
    before: dict[str, Value], after: dict[str, Value], other_python: bool = False
) -> list[Finding]:
    """Two sets of exact cases, key by key."""
    found = []
    for key in sorted(before.keys() | after.keys()):
        if other_python and _kind(key) == "bytes" and OBJECTS in key:
            continue  # see `OBJECTS`; the caller says so
        found.append(_compared(key, before.get(key), after.get(key)))
    return found


def _compared(key: str, before: Value | None, after: Value | None) -> Finding:
    kind = _kind(key)
    outcome, why = _changed(before, after)
    shown = _shown(before), _shown(after)
    return Finding(outcome, kind, key, *shown, why, claim_of(key))


def _kind(key: str) -> str:
    head = key.partition("/")[0]
    return "bytes" if head in ("bytes", "bench_memory") else "class" if head == "class" else "work"


def _changed(before: Value | None, after: Value | None) -> tuple[Outcome, str]:
    if before is None:
        return "undetermined", "not in the reference"
    if after is None:
        return "undetermined", "was not measured"
    if isinstance(before, str) or isinstance(after, str):
        return reclassed(str(before), str(after)), ""
    if before == after:
        return "same", ""
    more = any(old < new for old, new in zip(before, after, strict=False))
    if len(before) == len(after):
        return ("worse" if more else "better"), ""
    # Of storage that grows: room in excess shows in one step, growth by a constant in their sum.
    more |= sum(after) > sum(before)
    return ("worse" if more else "better"), f"{len(after)} instead of {len(before)} values"


def reclassed(before: str, after: str) -> Outcome:
    """By what became of the claim, and where that is the same by the rank of the class.

    A query that got faster than it is claimed to be breaks the claim, too: so does an index that
    is hidden in a structure without one.
    """
    if before == after:
        return "same"
    (old, *_, was), (new, *_, now) = before.split(", "), after.split(", ")
    if was != now:
        return VERDICTS.get((was, now), "undetermined")
    if was == "undetermined" or old not in CLASSES or new not in CLASSES:
        return "undetermined"
    return "worse" if CLASSES.index(new) > CLASSES.index(old) else "better"


def _shown(value: Value | None) -> str:
    if value is None or isinstance(value, str):
        return value or ""
    if len(value) == 1:
        return f"{value[0]:,}"
    total = f"{sum(value):,} in all"
    few = ", ".join(f"{it:,}" for it in value[:4]) + (", …" if len(value) > 4 else "")
    return f"{few}: {total}" if len(value) > 3 else few


@cache
def _claims() -> dict[tuple[str, str], list[str]]:
    found: dict[tuple[str, str], list[str]] = {}
    for claim in load_claims():
        printed = "nothing claimed" if claim.printed == NO_CLAIM else claim.printed
        text = f"{TABLES[claim.table]}, {claim.title}: {printed}; {claim.source}"
        found.setdefault((claim.structure, claim.subject), []).append(text)
    return found


def claim_of(key: str) -> str:
    """The claims that a case touches: those on its structure's query, operation or memory."""
    head, structure, *rest = key.split("/")
    memory = head in ("bytes", "bench_memory")
    known = _claims()
    found = [
        it for what in (["memory"] if memory else rest) for it in known.get((structure, what), ())
    ]
    listing = "listing" in rest or head == "bench_printed"
    chosen = [it for it in found if it.startswith(TABLES["listings"]) == listing]
    return (chosen or found or [""])[0]
