"""The figures of the chapter on regressions: a history in, a figure out."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm

from experiments.claims import MEMORY
from experiments.regression import OUTCOMES, ClaimName, Trends
from experiments.report.style import STYLES, TITLES, Plot, grid, label_ends, short_numbers, styled
from structures import NAMES, REGISTRY

PANELS = {
    "slope_time": "Slope in n_t, by time, the memory's part taken out",
    "work": "Work at the largest size",
    "bytes": "Bytes per vertex",
    "time": "Time, in memory accesses",
}
"""What is drawn of a query by commit, and its title."""
SLOPE = "slope_time"
LABELS = 12  # commits that are named below a panel, at most
SPREAD = 0.03  # how far apart structures' intervals are drawn, as part of the width, to ten runs
STRONGEST = 1.5  # the ratio to its usual time from which on a color is as strong as can be


def by_commit(trends: Trends, subject: str) -> Plot:
    """Slope, work, bytes and time of a query or operation by commit: a line per structure.

    Of the newest run's preset; times of other machines than its own have paler lines. A ring is a
    step to a new level, a cross a verdict by work that changed.
    """
    trends, rows = _of_newest(trends)
    titles = [it if key == "bytes" else f"{it}: {TITLES[subject]}" for key, it in PANELS.items()]
    with styled():
        figure, panels = grid(titles, (5.5, 2.9), 2, Plot, sharex=True)
        for axes, measure in zip(panels, PANELS, strict=True):
            sloped = measure == SLOPE
            if not sloped:
                axes.set_yscale("log")
                short_numbers(axes)
            mine = rows[rows["subject"] == (MEMORY if measure == "bytes" else subject)]
            for _, line in mine[mine["measure"] == measure].groupby(["structure", "machine"]):
                _draw_line(axes, trends, line)
            low, high = axes.dataLim.y0 if sloped else axes.dataLim.minposy, axes.dataLim.y1
            if axes.lines and np.isfinite([low, high]).all():  # no noise is to look like news
                room = min(low, 0) - 0.25, max(high, 1) + 0.15
                axes.set_ylim(room if sloped else (low / 2.5, high * 2.5))
            _name_commits(axes, trends, room=0.2)
        figure.draw_without_rendering()
        for axes in panels:
            label_ends(axes)
    return figure


def _of_newest(trends: Trends) -> tuple[Trends, pd.DataFrame]:
    """The runs of the newest one's preset, and what is comparable with it.

    ``here``: it is of the newest one's machine, or of any. Raises ValueError without a run.
    """
    if not trends.runs:
        raise ValueError(f"there is no run in {trends.history.path}; begin with: hem history add")
    newest = trends.runs[-1]
    trends = trends.only(preset=newest["profile"])
    rows = trends.figures
    names = pd.DataFrame(map(ClaimName.read, rows["claim"]), rows.index, ClaimName._fields)
    rows = rows.join(names).assign(here=rows["machine"].isin(("", newest["machine"]["id"])))
    wanted = rows["comparable"] & rows["table"].isin(("queries", "operations"))
    return trends, rows[wanted & rows["structure"].isin(NAMES)]


def _draw_line(axes: Axes, trends: Trends, line: pd.DataFrame) -> None:
    """One structure on one machine; slopes with their intervals, a bit beside each other's."""
    last = line.iloc[-1]
    look, sloped = STYLES[last["structure"]], last["measure"] == SLOPE
    width = SPREAD * min(len(trends.runs), 10) if sloped else 0.0
    part = NAMES.index(last["structure"]) / (len(NAMES) - 1)
    x, y = line["run"].to_numpy() + width * (part - 0.5), line["value"].to_numpy(float)
    axes.plot(x, y, **(look | {"label": "_", "alpha": 1.0 if last["here"] else 0.5}))
    if sloped:
        axes.vlines(x, line["low"], line["high"], color=look["color"], linewidth=1, alpha=0.6)
    stepped = line["before"].notna().to_numpy()
    _mark(axes, x[stepped], y[stepped], "step", look["color"], 11)
    changed = line["run"].isin(_changed(trends, [last["claim"]])["run"]).to_numpy()
    _mark(axes, x[changed], y[changed], "verdict", look["color"], 10)
    if last["here"] and (sloped or y[-1] > 0):
        axes.plot(last["run"] + width / 2, y[-1], label=look["label"], color=look["color"])


def _changed(trends: Trends, claims: Iterable[str]) -> pd.DataFrame:
    """Where the verdicts of some claims by work changed."""
    rows = trends.verdicts[trends.verdicts["changed"] & trends.verdicts["claim"].isin(list(claims))]
    return rows[rows["measure"] == OUTCOMES["outcome"]]


def _mark(axes: Axes, x: Any, y: Any, what: str, color: str, size: int) -> None:
    """Rings where a new level begins, crosses where a verdict changed."""
    if len(x):
        marker, fill = ("o", "none") if what == "step" else ("x", color)
        axes.plot(x, y, marker, color=color, ms=size, markerfacecolor=fill, gid=what)


def _name_commits(axes: Axes, trends: Trends, room: float = 0.0) -> None:
    """The runs along the axis, by commit; every so many if there are many."""
    count = len(trends.runs)
    at = list(range(count - 1, -1, count // -LABELS))
    turned: dict[str, Any] = {"rotation": 45, "ha": "right"} if count > 4 else {}
    axes.set_xticks(at, trends.about["commit"][at], **turned)
    axes.set_xlim(-0.5, count - 0.5 + room * max(count, 1))


def departures(trends: Trends) -> Plot:
    """How far every claim of every structure is from its usual time, run by run, as colors.

    Of the newest run's preset and machine, with the same marks.
    """
    trends, rows = _of_newest(trends)
    rows = rows[rows["here"] & (rows["measure"] == "time") & (rows["value"] > 0)]
    ends = (1 / STRONGEST, 1.0, STRONGEST)
    ticks, names = np.log(ends), [f"{it - 1:+.0%}" if it != 1 else "as usual" for it in ends]
    with styled():
        titles = [REGISTRY[it].title for it in NAMES]
        figure, panels = grid(titles, (11 / 3, 3.5), 3, Plot, sharex=True, sharey=True)
        norm = TwoSlopeNorm(0.0, ticks[0], ticks[-1])
        for axes, structure in zip(panels, NAMES, strict=True):
            image = _departures(axes, trends, rows[rows["structure"] == structure])
            drawn = axes.imshow(image, cmap="RdBu_r", norm=norm, aspect="auto")
        bar = figure.colorbar(drawn, ax=panels, shrink=0.5, label="time beside what is usual")
        bar.set_ticks(ticks.tolist(), labels=names)
    return figure


def _departures(axes: Axes, trends: Trends, rows: pd.DataFrame) -> np.ndarray:
    """(subjects, runs): logarithms of the figures over their medians; the marks drawn on top."""
    subjects = list(TITLES)
    usual = rows.groupby("subject")["value"].transform("median")
    table = rows.assign(off=np.log(rows["value"] / usual)).pivot_table("off", "subject", "run")
    changed = _changed(trends, rows["claim"])
    for part, what in ((rows[rows["before"].notna()], "step"), (changed, "verdict")):
        heights = part["claim"].map(lambda it: subjects.index(ClaimName.read(it).subject))
        _mark(axes, part["run"].to_numpy(), heights.to_numpy(), what, "black", 6)
    axes.set_yticks(range(len(subjects)), list(TITLES.values()), fontsize=7)
    axes.grid(visible=False)
    _name_commits(axes, trends)
    return table.reindex(index=subjects, columns=range(len(trends.runs))).to_numpy(float)
