"""The figure of costs that other tools measured: a panel per function."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from experiments.report.style import BLUE, GRAY, RED, grid, styled
from hem.complexity import Curve, Verdict, parse


def save_costs(
    path: Path, curves: Sequence[Curve], verdicts: Sequence[Verdict], claimed: bool
) -> None:
    """Draw costs on logarithmic axes into a file, whose ending says of what kind."""
    with styled():
        plot_costs(curves, verdicts, claimed).savefig(path)


def plot_costs(curves: Sequence[Curve], verdicts: Sequence[Verdict], claimed: bool) -> Figure:
    """Samples, and the class that explains them best; in gray the one that is claimed."""
    with styled():
        figure, panels = grid([it.name for it in curves], (4.2, 2.8), min(len(curves), 3))
        for axes, curve, verdict in zip(panels, curves, verdicts, strict=True):
            smooth = np.geomspace(curve.sizes[0], curve.sizes[-1], 100)
            drawn = {verdict.expected: GRAY} if claimed else {}
            for name, color in ({verdict.best: RED} | drawn).items():
                it = verdict.coefficients[name]
                costs = it["fixed"] + it["factor"] * parse(name)(smooth)
                axes.plot(smooth, costs, "--", color=color, label=name)
            for size, samples in zip(curve.sizes, curve.samples, strict=True):
                axes.plot(np.full(len(samples), size), samples, ".", color=BLUE, markersize=3)
            axes.set(xscale="log", yscale="log", xlabel=curve.parameter, ylabel="cost")
            axes.legend()
        return figure
