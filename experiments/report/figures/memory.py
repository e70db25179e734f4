"""Bytes per vertex as stacked bars: by field, and by what they are for."""

from collections.abc import Iterable, Mapping
from itertools import groupby
from operator import itemgetter
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from experiments.claims import Exactly, curves, load_claims
from experiments.report.session import require
from experiments.report.style import STYLES, Plot, styled
from experiments.report.tables import spelled
from experiments.runs import Run
from structures import NAMED, REGISTRY

PARTS = {
    "positions": ("vertex.point",),
    "references": ("half_edge", "origin", "face", "next", "opposite", "twin"),
    "indices": ("index",), "event": ("position_changed",), "headers": ("header",),
    "padding": ("padding",), "lists": ("list",), "objects": ("object",),
}  # fmt: skip
"""What bytes are for, by the names of their fields."""


def by_field(run: Run) -> Plot:
    """Bytes per vertex of arrays, stacked by field: as published, as modeled, and as traced."""
    names = [name for name, structure in REGISTRY.items() if structure.compiled]
    every = (curves(run).memory(name, size).cases.tail(1) for name in names for size in (8, 4))
    measured = [it for cases in every for it in cases.to_dict("records") if it["detail"]]
    rows = list(dict.fromkeys(case["structure"] for case in measured))
    with styled():
        plot, axes = _rows([NAMED[name].title for name in rows], 1.25, 1.1)
        for case in measured:
            name, sizes = case["structure"], case["detail"]["fields"].items()
            height = rows.index(name) + (-0.19 if case["reference_bytes"] == 8 else 0.19)
            fields = {field: size / case["vertices"] for field, size in sizes}
            traced, peak = (case["detail"][key] / case["vertices"] for key in ("traced", "peak"))
            note = f"{sum(fields.values()):.4g} B with {case['reference_bytes']}-byte references"
            note += f" · {traced:.1f} traced · {peak:.0f} at the peak"
            _bar(axes, height, 0.36, fields, STYLES[name]["color"], note, 2.9)
            if height > rows.index(name):
                axes.text(1, height + 0.2, in_words(fields), va="top", fontsize=7)
        for claim in load_claims():
            name, claimed = claim.structure, claim.expects
            if name in rows and isinstance(claimed, Exactly) and claimed.value:
                top, value = rows.index(name) - 0.42, float(claimed.value)
                axes.plot([value, value], [top, top + 0.44], color="black", linewidth=2.5)
                words = "published in the thesis" if name == rows[0] else ""
                axes.text(value, top - 0.04, words, ha="center", fontsize=8, fontweight="bold")
        axes.set_xlim(0, 395)
        axes.set_xlabel(
            "bytes per vertex (traced: what Python's allocator hands out for the finished "
            "structure; at the peak: while it is built)"
        )
    return plot


def references(run: Run) -> Plot:
    """Bytes per vertex of one half-edge mesh by what holds it: arrays, and objects."""
    arrays, objects = "half_edge", "half_edge_objects"
    held = {
        "arrays, 8-byte references": (arrays, 8, "fields"),
        "arrays, 4-byte references": (arrays, 4, "fields"),
        "objects, as the thesis' runtime lays them out (model)": (objects, 8, "clr"),
        "objects, in Python (measured)": (objects, 8, "fields"),
    }
    bars = {}
    for title, (name, size, kind) in held.items():
        if parts := _parts(curves(run).memory(name, size).cases, kind):
            bars[title] = name, parts
    with styled():
        plot, axes = _rows(list(bars), 0.6, 0.5)
        for row, (name, parts) in enumerate(bars.values()):
            total = f"{sum(parts.values()):,.0f}"
            _bar(axes, row, 0.62, parts, STYLES[name]["color"], total, 9, fontweight="bold")
        axes.margins(x=0.08)
    return plot


def _rows(names: list[str], height: float, more: float) -> tuple[Plot, Axes]:
    """A row for each name. Raises MissingError if there is none."""
    require(names, "measured memory field by field")
    plot = Plot(figsize=(11, height * len(names) + more), layout="constrained")
    axes = plot.subplots()
    axes.set_yticks(range(len(names)), names)
    axes.set(xlabel="bytes per vertex", ylim=(len(names) - 0.45, -0.75))
    axes.grid(axis="y", visible=False)
    return plot, axes


def _bar(
    axes: Axes, height: float, thickness: float, parts: Mapping[str, float], color: str, note: str,
    letter: float, **look: Any,
) -> None:  # fmt: skip
    """A stacked bar whose parts are named where letters of this width fit, and a note beside it."""
    start = 0.0
    for k, (part, size) in enumerate(parts.items()):
        name = spelled(part.rpartition(".")[2])
        shade = 0.28 if k % 2 else 0.48
        axes.barh(height, size, thickness, start, color=color, alpha=shade, edgecolor="white")
        if size > letter * len(name):
            axes.text(start + size / 2, height, name, ha="center", va="center", fontsize=8)
        start += size
    axes.text(start + 4, height, note, va="center", **{"fontsize": 9, **look})


def in_words(fields: Iterable[str]) -> str:
    """Fields in the order of a bar, behind their records: a narrow part of it has no name."""
    records = groupby((it.split(".") for it in fields), key=itemgetter(0))
    told = (f"{record}: {', '.join(name for _, name in its)}" for record, its in records)
    return spelled(" · ".join(told))


def _parts(cases: pd.DataFrame, kind: str) -> dict[str, float]:
    """Bytes per vertex by what they are for, at the largest size."""
    sums = dict.fromkeys(PARTS, 0.0)
    for case in cases.tail(1).to_dict("records"):
        for field, size in case["detail"].get(kind, {}).items():
            known = {field, field.split(".")[1]}
            part = next(part for part, names in PARTS.items() if known & set(names))
            sums[part] += size / case["vertices"]
    return {part: size for part, size in sums.items() if size}
