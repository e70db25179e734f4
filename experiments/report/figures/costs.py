"""The figure of costs that other tools measured: a panel per function."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from experiments.report.style import BLUE, GRAY, RED, grid, styled
from hem.complexity import Curve, Verdict, parse


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
                it = verdict.coefficients[name]
                costs = it["fixed"] + it["factor"] * parse(name)(smooth)
                axes.plot(smooth, costs, "--", color=color, label=name)
            for size, samples in zip(curve.sizes, curve.samples, strict=True):
                axes.plot(np.full(len(samples), size), samples, ".", color=BLUE, markersize=3)
            axes.set(xscale="log", yscale="log", xlabel=curve.parameter, ylabel="cost")
            axes.legend()
        figure.savefig(path)
