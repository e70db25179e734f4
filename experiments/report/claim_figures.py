"""The figure and the data of every claim: what was measured against what is claimed."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullLocator
from numpy.typing import NDArray

from experiments.claims import Between, Curve, Exactly, JudgedClaim, curves
from experiments.harness import Axis
from experiments.report.pages import was_measured
from experiments.report.session import Session, open_run
from experiments.report.style import GRAY, LOOKS, RED, Plot, compact, short_numbers, styled, svg
from hem.complexity import MODELS, Verdict

Array = NDArray[np.float64]

FOLDER = "claims"
"""The folder beside the pages that holds the figures and the data of the claims."""

WIDTH, HEIGHT, COLUMNS = 3.2, 2.3, 5
"""Of one panel, in inches; and how many stand beside each other."""

VARIABLES = {"faces": "faces n_t", "valence": "valence n_ev"}
STEPS = 60
"""Points of a curve that is drawn smoothly."""

INK = "#111111"


def file_name(judged: JudgedClaim) -> str:
    """How the names of a claim's files begin."""
    return judged.claim.key.replace("/", ".")


def write_claims(keys: list[str], folder: Path) -> None:
    """Write the figure and the data of these claims of the open run to ``folder``."""
    session = open_run()
    for judged in session.claims:
        if judged.claim.key in keys:
            write(session, judged, folder)


def write(session: Session, judged: JudgedClaim, folder: Path) -> None:
    """Write the figure of a claim, if anything was measured, and its data."""
    plot = draw(session, judged)
    if plot is not None:
        (folder / f"{file_name(judged)}.svg").write_text(svg(plot), "utf-8")
    (folder / f"{file_name(judged)}.csv").write_text(data(session, judged), "utf-8")


def draw(session: Session, judged: JudgedClaim) -> Plot | None:
    """The figure of a claim: a panel per axis, the bytes by size, or values beside bounds."""
    with styled():
        if judged.verdicts:
            plot = Plot(figsize=(WIDTH * len(judged.verdicts), HEIGHT))
            _place(plot)
            for panel, axis in zip(
                plot.subplots(1, len(judged.verdicts), squeeze=False)[0],
                judged.verdicts,
                strict=True,
            ):
                _growth(panel, _curve(session, judged, axis), judged, axis)
            return plot
        if isinstance(judged.claim.expects, Exactly) and was_measured(judged):
            return _bytes(session, judged)
        if isinstance(judged.claim.expects, Between) and len(judged.values):
            return _values(judged, judged.claim.expects)
    return None


def _curve(session: Session, judged: JudgedClaim, axis: Axis) -> Curve:
    claim = judged.claim
    return curves(session.run).curve(axis, claim.structure, claim.subject, claim.table)


def _place(plot: Plot) -> None:
    """Room around the panels, the same in every figure: to search for it takes longest."""
    width, height = (float(it) for it in plot.get_size_inches())
    plot.subplots_adjust(0.55 / width, 0.48 / height, 1 - 0.08 / width, 1 - 0.3 / height, 0.3)


def _growth(axes: Axes, curve: Curve, judged: JudgedClaim, axis: Axis) -> None:
    """Costs on logarithmic axes, and the class that is claimed, as it fits them best.

    The gray band is what waiting for memory can add to it. Where another class explains the costs,
    that one is drawn as well.
    """
    verdict, claimed = judged.verdicts[axis], judged.claim.claims_something
    smooth = np.geomspace(curve.sizes.min(), curve.sizes.max(), STEPS)
    for name in _classes(verdict, claimed):
        costs = axis.scale * _fitted(verdict, name, smooth)
        is_claim = claimed and name == verdict.expected
        rise = verdict.coefficients[name]["rise"]
        if rise > 1.01 and (is_claim or not claimed):
            axes.fill_between(smooth, costs, rise * costs, color=GRAY, alpha=0.16, linewidth=0)
        axes.plot(smooth, costs, "--", color=GRAY if is_claim else RED)
    color = LOOKS[judged.claim.structure].color if judged.claim.structure else INK
    low, center, high = (axis.scale * it for it in _summary(curve))
    axes.vlines(curve.sizes, low, high, color=color, linewidth=1.2)
    axes.plot(curve.sizes, center, "o", color=color)
    unit = f"{axis.label}, {axis.unit}" if axis.unit else axis.label
    axes.set_title(unit, fontsize=9, fontweight="normal", color=GRAY)
    axes.set_xlabel(VARIABLES[axis.variable])
    _logarithmic(axes, curve.sizes, np.r_[low, high][np.r_[low, high] > 0])


def _summary(curve: Curve) -> tuple[Array, Array, Array]:
    """The smallest sample, the center and the largest of each case; no access counts as one."""
    least = 1.0 if curve.measure == "work" else 0.0
    low, high = curve.spread(1.0)
    return tuple(np.maximum(it, least) for it in (low, curve.centers, high))  # type: ignore[return-value]


def _classes(verdict: Verdict, claimed: bool) -> list[str]:
    """The classes to draw: what is claimed, and what was found where that is another."""
    if not claimed:
        return [verdict.best]
    kept = verdict.outcome == "consistent" or verdict.best == verdict.expected
    return [verdict.expected] if kept else [verdict.expected, verdict.best]


def _fitted(verdict: Verdict, name: str, sizes: Array) -> Array:
    """The cost that a fitted class gives, with memory at its fastest."""
    it = verdict.coefficients[name]
    return np.asarray(it["fixed"] + it["factor"] * MODELS[name](sizes), float)


def _logarithmic(axes: Axes, x: Array, y: Array) -> None:
    """Both axes logarithmic; upright at least 1.6 decades, so that noise stays small."""
    axes.set(xscale="log", yscale="log")
    logs = np.log10(y if len(y) else np.ones(1))
    middle, half = (logs.min() + logs.max()) / 2, max(np.ptp(logs) / 2 * 1.1 + 0.05, 0.8)
    axes.set_ylim(10 ** (middle - half), 10 ** (middle + half))
    short_numbers(axes)


def _bytes(session: Session, judged: JudgedClaim) -> Plot:
    """Bytes per vertex against size, and what is claimed."""
    cases = curves(session.run).memory(judged.claim.structure, 8)
    each = [it[0] / n for it, n in zip(cases["samples"], cases["vertices"], strict=True)]
    plot = Plot(figsize=(WIDTH, HEIGHT))
    _place(plot)
    axes = plot.subplots()
    axes.plot(cases["vertices"], each, "o", color=LOOKS[judged.claim.structure].color)
    value = judged.claim.expects.value if isinstance(judged.claim.expects, Exactly) else None
    if value:
        axes.axhline(float(value), color=GRAY, linestyle="--")
    axes.set(xscale="log", ylim=(0, 1.25 * max([*each, float(value or 1)])))
    axes.set_xlabel("vertices n_v")
    axes.set_title("bytes per vertex", fontsize=9, fontweight="normal", color=GRAY)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: compact(value)))
    axes.xaxis.set_minor_locator(NullLocator())
    return plot


def _values(judged: JudgedClaim, bounds: Between) -> Plot:
    """The values of a sentence on one axis, and the bounds that they must keep."""
    plot = Plot(figsize=(WIDTH * 1.3, 1.1))
    axes = plot.subplots()
    plot.subplots_adjust(0.06, 0.34, 0.94, 0.78)
    values = np.asarray(judged.values, float)
    limits = [it for it in (bounds.low, bounds.high) if np.isfinite(it)]
    every = np.r_[values, limits]
    if every.min() > 0 and every.max() > 30 * every.min():
        axes.set_xscale("log")
        room = (every.min() / 1.5, every.max() * 1.5)
    else:
        low, high = min(every.min(), 0), every.max()
        room = (low - 0.08 * (high - low or 1), high + 0.08 * (high - low or 1))
    axes.set(xlim=room, ylim=(-1, 1), yticks=[])
    low, high = np.clip([bounds.low, bounds.high], *axes.get_xlim())
    axes.axvspan(low, high, color=GRAY, alpha=0.2, linewidth=2)
    axes.plot(values, np.zeros(len(values)), "o", color=INK, alpha=0.75, markersize=6)
    axes.spines["left"].set_visible(False)
    axes.set_title(f"claimed: {bounds.words}", fontsize=9, fontweight="normal", color=GRAY)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: compact(round(value, 9) + 0)))
    axes.xaxis.set_minor_locator(NullLocator())
    return plot


HEAD = (
    "measure", "variable", "experiment", "order", "family", "vertices", "faces", "valence",
    "samples", "center", "smallest", "largest", "unit", "latency_seconds",
)  # fmt: skip


def data(session: Session, judged: JudgedClaim) -> str:
    """What a claim was judged by as comma-separated values; times in seconds."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    if judged.verdicts:
        writer.writerow(HEAD)
        for axis in judged.verdicts:
            writer.writerows(_cases(_curve(session, judged, axis), axis))
    elif isinstance(judged.claim.expects, Between):
        writer.writerow(("value", "low", "high"))
        bounds = judged.claim.expects
        writer.writerows(
            (f"{it:.6g}", f"{bounds.low:g}", f"{bounds.high:g}") for it in judged.values
        )
    else:
        writer.writerow(("vertices", "reference_bytes", "field", "bytes"))
        cases = curves(session.run).memory(judged.claim.structure, 8)
        for case in cases.to_dict("records"):
            fields = case["detail"].get("fields", {}) | {"all": int(case["samples"][0])}
            head = (case["vertices"], case["reference_bytes"])
            writer.writerows((*head, name, size) for name, size in fields.items())
    return file.getvalue()


def _cases(curve: Curve, axis: Axis) -> Iterator[list[Any]]:
    low, center, high = _summary(curve)
    summary = zip(center, low, high, strict=True)
    for case, found in zip(curve.cases.to_dict("records"), summary, strict=True):
        valence = case["valence"] if _known(case["valence"]) else case["valence_max"] or ""
        yield [
            axis.measure, axis.variable,
            *(case[key] for key in ("experiment", "order", "family", "vertices", "faces")),
            valence, len(case["samples"]), *(f"{it:.6g}" for it in found),
            "accesses" if axis.exact else "seconds",
            f"{case['latency']:.4g}" if _known(case["latency"]) else "",
        ]  # fmt: skip


def _known(value: Any) -> bool:
    return value is not None and value == value  # not nan
