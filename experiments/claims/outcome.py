"""What can become of a claim."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum


class Outcome(StrEnum):
    """Too little or too noisy data is undetermined, never a pass."""

    VIOLATED = "violated"
    UNDETERMINED = "undetermined"
    CONSISTENT = "consistent"
    NO_CLAIM = "no claim"

    @property
    def mark(self) -> str:
        """One character that stands for it."""
        return MARKS[self]

    @property
    def color(self) -> str:
        """A color's name that terminals know."""
        return COLORS[self]

    @property
    def css(self) -> str:
        """The class of elements that show it."""
        return self.value.replace(" ", "-")

    @classmethod
    def worst(cls, outcomes: Iterable[str]) -> Outcome:
        """The worst of some; no claim where there are none."""
        given = set(outcomes)
        return next((it for it in cls if it in given), cls.NO_CLAIM)


MARKS = {
    Outcome.CONSISTENT: "✓",
    Outcome.VIOLATED: "✗",
    Outcome.UNDETERMINED: "?",
    Outcome.NO_CLAIM: "–",
}
COLORS = {
    Outcome.CONSISTENT: "green",
    Outcome.VIOLATED: "red",
    Outcome.UNDETERMINED: "yellow",
    Outcome.NO_CLAIM: "bright_black",
}
