"""What is claimed in a cell of a table or in a sentence, and what became of it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Self

import numpy as np

from experiments.harness import Axis
from hem.arrays import Floats
from hem.complexity import Verdict

MEMORY = "memory"  # the subject of the claims about bytes

NO_CLAIM = "N/A"
BOUND = "≤ "  # what a class begins with that is claimed as a bound only

SENTENCES = "sentences"  # the table of what is not a cell
EXPECTATIONS = "expectations"  # that of sentences which no document says, but this study expects


class Outcome(StrEnum):
    """What can become of a claim. Too little or too noisy data is undetermined, never a pass.

    ``mark``: one character that stands for it; ``color``: a color's name that terminals know.
    """

    mark: str
    color: str

    VIOLATED = "violated", "✗", "red"
    UNDETERMINED = "undetermined", "?", "yellow"
    CONSISTENT = "consistent", "✓", "green"
    NO_CLAIM = "no claim", "–", "bright_black"

    def __new__(cls, value: str, mark: str = "", color: str = "") -> Self:
        """A text that has a mark and a color."""
        outcome = str.__new__(cls, value)
        outcome._value_, outcome.mark, outcome.color = value, mark, color
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


MET = {
    Outcome.VIOLATED: ("●", "not as expected"),
    Outcome.UNDETERMINED: ("◌", "undetermined"),
    Outcome.CONSISTENT: ("○", "as expected"),
}
"""What is said instead of what this study expects itself: never to be taken for a document's."""


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
    """Every value of a quantity lies in between; ``measured`` says in words what it is."""

    quantity: str
    measured: str
    low: float = -np.inf
    high: float = np.inf

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


@dataclass(frozen=True, eq=False)
class JudgedClaim:
    """A claim, what became of it, and why.

    ``outcome``: by what is exact where there is such a measure, else by time; ``outcome_time``: by
    time. ``found``: short, such as ``O(n_ev)`` or ``6.33``; ``reason``: a sentence. ``verdicts``:
    of a growth, by axis. ``values``: of a quantity, or the bytes per vertex. ``work`` and
    ``seconds``: per query at the largest size, at random handles where that was measured.
    """

    claim: Claim
    outcome: Outcome
    found: str
    reason: str = ""
    outcome_time: Outcome = Outcome.NO_CLAIM
    verdicts: Mapping[Axis, Verdict] = field(default_factory=dict)
    values: Floats = field(default_factory=lambda: np.zeros(0))
    work: float = np.nan
    seconds: float = np.nan

    @property
    def mark(self) -> str:
        """One character for what became of it."""
        return self._said[0]

    @property
    def words(self) -> str:
        """What became of it, such as ``consistent``."""
        return self._said[1]

    @property
    def _said(self) -> tuple[str, str]:
        documented = self.outcome.mark, self.outcome.value
        own = self.claim.table == EXPECTATIONS
        return MET.get(self.outcome, documented) if own else documented

    @property
    def was_measured(self) -> bool:
        """Whether the run has anything to say about the claim."""
        return bool(self.verdicts) or len(self.values) > 0
