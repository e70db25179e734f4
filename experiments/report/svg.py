"""Small plots on logarithmic axes, written as SVG: quick, crisp, and readable in the dark."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

WIDTH, HEIGHT = 320, 208
LEFT, RIGHT, TOP, BOTTOM = 46, 12, 12, 36
"""What the labels need around the axes, in pixels."""

STYLE = """
text { font: 11px system-ui, "Segoe UI", "Liberation Sans", Arial, sans-serif; fill: #555a66; }
.grid { stroke: #e6e6e6; } .frame { stroke: #9a9da6; fill: none; }
.ink { stroke: #111; } .ink-fill { fill: #111; }
.band { fill: #8a8a8a; fill-opacity: .16; } .dash { stroke-dasharray: 5 4; fill: none; }
.claim { stroke: #6b6f7b; stroke-width: 1.6; } .found { stroke: #c23b22; stroke-width: 1.6; }
@media (prefers-color-scheme: dark) {
  text { fill: #a5a8b3; } .grid { stroke: #33353b; } .frame { stroke: #6b6f7b; }
  .ink { stroke: #ececea; } .ink-fill { fill: #ececea; } .claim { stroke: #a5a8b3; }
  .found { stroke: #ff8a75; } }
"""


@dataclass(frozen=True)
class Axis:
    """One direction of a plot: values from ``low`` to ``high`` go to pixels from ``start`` on."""

    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = True

    def __call__(self, values: ArrayLike) -> Array:
        """The pixels of values."""
        ends = np.array([self.low, self.high])
        at = np.asarray(values, float)
        if self.logarithmic:
            at, ends = np.log(np.maximum(at, self.low / 100)), np.log(ends)
        return self.start + (at - ends[0]) / (ends[1] - ends[0]) * (self.end - self.start)

    def ticks(self) -> list[float]:
        """Round values along the axis: powers of ten, or finer where there are too few of them."""
        if not self.logarithmic:
            return _round_steps(self.low, self.high)
        exponents = range(int(np.floor(np.log10(self.low))), int(np.ceil(np.log10(self.high))) + 1)
        every = [10.0**k for k in exponents]
        inside = [it for it in every if self.low <= it <= self.high]
        if len(inside) < 2:
            finer = [step * it for it in every for step in (1, 2, 5)]
            return [it for it in finer if self.low <= it <= self.high]
        return inside[:: -(-len(inside) // 6)]


def _round_steps(low: float, high: float) -> list[float]:
    rough = (high - low) / 4
    power = 10.0 ** np.floor(np.log10(rough))
    step = power * min((1, 2, 5, 10), key=lambda k: abs(k * power - rough))
    return [float(it) for it in step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)]


def logarithmic(values: ArrayLike, start: float, end: float, decades: float = 1.0) -> Axis:
    """An axis over all positive values with some room, at least so many decades long."""
    logs = np.log10([it for it in np.ravel(np.asarray(values, float)) if 0 < it < np.inf] or [1.0])
    middle, half = (logs.min() + logs.max()) / 2, (logs.max() - logs.min()) / 2 * 1.08 + 0.05
    half = max(half, decades / 2)
    return Axis(float(10 ** (middle - half)), float(10 ** (middle + half)), start, end)


def document(parts: Iterable[str], title: str, width: int = WIDTH, height: int = HEIGHT) -> str:
    """A whole file."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}" role="img"><title>{escape(title)}</title>'
        f"<style>{STYLE}</style>{''.join(parts)}</svg>\n"
    )


def axes(x: Axis, y: Axis, across: str, up: str) -> Iterable[str]:
    """Grid, frame, ticks and what the axes show."""
    for value, at in zip(x.ticks(), x(x.ticks()), strict=True):
        yield f'<path class="grid" d="M{at:.1f} {y.start:g}V{y.end:g}"/>'
        yield text(at, y.start + 14, short(value), "middle")
    for value, at in zip(y.ticks(), y(y.ticks()), strict=True):
        yield f'<path class="grid" d="M{x.start:g} {at:.1f}H{x.end:g}"/>'
        yield text(x.start - 5, at + 4, short(value), "end")
    yield f'<path class="frame" d="M{x.start:g} {y.end:g}V{y.start:g}H{x.end:g}"/>'
    yield text(x.end, y.start + 29, across, "end")
    yield text(x.start + 5, y.end + 7, up)


def line(x: Array, y: Array, css: str, style: str = "") -> str:
    """Straight from point to point."""
    return f'<path class="{css}"{_style(style)} d="{_path(x, y)}"/>'


def band(x: Array, low: Array, high: Array) -> str:
    """What lies between two lines."""
    around = _path(np.r_[x, x[::-1]], np.r_[low, high[::-1]])
    return f'<path class="band" d="{around}Z"/>'


def bar(x: float, y: float, width: float, height: float) -> str:
    """A gray box."""
    return f'<rect class="band" x="{x:.1f}" y="{y:g}" width="{width:.1f}" height="{height:g}"/>'


def dots(x: Array, y: Array, css: str, style: str = "", radius: float = 3) -> str:
    """A dot per point."""
    circles = "".join(
        f'<circle cx="{a:.1f}" cy="{b:.1f}" r="{radius:g}"/>' for a, b in zip(x, y, strict=True)
    )
    return f'<g class="{css}"{_style(style)}>{circles}</g>'


def whiskers(x: Array, low: Array, high: Array, css: str, style: str = "") -> str:
    """An upright line per point."""
    each = "".join(
        f"M{a:.1f} {b:.1f}V{c:.1f}" for a, b, c in zip(x, low, high, strict=True) if b - c > 1
    )
    return f'<path class="{css}"{_style(style)} d="{each}"/>' if each else ""


def text(x: float, y: float, words: str, anchor: str = "start") -> str:
    """Words that begin, end or have their middle at a point."""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def short(value: float) -> str:
    """A number that stands at a tick, such as ``10k``."""
    for size, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= size:
            return f"{value / size:g}{unit}"
    return f"{value:g}"


def _path(x: Array, y: Array) -> str:
    return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(x, y, strict=True))


def _style(style: str) -> str:
    return f' style="{style}"' if style else ""
