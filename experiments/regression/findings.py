"""What differs from the baseline, finding by finding, and the exit code that follows from it.

Nothing passes because nobody looked: what is not there to be compared is a finding as well.
"""

from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple


class Change(StrEnum):
    """What became of something, in the order that a reader needs."""

    WORSE = "worse"
    UNDETERMINED = "undetermined"
    BETTER = "better"
    SAME = "same"


class Kind(StrEnum):
    """What was compared: counters exactly, slopes by their intervals, times by statistics."""

    WORK = "work"
    BYTES = "bytes"
    CLASS = "class"
    SLOPE = "slope"
    TIME = "time"


class CaseKey(NamedTuple):
    """A case, by its number of faces; of a curve or a claim what its cases share, else nothing."""

    experiment: str = ""
    structure: str = ""
    subject: str = ""
    family: str = ""
    size: int = 0
    valence: int = 0
    order: str = ""
    reference_bytes: int = 0

    def __str__(self) -> str:
        valence = f"valence {self.valence}" if self.valence else ""
        references = "8-byte references" if self.reference_bytes == 8 else ""
        parts = (*self[:5], valence, self.order, references)
        return "/".join(str(part) for part in parts if part)


@dataclass(frozen=True)
class Finding:
    """One thing that was compared.

    ``before``, ``after``: the figures as text, empty where there is none. ``why``: in words, and
    ``next``: the command that mends it, where they are needed. ``axis``: what a cost was judged by,
    such as "n_t, by time". ``claim``: what it touches; ``claimed``: of a claim its kind.
    ``random``: it was measured on both sides and chance has a say in it.
    """

    change: Change
    kind: Kind
    case: CaseKey
    before: str = ""
    after: str = ""
    why: str = ""
    next: str = ""
    axis: str = ""
    claim: str = ""
    claimed: str = ""
    random: bool = False

    @property
    def where(self) -> str:
        """The case, and the axis where there is one."""
        return f"{self.case} {self.axis}".strip()

    @property
    def difference(self) -> str:
        """The figures and why, such as ``19 → 20``."""
        figures = f"{self.before} → {self.after}" if self.before else self.after
        return f"{figures} ({self.why})" if figures and self.why else figures or self.why


MOST_OPEN = 0.1
"""Part of what chance has a say in that may be left open, and one in any case if it is not all:
machines are never quiet all the time, and a gate that is never passed is not looked at. Of all else
nothing may be."""
STRAYS = 1
"""Votes for slower that do not matter where most say that all is as before: other tenants of the
machine were at work."""
STRAY = 8.0
"""How many times slower such a one is at most: a mesh that fits into the caches was measured to
take 5.8 times as long where another tenant had filled them."""


def exit_code(findings: Collection[Finding]) -> int:
    """1 where anything got worse; 2 where anything is missing or too much is open; else 0."""
    if any(finding.change == Change.WORSE for finding in findings):
        return 1
    doubtful = [finding for finding in findings if finding.change == Change.UNDETERMINED]
    by_chance, chances = (sum(it.random for it in some) for some in (doubtful, findings))
    too_many = by_chance > max(MOST_OPEN * chances, min(1, chances - 1))
    return 2 if by_chance < len(doubtful) or too_many else 0


def vote(changes: Iterable[Change], *, unanimous: bool = False) -> tuple[Change, str]:
    """What more than half say, and how many said what, such as "5 same, 1 worse".

    All is as before only if at most `STRAYS` say slower. ``unanimous``: it changed only if none
    says otherwise, though some may not know.
    """
    said = Counter(changes)
    (change, most), *_ = ranked = said.most_common()
    otherwise = said.total() - most - said[Change.UNDETERMINED]
    agreed = not (unanimous and otherwise)
    if change == Change.SAME:
        agreed = said[Change.WORSE] <= STRAYS
    decided = agreed and 2 * most > said.total()
    words = ", ".join(f"{count} {it}" for it, count in ranked)
    return change if decided else Change.UNDETERMINED, words
