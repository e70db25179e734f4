"""What is claimed: one type for cells of tables, sentences and errata."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

MEMORY = "memory"
"""The subject of the claims about bytes."""

NO_CLAIM = "N/A"
BOUND = "≤ "
"""What a class begins with that is claimed as a bound only."""

SENTENCES = "sentences"
ERRATA = "errata"
"""The tables of what is not a cell."""


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
class Shown:
    """A run of what is published shows it beside a run of what is corrected."""

    number: int


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
    expects: Growth | Exactly | Between | Shown
    structure: str = ""
    subject: str = ""
    printed: str = ""

    @property
    def claims_something(self) -> bool:
        """Whether there is anything to be violated."""
        match self.expects:
            case Growth(classes):
                return bool(classes)
            case Exactly(value):
                return value is not None
        return True
