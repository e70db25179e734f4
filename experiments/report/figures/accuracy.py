"""The figures on judges: what they name right, and what for what; and costs of other tools."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from experiments.report.style import BLUE, FADED, GRAY, RED, Plot, grid, styled
from hem.complexity import Curve, Verdict

KINDS = {"right": BLUE, "undetermined": "#b8b8b8", "wrong": RED}
"""What can be said of an answer, and its color in every figure here."""

LEAST_WRITTEN = 0.045  # a share from which on there is room for its number


def plot_answer_shares(shares: pd.DataFrame, titles: Mapping[str, str]) -> Plot:
    """A panel per condition, a bar per judge: right, undetermined and wrong.

    shares: a row per judge and condition, a column per kind of answer. titles: by condition.
    """
    with styled():
        figure, panels = grid(list(titles.values()), (4.8, 2.3), 2, Plot, sharex=True, sharey=True)
        for axes, condition in zip(panels, titles, strict=True):
            mine = shares.xs(condition, level="condition").loc[shares.index.unique("judge")]
            left = np.zeros(len(mine))
            for kind, color in KINDS.items():
                bars = axes.barh(list(mine.index), mine[kind], 0.72, left, color=color)
                words = [f"{it:.0%}" if it >= LEAST_WRITTEN else "" for it in mine[kind]]
                ink = "#333333" if kind == "undetermined" else "white"
                axes.bar_label(bars, words, label_type="center", color=ink, fontsize=8)
                left = left + mine[kind].to_numpy()
            axes.set(xlim=(0, 1), ylim=(len(mine) - 0.5, -0.5))
            axes.xaxis.set_major_formatter(lambda share, _: f"{share:.0%}")
            _hide_frame(axes)
        for axes in panels[-2:]:
            axes.set_xlabel("share of the curves")
        handles = [Rectangle((0, 0), 1, 1, color=color) for color in KINDS.values()]
        figure.legend(handles, list(KINDS), loc="outside lower center", ncols=3, frameon=False)
    return figure


def plot_confusions(confusions: Mapping[str, pd.DataFrame]) -> Plot:
    """A panel per judge: which answers curves of each class got. A "?" is undetermined."""
    with styled():
        figure, panels = grid(list(confusions), (2.8, 3.3), kind=Plot, sharey=True)
        for axes, counts in zip(panels, confusions.values(), strict=True):
            _draw_matrix(axes, counts)
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


def save_costs(
    path: Path, curves: Sequence[Curve], verdicts: Sequence[Verdict], claimed: bool
) -> None:
    """Draw samples on logarithmic axes, and the class that explains them best; in gray the claimed.

    ``path``: its ending says what kind of file it becomes.
    """
    with styled():
        figure, panels = grid([it.name for it in curves], (4.2, 2.8), min(len(curves), 3))
        for axes, curve, verdict in zip(panels, curves, verdicts, strict=True):
            smooth = np.geomspace(curve.sizes[0], curve.sizes[-1], 100)
            drawn = {verdict.expected: GRAY} if claimed else {}
            for name, color in ({verdict.best: RED} | drawn).items():
                costs = verdict.predicted(name, smooth)
                axes.plot(smooth, costs, "--", color=color, label=name)
            for size, samples in zip(curve.sizes, curve.samples, strict=True):
                axes.plot(np.full(len(samples), size), samples, ".", color=BLUE, markersize=3)
            axes.set(xscale="log", yscale="log", xlabel=curve.parameter, ylabel="cost")
            axes.legend()
        figure.savefig(path)
