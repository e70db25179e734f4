"""How every plot looks: one color, line and marker per structure, labels at the lines."""

import io
from collections.abc import Iterable, Sequence
from colorsys import hls_to_rgb, rgb_to_hls
from functools import partial
from itertools import product, zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context, rc_params_from_file
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator
from scipy.optimize import isotonic_regression

from experiments.harness import OPERATIONS, QUERIES_TABLE, Axis
from structures import NAMED

STYLES: dict[str, dict[str, Any]] = {
    name: {"label": it.abbreviation, "linestyle": it.look.line,
           "color": it.look.color, "marker": it.look.marker}
    for name, it in NAMED.items()
}  # fmt: skip
"""How Matplotlib draws the line of a structure, as each declares it: the same in every plot."""

TITLES = {**QUERIES_TABLE.subjects, **OPERATIONS}
"""The queries and the operations, and what a panel or a row of them is called."""

VARIABLES = {"faces": "faces n_t", "valence": "valence n_ev", "vertices": "vertices n_v"}
GRAY = "#737373"
FADED = "#efefef"
RED = "#c23b22"
BLUE = "#2f7fc1"

GAP = 10.5  # points from one label to the next
APART = 40.0  # points between the ends of two lines from which on their labels cannot meet
SIDES = {5: "left", 0: "center", -5: "right"}  # of a label, by its points from the end of its line
RC = rc_params_from_file(Path(__file__).parent / "static" / "hem.mplstyle", False, False)
styled = partial(rc_context, RC)
"""A context in which figures are made."""


class Plot(Figure):
    """A figure of lines, bars and words, which a page shows as SVG; pictures are PNG."""


def show_figures() -> None:
    """Let the interpreter that runs a notebook show plots as SVG and pictures as PNG."""
    from IPython.core.getipython import get_ipython

    shell: Any = get_ipython()
    if shell:
        formatters = shell.display_formatter.formatters
        formatters["image/svg+xml"].for_type(Plot, lambda plot: (svg(plot), {"alt": words(plot)}))
        formatters["image/png"].for_type(Figure, _picture)
        formatters["image/png"].for_type(Plot, lambda plot: None)


def _picture(figure: Figure) -> Any:
    from IPython.core.pylabtools import retina_figure

    data, size = retina_figure(figure, base64=True)  # type: ignore[no-untyped-call]
    return data, size | {"alt": words(figure)}


def svg(plot: Figure) -> str:
    """A plot as SVG with a transparent background and text that can be searched."""
    file = io.StringIO()
    with styled():
        plot.savefig(file, format="svg", transparent=True, metadata={"Date": None})
    return file.getvalue()


def words(plot: Figure) -> str:
    """A plot for those who do not see it: its panels, and from where to where each line goes."""
    told = []
    for axes in (it for it in plot.axes if it.get_visible()):
        lines = []
        for line in labeled(axes):
            ends = np.asarray(line.get_ydata(), float)[[0, -1]]
            first, last = (compact(float(f"{y:.2g}")) for y in ends)
            lines.append(f"{line.get_label()} {first} to {last}")
        title = axes.get_title("left").replace("\n", " ")
        about = ", ".join(filter(None, [title, axes.get_ylabel()]))
        told.append(": ".join(filter(None, [about, "; ".join(lines)])))
    return ". ".join(filter(None, told))


def panels(
    titles: Sequence[str], size: tuple[float, float] = (3.7, 2.8), columns: int = 3, **shared: Any
) -> tuple[Plot, list[Axes]]:
    """A plot with a titled logarithmic panel for each of ``titles``."""
    plot, every = grid(titles, size, columns, Plot, **shared)
    plot.set_figheight(plot.get_figheight() + 0.3)
    for axes in every:
        axes.set(xscale="log", yscale="log")
        short_numbers(axes)
    return plot, every


class Tens(LogLocator):
    """Ticks at powers of ten, and closer ones on a short axis."""

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """The widest of which two are to be seen, between these limits and beside them."""
        closer = LogLocator(subs=(1.0, 2.0, 5.0)), MaxNLocator(4)
        tries = [super().tick_values, *(it.tick_values for it in closer)]
        every = (find(vmin, vmax) for find in tries)
        return next((it for it in every if len(inside(it, vmin, vmax)) > 1), [])


def inside(ticks: Iterable[float], low: float, high: float) -> list[float]:
    """The ticks that are within these limits."""
    return [it for it in ticks if low <= it <= high]


def short_numbers(axes: Axes) -> None:
    """Few ticks, as 1k and 10k: what else there is takes long to draw."""
    for direction in (axes.xaxis, axes.yaxis):
        direction.set_major_locator(Tens(numticks=7))
        direction.set_major_formatter(lambda value, _: compact(value))
        direction.set_minor_locator(NullLocator())


def compact(value: float) -> str:
    """A number that stands at a tick, such as ``10k``."""
    for size, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= size:
            return f"{value / size:g}{unit}"
    return f"{value:g}"


def axis_label(axis: Axis, table: str) -> str:
    """What is measured of a table along an axis, with its unit."""
    return ", ".join(filter(None, (axis.label_in(table), axis.unit)))


def labeled(axes: Axes) -> list[Line2D]:
    """The lines that have a label."""
    return [line for line in axes.lines if not str(line.get_label()).startswith("_")]


def finish_panels(figure: Figure, every: Sequence[Axes], room: float = 0.17) -> None:
    """Label the lines. They need room beside the axis, and a settled layout before that."""
    limits = np.array([axes.get_xlim() for axes in every if labeled(axes)])
    low, high = limits[:, 0].min(), limits[:, 1].max()
    for axes in every:
        axes.set_xlim(low, high)
        axes.set_xticks(inside(axes.get_xticks(), low, high))
        axes.spines["bottom"].set_bounds(low, high)
        axes.xaxis.label.set_x(0.5 / (1 + room))
        axes.set_xlim(low, high * (high / low) ** room)
        if not labeled(axes):
            axes.text(0.5, 0.5, "not measured", transform=axes.transAxes, ha="center", color=GRAY)
    if layout := figure.get_layout_engine():
        layout.execute(figure)
        figure.set_layout_engine("none")
    for axes in every:
        label_ends(axes)


def label_ends(axes: Axes) -> None:
    """Write each line's label to the right of its end, above the axis, ``GAP`` points apart.

    Lines that end elsewhere, by more than ``APART`` points, are not in each other's way; where
    others go on, a label stands aside of them. Call it when the axes' limits stand.
    """
    figure: Any = axes.get_figure(root=True)
    lines = labeled(axes)
    last = np.array([np.asarray(line.get_xydata())[-1] for line in lines]).reshape(-1, 2)
    across, up = (axes.transData.transform(last) * 72 / figure.dpi).T
    side_by_side = np.argsort(across)
    breaks = np.flatnonzero(np.diff(across[side_by_side]) > APART) + 1
    for group in np.split(side_by_side, breaks):
        upward = group[np.argsort(up[group], kind="stable")]
        lowest = axes.bbox.y0 * 72 / figure.dpi + GAP * (np.arange(len(group)) + 0.5)
        places = np.maximum(spread_apart(up[upward].tolist(), GAP), lowest)
        for i, place in zip(upward[::-1], places[::-1], strict=True):
            label = axes.annotate(
                str(lines[i].get_label()), last[i], (5, place - up[i]), textcoords="offset points",
                annotation_clip=False, color=darker(lines[i].get_color()), va="center", fontsize=8,
            )  # fmt: skip
            if last[i, 0] < last[:, 0].max():
                _step_aside(label, axes)


def _step_aside(label: Annotation, axes: Axes) -> None:
    """Move a label as little as need be to where it lies over no line and no other label."""
    lines = [it.get_transform().transform_path(it.get_path()) for it in axes.lines]
    others = [it.get_window_extent() for it in axes.texts if it is not label]
    _, y = start = label.get_position()
    for shift, (x, side) in product(sorted(range(-40, 41, 2), key=abs), SIDES.items()):
        label.set(position=(x, y + shift), ha=side)
        box = label.get_window_extent()
        inside = axes.bbox.contains(*box.min) and axes.bbox.contains(*box.max)
        struck = any(it.intersects_bbox(box, filled=False) for it in lines)
        if inside and not struck and not box.count_overlaps(others):
            return
    label.set(position=start, ha="left")


def darker(color: Any) -> tuple[float, ...]:
    """A color as small letters have to have it to be read on white."""
    hue, lightness, saturation = rgb_to_hls(*to_rgb(color))
    return hls_to_rgb(hue, min(lightness, 0.3), saturation)


def spread_apart(heights: list[float], gap: float) -> list[float]:
    """Ascending heights moved as little as need be to stand at least ``gap`` apart."""
    steps = gap * np.arange(len(heights))
    return [float(it) for it in isotonic_regression(np.array(heights) - steps).x + steps]


def grid(
    titles: Sequence[str], size: tuple[float, float], columns: int = 99, kind: Any = Figure,
    **shared: Any,
) -> tuple[Any, list[Axes]]:  # fmt: skip
    """A figure with a titled panel of this size, in inches, for each of ``titles``."""
    columns = min(columns, len(titles))
    rows = -(-len(titles) // columns)
    figure = kind(figsize=(size[0] * columns, size[1] * rows), layout="constrained")
    every = list(figure.subplots(rows, columns, squeeze=False, **shared).flat)
    for axes, title in zip_longest(every, titles):
        axes.set_visible(title is not None)
        axes.set_title(title or "")
    return figure, every[: len(titles)]
