"""The figures on accuracy: how many synthetic curves each judge names right, and what for what."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from experiments.report.style import FADED, GRAY, LOOKS, styled

KINDS = {
    "right": LOOKS["winged_edge"].color,
    "undetermined": "#d5d5d5",
    "wrong": LOOKS["as_printed"].color,
}
"""What can be said of an answer, and its color in every figure here."""

LEAST_WRITTEN = 0.045
"""A share from which on there is room for its number."""


def plot_answer_shares(shares: pd.DataFrame, titles: Mapping[str, str]) -> Figure:
    """A panel per condition, a bar per judge: right, undetermined and wrong.

    shares: a row per judge and condition, a column per kind of answer. titles: by condition.
    """
    judges = list(shares.index.unique("judge"))
    with styled():
        figure = Figure(figsize=(9.6, 4.6), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True, sharey=True)
        for axes, (condition, title) in zip(panels.flat, titles.items(), strict=True):
            axes.set_title(title)
            for row, judge in enumerate(judges):
                _draw_bar(axes, row, shares.loc[(judge, condition)])
            axes.set_yticks(range(len(judges)), judges)
            axes.set(xlim=(0, 1), ylim=(len(judges) - 0.5, -0.5))
            axes.xaxis.set_major_formatter(lambda share, _: f"{share:.0%}")
            _hide_frame(axes)
        for axes in panels[-1]:
            axes.set_xlabel("share of the curves")
        handles = [Rectangle((0, 0), 1, 1, color=color) for color in KINDS.values()]
        figure.legend(handles, list(KINDS), loc="outside lower center", ncols=3, frameon=False)
    return figure


def _draw_bar(axes: Axes, row: int, shares: pd.Series[Any]) -> None:
    left = 0.0
    for kind, color in KINDS.items():
        bar = axes.barh(row, float(shares[kind]), 0.72, left, color=color)
        if shares[kind] >= LEAST_WRITTEN:
            ink = "#333333" if kind == "undetermined" else "white"
            label = f"{shares[kind]:.0%}"
            axes.bar_label(bar, [label], label_type="center", color=ink, fontsize=8)
        left += float(shares[kind])


def plot_confusions(confusions: Mapping[str, pd.DataFrame]) -> Figure:
    """A panel per judge: which answers curves of each class got. A "?" is undetermined."""
    with styled():
        figure = Figure(figsize=(2.6 * len(confusions) + 0.8, 3.3), layout="constrained")
        panels = figure.subplots(1, len(confusions), sharey=True, squeeze=False)[0]
        for axes, (judge, counts) in zip(panels, confusions.items(), strict=True):
            _draw_matrix(axes, counts)
            axes.set_title(judge)
        panels[0].set_ylabel("true class")
        figure.supxlabel("answer", fontsize=9)
    return figure


def _draw_matrix(axes: Axes, counts: pd.DataFrame) -> None:
    shares = counts.to_numpy(float) / counts.to_numpy().sum(axis=1, keepdims=True)
    classes, answers = [str(name) for name in counts.index], [*counts.index, "?"]
    for (row, column), share in np.ndenumerate(shares):
        color = GRAY if column == len(classes) else KINDS["right" if row == column else "wrong"]
        shade = 0.15 + 0.85 * share if share else 0.0
        for fill, alpha in ((FADED, 1.0), (color, shade)):
            corner = column - 0.47, row - 0.47
            axes.add_patch(Rectangle(corner, 0.94, 0.94, color=fill, alpha=alpha, lw=0))
        if share:
            ink = "white" if share > 0.4 else "#222222"
            label = f"{100 * share:.0f}" if share >= 0.005 else "<1"
            axes.text(column, row, label, ha="center", va="center", fontsize=7, color=ink)
    axes.set_xticks(range(len(answers)), answers, rotation=60, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(classes)), classes)
    axes.set(xlim=(-0.5, len(answers) - 0.5), ylim=(len(classes) - 0.5, -0.5), aspect="equal")
    _hide_frame(axes)


def _hide_frame(axes: Axes) -> None:
    axes.grid(visible=False)
    axes.tick_params(length=0)
    axes.spines[["left", "bottom"]].set_visible(False)
