"""The line plots of the chapters: a run in, a figure out. Nothing is computed but medians."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from experiments.bench_fracture import FIND, VISITED, WAYS
from experiments.claims import MIXES, break_even, curves
from experiments.harness import OPERATIONS, WORKLOADS, Axis
from experiments.report.session import MissingError
from experiments.report.style import (
    FADED,
    GRAY,
    LOOKS,
    RED,
    Ends,
    Plot,
    finish_panels,
    fit_heights,
    panels,
    plain_numbers,
    styled,
)
from experiments.runs import Run
from hem.contract import QUERIES
from structures import NAMED

TITLES = {**{name: query.title for name, query in QUERIES.items()}, **OPERATIONS}
VARIABLES = {"faces": "faces n_t", "valence": "valence n_ev", "vertices": "vertices n_v"}

RENDERED = {
    "one by one": ("no render mesh", "-"),
    "in a transaction": ("followed, one commit at the end", "--"),
    "rendered": ("followed, a commit per edit", "-."),
    "render mesh built anew": ("built anew after every edit", ":"),
}
"""The ways to keep a render mesh up to date, by the order of their cases."""


def lines_by_structure(
    axes: Axes, cases: pd.DataFrame, x: str, scale: float, values: str = "samples"
) -> Ends:
    """A line per structure: medians of times or means of counts, times ``scale``, against ``x``."""
    ends: Ends = {}
    for name, kind in NAMED.items():
        mine = cases[cases["structure"] == name].sort_values(x)
        heights = scale * _centers(mine, values)
        seen = heights > 0  # nothing is read to unpack a handle
        if seen.any():
            across, heights = mine[x].to_numpy(float)[seen], heights[seen]
            look = LOOKS[name]
            axes.plot(across, heights, look.line, color=look.color, marker=look.marker)
            ends[kind.abbreviation] = (across[-1], heights[-1], look.color)
    return ends


def _centers(cases: pd.DataFrame, values: str) -> np.ndarray:
    """The mean of counts, the median of times; a column of numbers as it is."""
    if values != "samples":
        return cases[values].to_numpy(float)
    kinds = zip(cases["kind"], cases["samples"], strict=True)
    return np.array([np.mean(it) if kind == "work" else np.median(it) for kind, it in kinds])


def _draw(
    titles: Mapping[str, str],
    x: str,
    fill: Callable[[Axes, str], Ends],
    what: str,
    ylabel: str = "",
    room: float = 0.17,
    **layout: object,
) -> Plot:
    """A panel per title, filled by ``fill``. Raises MissingError if none has anything to draw."""
    with styled():
        figure, every = panels(list(titles.values()), **layout)  # type: ignore[arg-type]
        ends = [fill(axes, name) for axes, name in zip(every, titles, strict=True)]
        if not any(ends):
            raise MissingError(f"This run has not measured {what}.")
        if layout.get("sharey"):
            fit_heights(every)
        for axes in every:
            at = axes.get_subplotspec()
            if at is None or at.is_last_row() or not layout.get("sharex"):
                axes.set_xlabel(VARIABLES[x])
            if ylabel and (at is None or at.is_first_col()):
                axes.set_ylabel(ylabel)
        finish_panels(figure, every, ends, room)
    return figure


def scaling(run: Run, axis: Axis, subjects: Iterable[str] = QUERIES) -> Plot:
    """Cost along an axis: a panel per query or operation, a line per structure.

    Time of queries against size has random handles in bold, consecutive ones thin, and in gray
    below them the latency of the memory at the working set that a half-edge mesh of that size has.
    """
    titles = {name: TITLES[name] for name in subjects}
    label = f"{axis.label}, {axis.unit}" if axis.unit else axis.label
    shape = {"sharex": True, "sharey": True}
    return _draw(
        titles, axis.variable, lambda axes, name: _scaled(axes, run, axis, name),
        f"{axis.label} by {axis.variable}", label, **shape,
    )  # fmt: skip


def _scaled(axes: Axes, run: Run, axis: Axis, subject: str) -> Ends:
    in_both_orders = axis is Axis.TIME_FACES and subject in QUERIES
    bold = Axis.RANDOM_FACES if in_both_orders else axis
    ends = lines_by_structure(axes, _cases(run, bold, subject), axis.variable, axis.scale)
    if in_both_orders:
        for name, thin in _cases(run, axis, subject).groupby("structure"):
            look = LOOKS[str(name)]
            times = axis.scale * _centers(thin, "samples")
            axes.plot(thin["faces"], times, look.line, color=look.color, linewidth=0.7)
        ends |= _latency_below(axes, run, subject)
    return ends


def _cases(run: Run, axis: Axis, subject: str, table: str = "") -> pd.DataFrame:
    """The cases of all structures along an axis."""
    return pd.concat([curves(run).curve(axis, name, subject, table).cases for name in NAMED])


def _latency_below(axes: Axes, run: Run, subject: str) -> Ends:
    cases = curves(run).curve(Axis.RANDOM_FACES, "half_edge", subject).cases
    latency = None
    if len(cases):
        latency = curves(run).latency(cases["working_set"].to_numpy(float))
    if latency is None:
        return {}
    x, y = cases["faces"].to_numpy(float), 1e9 * latency
    axes.fill_between(x, y, 1e-3, color=FADED, linewidth=0, zorder=0)
    axes.plot(x, y, color=GRAY, linewidth=1)
    return {"latency": (x[-1], y[-1], GRAY)}


def overview(run: Run) -> Plot:
    """The study in one picture: the faces around a vertex, by work and by time."""
    titles = {
        axis.key: f"Vertex → Faces, {axis.label}" for axis in (Axis.WORK_FACES, Axis.TIME_FACES)
    }
    by_key = {axis.key: axis for axis in Axis}
    return _draw(
        titles, "faces", lambda axes, key: _scaled(axes, run, by_key[key], "vertex_faces"),
        "the faces around a vertex", size=(4.5, 3.1),
    )  # fmt: skip


def listings(run: Run, axis: Axis = Axis.WORK_FACES) -> Plot:
    """What the thesis' listings cost as published and as corrected: a panel each, against size."""
    from experiments.bench_printed import EXPERIMENT

    assert EXPERIMENT.table is not None
    table, scale = EXPERIMENT.table, axis.scale / (1 if axis.exact else 1000)
    label = axis.label if axis.exact else f"{axis.label}, µs"
    return _draw(
        table.subjects, "faces",
        lambda axes, name: lines_by_structure(
            axes, _cases(run, axis, name, table.name), "faces", scale
        ),
        "the thesis' listings", label, 0.45, columns=4, size=(2.75, 2.7),
    )  # fmt: skip


def building(run: Run) -> Plot:
    """Time to build, per vertex, against size: meshes as generated, and renumbered at random."""
    cases = run.cases.query("experiment == 'bench_build' and reference_bytes == 4")
    each = [np.median(it) / n for it, n in zip(cases["samples"], cases["vertices"], strict=True)]
    cases = cases.assign(each=np.array(each, float))
    titles = {"consecutive": "Building, as generated", "random": "Building, renumbered at random"}

    def fill(axes: Axes, order: str) -> Ends:
        ends = lines_by_structure(axes, cases[cases["order"] == order], "vertices", 1e9, "each")
        plain_numbers(axes)
        return ends

    return _draw(
        titles, "vertices", fill, "building", "time per vertex, ns", size=(4.3, 2.9), sharey=True
    )


def rendering(run: Run, structure: str = "half_edge") -> Plot:
    """What a render mesh adds to one edit from Python, by size."""
    cases = run.cases.query("experiment == 'bench_operations' and subject == 'split_face'")
    cases = cases[cases["structure"] == structure].sort_values("faces")
    title = f"Splitting a face from Python, {NAMED[structure].title.lower()} mesh"

    def fill(axes: Axes, _: str) -> Ends:
        ends: Ends = {}
        for order, (label, line) in RENDERED.items():
            mine = cases[cases["order"] == order]
            if len(mine):
                x, y = mine["faces"].to_numpy(float), 1e6 * _centers(mine, "samples")
                color = GRAY if order == "one by one" else LOOKS[structure].color
                axes.plot(x, y, line, color=color, marker="o")
                ends[label] = (x[-1], y[-1], "black")
        plain_numbers(axes)
        return ends

    return _draw(
        {"": title}, "faces", fill, "operations with a render mesh", "time per edit, µs", 0.75,
        size=(7.5, 3.3),
    )  # fmt: skip


def workloads(run: Run) -> Plot:
    """Time per unit of every workload, by size."""
    cases = run.cases[run.cases["experiment"] == "bench_workloads"]

    def fill(axes: Axes, name: str) -> Ends:
        ends = lines_by_structure(axes, cases[cases["subject"] == name], "vertices", 1e6)
        axes.set_ylabel(f"time per {WORKLOADS[name].unit}, µs")
        plain_numbers(axes)
        return ends

    titles = {name: workload.title for name, workload in WORKLOADS.items()}
    return _draw(titles, "vertices", fill, "any workload")


def overtaking(run: Run) -> Plot:
    """After how many queries or edits per build each structure overtakes the indexed mesh."""
    table = break_even(curves(run))
    table = table[np.isfinite(table["times"].astype(float))]

    def fill(axes: Axes, subject: str) -> Ends:
        axes.set_yscale("symlog")
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        mine = table[table["subject"] == subject].assign(
            level=lambda rows: rows["times"].clip(lower=1e-9)
        )
        ends = lines_by_structure(axes, mine, "vertices", 1.0, "level")
        axes.set_ylim(0, 2 * max(table["times"], default=1.0))
        return ends

    return _draw(
        {name: title.capitalize() for name, title in MIXES.items()}, "vertices", fill,
        "building and queries or operations of the same meshes, beside an indexed mesh",
        "how many per build", 0.3, columns=4, size=(2.75, 2.9),
    )  # fmt: skip


def shards_per_second(run: Run) -> Plot:
    """How many shards each structure makes a second, by size."""
    cases = run.cases.query("experiment == 'bench_fracture' and subject == 'shatter'")
    cases = cases.assign(rate=[float(1 / np.median(it)) for it in cases["samples"]])
    return _draw(
        {"": "Breaking a surface around an impact"},
        "faces",
        lambda axes, _: lines_by_structure(axes, cases, "faces", 1.0, "rate"),
        "how a surface breaks",
        "shards per second",
        size=(7.5, 3.5),
    )


def face_finding(run: Run, structure: str = "half_edge") -> Plot:
    """Finding the face under an impact in three ways: faces looked at, and time."""
    looks = zip(WAYS, ((LOOKS["winged_edge"].color, "o"), (RED, "D"), (GRAY, "s")), strict=True)
    styles = dict(looks)

    def fill(axes: Axes, suffix: str) -> Ends:
        ends: Ends = {}
        for way, (color, marker) in styles.items():
            curve = curves(run).named("bench_fracture", structure, FIND, way + suffix)
            if len(curve):
                heights = (1.0 if suffix else 1e6) * curve.centers
                axes.plot(curve.sizes, heights, color=color, marker=marker)
                ends[way] = (curve.sizes[-1], heights[-1], color)
        plain_numbers(axes)
        return ends

    titles = {f", {VISITED}": VISITED.capitalize(), "": "Time each, µs"}
    return _draw(titles, "faces", fill, "how a face is found", room=0.45, size=(5.2, 3.2))
