"""The figures of the chapters on operations: a run in, a figure out."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from experiments.claims.breakeven import MIXES, break_even
from experiments.harness.workloads import WORKLOADS
from experiments.report.figures import Ends, finish_panels
from experiments.report.style import GRAY, LOOKS, short, styled
from experiments.runs.results import Run
from structures import NAMES, REGISTRY

RENDERED = {
    "one by one": ("no render mesh", "-"),
    "in a transaction": ("followed, one commit at the end", "--"),
    "rendered": ("followed, a commit per edit", "-."),
    "render mesh built anew": ("built anew after every edit", ":"),
}
"""The ways to keep a render mesh up to date, by the order of their cells."""


def rendering(run: Run, structure: str = "half_edge") -> Figure:
    """What a render mesh adds to one edit from Python, by size."""
    cells = run.cases[run.cases["experiment"] == "bench_operations"]
    cells = cells[(cells["structure"] == structure) & (cells["subject"] == "split_face")]
    with styled():
        figure = Figure(figsize=(7.5, 3.6), layout="constrained")
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log", xlabel="faces n_t", ylabel="time per edit, µs")
        axes.set_title(f"Splitting a face from Python, {REGISTRY[structure].title.lower()} mesh")
        ends: Ends = {}
        for order, (label, line) in RENDERED.items():
            x, y = _line(cells[cells["order"] == order], "faces")
            if len(x):
                color = GRAY if order == "one by one" else LOOKS[structure].color
                axes.plot(x, 1e6 * y, line, color=color, marker="o")
                ends[label] = (x[-1], 1e6 * y[-1], "black")
        _plain_numbers(axes)
        finish_panels(figure, [axes], [ends], room=0.75)
    return figure


def workloads(run: Run) -> Figure:
    """Time per unit of every workload, by size."""
    cells = run.cases[run.cases["experiment"] == "bench_workloads"]
    with styled():
        figure = Figure(figsize=(11, 5.6), layout="constrained")
        panels = figure.subplots(2, 3, sharex=True)
        ends: list[Ends] = []
        for axes, (name, workload) in zip(panels.flat, WORKLOADS.items(), strict=False):
            axes.set(xscale="log", yscale="log", ylabel=f"time per {workload.unit}, µs")
            axes.set_title(workload.title)
            ends.append(_lines(axes, cells[cells["subject"] == name], "vertices", 1e6))
            axes.tick_params(labelbottom=True)
            axes.set_xlabel("vertices n_v")
            _plain_numbers(axes)
        for axes in panels.flat[len(WORKLOADS) :]:
            axes.set_visible(False)
        finish_panels(figure, panels.flat[: len(WORKLOADS)], ends)
    return figure


def overtaking(run: Run) -> Figure:
    """After how many queries or edits per build each structure overtakes the indexed mesh."""
    table = break_even(run)
    with styled():
        figure = Figure(figsize=(11, 3.2), layout="constrained")
        panels = figure.subplots(1, len(MIXES), sharey=True, sharex=True)
        ends: list[Ends] = []
        for axes, (what, title) in zip(panels, MIXES.items(), strict=True):
            axes.set(xscale="log", yscale="symlog", xlabel="vertices n_v", title=title.capitalize())
            ends.append({})
            for structure in NAMES[1:]:
                mine = table[(table["what"] == what) & (table["structure"] == structure)]
                mine = mine[np.isfinite(mine["times"])]
                if len(mine):
                    look = LOOKS[structure]
                    x, y = mine["vertices"].to_numpy(float), mine["times"].to_numpy(float)
                    axes.plot(x, y, look.line, color=look.color, marker=look.marker)
                    ends[-1][short(structure)] = (x[-1], y[-1], look.color)
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        panels[0].set_ylabel("how many per build")
        most = table["times"][np.isfinite(table["times"])].max()
        panels[0].set_ylim(0, 2 * most)
        finish_panels(figure, panels, ends, room=0.3)
    return figure


def _lines(axes: Axes, cells: pd.DataFrame, variable: str, scale: float) -> Ends:
    ends: Ends = {}
    for structure in NAMES:
        x, y = _line(cells[cells["structure"] == structure], variable)
        if len(x):
            look = LOOKS[structure]
            axes.plot(x, scale * y, look.line, color=look.color, marker=look.marker)
            ends[short(structure)] = (x[-1], scale * y[-1], look.color)
    return ends


def _line(cells: pd.DataFrame, variable: str) -> tuple[np.ndarray, np.ndarray]:
    cells = cells.sort_values(variable)
    medians = np.array([float(np.median(it)) for it in cells["samples"]])
    return cells[variable].to_numpy(float), medians


def _plain_numbers(axes: Axes) -> None:
    """Numbers without powers, also between the decades where there is no whole one to be seen."""
    axes.margins(y=0.18)
    low, high = axes.get_ylim()
    marks = (1.0,) if high / low > 30 else (1.0, 2.0, 5.0)
    axes.yaxis.set_major_locator(LogLocator(subs=marks))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
