"""What a history says of a claim from commit to commit, and where it changed.

Work, bytes and outcomes by work are comparable between machines, times are not: a series of times
is of one machine. All series are of one profile, as the profile sets the sizes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from experiments.claims.judged import LEAST_SLOPE
from experiments.regression.change_points import Step, steps
from experiments.regression.history import History, Line


@dataclass(frozen=True)
class Measure:
    """A figure of a claim. ``at``: the fields that have to agree for two to be comparable."""

    title: str
    key: str
    exact: bool
    at: tuple[str, ...] = ()
    slope: bool = False

    def value(self, claim: dict[str, Any]) -> float | None:
        """The figure, or None where there is none."""
        if self.slope:
            found = claim.get("slopes", {}).get(self.key)
            return None if found is None else float(found[0])
        return claim.get(self.key)

    def bounds(self, claim: dict[str, Any]) -> tuple[float, float] | None:
        """The interval of a slope."""
        found = claim.get("slopes", {}).get(self.key) if self.slope else None
        return (float(found[1]), float(found[2])) if found and len(found) == 3 else None


MEASURES = {
    "work": Measure("work", "work", True, ("work_faces",)),
    "bytes": Measure("bytes", "bytes", True),
    "slope_faces": Measure("slope n_t", "work_faces", True, slope=True),
    "slope_valence": Measure("slope n_ev", "work_valence", True, slope=True),
    "slope_time": Measure("slope n_t, time", "time_faces", False, slope=True),
    "time": Measure("time", "relative", False, ("time_faces", "time_sizes")),
}
"""What is drawn. What is exact is comparable between machines."""

OUTCOMES = {"outcome": "verdict by work", "outcome_time": "verdict by time"}
"""The verdicts of a claim; that by work is comparable between machines, and of memory by bytes."""


@dataclass(frozen=True)
class Series:
    """One figure of one claim; ``machine`` is None where machines are comparable.

    ``at``: indices into the history's runs; ``values``: the figures there. ``steps``: where a new
    level begins, indices into ``at``.
    """

    claim: str
    measure: str
    profile: str
    machine: str | None
    at: list[int]
    values: list[float]
    steps: list[Step] = field(default_factory=list)


@dataclass(frozen=True)
class Change:
    """Something that is not as it was: ``run`` is an index into the history's runs."""

    claim: str
    what: str
    run: int
    before: str
    after: str
    machine: str | None

    @property
    def is_verdict(self) -> bool:
        """Whether it is a verdict that changed, and no figure."""
        return self.what in OUTCOMES.values()


def claims(history: History) -> list[str]:
    """The names of all claims, in the order of the newest run that has them."""
    found: dict[str, None] = {}
    for run in reversed(history.runs):
        found |= dict.fromkeys(run["claims"])
    return list(found)


def chosen(history: History, text: str | None) -> list[str]:
    """The claims that ``text`` names: a structure, a query, or ``structure/query``; None: all.

    Raises ValueError that says what there is.
    """
    every = claims(history)
    if text is None:
        return every
    wanted = text.strip("/").split("/")
    found = [name for name in every if _within(wanted, name.split("/"))]
    if not found and history.runs:
        parts = [dict.fromkeys(name.split("/")[k] for name in every) for k in (1, 2)]
        raise ValueError(
            f"the history has no claim {text!r}; say a structure ({', '.join(parts[0])}), what it "
            f"is asked ({', '.join(parts[1])}), or both, as in half_edge/vertex_faces"
        )
    return found


def _within(wanted: list[str], parts: list[str]) -> bool:
    return any(parts[k : k + len(wanted)] == wanted for k in range(len(parts)))


def series(history: History, claim: str, measure: str) -> list[Series]:
    """All series of a figure, with their steps; one per profile, and machine if it is a time.

    Of meshes of several sizes those that were measured last: others have nothing to compare with.
    """
    it = MEASURES[measure]
    groups: dict[tuple[str, str | None], list[int]] = {}
    for k, run in enumerate(history.runs):
        if it.value(run["claims"].get(claim, {})) is not None:
            machine = None if it.exact else run["machine"]["id"]
            groups.setdefault((run["profile"], machine), []).append(k)
    return [
        _series(history, claim, measure, profile, machine, runs)
        for (profile, machine), runs in groups.items()
    ]


def _series(
    history: History, claim: str, measure: str, profile: str, machine: str | None, runs: list[int]
) -> Series:
    it = MEASURES[measure]
    sizes = [tuple(history.runs[k]["claims"][claim].get(key) for key in it.at) for k in runs]
    at = [k for k, size in zip(runs, sizes, strict=True) if size == sizes[-1]]
    values = [float(it.value(history.runs[k]["claims"][claim]) or 0) for k in at]
    return Series(claim, measure, profile, machine, at, values, _steps(it, values))


def _steps(measure: Measure, values: list[float]) -> list[Step]:
    if not measure.slope:
        positive = measure.exact or min(values) > 0
        return steps(values, exact=measure.exact) if positive else []
    if measure.exact:
        held = [values[0]]
        for value in values[1:]:
            held.append(held[-1] if abs(value - held[-1]) < LEAST_SLOPE else value)
        return steps(held, exact=True)
    found = steps(np.exp(values))  # of slopes the noise is absolute
    return [Step(it.index, float(np.log(it.before)), float(np.log(it.after))) for it in found]


def changes(history: History, names: list[str] | None = None) -> list[Change]:
    """All verdicts and figures that changed, in the order of the commits."""
    found = [
        change
        for claim in (claims(history) if names is None else names)
        for change in (*_verdicts(history, claim), *_figures(history, claim))
    ]
    return sorted(found, key=lambda it: (it.run, not it.is_verdict))


def _verdicts(history: History, claim: str) -> Iterator[Change]:
    for key, what in OUTCOMES.items():
        groups: dict[tuple[str, str | None], list[int]] = {}
        for k, run in enumerate(history.runs):
            if key in run["claims"].get(claim, {}):
                machine = run["machine"]["id"] if key == "outcome_time" else None
                groups.setdefault((run["profile"], machine), []).append(k)
        for (_, machine), runs in groups.items():
            for before, after in pairwise(runs):
                was, now = (_claim(history.runs[k], claim)[key] for k in (before, after))
                if was != now:
                    yield Change(claim, what, after, was, now, machine)


def _figures(history: History, claim: str) -> Iterator[Change]:
    for measure, it in MEASURES.items():
        for line in series(history, claim, measure):
            for step in line.steps:
                before, after = (f"{value:.4g}" for value in (step.before, step.after))
                run = line.at[step.index]
                yield Change(claim, it.title, run, before, after, line.machine)


def _claim(run: Line, claim: str) -> dict[str, Any]:
    found: dict[str, Any] = run["claims"][claim]
    return found
