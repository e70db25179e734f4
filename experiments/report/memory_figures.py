"""Bytes per vertex as stacked bars: by field, and by what they are for."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes

from experiments.claims import Exactly, curves
from experiments.report.session import MissingError, open_run
from experiments.report.style import LOOKS, Plot, styled
from experiments.runs import Run
from structures import NAMED, REGISTRY

PARTS = {
    "positions": ("vertex.point",),
    "references": ("half_edge", "origin", "face", "next", "opposite", "twin"),
    "indices": ("index",),
    "event": ("position_changed",),
    "headers": ("header",),
    "padding": ("padding",),
    "lists": ("list",),
    "objects": ("object",),
}
"""What bytes are for, by the names of their fields."""

MISSING = "This run has not measured memory."


def memory(run: Run) -> Plot:
    """Bytes per vertex, stacked by field: as printed, modeled with 8 and 4 bytes, and as traced.

    Of what is made of arrays; ``references`` has the objects.
    """
    cases = {
        name: {size: curves(run).memory(name, size) for size in (8, 4)}
        for name, structure in REGISTRY.items()
        if structure.compiled
    }
    measured = {name: both for name, both in cases.items() if any(map(len, both.values()))}
    if not measured:
        raise MissingError(MISSING)
    with styled():
        figure = Plot(figsize=(11, 1.25 * len(measured) + 1.1), layout="constrained")
        axes = figure.subplots()
        for row, (name, both) in enumerate(measured.items()):
            for offset, size in ((-0.19, 8), (0.19, 4)):
                if len(both[size]):
                    _fields(axes, row + offset, both[size].iloc[-1], LOOKS[name].color)
            _printed(axes, row, name)
        _finish(axes, [NAMED[name].title for name in measured])
        axes.set_xlim(0, 350)
    return figure


def _fields(axes: Axes, height: float, case: pd.Series, color: str) -> None:
    """One stacked bar, its fields named inside; beside it what was traced."""
    sizes = [size / case["vertices"] for size in case["detail"]["fields"].values()]
    names = [field.split(".")[1].replace("_", " ") for field in case["detail"]["fields"]]
    total = _bar(axes, height, 0.36, list(zip(names, sizes, strict=True)), color)
    traced, peak = (case["detail"][key] / case["vertices"] for key in ("traced", "peak"))
    note = f"{total:g} B with {case['reference_bytes']}-byte references"
    note += f" · {traced:.1f} traced · {peak:.0f} at the peak"
    axes.text(total + 3, height, note, va="center", fontsize=8)


def _bar(
    axes: Axes, height: float, thickness: float, parts: list[tuple[str, float]], color: str
) -> float:
    """A stacked bar whose parts are named where there is room -> its length."""
    start = 0.0
    for k, (name, size) in enumerate(parts):
        shade = 0.28 if k % 2 else 0.48
        axes.barh(height, size, thickness, start, color=color, alpha=shade, edgecolor="white")
        if size > 2.2 * len(name):
            axes.text(start + size / 2, height, name, ha="center", va="center", fontsize=6.5)
        start += size
    return start


def _printed(axes: Axes, row: int, structure: str) -> None:
    """A black mark where the thesis prints a number."""
    key = f"{structure}/memory"
    claims = (it.claim.expects for it in open_run().claims if it.claim.key == key)
    value = next((it.value for it in claims if isinstance(it, Exactly)), None)
    if value:
        axes.plot(2 * [float(value)], [row - 0.42, row + 0.02], color="black", linewidth=2.5)
        axes.annotate(
            "printed in the thesis", (value, row - 0.42), (0, 4), textcoords="offset points",
            ha="center", fontsize=8, fontweight="bold",
        ) if row == 0 else None  # fmt: skip


def references(run: Run) -> Plot:
    """Bytes per vertex of one half-edge mesh by what holds it: arrays, and objects."""
    objects = curves(run).memory("half_edge_objects", 8)
    held = {
        "arrays, 8-byte references": _parts(curves(run).memory("half_edge", 8), "fields"),
        "arrays, 4-byte references": _parts(curves(run).memory("half_edge", 4), "fields"),
        "objects, as the thesis' runtime lays them out (model)": _parts(objects, "clr"),
        "objects, in Python (measured)": _parts(objects, "fields"),
    }
    held = {name: parts for name, parts in held.items() if parts}
    if not held:
        raise MissingError(MISSING)
    with styled():
        figure = Plot(figsize=(11, 0.6 * len(held) + 0.5), layout="constrained")
        axes = figure.subplots()
        for row, (name, parts) in enumerate(held.items()):
            structure = "half_edge" if name.startswith("arrays") else "half_edge_objects"
            color = LOOKS[structure].color
            total = _bar(axes, row, 0.62, list(parts.items()), color)
            axes.text(total + 6, row, f"{total:,.0f}", va="center", fontweight="bold")
        _finish(axes, list(held))
        axes.margins(x=0.08)
    return figure


def _finish(axes: Axes, names: list[str]) -> None:
    axes.set_yticks(range(len(names)), names)
    axes.set(xlabel="bytes per vertex", ylim=(len(names) - 0.45, -0.75))
    axes.grid(axis="y", visible=False)


def _parts(cases: pd.DataFrame, kind: str) -> Mapping[str, float]:
    """Bytes per vertex by what they are for, at the largest size."""
    if cases.empty:
        return {}
    case, sums = cases.iloc[-1], dict.fromkeys(PARTS, 0.0)
    for field, size in case["detail"][kind].items():
        last = field.split(".")[1]
        part = next(it for it, names in PARTS.items() if field in names or last in names)
        sums[part] += size / case["vertices"]
    return {part: size for part, size in sums.items() if size}
