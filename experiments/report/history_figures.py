"""The figures of the chapter on regressions: a history in, a figure out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure

from experiments.claims.growth import MEMORY, OPERATIONS, title_of
from experiments.regression.history import History, Line
from experiments.regression.trends import MEASURES, OUTCOMES, Change, Series, changes, series
from experiments.report.style import LOOKS, label_ends, short, styled
from hem.contract import QUERIES
from structures import NAMES, REGISTRY

Ends = dict[str, tuple[float, float, str]]

PANELS = {
    "slope_time": "Slope in n_t, by time",
    "work": "Work at the largest size",
    "bytes": "Bytes per vertex",
    "time": "Time, in memory accesses",
}
"""What is drawn of a query by commit, and its title."""
FROM_ZERO = ("slope_time",)
LABELS = 12
"""Commits that are named below a panel, at most."""
SPREAD = 0.03
"""How far apart the structures' intervals are drawn, in parts of the width, up to ten runs."""
STRONGEST = 1.5
"""The ratio to its usual time from which on a color is as strong as can be."""


def newest(history: History) -> Line:
    """The newest run. Raises ValueError if there is none."""
    if not history.runs:
        raise ValueError(f"there is no run in {history.path}; begin with: hem history add")
    return history.runs[-1]


def by_commit(history: History, what: str) -> Figure:
    """Slope, work, bytes and time of a query or operation by commit: a line per structure.

    Runs of the newest one's profile. Times of its machine have full lines, those of others dotted
    ones, each machine a line of its own. A ring is a step to a new level, a cross a verdict by work
    that changed.
    """
    run = newest(history)
    changed = changes(history)
    with styled():
        figure = Figure(figsize=(11, 5.8), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True)
        ends: list[Ends] = []
        for axes, (measure, title) in zip(panels.flat, PANELS.items(), strict=True):
            axes.set_title(title if measure == "bytes" else f"{title}: {title_of(what)}")
            if measure not in FROM_ZERO:
                axes.set_yscale("log")
            ends.append({})
            for place, structure in enumerate(NAMES):
                asked = MEMORY if measure == "bytes" else what
                table = "operations" if asked in OPERATIONS else "queries"
                claim = f"{table}/{structure}/{asked}"
                offset = _spread(history, measure) * (place / (len(NAMES) - 1) - 0.5)
                for line in series(history, claim, measure):
                    if line.profile == run["profile"]:
                        end = _line(axes, history, line, structure, offset)
                        _crosses(axes, changed, line, structure, offset)
                        if line.machine in (None, run["machine"]["id"]) and (
                            measure in FROM_ZERO or end[1] > 0
                        ):
                            ends[-1] |= {short(structure): end}
            _room_for_levels(axes, measure)
            _commits(axes, history, room=0.2)
        figure.draw_without_rendering()
        for axes, labels in zip(panels.flat, ends, strict=True):
            label_ends(axes, labels)
    return figure


def _spread(history: History, measure: str) -> float:
    return SPREAD * min(len(history.runs), 10) if measure in FROM_ZERO else 0.0


def _line(
    axes: Axes, history: History, line: Series, structure: str, offset: float
) -> tuple[float, float, str]:
    look, here = LOOKS[structure], line.machine in (None, newest(history)["machine"]["id"])
    x, y = np.array(line.at) + offset, np.array(line.values)
    style: dict[str, Any] = {"color": look.color, "marker": look.marker}
    axes.plot(x, y, look.line if here else ":", alpha=1.0 if here else 0.5, **style)
    bounds = [MEASURES[line.measure].bounds(history.runs[k]["claims"][line.claim]) for k in line.at]
    for at, bound in zip(x, bounds, strict=True):
        if bound and not MEASURES[line.measure].exact:
            axes.plot([at, at], bound, "-", color=look.color, linewidth=1, alpha=0.6)
    for step in line.steps:
        axes.plot(
            x[step.index], y[step.index], "o", markersize=11, markerfacecolor="none",
            markeredgecolor=look.color, gid="step",
        )  # fmt: skip
    end = line.at[-1] + _spread(history, line.measure) / 2
    return float(end), float(y[-1]), look.color


def _crosses(
    axes: Axes, changed: list[Change], line: Series, structure: str, offset: float
) -> None:
    for it in changed:
        if (it.claim, it.what) == (line.claim, OUTCOMES["outcome"]) and it.run in line.at:
            value, color = line.values[line.at.index(it.run)], LOOKS[structure].color
            axes.plot(it.run + offset, value, "x", markersize=10, color=color, gid="verdict")


def _room_for_levels(axes: Axes, measure: str) -> None:
    """Room above and below, and no axis so narrow that noise looks like news."""
    low = axes.dataLim.y0 if measure in FROM_ZERO else axes.dataLim.minposy
    high = axes.dataLim.y1
    if not axes.lines or not np.isfinite([low, high]).all():
        return
    if measure in FROM_ZERO:
        axes.set_ylim(min(low, 0) - 0.25, max(high, 1) + 0.15)
    else:
        axes.set_ylim(low / 2.5, high * 2.5)


def _commits(axes: Axes, history: History, room: float = 0.0) -> None:
    """The runs along the axis, by commit; every so many if there are many."""
    count = len(history.runs)
    every = -(-count // LABELS)
    at = list(range(count - 1, -1, -every))
    marks = ["*" if history.runs[k].get("dirty") else "" for k in at]
    names = [history.runs[k]["commit"][:7] + mark for k, mark in zip(at, marks, strict=True)]
    axes.set_xticks(
        at, names, rotation=45 if count > 4 else 0, ha="right" if count > 4 else "center"
    )
    axes.set_xlim(-0.5, count - 0.5 + room * max(count, 1))


def departures(history: History, measure: str = "time") -> Figure:
    """How far every claim of every structure is from its usual figure, run by run, as colors.

    Of the newest run's profile and, for times, its machine. A ring is a step to a new level, a
    cross a verdict by work that changed.
    """
    run = newest(history)
    rows = [*QUERIES, *OPERATIONS]
    changed = changes(history)
    with styled():
        figure = Figure(figsize=(11, 7.0), layout="constrained")
        panels = figure.subplots(2, 3, sharex=True, sharey=True)
        norm = TwoSlopeNorm(0.0, -float(np.log(STRONGEST)), float(np.log(STRONGEST)))
        for axes, structure in zip(panels.flat, NAMES, strict=True):
            lines = [_of_run(history, structure, what, measure, run) for what in rows]
            image = np.full((len(rows), len(history.runs)), np.nan)
            for row, line in enumerate(lines):
                if line is not None and min(line.values) > 0:
                    values = np.log(line.values)
                    image[row, line.at] = values - np.median(values)
            drawn = axes.imshow(image, cmap="RdBu_r", norm=norm, aspect="auto")
            _marks(axes, structure, rows, lines, changed)
            axes.set_title(REGISTRY[structure].title)
            axes.set_yticks(range(len(rows)), [title_of(what) for what in rows], fontsize=7)
            axes.grid(visible=False)
            _commits(axes, history)
        ticks = {1 / STRONGEST: f"{1 / STRONGEST - 1:+.0%}", 1.0: "as usual"}
        ticks[STRONGEST] = f"{STRONGEST - 1:+.0%}"
        bar = figure.colorbar(drawn, ax=panels, shrink=0.5, ticks=np.log(list(ticks)))
        bar.ax.set_yticklabels(list(ticks.values()))
        bar.set_label(PANELS[measure])
    return figure


def _of_run(history: History, structure: str, what: str, measure: str, run: Line) -> Series | None:
    """The series that ends, or would end, with this run."""
    claim = f"{'operations' if what in OPERATIONS else 'queries'}/{structure}/{what}"
    machines = None, run["machine"]["id"]
    found = [
        it
        for it in series(history, claim, measure)
        if it.profile == run["profile"] and it.machine in machines
    ]
    return found[0] if found else None


def _marks(
    axes: Axes, structure: str, rows: Sequence[str], lines: list[Series | None], found: list[Change]
) -> None:
    for row, line in enumerate(lines):
        for step in line.steps if line else ():
            axes.plot(
                line.at[step.index] if line else 0, row, "o", color="black", markersize=6,
                markerfacecolor="none", gid="step",
            )  # fmt: skip
    for it in found:
        table, of, what = it.claim.split("/")
        if (
            of == structure
            and table != "listings"
            and it.what == OUTCOMES["outcome"]
            and what in rows
        ):
            axes.plot(it.run, rows.index(what), "x", color="black", markersize=6, gid="verdict")
