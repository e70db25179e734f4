"""The figures of the chapter on regressions: a history in, a figure out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure

from experiments.claims import MEMORY
from experiments.harness import OPERATIONS, QUERIES_TABLE
from experiments.regression import OUTCOMES, Line, Trends, is_of
from experiments.report.history_tables import short_commit
from experiments.report.style import LOOKS, label_ends, short, styled
from structures import NAMES, REGISTRY

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

TITLES = {**QUERIES_TABLE.subjects, **OPERATIONS}
"""What has a row: the queries and the operations."""

Ends = dict[str, tuple[float, float, str]]


def newest(trends: Trends) -> Line:
    """The newest run. Raises ValueError if there is none."""
    if not trends.runs:
        raise ValueError(f"there is no run in {trends.history.path}; begin with: hem history add")
    return trends.runs[-1]


def by_commit(trends: Trends, subject: str) -> Figure:
    """Slope, work, bytes and time of a query or operation by commit: a line per structure.

    Runs of the newest one's profile. Times of its machine have full lines, those of others dotted
    ones, each machine a line of its own. A ring is a step to a new level, a cross a verdict by work
    that changed.
    """
    newest(trends)
    with styled():
        figure = Figure(figsize=(11, 5.8), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True).flat
        ends = [
            _panel(axes, trends, measure, subject)
            for axes, measure in zip(panels, PANELS, strict=True)
        ]
        figure.draw_without_rendering()
        for axes, labels in zip(panels.base.flat, ends, strict=True):
            label_ends(axes, labels)
    return figure


def _panel(axes: Axes, trends: Trends, measure: str, subject: str) -> Ends:
    """One measure of all structures -> where their lines end."""
    title = PANELS[measure]
    axes.set_title(title if measure == "bytes" else f"{title}: {TITLES[subject]}")
    if measure not in FROM_ZERO:
        axes.set_yscale("log")
    run, ends, width = newest(trends), Ends(), _spread(trends, measure)
    lines = _of_profile(trends, measure, MEMORY if measure == "bytes" else subject)
    for place, structure in enumerate(NAMES):
        offset = width * (place / max(len(NAMES) - 1, 1) - 0.5)
        for machine, line in lines[lines["structure"] == structure].groupby("machine"):
            here = machine in ("", run["machine"]["id"])
            _line(axes, trends, line, offset, here)
            last = line.iloc[-1]
            if here and (measure in FROM_ZERO or last["value"] > 0):
                end = float(last["run"]) + width / 2, float(last["value"])
                ends[short(structure)] = (*end, LOOKS[structure].color)
    _room_for_levels(axes, measure)
    _commits(axes, trends, room=0.2)
    return ends


def _of_profile(trends: Trends, measure: str, subject: str | None = None) -> pd.DataFrame:
    """What is comparable of a measure in runs of the newest one's profile, with its structure."""
    rows = trends.figures
    names = rows["claim"].str.split("/", expand=True)
    rows = rows.assign(structure=names[1], subject=names[2])
    wanted = rows["comparable"] & (rows["measure"] == measure) & (names[0] != "listings")
    wanted &= rows["profile"] == newest(trends)["profile"]
    return rows[wanted & (rows["subject"] == subject)] if subject else rows[wanted]


def _spread(trends: Trends, measure: str) -> float:
    return SPREAD * min(len(trends.runs), 10) if measure in FROM_ZERO else 0.0


def _line(axes: Axes, trends: Trends, line: pd.DataFrame, offset: float, here: bool) -> None:
    look = LOOKS[line["structure"].iloc[0]]
    x, y = line["run"].to_numpy() + offset, line["value"].to_numpy(float)
    style: dict[str, Any] = {"color": look.color, "marker": look.marker}
    axes.plot(x, y, look.line if here else ":", alpha=1.0 if here else 0.5, **style)
    if line["measure"].iloc[0] in FROM_ZERO:
        axes.vlines(x, line["low"], line["high"], color=look.color, linewidth=1, alpha=0.6)
    _mark(axes, x, y, line["before"].notna(), "step", look.color, 11)
    changed = is_of([line["claim"].iloc[0]], _changed_verdicts(trends))["run"]
    _mark(axes, x, y, line["run"].isin(changed), "verdict", look.color, 10)


def _changed_verdicts(trends: Trends) -> pd.DataFrame:
    return trends.changes[trends.changes["measure"] == OUTCOMES["outcome"]]


def _mark(
    axes: Axes, x: Any, y: Any, where: pd.Series[bool], what: str, color: str, size: int
) -> None:
    """Rings where a new level begins, crosses where a verdict changed."""
    at = where.to_numpy()
    if at.any():
        marker, fill = ("o", "none") if what == "step" else ("x", color)
        axes.plot(
            x[at], y[at], marker, color=color, markersize=size, markerfacecolor=fill, gid=what
        )


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


def _commits(axes: Axes, trends: Trends, room: float = 0.0) -> None:
    """The runs along the axis, by commit; every so many if there are many."""
    count = len(trends.runs)
    at = list(range(count - 1, -1, count // -LABELS))
    names = [short_commit(trends.runs[k]) for k in at]
    turned: dict[str, Any] = {"rotation": 45, "ha": "right"} if count > 4 else {}
    axes.set_xticks(at, names, **turned)
    axes.set_xlim(-0.5, count - 0.5 + room * max(count, 1))


def departures(trends: Trends, measure: str = "time") -> Figure:
    """How far every claim of every structure is from its usual figure, run by run, as colors.

    Of the newest run's profile and, for times, its machine. A ring is a step to a new level, a
    cross a verdict by work that changed.
    """
    machines = "", newest(trends)["machine"]["id"]
    rows = _of_profile(trends, measure)
    rows = rows[rows["machine"].isin(machines) & (rows["value"] > 0)]
    norm = TwoSlopeNorm(0.0, -float(np.log(STRONGEST)), float(np.log(STRONGEST)))
    with styled():
        figure = Figure(figsize=(11, 7.0), layout="constrained")
        panels = figure.subplots(-(-len(NAMES) // 3), 3, sharex=True, sharey=True, squeeze=False)
        for axes, structure in zip(panels.flat, NAMES, strict=False):
            image = _departures(axes, trends, rows[rows["structure"] == structure], structure)
            drawn = axes.imshow(image, cmap="RdBu_r", norm=norm, aspect="auto")
        for axes in panels.flat[len(NAMES) :]:
            axes.set_visible(False)
        ticks = {1 / STRONGEST: f"{1 / STRONGEST - 1:+.0%}", 1.0: "as usual"}
        ticks[STRONGEST] = f"{STRONGEST - 1:+.0%}"
        bar = figure.colorbar(drawn, ax=panels, shrink=0.5, ticks=np.log(list(ticks)))
        bar.ax.set_yticklabels(list(ticks.values()))
        bar.set_label(PANELS[measure])
    return figure


def _departures(axes: Axes, trends: Trends, rows: pd.DataFrame, structure: str) -> np.ndarray:
    """(subjects, runs): logarithms of the figures over their medians; the marks drawn on top."""
    subjects = list(TITLES)
    usual = rows.groupby("subject")["value"].transform("median")
    table = rows.assign(off=np.log(rows["value"] / usual)).pivot_table("off", "subject", "run")
    steps = rows[rows["before"].notna()]
    changed = is_of(rows["claim"], _changed_verdicts(trends))
    for part, what in ((steps, "step"), (changed, "verdict")):
        names = part["claim"].str.split("/").str[-1].map(subjects.index)
        whole = pd.Series(True, index=part.index)
        _mark(axes, part["run"].to_numpy(), names.to_numpy(), whole, what, "black", 6)
    axes.set_title(REGISTRY[structure].title)
    axes.set_yticks(range(len(subjects)), list(TITLES.values()), fontsize=7)
    axes.grid(visible=False)
    _commits(axes, trends)
    return table.reindex(index=subjects, columns=range(len(trends.runs))).to_numpy(float)
