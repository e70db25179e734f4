"""The figures of the notebooks: a run in, a figure out. Nothing is computed but medians."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from experiments.claims.growth import MEMORY, load_claims, title_of
from experiments.claims.judged import Evidence
from experiments.report.style import FADED, GRAY, LOOKS, label_ends, short, styled
from experiments.runs.results import Run
from hem.contract import QUERIES
from structures import NAMES, REGISTRY

Ends = dict[str, tuple[float, float, str]]

LISTINGS_AND_OPERATIONS = ("build", "split_edge", "split_face", "collapse_edge")
"""What is measured as printed and mended."""

MEASURES = {"time": (1e9, "time each, ns"), "work": (1.0, "elements accessed each")}
"""By measure: the factor to the unit that is drawn, and the label."""
VARIABLES = {"faces": "faces n_t", "valence": "valence n_ev"}


def scaling(run: Run, measure: str, variable: str, queries: Iterable[str] = QUERIES) -> Figure:
    """Cost against size or valence: a panel per query, a line per structure, both axes logarithmic.

    ``queries``: or operations. ``measure``: "time" or "work"; ``variable``: "faces" or "valence".
    Time of queries against size has
    random handles in bold, consecutive ones thin, and in gray below them the latency of the memory
    at the working set that a half-edge mesh of that size has.
    """
    evidence, names = Evidence(run), list(queries)
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    with styled():
        figure = Figure(figsize=(3.7 * columns, 2.8 * rows + 0.3), layout="constrained")
        panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        ends = [
            _panel(panel, evidence, measure, variable, query)
            for panel, query in zip(panels.flat, names, strict=False)
        ]
        for panel in panels.flat[len(names) :]:
            panel.set_visible(False)
        _fit_heights(panels.flat)
        for panel in panels[-1]:
            panel.set_xlabel(VARIABLES[variable])
        for panel in panels[:, 0]:
            panel.set_ylabel(MEASURES[measure][1])
        finish_panels(figure, panels.flat[: len(names)], ends)
    return figure


def _panel(axes: Axes, evidence: Evidence, measure: str, variable: str, query: str) -> Ends:
    scale, _ = MEASURES[measure]
    axes.set_title(title_of(query))
    axes.set(xscale="log", yscale="log")
    ends: Ends = {}
    in_both_orders = (measure, variable) == ("time", "faces") and query in QUERIES
    drawn = "random" if in_both_orders else measure
    for structure in NAMES:
        cells = evidence.curve(drawn, variable, structure, query)
        if cells.empty:
            continue
        x, y = cells[variable].to_numpy(float), scale * _centers(cells, measure)
        seen = y > 0  # nothing is read to unpack a handle
        look = LOOKS[structure]
        axes.plot(x[seen], y[seen], look.line, color=look.color, marker=look.marker)
        if seen.any():
            ends[short(structure)] = (x[seen][-1], y[seen][-1], look.color)
    if drawn == "random":
        _consecutive(axes, evidence, query)
        ends |= _latency_below(axes, evidence, query)
    return ends


def _consecutive(axes: Axes, evidence: Evidence, query: str) -> None:
    """Thin lines without marks: the same queries, asked in consecutive order."""
    for structure in NAMES:
        cells = evidence.curve("time", "faces", structure, query)
        x, y = cells["faces"].to_numpy(float), 1e9 * _centers(cells, "time")
        axes.plot(x, y, LOOKS[structure].line, color=LOOKS[structure].color, linewidth=0.7)


def _latency_below(axes: Axes, evidence: Evidence, query: str) -> Ends:
    cells = evidence.curve("random", "faces", "half_edge", query)
    latency = None if cells.empty else evidence.latency(cells["working_set"].to_numpy(float))
    if latency is None:
        return {}
    x, y = cells["faces"].to_numpy(float), 1e9 * latency
    axes.fill_between(x, y, 1e-3, color=FADED, linewidth=0, zorder=0)
    axes.plot(x, y, color=GRAY, linewidth=1)
    return {"latency": (x[-1], y[-1], GRAY)}


def _centers(cells: pd.DataFrame, measure: str) -> np.ndarray:
    center = np.mean if measure == "work" else np.median
    return np.array([center(samples) for samples in cells["samples"]])


def _fit_heights(panels: Iterable[Axes]) -> None:
    """One height axis for all these panels: that of their lines, with room above and below."""
    shared = list(panels)
    lines = [line for panel in shared for line in panel.lines]
    heights = np.concatenate([np.ravel(np.asarray(line.get_ydata(), float)) for line in lines])
    for panel in shared:
        panel.set_ylim(heights.min() / 2.2, heights.max() * 2.2)


def finish_panels(
    figure: Figure, panels: Iterable[Axes], ends: Sequence[Ends], room: float = 0.17
) -> None:
    """Label the lines. They need room beside the last point, and a settled layout before that."""
    shared = list(panels)
    limits = np.array([panel.get_xlim() for panel in shared])
    low, high = limits[:, 0].min(), limits[:, 1].max()
    for panel in shared:
        panel.set_xlim(low, high * (high / low) ** room)
    figure.draw_without_rendering()
    for panel, labels in zip(shared, ends, strict=True):
        label_ends(panel, labels)


def memory(run: Run) -> Figure:
    """Bytes per vertex, stacked by field: as printed, modeled with 8 and 4 bytes, and as traced.

    Of what is made of arrays; ``references`` has the objects.
    """
    evidence = Evidence(run)
    names = [name for name in NAMES if REGISTRY[name].compiled]
    printed = {it.structure: it.bytes_per_vertex for it in load_claims() if it.subject == MEMORY}
    with styled():
        figure = Figure(figsize=(11, 1.25 * len(names) + 1.1), layout="constrained")
        axes = figure.subplots()
        for row, structure in enumerate(names):
            for offset, reference_bytes in ((-0.19, 8), (0.19, 4)):
                cells = evidence.memory(structure, reference_bytes)
                if not cells.empty:
                    _bar(axes, row + offset, cells.iloc[-1], structure)
            if printed[structure]:
                mark = 2 * [float(printed[structure] or 0)]
                axes.plot(mark, [row - 0.42, row + 0.02], color="black", linewidth=2.5)
        axes.annotate(
            "printed in the thesis", (printed["indexed"] or 0, -0.42), (0, 4),
            textcoords="offset points", ha="center", fontsize=8, fontweight="bold",
        )  # fmt: skip
        axes.set_yticks(range(len(names)), [REGISTRY[name].title for name in names])
        axes.set(xlabel="bytes per vertex", xlim=(0, 350), ylim=(len(names) - 0.45, -0.75))
        axes.grid(axis="y", visible=False)
    return figure


def _bar(axes: Axes, height: float, cell: pd.Series, structure: str) -> None:
    """One stacked bar, its fields named inside where there is room; beside it what was traced."""
    fields, start = cell["detail"]["fields"], 0.0
    for k, (field, size) in enumerate(fields.items()):
        width = size / cell["vertices"]
        shade = 0.28 if k % 2 else 0.42
        axes.barh(
            height, width, 0.36, start, color=LOOKS[structure].color, alpha=shade, edgecolor="white"
        )
        if width >= 5.0 * len(field.split(".")[1]) * 0.42:
            axes.text(
                start + width / 2, height, field.split(".")[1].replace("_", " "),
                ha="center", va="center", fontsize=6.5,
            )  # fmt: skip
        start += width
    traced, peak = (cell["detail"][key] / cell["vertices"] for key in ("traced", "peak"))
    note = f"{start:g} B with {cell['reference_bytes']}-byte references · {traced:.1f} traced · "
    axes.text(start + 3, height, note + f"{peak:.0f} at the peak", va="center", fontsize=8)


def listings(run: Run, measure: str = "work") -> Figure:
    """What the thesis' listings cost as printed, and mended: a panel each, against size."""
    evidence, scale = Evidence(run), {"work": 1.0, "time": 1e6}[measure]
    label = {"work": "fields accessed each", "time": "time each, µs"}[measure]
    with styled():
        figure = Figure(figsize=(11, 3.0), layout="constrained")
        panels = figure.subplots(1, len(LISTINGS_AND_OPERATIONS))
        ends: list[Ends] = []
        for axes, what in zip(panels, LISTINGS_AND_OPERATIONS, strict=True):
            axes.set(xscale="log", yscale="log", title=title_of(what), xlabel="faces n_t")
            ends.append({})
            for structure, name in (("as_printed", "printed"), ("half_edge_objects", "mended")):
                cells = evidence.curve(measure, "faces", structure, what, "listings")
                if cells.empty:
                    continue
                x, y = cells["faces"].to_numpy(float), scale * _centers(cells, measure)
                look = LOOKS[structure]
                axes.plot(x, y, look.line, color=look.color, marker=look.marker)
                ends[-1][name] = (x[-1], y[-1], look.color)
        panels[0].set_ylabel(label)
        _fit_heights(panels[1:])
        finish_panels(figure, panels, ends, room=0.45)
    return figure


def references(run: Run) -> Figure:
    """Bytes per vertex of one half-edge mesh by what holds it: arrays, and objects."""
    evidence = Evidence(run)
    held = {
        f"arrays, {size}-byte references": _parts(evidence.memory("half_edge", size), "fields")
        for size in (4, 8)
    }
    objects = evidence.memory("half_edge_objects", 8)
    held["objects, as the thesis' runtime lays them out (model)"] = _parts(objects, "clr")
    held["objects, in Python (measured)"] = _parts(objects, "fields")
    with styled():
        figure = Figure(figsize=(11, 2.9), layout="constrained")
        axes = figure.subplots()
        for row, parts in enumerate(held.values()):
            start = 0.0
            for k, (part, size) in enumerate(parts.items()):
                color = LOOKS["half_edge" if row < 2 else "half_edge_objects"].color
                shade = 0.55 if k % 2 else 0.32
                axes.barh(row, size, 0.62, start, color=color, alpha=shade, edgecolor="white")
                if size > 5.5 * len(part):
                    axes.text(start + size / 2, row, part, ha="center", va="center", fontsize=7.5)
                start += size
            axes.text(start + 6, row, f"{start:,.0f}", va="center", fontsize=9, fontweight="bold")
        axes.set_yticks(range(len(held)), list(held))
        axes.set(xlabel="bytes per vertex", ylim=(len(held) - 0.4, -0.6))
        axes.margins(x=0.08)
        axes.grid(axis="y", visible=False)
    return figure


PARTS = {
    "positions": ("vertex.point",),
    "references": ("half_edge", "origin", "face", "next", "opposite", "twin"),
    "indices": ("index",),
    "event": ("position_changed",),
    "headers": ("header",),
    "padding": ("padding",),
    "lists": ("list",),
    "objects": ("object",),
}
"""What bytes are for, by the names of their fields."""


def _parts(cells: pd.DataFrame, kind: str) -> dict[str, float]:
    """Bytes per vertex by what they are for, at the largest size."""
    if cells.empty:
        return {}
    cell = cells.iloc[-1]
    sums = dict.fromkeys(PARTS, 0.0)
    for field, size in cell["detail"][kind].items():
        last = field.split(".")[1]
        part = next(it for it, names in PARTS.items() if field in names or last in names)
        sums[part] += size / cell["vertices"]
    return {part: size for part, size in sums.items() if size}


def building(run: Run) -> Figure:
    """Time to build, per vertex, against size: meshes as generated, and renumbered at random."""
    built = run.cases["experiment"] == "bench_build"
    cells = run.cases[built & (run.cases["reference_bytes"] == 4)]
    orders = {"consecutive": "as generated", "random": "renumbered at random"}
    with styled():
        figure = Figure(figsize=(8.6, 3.2), layout="constrained")
        panels = figure.subplots(1, 2, sharey=True)
        ends: list[Ends] = []
        for axes, (wanted, title) in zip(panels, orders.items(), strict=True):
            axes.set(xscale="log", yscale="log", title=f"Building, {title}", xlabel="vertices n_v")
            ends.append({})
            for structure in NAMES:
                mine = (cells["structure"] == structure) & (cells["order"] == wanted)
                line = cells[mine].sort_values("vertices")
                if line.empty:
                    continue
                x = line["vertices"].to_numpy(float)
                y = 1e9 * _centers(line, "time") / x
                look = LOOKS[structure]
                axes.plot(x, y, look.line, color=look.color, marker=look.marker)
                ends[-1][short(structure)] = (x[-1], y[-1], look.color)
        panels[0].set_ylabel("time per vertex, ns")
        panels[0].yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        finish_panels(figure, panels, ends)
    return figure


def overview(run: Run) -> Figure:
    """The study in one picture: the faces around a vertex, by work and by time."""
    evidence = Evidence(run)
    with styled():
        figure = Figure(figsize=(9, 3.4), layout="constrained")
        panels = figure.subplots(1, 2)
        ends = [
            _panel(panel, evidence, measure, "faces", "vertex_faces")
            for panel, measure in zip(panels, ("work", "time"), strict=True)
        ]
        for panel, measure in zip(panels, ("work", "time"), strict=True):
            panel.set(xlabel="faces n_t", ylabel=MEASURES[measure][1])
            panel.set_title(f"Vertex → Faces, {measure}")
            _fit_heights([panel])
        finish_panels(figure, panels, ends)
    return figure
