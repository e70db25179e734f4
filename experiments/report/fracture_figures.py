"""The figures of the chapter on destruction: the thesis' figure 11, bodies, what it costs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from html import escape
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

import hem
import structures
from experiments.report.fracture_scenes import Broken, break_up, model
from experiments.report.mesh_figures import INK, PAPER, STRONG, show_picture
from experiments.report.style import styled
from experiments.report.turnable import turnable_pieces
from hem.fracture import MATERIALS, Fracture, material, shatter
from hem.fracture.show import Image, PicturesMissingError

Array = NDArray[Any]

APART = 0.4
"""How far shards are drawn from where they came out; a part of their distance to the impact."""

IMPACTS = ((0.5, 0.5), (0.3, 0.72), (0.86, 0.5), (0.06, 0.06))
"""Where a plate of side 1 is struck: about the middle, off it, near a side, in a corner."""

FORCES = (1.0, 10.0, 50.0)
CENTER = (0.47, 0.52)


def plate(squares: int = 5) -> hem.TriangleMesh:
    """A flat plate of side 1, of squares cut in two, as the thesis breaks it."""
    n = squares + 1
    at = np.arange(n * n).reshape(n, n)
    a, b, c, d = (it.ravel() for it in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    y, x = np.divmod(np.arange(n * n), n) / np.array([[squares], [squares]])
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return hem.TriangleMesh(np.stack([x, y, 0 * x], axis=1), faces)


def impacts(name: str = "glass") -> Figure:
    """Figure 11: a plate, struck in several places."""
    titles = "About the middle", "Off the middle", "Near a side", "In a corner"
    return _plates([(it, name, at) for it, at in zip(titles, IMPACTS, strict=True)])


def materials() -> Figure:
    """The same blow on plates of all materials."""
    return _plates([(it.capitalize(), it, CENTER) for it in MATERIALS])


def _plates(every: Sequence[tuple[str, str, tuple[float, float]]]) -> Figure:
    with styled():
        figure = Figure(figsize=(3.3 * len(every), 3.6), layout="constrained")
        panels = figure.subplots(1, len(every), squeeze=False)[0]
        for axes, (title, name, at) in zip(panels, every, strict=True):
            s = structures.build("half_edge", plate())
            broken = shatter(s, (*at, 0), name, seed=4)
            _draw_plate(axes, broken)
            axes.set_title(f"{title}: {len(broken.shards)} shards")
    return figure


def _draw_plate(axes: Axes, broken: Fracture) -> None:
    """The rest in place, every shard moved away from the impact."""
    rest = np.concatenate([part.points[part.triangles] for part in broken.rest])[:, :, :2]
    shards = np.array([it.points for it in broken.shards])[:, :, :2].astype(float)
    moved = shards + APART * (shards.mean(axis=1, keepdims=True) - broken.impact[:2])
    for corners, color, width in ((rest, PAPER, 0.5), (moved, broken.material.color, 0.3)):
        drawn = PolyCollection(list(corners), facecolors=color, edgecolors=INK, linewidths=width)
        axes.add_collection(drawn)
    axes.plot(*broken.impact[:2], "x", color=STRONG, markersize=7, markeredgewidth=2)
    axes.set(xlim=(-0.22, 1.22), ylim=(-0.22, 1.22), aspect="equal")
    axes.axis("off")


def broken_by_force(
    name: str, material_name: str, forces: Sequence[float] = FORCES, wrap: bool = False
) -> list[Broken]:
    """A model under Voronoi fracture by blows of several forces, J/kg, in the same place."""
    mesh, up = model(name, wrap)
    chosen = material(material_name)
    return [break_up(mesh, "voronoi", chosen, force, up=up) for force in forces]


def tetrahedra(name: str = "sphere:162", force: float = 2.0) -> Broken:
    """A model of few and therefore large faces, broken into tetrahedra."""
    mesh, up = model(name)
    return break_up(mesh, "tetra", material("stone"), force, up=up)


def gallery(every: Sequence[Broken]) -> Figure:
    """Each fracture in a row of its own: in place on the left, exploded on the right."""
    with styled():
        figure = Figure(figsize=(9.6, 3.75 * len(every)), layout="constrained")
        for axes, broken in zip(
            figure.subplots(len(every), squeeze=False)[:, 0], every, strict=True
        ):
            show_picture(axes, _title(broken), partial(_still, broken))
    return figure


def _still(broken: Broken) -> Image:
    return broken.scene().still()


def turnable(broken: Broken) -> str:
    """The pieces to be turned with the mouse, as HTML; without PyVista what is missing."""
    try:
        return turnable_pieces(broken.scene(), _title(broken), broken.up)
    except PicturesMissingError as missing:
        return f"<p>{escape(str(missing))}</p>"


def _title(broken: Broken) -> str:
    found = broken.fracture
    parts = found.mass.volumes / found.mass.volumes.sum()
    shards = parts[: len(found.shards)]
    return (
        f"{found.material.name.capitalize()}, {broken.blow.force:g} J/kg: {len(shards):,} shards, "
        f"{shards.sum():.0%} of the volume, the median one {100 * np.median(shards):.2g}%"
    )
