"""How every plot looks: one color, line and marker per structure, labels at the lines."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from matplotlib.transforms import ScaledTranslation
from scipy.optimize import isotonic_regression

from hem.contract import Look
from structures import NAMED

Ends = dict[str, tuple[float, float, str]]
"""Where lines end: label -> (x, y, color) in data coordinates."""


LOOKS: dict[str, Look] = {name: it.look for name, it in NAMED.items()}
"""By structure, as each declares it: the same in every plot."""

GRAY = "#8a8a8a"
FADED = "#efefef"
RED = "#c23b22"

APART = 40.0
"""Points between the ends of two lines from which on their labels cannot meet."""

RC: Any = {
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "lines.linewidth": 1.6,
    "lines.markersize": 4,
    "figure.dpi": 110,
    "savefig.dpi": 150,
    "svg.fonttype": "none",
    "svg.hashsalt": "hem",
}


class Plot(Figure):
    """A figure of lines, bars and words, which a page shows as SVG; pictures are PNG."""


def short(structure: str) -> str:
    """The name of a structure that stands at its line."""
    return str(NAMED[structure].abbreviation)


def styled() -> Any:
    """A context in which figures are made."""
    return rc_context(RC)


def show_figures() -> None:
    """Let the interpreter that runs a notebook show plots as SVG and pictures as PNG."""
    from IPython.core.getipython import get_ipython
    from IPython.core.pylabtools import select_figure_formats

    shell: Any = get_ipython()
    if shell:
        select_figure_formats(shell, {"retina"})  # type: ignore[no-untyped-call]
        formatters = shell.display_formatter.formatters
        formatters["image/svg+xml"].for_type(Plot, svg)
        formatters["image/png"].for_type(Plot, lambda plot: None)


def svg(plot: Figure) -> str:
    """A plot as SVG with a transparent background and text that can be searched."""
    file = io.StringIO()
    with styled():
        plot.savefig(file, format="svg", transparent=True, metadata={"Date": None})
    return file.getvalue()


def panels(
    titles: Sequence[str], size: tuple[float, float] = (3.7, 2.8), columns: int = 3, **shared: Any
) -> tuple[Plot, list[Axes]]:
    """A figure with a titled logarithmic panel for each of ``titles``."""
    columns = min(columns, len(titles))
    rows = -(-len(titles) // columns)
    figure = Plot(figsize=(size[0] * columns, size[1] * rows + 0.3), layout="constrained")
    every = list(figure.subplots(rows, columns, squeeze=False, **shared).flat)
    for axes in every[len(titles) :]:
        axes.set_visible(False)
    for axes, title in zip(every, titles, strict=False):
        axes.set(xscale="log", yscale="log", title=title)
        short_numbers(axes)
    return figure, every[: len(titles)]


def short_numbers(axes: Axes) -> None:
    """Ticks at powers of ten alone, as 1k and 10k: what else there is takes long to draw."""
    for direction in (axes.xaxis, axes.yaxis):
        direction.set_major_locator(LogLocator(numticks=7))
        direction.set_major_formatter(FuncFormatter(lambda value, _: compact(value)))
        direction.set_minor_locator(NullLocator())


def compact(value: float) -> str:
    """A number that stands at a tick, such as ``10k``."""
    for size, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= size:
            return f"{value / size:g}{unit}"
    return f"{value:g}"


def fit_heights(shared: Iterable[Axes]) -> None:
    """One height axis for all these panels: that of their lines, with room above and below."""
    shared = list(shared)
    lines = [np.ravel(np.asarray(it.get_ydata(), float)) for axes in shared for it in axes.lines]
    heights = np.concatenate(lines or [np.ones(1)])
    for axes in shared:
        axes.set_ylim(heights.min() / 2.2, heights.max() * 2.2)


def finish_panels(
    figure: Figure, every: Iterable[Axes], ends: Sequence[Ends], room: float = 0.17
) -> None:
    """Label the lines. They need room beside the last point, and a settled layout before that."""
    shared = list(every)
    for axes, labels in zip(shared, ends, strict=True):
        if not labels:
            axes.text(0.5, 0.5, "not measured", transform=axes.transAxes, ha="center", color=GRAY)
    drawn = [axes for axes, labels in zip(shared, ends, strict=True) if labels]
    limits = np.array([axes.get_xlim() for axes in drawn])
    low, high = limits[:, 0].min(), limits[:, 1].max()
    for axes in shared:
        axes.set_xlim(low, high * (high / low) ** room)
    layout = figure.get_layout_engine()
    if layout:
        layout.execute(figure)
        figure.set_layout_engine("none")
    for axes, labels in zip(shared, ends, strict=True):
        label_ends(axes, labels)


def plain_numbers(axes: Axes) -> None:
    """Upright numbers also between the decades, where there is no whole one to be seen."""
    axes.margins(y=0.18)
    low, high = axes.get_ylim()
    marks = (1.0,) if high / low > 30 else (1.0, 2.0, 5.0)
    axes.yaxis.set_major_locator(LogLocator(subs=marks))


def label_ends(axes: Axes, ends: Mapping[str, tuple[float, float, str]], gap: float = 10.5) -> None:
    """Write each label to the right of its line's end, pushed apart to ``gap`` points.

    Lines that end elsewhere, by more than ``APART`` points, are not in each other's way. Call it
    when the axes' limits stand.
    """
    figure = axes.get_figure(root=True)
    assert figure is not None
    places = {
        label: axes.transData.transform((x, y)) * 72 / figure.dpi
        for label, (x, y, _) in ends.items()
    }
    groups: dict[int, list[str]] = {}
    for label in sorted(places, key=lambda label: float(places[label][1])):
        groups.setdefault(round(places[label][0] / APART), []).append(label)
    for labels in groups.values():
        heights = [float(places[label][1]) for label in labels]
        for label, old, new in zip(labels, heights, spread_apart(heights, gap), strict=True):
            x, y, color = ends[label]
            shift = ScaledTranslation(5 / 72, (new - old) / 72, figure.dpi_scale_trans)
            axes.text(
                x, y, label, color=color, va="center", fontsize=8,
                transform=axes.transData + shift, clip_on=False,
            )  # fmt: skip


def spread_apart(heights: list[float], gap: float) -> list[float]:
    """Ascending heights moved as little as need be to stand at least ``gap`` apart."""
    steps = gap * np.arange(len(heights))
    return [float(it) for it in isotonic_regression(np.array(heights) - steps).x + steps]
