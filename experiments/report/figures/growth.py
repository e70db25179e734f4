"""Costs by the size of the mesh: a run in, a figure out. Nothing is computed but medians."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from experiments.bench_fracture import FIND, SHATTER, VISITED, WAYS
from experiments.bench_workloads import COMPILED, WORKLOADS
from experiments.claims import MIXES, break_even, curves
from experiments.harness import ANSWERING, QUERIES_TABLE, Axis
from experiments.report import style
from experiments.report.comparisons import medians
from experiments.report.session import require
from experiments.report.style import BLUE, GRAY, RED, STYLES, Plot
from experiments.runs import Run, tables
from hem.contract import QUERIES
from structures import NAMED, REGISTRY

RENDERED: dict[str, dict[str, Any]] = {
    "one by one": {"label": "no render mesh", "linestyle": "-", "color": GRAY},
    "in a transaction": {"label": "followed, one commit at the end", "linestyle": "--"},
    "rendered": {"label": "followed, a commit per edit", "linestyle": "-."},
    "render mesh built anew": {"label": "built anew after every edit", "linestyle": ":"},
}
"""The ways to keep a render mesh up to date, by the order of their cases, and their lines."""


def draw_lines(
    axes: Axes, cases: pd.DataFrame, x: str, by: str, styles: Mapping[str, Any], **look: Any
) -> None:
    """A line of ``cost`` against ``x`` for each value of the column ``by`` that has a style."""
    cases = cases[cases["cost"] > 0].sort_values(x)  # nothing is read to unpack a handle
    for name in styles:
        mine = cases[cases[by] == name]
        if len(mine):
            axes.plot(mine[x].to_numpy(float), mine["cost"].to_numpy(float), **styles[name] | look)


def draw(
    cases: pd.DataFrame, titles: Mapping[str, str], x: str, what: str, ylabel: str = "", *,
    panel: str = "subject", by: str = "structure", styles: Mapping[str, Any] = STYLES,
    also: Callable[[Axes, str], None] | None = None, room: float = 0.17, plain: bool = False,
    diagonals: bool = False, **layout: Any,
) -> Plot:  # fmt: skip
    """A panel per title, of the cases with its value in the column ``panel``: lines as above.

    ``also``: draws what else is in a panel; ``diagonals``: with lines to tell linear growth by.
    Raises MissingError if none has anything to draw.
    """
    with style.styled():
        figure, every = style.panels(list(titles.values()), **layout)
        for axes, name in zip(every, titles, strict=True):
            at: Any = axes.get_subplotspec()
            axes.set(xlabel=style.VARIABLES[x], ylabel=ylabel if at.is_first_col() else "")
            draw_lines(axes, cases[cases[panel] == name], x, by, styles)
            if also:
                also(axes, name)
            if layout.get("sharex"):
                axes.label_outer()
            if plain and axes.lines:
                low, high = _heights(axes)
                margin = max((high / low) ** 0.18, 1.05)  # of costs that are the same, too
                axes.set_ylim(low / margin, high * margin)
        require(any(map(style.labeled, every)), f"measured {what}")
        if layout.get("sharey"):  # what lies below the lines does not count
            low, high = _heights(*every)
            every[0].set_ylim(low / 2.2, high * 2.2)
        style.finish_panels(figure, every, room)
        for axes in every if diagonals else ():
            _draw_diagonals(axes)
    return figure


def _draw_diagonals(axes: Axes) -> None:
    """Dotted lines of slope 1, along the axis."""
    (left, right), (low, high) = axes.spines["bottom"].get_bounds(), axes.get_ylim()
    dotted: dict[str, Any] = {"color": "#9a9a9a", "linewidth": 0.8, "linestyle": (0, (1, 3))}
    for y in np.geomspace(low * left / right, high, 8)[1:-1]:
        axes.plot((left, right), (y, y * right / left), zorder=0, **dotted)


def _heights(*every: Axes) -> tuple[float, float]:
    """The lowest and the highest point of all lines."""
    heights = np.concatenate([line.get_ydata() for axes in every for line in axes.lines])
    return float(heights.min()), float(heights.max())


def _costs(run: Run, axis: Axis, subjects: Iterable[str], table: str = "") -> pd.DataFrame:
    """The cases of all structures along an axis, each with its ``cost`` in the axis' unit."""
    every = [(name, subject) for subject in subjects for name in NAMED]
    found = (curves(run).curve(axis, name, subject, table) for name, subject in every)
    return pd.concat([it.cases.assign(cost=axis.scale * it.centers) for it in found])


def scaling(run: Run, axis: Axis, subjects: Iterable[str] = QUERIES) -> Plot:
    """Cost along an axis: a panel per query or operation, a line per structure.

    Queries against size by time: in random order, and beside that in order, and the latency.
    """
    titles = {name: style.TITLES[name] for name in subjects}
    shape: dict[str, Any] = {"diagonals": True, "sharex": True, "sharey": True}
    label = style.axis_label(axis, QUERIES_TABLE.name)
    if axis is Axis.TIME_FACES and titles.keys() <= QUERIES.keys():
        axis, shape["also"] = Axis.RANDOM_FACES, partial(_draw_order_and_latency, run)
        label = f"time, {axis.unit}"
    elif axis is Axis.TIME_FACES:  # of operations, which no order of queries describes
        label = f"time at elements far apart, {axis.unit}"
    what = f"{axis.label} by {axis.variable}"
    return draw(_costs(run, axis, titles), titles, axis.variable, what, label, **shape)


def overview(run: Run) -> Plot:
    """The study in one picture: the faces around a vertex, by work and by time."""
    subject, shown = "vertex_faces", (Axis.WORK_FACES, Axis.RANDOM_FACES)
    kinds = Axis.WORK_FACES.label, "time, ns"
    titles = {axis.key: f"Vertex → Faces: {it}" for axis, it in zip(shown, kinds, strict=True)}
    costs = pd.concat(_costs(run, axis, [subject]).assign(axis=axis.key) for axis in shown)

    def also(axes: Axes, key: str) -> None:
        if key == Axis.RANDOM_FACES.key:
            _draw_order_and_latency(run, axes, subject)

    what = "the faces around a vertex"
    return draw(costs, titles, "faces", what, panel="axis", also=also, size=(4.5, 3.1), plain=True)


def _draw_order_and_latency(run: Run, axes: Axes, subject: str) -> None:
    """Thin lines for queries in order, and in gray the latency below them.

    It is that at the working set of a half-edge mesh, with a mark where that outgrows a cache.
    """
    thin = {"label": "_", "marker": "", "linewidth": 0.7}
    draw_lines(axes, _costs(run, Axis.TIME_FACES, [subject]), "faces", "structure", STYLES, **thin)
    cases = curves(run).curve(Axis.RANDOM_FACES, "half_edge", subject).cases
    latency = curves(run).latency(cases["working_set"].to_numpy(float))
    if len(cases) and latency is not None:
        x, y = cases["faces"].to_numpy(float), 1e9 * latency
        axes.fill_between(x, y, 1e-3, color=style.FADED, linewidth=0, zorder=0)
        axes.plot(x, y, color=GRAY, linewidth=1, label="latency")
        foot, look = axes.get_xaxis_transform(), dict[str, Any](fontsize=7, color=GRAY)
        for level, size in run.meta["machine"].get("caches", {}).items():
            held = 1024 * float(size.removesuffix("K"))
            if place := np.interp(held, cases["working_set"], x, left=0, right=0):
                axes.vlines(place, 0, 0.05, GRAY, linewidth=1, transform=foot)
                axes.annotate(level, (place, 0), (3, 3), foot, "offset points", **look)


def listings(run: Run, axis: Axis = Axis.WORK_FACES) -> Plot:
    """What the thesis' listings cost as published and as corrected: a panel each, against size."""
    table = tables()["listings"]
    costs = _costs(run, axis, table.subjects, table.name)
    label, scale = axis.label_in(table.name), 1.0
    if not axis.exact:
        label, scale = f"{label}, µs", 1e-3
    costs = costs.assign(cost=scale * costs["cost"])
    shape: dict[str, Any] = {"room": 0.45, "columns": 4, "size": (2.75, 2.7), "plain": True}
    return draw(costs, table.subjects, "faces", "the thesis' listings", label, **shape)


def building(run: Run) -> Plot:
    """Time to build, per vertex, against size: meshes as generated, and renumbered at random."""
    cases = medians(run, "bench_build", 1e9).query("reference_bytes == 4")
    cases = cases.assign(cost=cases["cost"] / cases["vertices"])
    titles = {"consecutive": "Building, as generated", "random": "Building, renumbered at random"}
    if (cases["order"] == ANSWERING).any():
        titles[ANSWERING] = "Building, and finding neighbors"
    shape: dict[str, Any] = {"panel": "order", "plain": True, "size": (4.3, 2.9), "sharey": True}
    return draw(cases, titles, "vertices", "building", "time per vertex, ns", **shape)


def rendering(run: Run) -> Plot:
    """What a render mesh adds to one edit of a half-edge mesh from Python, by size."""
    cases = medians(run, "bench_operations", 1e6).query("structure == 'half_edge'")
    look = {"color": STYLES["half_edge"]["color"], "marker": "o"}
    styles = {order: look | it for order, it in RENDERED.items()}
    titles = {"split_face": "Splitting a face from Python, half-edge mesh"}
    shape: dict[str, Any] = {"room": 0.75, "plain": True, "size": (7.5, 3.3), "styles": styles}
    what, label = "operations with a render mesh", "time per edit, µs"
    return draw(cases, titles, "faces", what, label, by="order", **shape)


def workloads(run: Run, order: str = COMPILED) -> Plot:
    """Time per unit of every measured workload, by size: compiled or from Python, never both."""

    def also(axes: Axes, name: str) -> None:
        axes.set_ylabel(f"time per {WORKLOADS[name].unit}, µs")

    cases = medians(run, "bench_workloads", 1e6).query("order == @order")
    measured = set(cases["subject"]) or WORKLOADS.keys()
    titles = {name: it.title for name, it in WORKLOADS.items() if name in measured}
    return draw(cases, titles, "vertices", f"any workload {order}", also=also, plain=True)


def overtaking(run: Run) -> Plot:
    """How many queries or edits after building each structure overtakes the indexed mesh."""
    table = break_even(curves(run)).query("times < inf")
    table = table.assign(cost=table["times"].clip(lower=1e-9))

    def also(axes: Axes, _: str) -> None:
        axes.set_yscale("symlog")
        axes.yaxis.set_major_formatter(lambda value, _: style.compact(value))
        axes.set_ylim(0, 2 * max([1.0, *table["times"]]))

    titles = {name: title.capitalize() for name, title in MIXES.items()}
    what = "on one machine building and queries of the same meshes, beside an indexed mesh"
    shape: dict[str, Any] = {"also": also, "room": 0.3, "columns": 4, "size": (2.75, 2.9)}
    return draw(table, titles, "vertices", what, "how many until building is repaid", **shape)


def shards_per_second(run: Run) -> Plot:
    """How many shards each compiled structure makes a second, by size."""
    cases = medians(run, "bench_fracture")
    cases = cases[cases["structure"].isin([name for name, it in REGISTRY.items() if it.compiled])]
    cases = cases.assign(cost=1 / cases["cost"])
    titles, label = {SHATTER: "Breaking a surface around an impact"}, "shards per second"
    return draw(cases, titles, "faces", "how a surface breaks", label, size=(7.5, 3.5))


def face_finding(run: Run) -> Plot:
    """Finding the face under an impact in three ways: faces looked at, and time."""
    looks = zip(WAYS, (BLUE, RED, GRAY), "oDs", strict=True)
    styles = {way: {"label": way, "color": color, "marker": it} for way, color, it in looks}
    titles = {VISITED: f"{VISITED.capitalize()}, mean", "": "Time each, µs"}
    found = []
    for way in WAYS:
        for measure, order, scale in ((VISITED, f"{way}, {VISITED}", 1.0), ("", way, 1e6)):
            curve = curves(run).named("bench_fracture", "half_edge", FIND, order)
            costs: dict[str, Any] = {"cost": scale * curve.centers, "way": way, "measure": measure}
            found.append(curve.cases.assign(**costs))
    shape: dict[str, Any] = {"room": 0.45, "plain": True, "size": (5.2, 3.2), "panel": "measure"}
    what = "how a face is found"
    return draw(pd.concat(found), titles, "faces", what, by="way", styles=styles, **shape)
