"""The figures on rigour: who names how many curves right, and the same code against itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.report.style import FADED, GRAY, LOOKS, styled
from experiments.validation.accuracy import UNDETERMINED, confusion, shares
from experiments.validation.synthetic import CURVES, PARTS

KINDS = {
    "right": LOOKS["winged_edge"].color,
    UNDETERMINED: "#d5d5d5",
    "wrong": LOOKS["as_printed"].color,
}
"""What can be said of a curve, as every figure here draws it."""

LEAST_WRITTEN = 0.045
"""A share from which on there is room for its number."""


def who_names_what(table: pd.DataFrame) -> Figure:
    """A panel per part of the corpus, a bar per judge: right, undetermined and wrong."""
    found = shares(table)
    judges = list(dict.fromkeys(table["judge"]))
    with styled():
        figure = Figure(figsize=(9.6, 4.6), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True, sharey=True)
        for axes, part in zip(panels.flat, PARTS, strict=True):
            axes.set_title(PARTS[part])
            for row, judge in enumerate(judges):
                _bar(axes, row, found.loc[(judge, part)])
            _bars_only(axes, judges)
        for axes in panels[-1]:
            axes.set_xlabel("share of the curves")
        handles = [axes.barh(0, 0, color=color) for color in KINDS.values()]
        figure.legend(handles, list(KINDS), loc="outside lower center", ncols=3, frameon=False)
    return figure


def _bar(axes: Axes, row: int, found: pd.Series[Any]) -> None:
    left = 0.0
    for kind, color in KINDS.items():
        share = float(found[kind])
        axes.barh(row, share, 0.72, left, color=color)
        if share >= LEAST_WRITTEN:
            ink = "#333333" if kind == UNDETERMINED else "white"
            axes.text(
                left + share / 2, row, f"{share:.0%}", color=ink, ha="center", va="center",
                fontsize=8,
            )  # fmt: skip
        left += share


def _bars_only(axes: Axes, judges: list[str]) -> None:
    axes.set_yticks(range(len(judges)), judges)
    axes.set_ylim(len(judges) - 0.5, -0.5)
    axes.set_xlim(0, 1)
    axes.xaxis.set_major_formatter(lambda share, _: f"{share:.0%}")
    axes.grid(visible=False)
    axes.tick_params(length=0)
    axes.spines[["left", "bottom"]].set_visible(False)


def confusions(table: pd.DataFrame, part: str) -> Figure:
    """A panel per judge: what curves of each class were named, in one part of the corpus."""
    judges = list(dict.fromkeys(table["judge"]))
    with styled():
        figure = Figure(figsize=(2.6 * len(judges) + 0.8, 3.3), layout="constrained")
        panels = figure.subplots(1, len(judges), sharey=True, squeeze=False)[0]
        for axes, judge in zip(panels, judges, strict=True):
            _matrix(axes, confusion(table, judge, part))
            axes.set_title(judge)
        panels[0].set_ylabel("true class")
        figure.supxlabel("named", fontsize=9)
    return figure


def _matrix(axes: Axes, counts: pd.DataFrame) -> None:
    per_class = counts.to_numpy(float) / counts.to_numpy().sum(axis=1, keepdims=True)
    names = [*CURVES, "?"]
    for (row, column), share in np.ndenumerate(per_class):
        kind = UNDETERMINED if column == len(CURVES) else "right" if row == column else "wrong"
        color = KINDS[kind] if kind != UNDETERMINED else GRAY
        axes.add_patch(_square(column, row, FADED, 1.0))
        if share:
            axes.add_patch(_square(column, row, color, 0.15 + 0.85 * share))
            ink = "white" if share > 0.4 else "#222222"
            label = f"{100 * share:.0f}" if share >= 0.005 else "<1"
            axes.text(column, row, label, ha="center", va="center", fontsize=7, color=ink)
    axes.set_xticks(range(len(names)), names, rotation=60, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(CURVES)), list(CURVES))
    axes.set(xlim=(-0.5, len(names) - 0.5), ylim=(len(CURVES) - 0.5, -0.5), aspect="equal")
    axes.grid(visible=False)
    axes.tick_params(length=0)
    axes.spines[["left", "bottom"]].set_visible(False)


def _square(column: int, row: int, color: str, alpha: float) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle((column - 0.47, row - 0.47), 0.94, 0.94, color=color, alpha=alpha, linewidth=0)


def same_code(kept: dict[str, Any]) -> Figure:
    """Every comparison of the same code: the ratio that was measured, by pair of runs."""
    factor = float(kept["factor"])
    with styled():
        figure = Figure(figsize=(9.6, 3.0), layout="constrained")
        axes = figure.subplots()
        axes.axhspan(1 / factor, factor, color=FADED, zorder=0)
        rng = np.random.default_rng(0)
        for pair, row in enumerate(kept["pairs"], start=1):
            ratios = np.array(row["ratios"])
            x = pair + rng.uniform(-0.3, 0.3, len(ratios))
            axes.plot(x, ratios, ".", color=LOOKS["winged_edge"].color, markersize=3, alpha=0.6)
            alarms = list(row["alarms"].values())
            axes.plot([pair] * len(alarms), alarms, "X", color=KINDS["wrong"], markersize=7)
        axes.set_yscale("log")
        ticks = [0.125, 0.25, 0.5, 0.7, 0.8, 0.9, 1, 1.1, 1.25, 1.4, 2, 4, 8]
        every = [ratio for row in kept["pairs"] for ratio in row["ratios"]]
        low, high = min(0.8, *every) / 1.03, max(1.25, *every) * 1.03
        shown = [tick for tick in ticks if low <= tick <= high]
        axes.set_yticks(shown, [f"{tick:g}" for tick in shown])
        axes.set_ylim(low, high)
        axes.minorticks_off()
        axes.set_xticks(range(1, len(kept["pairs"]) + 1))
        axes.set(xlabel="pair of runs", ylabel="time after / before", xlim=(0.3, None))
        axes.set_title(f"{kept['comparisons']} comparisons, {kept['alarms']} false alarms")
    return figure
