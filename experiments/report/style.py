"""How every plot looks: one color, line and marker per structure, labels at the lines."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.transforms import ScaledTranslation

from hem.contract import Look
from structures import NAMED

LOOKS: dict[str, Look] = {name: it.look for name, it in NAMED.items()}
"""By structure, as each declares it: the same in every plot."""

GRAY = "#8a8a8a"
FADED = "#efefef"

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
}


def styled() -> Any:
    """A context in which figures are made."""
    return rc_context(RC)


def short(structure: str) -> str:
    """The name that stands at a line."""
    return str(NAMED[structure].abbreviation)


def label_ends(axes: Axes, ends: Mapping[str, tuple[float, float, str]], gap: float = 10.5) -> None:
    """Write each label to the right of its line's end, pushed apart to ``gap`` points.

    Lines that end elsewhere, by more than ``APART`` points, are not in each other's way.
    ``ends``: label -> (x, y, color) in data coordinates. Call it when the axes' limits stand.
    """
    figure = axes.get_figure(root=True)
    assert figure is not None
    points = figure.dpi / 72
    placed = {
        label: float(axes.transData.transform((x, y))[1]) / points
        for label, (x, y, _) in ends.items()
    }
    across = {
        label: float(axes.transData.transform((x, y))[0]) / points
        for label, (x, y, _) in ends.items()
    }
    groups: dict[int, list[str]] = {}
    for label in sorted(placed, key=lambda label: placed[label]):
        groups.setdefault(round(across[label] / APART), []).append(label)
    moved = {
        label: height
        for order in groups.values()
        for label, height in zip(
            order, spread_apart([placed[label] for label in order], gap), strict=True
        )
    }
    for label, height in moved.items():
        x, y, color = ends[label]
        shift = ScaledTranslation(5 / 72, (height - placed[label]) / 72, figure.dpi_scale_trans)
        axes.text(
            x, y, label, color=color, va="center", fontsize=8, transform=axes.transData + shift,
            clip_on=False,
        )  # fmt: skip


def spread_apart(heights: list[float], gap: float) -> list[float]:
    """Ascending heights moved as little as need be to stand at least ``gap`` apart.

    Neighbors that are too close become a block around their mean, which may grow by others.
    """
    blocks: list[list[float]] = []  # mean, how many
    for height in heights:
        blocks.append([height, 1])
        while len(blocks) > 1 and _top(blocks[-2], gap) + gap > _bottom(blocks[-1], gap):
            mean, count = blocks.pop()
            before, many = blocks[-1]
            blocks[-1] = [(before * many + mean * count) / (many + count), many + count]
    return [
        float(place)
        for block in blocks
        for place in _bottom(block, gap) + gap * np.arange(int(block[1]))
    ]


def _bottom(block: list[float], gap: float) -> float:
    return block[0] - gap * (block[1] - 1) / 2


def _top(block: list[float], gap: float) -> float:
    return block[0] + gap * (block[1] - 1) / 2
