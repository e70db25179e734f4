"""What a history says of every claim from commit to commit, and where it changed.

Work, bytes and outcomes by work are comparable between machines, times are not: a series of times
is of one machine, and of runs in which that was not too busy to judge by time. All series are of
one preset, as the preset sets the sizes.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
import pandas as pd

from experiments.claims import in_digits
from experiments.regression.change_points import Step, find_steps
from experiments.regression.history import History
from experiments.regression.snapshots import LEAST_SLOPE, ClaimName


@dataclass(frozen=True)
class Measure:
    """A figure of a claim. ``at``: the fields that have to agree for two to be comparable."""

    title: str
    key: str
    exact: bool
    at: tuple[str, ...] = ()
    slope: bool = False


MEASURES = {
    "work": Measure("work", "work", True, ("work_faces",)),
    "bytes": Measure("bytes", "bytes", True),
    "slope_faces": Measure("slope n_t", "work_faces", True, slope=True),
    "slope_valence": Measure("slope n_ev", "work_valence", True, slope=True),
    "slope_time": Measure("slope n_t, time", "time_faces", False, slope=True),
    "time": Measure("time", "relative", False, ("time_faces", "time_sizes")),
}
"""What is followed. What is exact is comparable between machines."""
OUTCOMES = {"outcome": "verdict by work", "outcome_time": "verdict by time"}
"""The verdicts of a claim; that by work is comparable between machines, and of memory by bytes."""
SERIES = ["claim", "measure", "preset", "machine"]
"""What the figures of a series have in common; the machine is empty where any will do."""
Rows = Iterator[tuple[Any, ...]]


class Trends:
    """A history as one table of figures and one of verdicts; each is worked out once."""

    def __init__(self, history: History) -> None:
        self.history = history
        self.runs = history.runs

    @cached_property
    def about(self) -> pd.DataFrame:
        """By run its ``commit``, ``*`` with changes besides, ``~`` if too busy; and the like."""
        marks = ["*" * bool(it.get("dirty")) + "~" * bool(it.get("too_busy")) for it in self.runs]
        rows = [
            (it["commit"][:7] + mark, it["profile"], it["machine"]["id"])
            for it, mark in zip(self.runs, marks, strict=True)
        ]
        return pd.DataFrame(rows, columns=["commit", "preset", "machine"])

    def only(self, machine: str | None = None, preset: str | None = None) -> Self:
        """The runs of one machine or preset, by first letters; ValueError names those there are."""
        about = self.about
        for what, wanted in (("machine", machine), ("preset", preset)):
            if wanted is not None:
                known = about[what].unique()
                named = [it for it in known if wanted and it.startswith(wanted)]
                named = [wanted] if wanted in named else named
                if len(named) != 1:
                    which, there = "several runs are" if named else "no run is", ", ".join(known)
                    raise ValueError(f"{which} of {what} {wanted!r}; there are {there}")
                about = about[about[what] == named[0]]
        return type(self)(replace(self.history, runs=[self.runs[k] for k in about.index]))

    def claims(self, text: str | None = None) -> list[str]:
        """The claims, in the newest run's order, that ``text`` names; None: all.

        ``text``: a structure, a query, or ``structure/query``. Raises ValueError for another.
        """
        every = list(dict.fromkeys(name for run in reversed(self.runs) for name in run["claims"]))
        wanted = f"/{(text or '').strip('/')}/"
        chosen = [name for name in every if text is None or wanted in f"/{name}/"]
        if not chosen and every:
            _, *parts = (dict.fromkeys(it) for it in zip(*map(ClaimName.read, every), strict=True))
            raise ValueError(
                f"the history has no claim {text!r}; say one of\n"
                f"  a structure: {', '.join(parts[0])}\n  what it is asked: {', '.join(parts[1])}\n"
                "  or both, as in half_edge/vertex_faces"
            )
        return chosen

    @cached_property
    def figures(self) -> pd.DataFrame:
        """A row per run, claim and measure, in the order of the commits.

        ``run``: index into ``runs``. ``value``, ``low``, ``high``: the figure and its interval.
        ``comparable``: it is of the same meshes as the newest of its series. ``before``, ``after``:
        the levels where a new one begins with this row, else NaN.
        """
        figures = self._table(_figures, ["at", "value", "low", "high"])
        newest = figures.groupby(SERIES)["at"].transform("last")
        figures["comparable"] = figures["at"] == newest
        figures[["before", "after"]] = np.nan
        for _, part in figures[figures["comparable"]].groupby(SERIES):
            measure = MEASURES[part["measure"].iloc[0]]
            for step in _steps(measure, part["value"].to_numpy(float)):
                figures.loc[part.index[step.index], ["before", "after"]] = step.before, step.after
        return figures

    @cached_property
    def verdicts(self) -> pd.DataFrame:
        """A row per run, claim and measure: ``outcome``, that ``before``, if it is ``changed``."""
        verdicts = self._table(_verdicts, ["outcome"])
        before = verdicts.groupby(SERIES)["outcome"].shift()
        changed = before.notna() & (before != verdicts["outcome"])
        return verdicts.assign(before=before, changed=changed)

    @cached_property
    def changes(self) -> pd.DataFrame:
        """All verdicts and figures that changed, by commit: run, claim, measure, before, after."""
        columns = ["run", "claim", "measure", "machine", "before", "after"]
        seen = self.verdicts[self.verdicts["changed"]].rename(columns={"outcome": "after"})[columns]
        steps = self.figures[self.figures["before"].notna()][columns].astype(object)
        steps["measure"] = steps["measure"].map(lambda name: MEASURES[name].title)
        levels = steps[["before", "after"]].map(in_digits, count=4)
        both = pd.concat([seen.assign(verdict=True), steps.assign(**levels, verdict=False)])
        return both.sort_values(["run", "verdict"], ascending=[True, False], kind="stable")

    def _table(self, of_claim: Callable[[Any], Rows], columns: list[str]) -> pd.DataFrame:
        """A row for each figure of a claim: its measure, whether it is exact, and the rest."""
        rows = [
            (k, name, measure, run["profile"], "" if exact else run["machine"]["id"], *values)
            for k, run in enumerate(self.runs)
            for name, claim in run["claims"].items()
            for measure, exact, *values in of_claim(claim)
            if exact or not run.get("too_busy")
        ]
        return pd.DataFrame(rows, columns=["run", *SERIES, *columns])


def _figures(claim: dict[str, Any]) -> Rows:
    for name, it in MEASURES.items():
        if it.key in (figures := claim.get("slopes", {}) if it.slope else claim):
            values = figures[it.key] if it.slope else (figures[it.key], np.nan, np.nan)
            yield name, it.exact, str([claim.get(field) for field in it.at]), *values


def _verdicts(claim: dict[str, Any]) -> Rows:
    yield from ((it, key == "outcome", claim[key]) for key, it in OUTCOMES.items() if key in claim)


def _steps(measure: Measure, values: np.ndarray[Any, Any]) -> list[Step]:
    if not measure.slope:
        return find_steps(values, exact=measure.exact) if measure.exact or values.min() > 0 else []
    if measure.exact:
        held = [values[0]]
        for value in values[1:]:
            held.append(held[-1] if abs(value - held[-1]) < LEAST_SLOPE else value)
        return find_steps(held, exact=True)
    steps = find_steps(np.exp(values))  # of slopes the noise is absolute
    return [Step(it.index, float(np.log(it.before)), float(np.log(it.after))) for it in steps]
