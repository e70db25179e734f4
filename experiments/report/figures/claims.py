"""The figure and the data of every claim: what was measured against what is claimed."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import NullLocator

from experiments.claims import Between, Curve, Exactly, Growth, JudgedClaim, curves
from experiments.harness import Axis
from experiments.report import style
from experiments.report.rows import two_digits
from experiments.report.session import Session, claim_file, open_run
from experiments.report.style import GRAY, RED, STYLES, Plot
from hem.arrays import Floats

WIDTH, HEIGHT = 3.2, 2.3  # of one panel, in inches
STEPS = 60  # points of a curve that is drawn smoothly
INK = "#111111"


def write_claims(keys: list[str], folder: Path) -> None:
    """Write the figures, where anything was measured, and the data of claims of the open run."""
    session = open_run()
    for judged in session.claims:
        if judged.claim.key in keys:
            if plot := draw(session, judged):
                (folder / f"{claim_file(judged)}.svg").write_text(style.svg(plot), "utf-8")
            (folder / f"{claim_file(judged)}.csv").write_text(data(session, judged), "utf-8")


def draw(session: Session, judged: JudgedClaim) -> Plot | None:
    """The figure of a claim: a panel per axis, the bytes by size, or values beside bounds."""
    if not judged.was_measured:
        return None
    with style.styled():
        plot = Plot(figsize=(WIDTH * max(len(judged.verdicts), 1), HEIGHT))
        width, height = plot.get_size_inches()  # room that is the same in every figure
        plot.subplots_adjust(0.55 / width, 0.48 / height, 1 - 0.08 / width, 1 - 0.3 / height, 0.3)
        if isinstance(judged.claim.expects, Exactly):
            _draw_bytes(plot.subplots(), session, judged, judged.claim.expects.value)
        elif isinstance(judged.claim.expects, Between):
            plot.set_size_inches(WIDTH * 1.3, 1.1)
            plot.subplots_adjust(0.06, 0.34, 0.94, 0.78)
            _draw_values(plot.subplots(), judged.values, judged.claim.expects)
        for place, axis in enumerate(judged.verdicts, start=1):
            panel = plot.add_subplot(1, len(judged.verdicts), place)
            _draw_growth(panel, curves(session.run).of(judged.claim, axis), judged, axis)
    return plot


def _draw_growth(axes: Axes, curve: Curve, judged: JudgedClaim, axis: Axis) -> None:
    """Costs on logarithmic axes, and the class that is claimed, as it fits them best.

    The gray band is what waiting for memory can add to it. Where another class explains the costs,
    that one is drawn as well. No access counts as one. The limits are at least 1.6 decades apart,
    so that noise stays small.
    """
    verdict, claimed = judged.verdicts[axis], judged.claim.claims_something
    smooth = np.geomspace(curve.sizes.min(), curve.sizes.max(), STEPS)
    classes = {verdict.expected: GRAY} if claimed else {verdict.best: RED}
    if verdict.outcome != "consistent":
        classes.setdefault(verdict.best, RED)
    for place, (name, color) in enumerate(classes.items()):
        costs = axis.scale * verdict.predicted(name, smooth)
        slowdown = verdict.coefficients[name]["slowdown"]
        if slowdown > 1.01 and place == 0:
            axes.fill_between(smooth, costs, slowdown * costs, color=GRAY, alpha=0.16, lw=0)
        axes.plot(smooth, costs, "--", color=color)
    color = STYLES[judged.claim.structure]["color"] if judged.claim.structure else INK
    found = axis.scale * _summary(curve).clip(lower=1.0 if axis.exact else 0.0)
    axes.vlines(curve.sizes, found["smallest"], found["largest"], color=color, linewidth=1.2)
    axes.plot(curve.sizes, found["center"], "o", color=color)
    _name(axes, style.axis_label(axis, judged.claim.table))
    raw, slope = two_digits(verdict.raw_slope), two_digits(verdict.slope)
    slopes = f"slope {raw}" if axis.exact else f"slope {raw}, memory out {slope}"
    axes.set(xscale="log", yscale="log", xlabel=f"{style.VARIABLES[axis.variable]}; {slopes}")
    every = found.to_numpy(float)
    logs = np.log10(every[every > 0] if (every > 0).any() else [1.0])
    middle, half = (logs.min() + logs.max()) / 2, max(np.ptp(logs) / 2 * 1.1 + 0.05, 0.8)
    axes.set_ylim(10 ** (middle - half), 10 ** (middle + half))
    style.short_numbers(axes)


def _summary(curve: Curve) -> pd.DataFrame:
    """The center, the smallest and the largest sample of each case."""
    low, high = ([end(it) for it in curve.samples] for end in (np.min, np.max))
    return pd.DataFrame({"center": curve.centers, "smallest": low, "largest": high})


def _name(axes: Axes, title: str) -> None:
    """A title, and plain numbers across."""
    axes.set_title(title, fontsize=9, fontweight="normal", color=GRAY)
    axes.xaxis.set_major_formatter(lambda value, _: style.compact(round(value, 9) + 0))
    axes.xaxis.set_minor_locator(NullLocator())


def _draw_bytes(axes: Axes, session: Session, judged: JudgedClaim, value: float | None) -> None:
    """Bytes per vertex against size, and what is claimed."""
    curve = curves(session.run).memory(judged.claim.structure)
    cases, each = curve.cases, curve.centers / curve.cases["vertices"]
    axes.plot(cases["vertices"], each, "o", color=STYLES[judged.claim.structure]["color"])
    if value:
        axes.axhline(float(value), color=GRAY, linestyle="--")
    axes.set(xscale="log", ylim=(0, 1.25 * max([*each, float(value or 1)])), xlabel="vertices n_v")
    _name(axes, "bytes per vertex")


def _draw_values(axes: Axes, values: Floats, bounds: Between) -> None:
    """The values of a sentence on one axis, and the bounds that they must keep."""
    every = np.r_[values, [it for it in (bounds.low, bounds.high) if np.isfinite(it)]]
    low, high = min(every.min(), 0), every.max()
    room = (low - 0.08 * (high - low or 1), high + 0.08 * (high - low or 1))
    if every.min() > 0 and every.max() > 30 * every.min():
        axes.set_xscale("log")
        room = (every.min() / 1.5, every.max() * 1.5)
    axes.set(xlim=room, ylim=(-1, 1), yticks=[])
    axes.axvspan(*np.clip([bounds.low, bounds.high], *room), color=GRAY, alpha=0.2, linewidth=2)
    axes.plot(values, np.zeros(len(values)), "o", color=INK, alpha=0.75, markersize=6)
    axes.spines["left"].set_visible(False)
    _name(axes, f"claimed: {bounds.words}")


def data(session: Session, judged: JudgedClaim) -> str:
    """What a claim was judged by, and who claims it, as comma-separated values; in seconds."""
    of_run, bounds = curves(session.run), judged.claim.expects
    if isinstance(bounds, Growth):
        axes = judged.verdicts or [Axis.WORK_FACES]  # of what was not measured the heads alone
        table = pd.concat([_cases(of_run.of(judged.claim, it), it) for it in axes])
    elif isinstance(bounds, Between):
        table = pd.DataFrame({"value": judged.values, "low": bounds.low, "high": bounds.high})
    else:
        rows = [
            (it["vertices"], it["reference_bytes"], field, int(size))
            for it in of_run.memory(judged.claim.structure).cases.to_dict("records")
            for field, size in {**it["detail"].get("fields", {}), "all": it["samples"][0]}.items()
        ]
        table = pd.DataFrame(rows, columns=["vertices", "reference_bytes", "field", "bytes"])
    table["claimed"] = judged.claim.kind.value
    return table.to_csv(index=False, lineterminator="\n", float_format="%.6g")


def _cases(curve: Curve, axis: Axis) -> pd.DataFrame:
    cases = curve.cases.reset_index(drop=True)
    numbers = cases[["valence", "valence_max", "latency"]].astype(float)
    facts: dict[str, Any] = {
        "measure": axis.measure, "variable": axis.variable,
        **cases[["experiment", "order", "family"]], **cases[["vertices", "faces"]].astype(int),
        "valence": numbers["valence"].fillna(numbers["valence_max"]),
        "samples": cases["samples"].map(len), **_summary(curve),
        "unit": "accesses" if axis.exact else "seconds", "latency_seconds": numbers["latency"],
    }  # fmt: skip
    return pd.DataFrame(facts)
