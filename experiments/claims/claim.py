"""What is claimed in a cell of a table or in a sentence, and what became of it."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Self

import numpy as np

from experiments.harness import Axis
from hem.arrays import Floats
from hem.complexity import Verdict

MEMORY = "memory"  # the subject of the claims about bytes

NO_CLAIM = "–"  # what stands where nobody claims anything
NOT_POSSIBLE = "N/A"  # what table 1 prints where a structure keeps no record of an edge
BOUND = "≤ "  # what a class begins with that is claimed as a bound only

SENTENCES = "sentences"  # the table of what is not a cell


class Outcome(StrEnum):
    """What can become of a claim. Too little or too noisy data is undetermined, never a pass.

    ``mark``: a character for it; ``own``: that where we expect it; ``color``: a terminal's.
    """

    mark: str
    own: str
    color: str

    VIOLATED = "violated", "✗", "●", "red"
    UNDETERMINED = "undetermined", "?", "◌", "yellow"
    CONSISTENT = "consistent", "✓", "○", "green"
    NO_CLAIM = "no claim", "–", "–", "bright_black"

    def __new__(cls, value: str, mark: str = "", own: str = "", color: str = "") -> Self:
        """A text that has marks and a color."""
        outcome = str.__new__(cls, value)
        outcome._value_, outcome.mark, outcome.own, outcome.color = value, mark, own, color
        return outcome

    @property
    def css(self) -> str:
        """The class of elements that show it."""
        return self.value.replace(" ", "-")

    @classmethod
    def worst(cls, outcomes: Iterable[str]) -> "Outcome":
        """The worst of some; no claim where there are none."""
        given = set(outcomes)
        return next((it for it in cls if it in given), cls.NO_CLAIM)


class Kind(StrEnum):
    """Who claims something, in ``about`` as a part of a sentence; each has marks of its own."""

    about: str

    PRINTED = "printed", "a document prints it"
    FOLLOWS = "follows", "it follows from what a document prints, by the same reasoning"
    EXPECTED = "expected", "we expect it, no document says so"
    NOBODY = "not claimed", "nobody claims anything; what was found is shown"

    def __new__(cls, value: str, about: str = "") -> Self:
        """A text that is explained."""
        kind = str.__new__(cls, value)
        kind._value_, kind.about = value, about
        return kind

    def marks(self, outcomes: Iterable[Outcome]) -> str:
        """A character per outcome: what follows stands in brackets, what we expect has circles."""
        text = "".join(it.own if self is Kind.EXPECTED else it.mark for it in outcomes)
        return f"({text})" if self is Kind.FOLLOWS else text


CLAIMED = Kind.PRINTED, Kind.FOLLOWS, Kind.EXPECTED
"""The kinds that claim something."""

MET = {Outcome.VIOLATED: "not as expected", Outcome.CONSISTENT: "as expected"}
"""What is said instead of what this study expects itself."""


@dataclass(frozen=True)
class Growth:
    """A cost grows as claimed: the class by variable, empty where nothing is claimed."""

    classes: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Exactly:
    """So many bytes per vertex, with 8-byte references; None where nothing is claimed."""

    value: float | None


@dataclass(frozen=True)
class Between:
    """Every value of a quantity lies in between; ``measured`` says in words what it is.

    ``every``: the claim is of all that there is, so that one value outside refutes it.
    """

    quantity: str
    measured: str
    low: float = -np.inf
    high: float = np.inf
    every: bool = False

    @property
    def words(self) -> str:
        """The bounds, such as ``at least 6``."""
        if self.low == self.high:
            return f"{self.low:g}"
        if np.isinf(self.low):
            return f"at most {self.high:g}"
        return f"at least {self.low:g}" if np.isinf(self.high) else f"{self.low:g} to {self.high:g}"


@dataclass(frozen=True)
class Claim:
    """One claim.

    ``key``: its name in links and files, such as ``half_edge/vertex_faces`` or
    ``sentence/bytes_ratio``. ``text``: the claim as a sentence. ``source``: where it stands, or why
    it is expected. ``table`` and ``title``: the table it is a row or a cell of, and the row's head.
    ``structure`` and ``subject``: of a cell, else empty. ``printed``: as the table has it.
    """

    key: str
    text: str
    kind: Kind
    source: str
    table: str
    title: str
    expects: Growth | Exactly | Between
    structure: str = ""
    subject: str = ""
    printed: str = ""

    @property
    def classes(self) -> Mapping[str, str]:
        """Of a growth the class that is claimed, by variable."""
        return self.expects.classes if isinstance(self.expects, Growth) else {}

    @property
    def claims_something(self) -> bool:
        """Whether there is anything to be violated."""
        return self.expects not in (Growth(), Exactly(None))

    @property
    def claimant(self) -> Kind:
        """Who claims it; nobody where a document prints that there is nothing to claim."""
        return self.kind if self.claims_something else Kind.NOBODY


@dataclass(frozen=True, eq=False)
class JudgedClaim:
    """A claim, what became of it, and why.

    ``outcome``: by what is exact where there is such a measure, else by time. ``outcomes``: of a
    growth, by measure: ``work``, ``time`` in order and at ``random``. ``found``: short, such as
    ``O(n_ev)`` or ``6.33``; ``reason``: a sentence. ``verdicts``: of a growth, by axis. ``values``:
    of a quantity, or the bytes per vertex. ``work``, ``seconds``: per query at the largest size.
    """

    claim: Claim
    outcome: Outcome
    found: str
    reason: str = ""
    outcomes: Mapping[str, Outcome] = field(default_factory=dict)
    verdicts: Mapping[Axis, Verdict] = field(default_factory=dict)
    values: Floats = field(default_factory=lambda: np.zeros(0))
    work: float = np.nan
    seconds: float = np.nan

    @property
    def outcome_time(self) -> Outcome:
        """What became of it by time, asked in order."""
        return self.outcomes.get("time", Outcome.NO_CLAIM)

    @property
    def marks(self) -> str:
        """A character for each measure that it was judged by, or for what became of it."""
        return self.claim.kind.marks(self.outcomes.values() or [self.outcome])

    @property
    def mark(self) -> str:
        """What became of it, as short as can be."""
        return self.claim.kind.marks([self.outcome])

    @property
    def words(self) -> str:
        """What became of it, such as ``consistent``."""
        met = MET if self.claim.kind is Kind.EXPECTED else {}
        return met.get(self.outcome, self.outcome.value)

    @property
    def was_measured(self) -> bool:
        """Whether the run has anything to say about the claim."""
        return bool(self.verdicts) or len(self.values) > 0


def tally(claims: Iterable[JudgedClaim]) -> dict[tuple[Kind, str], Counter[Outcome]]:
    """How many claims came out how, by kind and measure: of growth, ``bytes`` or ``sentence``."""
    counts: dict[tuple[Kind, str], Counter[Outcome]] = {}
    for it in claims:
        if it.claim.claims_something:
            other = "sentence" if it.claim.table == SENTENCES else "bytes"
            for measure, outcome in (it.outcomes or {other: it.outcome}).items():
                counts.setdefault((it.claim.kind, measure), Counter())[outcome] += 1
    return counts
