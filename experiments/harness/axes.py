"""What a claim is judged along: memory accesses or time, by the number of faces or the valence."""

from __future__ import annotations

from enum import Enum


class Axis(Enum):
    """One measure along one variable, the other variable held.

    ``WORK_…`` counts memory accesses, ``TIME_…`` is time in the order that finds most in the
    caches, ``RANDOM_…`` time in random order.
    """

    WORK_FACES = "work", "faces"
    WORK_VALENCE = "work", "valence"
    TIME_FACES = "time", "faces"
    TIME_VALENCE = "time", "valence"
    RANDOM_FACES = "random", "faces"

    def __init__(self, measure: str, variable: str) -> None:
        self.measure = measure
        self.variable = variable

    @property
    def key(self) -> str:
        """The name in files: ``work_faces``."""
        return f"{self.measure}_{self.variable}"

    @property
    def symbol(self) -> str:
        """The variable's symbol in the thesis."""
        return SYMBOLS[self.variable]

    @property
    def exact(self) -> bool:
        """Whether values are counted, and so the same on every machine."""
        return self.measure == "work"

    @property
    def label(self) -> str:
        """How a plot names the measure."""
        return LABELS[self.measure]

    @property
    def unit(self) -> str:
        """The unit that values are shown in."""
        return "" if self.exact else "ns"

    @property
    def scale(self) -> float:
        """What stored values are multiplied by to be shown in ``unit``."""
        return 1.0 if self.exact else 1e9


SYMBOLS = {"faces": "n_t", "valence": "n_ev"}
LABELS = {
    "work": "memory accesses",
    "time": "time in order",
    "random": "time in random order",
}
