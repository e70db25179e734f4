"""The plot and the data of every claim: what was measured against what is claimed."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from experiments.claims.growth import VARIABLES, Claim
from experiments.claims.judged import SOURCES, Evidence
from experiments.claims.sentences import Statement, bounds
from experiments.report import svg
from experiments.report.style import LOOKS
from hem.complexity.judge import Verdict
from hem.complexity.models import MODELS

MEASURES = {
    "work": ("work", "accesses each", 1.0),
    "time": ("time", "ns each", 1e9),
    "random": ("time at random", "ns each", 1e9),
}
"""By measure: its name, its unit in a plot, and how many of those one sample is."""

ACROSS = {"faces": "faces n_t", "valence": "valence n_ev"}

STEPS = 60
"""Points of a curve that is drawn smoothly."""


@dataclass(frozen=True)
class Panel:
    """One plot of a claim: a measure along one variable, and the verdict on it."""

    measure: str
    variable: str
    cells: pd.DataFrame
    verdict: Verdict

    @property
    def name(self) -> str:
        """What names its file."""
        return f"{self.measure}_{self.variable}"

    @property
    def title(self) -> str:
        """What stands above it."""
        return f"{MEASURES[self.measure][0]} against {VARIABLES[self.variable]}"


def panels(evidence: Evidence, claim: Claim, row: dict[str, Any]) -> Iterator[Panel]:
    """The plots of a cell of a table, of all that was measured."""
    for measure, variable in SOURCES:
        verdict = row.get(f"{measure}_{variable}")
        if isinstance(verdict, Verdict):
            cells = evidence.curve(measure, variable, claim.structure, claim.subject, claim.table)
            yield Panel(measure, variable, cells, verdict)


def growth(panel: Panel, structure: str, claimed: bool) -> str:
    """Costs on logarithmic axes, and the class that is claimed, as it fits them best.

    The gray band is what waiting for memory can add to it. Where another class explains the costs,
    that one is drawn as well.
    """
    _, unit, scale = MEASURES[panel.measure]
    sizes = panel.cells[panel.variable].to_numpy(float)
    center, low, high = (scale * it for it in summary(panel.cells, panel.measure))
    smooth = np.geomspace(sizes.min(), sizes.max(), STEPS)
    curves = {name: scale * _fitted(panel.verdict, name, smooth) for name in _drawn(panel, claimed)}
    x = svg.logarithmic(sizes, svg.LEFT, svg.WIDTH - svg.RIGHT)
    y = svg.logarithmic(np.r_[low, high], svg.HEIGHT - svg.BOTTOM, svg.TOP, decades=1.6)
    css, color = _color(structure)
    parts = list(svg.axes(x, y, ACROSS[panel.variable], unit))
    for name, curve in curves.items():
        rise = panel.verdict.coefficients[name]["rise"]
        is_claim = claimed and name == panel.verdict.expected
        if rise > 1.01 and (is_claim or not claimed):
            parts.append(svg.band(x(smooth), y(curve), np.maximum(y(rise * curve), svg.TOP)))
        parts.append(svg.line(x(smooth), y(curve), f"dash {'claim' if is_claim else 'found'}"))
    parts += [
        svg.whiskers(x(sizes), y(low), y(high), css, f"stroke:{color}" if color else ""),
        svg.dots(x(sizes), y(center), f"{css}-fill", f"fill:{color}" if color else ""),
    ]
    return svg.document(parts, panel.title)


def _drawn(panel: Panel, claimed: bool) -> list[str]:
    """The classes to draw: what is claimed, and what was found where that is another."""
    verdict = panel.verdict
    if not claimed:
        return [verdict.best]
    kept = verdict.outcome == "consistent" or verdict.best == verdict.expected
    return [verdict.expected] if kept else [verdict.expected, verdict.best]


def _fitted(verdict: Verdict, name: str, sizes: svg.Array) -> svg.Array:
    """The cost that a fitted class gives, with memory at its fastest."""
    it = verdict.coefficients[name]
    return np.asarray(it["fixed"] + it["factor"] * MODELS[name](sizes), float)


def _color(structure: str) -> tuple[str, str]:
    """The class and the color of a structure's marks: black turns white in the dark."""
    return ("ink", "") if structure in ("", "indexed") else ("own", LOOKS[structure].color)


def summary(cells: pd.DataFrame, measure: str) -> tuple[svg.Array, svg.Array, svg.Array]:
    """Per cell the mean of counts or the median of times, the smallest and the largest."""
    center = np.mean if measure == "work" else np.median
    samples = [np.maximum(it, 1) if measure == "work" else it for it in cells["samples"]]
    return (
        np.array([float(center(it)) for it in samples]),
        np.array([float(np.min(it)) for it in samples]),
        np.array([float(np.max(it)) for it in samples]),
    )


def memory(cells: pd.DataFrame, structure: str, printed: int | None) -> str:
    """Bytes per vertex against size, and what is printed."""
    vertices = cells["vertices"].to_numpy(float)
    each = np.array([it[0] for it in cells["samples"]]) / vertices
    x = svg.logarithmic(vertices, svg.LEFT, svg.WIDTH - svg.RIGHT)
    top = max([*each, float(printed or 0)]) or 1.0
    y = svg.Axis(0, 1.25 * top, svg.HEIGHT - svg.BOTTOM, svg.TOP, logarithmic=False)
    css, color = _color(structure)
    parts = list(svg.axes(x, y, "vertices n_v", "bytes per vertex"))
    if printed:
        ends = np.array([x.start, x.end])
        parts.append(svg.line(ends, y([printed, printed]), "dash claim"))
    parts.append(
        svg.dots(x(vertices), y(each), f"{css}-fill", f"fill:{color}" if color else "", radius=3.5)
    )
    return svg.document(parts, "bytes per vertex")


def quantity(statement: Statement) -> str:
    """The values of a sentence on one axis, and the bounds they must keep."""
    height = 86
    values, limits = statement.values, [it for it in (statement.low, statement.high) if _finite(it)]
    every = np.r_[values, limits, [0.0] if min([*values, *limits]) > 0 else []]
    room = 0.08 * (every.max() - every.min()) or 0.5
    wide = len(values) > 0 and every.min() >= 0 and values.max() > 30 * max(values.min(), 1e-9)
    if wide and values.min() > 0:
        x = svg.logarithmic(np.r_[values, limits], svg.RIGHT, svg.WIDTH - svg.RIGHT)
    else:
        ends = svg.RIGHT, svg.WIDTH - svg.RIGHT
        x = svg.Axis(every.min() - room, every.max() + room, *ends, logarithmic=False)
    parts = [_tick(x, value) for value in x.ticks()]
    low, high = (float(np.clip(it, x.low, x.high)) for it in (statement.low, statement.high))
    start, end = x([low, high])
    parts += [
        svg.bar(start, 20, max(end - start, 3), 36),
        svg.text(svg.RIGHT, 13, f"claimed: {bounds(statement)}"),
        f'<path class="frame" d="M{svg.RIGHT} 56H{svg.WIDTH - svg.RIGHT}"/>',
        svg.dots(x(values), np.full(len(values), 38.0), "ink-fill", "fill-opacity:.75", 4),
    ]
    return svg.document(parts, "what was found, and what is claimed", height=height)


def _finite(value: float) -> bool:
    return bool(np.isfinite(value))


def _tick(x: svg.Axis, value: float) -> str:
    at = float(x([value])[0])
    return f'<path class="grid" d="M{at:.1f} 20V56"/>' + svg.text(
        at, 71, svg.short(value), "middle"
    )


HEAD = (
    "measure", "variable", "experiment", "order", "family", "vertices", "faces", "valence",
    "samples", "center", "smallest", "largest", "unit", "latency_seconds",
)  # fmt: skip


def table(every: list[Panel]) -> str:
    """The cells behind a claim's plots as comma-separated values, times in seconds."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(HEAD)
    for panel in every:
        unit = "accesses" if panel.measure == "work" else "seconds"
        numbers = zip(*summary(panel.cells, panel.measure), strict=True)
        for cell, each in zip(panel.cells.to_dict("records"), numbers, strict=True):
            known = [cell[key] for key in ("experiment", "order", "family", "vertices", "faces")]
            known += [cell["valence"] if _known(cell["valence"]) else cell["valence_max"] or ""]
            found = [len(cell["samples"]), *(f"{it:.6g}" for it in each), unit]
            late = [f"{cell['latency']:.4g}" if _known(cell["latency"]) else ""]
            writer.writerow([panel.measure, panel.variable, *known, *found, *late])
    return file.getvalue()


def _known(value: Any) -> bool:
    return value is not None and not pd.isna(value)


def bytes_table(cells: pd.DataFrame) -> str:
    """The bytes of every field, by size, as comma-separated values."""
    lines = ["vertices,reference_bytes,field,bytes"]
    for cell in cells.to_dict("records"):
        head = f"{cell['vertices']},{cell['reference_bytes']}"
        fields = cell["detail"].get("fields", {})
        lines += [f"{head},{name},{size}" for name, size in fields.items()]
        lines.append(f"{head},all,{cell['samples'][0]:.0f}")
    return "\n".join(lines) + "\n"


def values_table(statement: Statement) -> str:
    """The values of a sentence and its bounds, one per line."""
    lines = [f"{it:.6g},{statement.low:g},{statement.high:g}" for it in statement.values]
    return "\n".join(["value,low,high", *lines]) + "\n"
