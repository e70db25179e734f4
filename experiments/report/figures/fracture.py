"""The figures of the chapter on destruction: the thesis' figure 11, bodies, what it costs."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

import hem
import structures
from experiments.report.figures.meshes import INK, PAPER, STRONG, turnable
from experiments.report.fracture_scenes import Broken, break_up, model
from experiments.report.pages import Html
from experiments.report.style import grid, styled
from hem.fracture import MATERIALS, material, shatter

APART = 0.4  # how far shards are drawn from their places, as part of the way to the impact
FORCES = (1.0, 10.0, 50.0)
CENTER = (0.47, 0.52)
IMPACTS = {
    "About the middle": (0.5, 0.5), "Off the middle": (0.3, 0.72),
    "Near a side": (0.86, 0.5), "In a corner": (0.06, 0.06),
}  # fmt: skip
"""Where a plate of side 1 is struck."""


def plate() -> hem.TriangleMesh:
    """A flat plate of side 1, of squares cut in two, as the thesis breaks it."""
    squares = 5
    n = squares + 1
    a = (np.arange(squares) + n * np.arange(squares)[:, None]).ravel()
    y, x = np.divmod(np.arange(n * n), n) / np.array([[squares], [squares]])
    faces = [np.stack(it, axis=1) for it in ((a, a + 1, a + n + 1), (a, a + n + 1, a + n))]
    return hem.TriangleMesh(np.stack([x, y, 0 * x], axis=1), np.concatenate(faces))


def impacts() -> Figure:
    """Figure 11: a plate of glass, struck in several places."""
    return _plates([(title, "glass", at) for title, at in IMPACTS.items()])


def materials() -> Figure:
    """The same blow on plates of all materials."""
    return _plates([(it.capitalize(), it, CENTER) for it in MATERIALS])


def _plates(every: Sequence[tuple[str, str, tuple[float, float]]]) -> Figure:
    """The rest of each plate in place, every shard moved away from the impact."""
    with styled():
        figure, panels = grid([title for title, _, _ in every], (3.3, 3.6))
        for axes, (title, name, at) in zip(panels, every, strict=True):
            broken = shatter(structures.build("half_edge", plate()), (*at, 0), name, seed=4)
            rest = np.concatenate([part.points[part.triangles] for part in broken.rest])[:, :, :2]
            shards = np.array([it.points for it in broken.shards])[:, :, :2].astype(float)
            moved = shards + APART * (shards.mean(axis=1, keepdims=True) - broken.impact[:2])
            for corners, color, width in ((rest, PAPER, 0.5), (moved, broken.material.color, 0.3)):
                look: Any = {"facecolors": color, "edgecolors": INK, "linewidths": width}
                axes.add_collection(PolyCollection(list(corners), **look))
            axes.plot(*broken.impact[:2], "x", color=STRONG, markersize=7, markeredgewidth=2)
            axes.set(xlim=(-0.22, 1.22), ylim=(-0.22, 1.22), aspect="equal")
            axes.set_title(f"{title}: {len(broken.shards)} shards")
            axes.axis("off")
    return figure


@cache
def broken_by_force(
    name: str, of: str, *forces: float, method: str = "voronoi", wrap: bool = False
) -> tuple[Broken, ...]:
    """A model of a material, struck in the same place with several forces, J/kg."""
    mesh, up = model(name, wrap)
    return tuple(break_up(mesh, method, material(of), it, up=up) for it in forces or FORCES)


def gallery(every: Sequence[Broken]) -> Figure:
    """Each fracture in a row of its own: in place on the left, exploded on the right."""
    with styled():
        figure, panels = grid(list(map(_title, every)), (9.6, 3.75), 1)
        for axes, broken in zip(panels, every, strict=True):
            axes.imshow(broken.scene().still())
            axes.axis("off")
    return figure


def turnable_pieces(broken: Broken) -> Html:
    """The pieces to be turned with the mouse."""
    return turnable(broken.scene(), _title(broken), broken.up)


def _title(broken: Broken) -> str:
    found = broken.fracture
    shards = (found.mass.volumes / found.mass.volumes.sum())[: len(found.shards)]
    return (
        f"{found.material.name.capitalize()}, {broken.blow.force:g} J/kg: {len(shards):,} shards, "
        f"{shards.sum():.0%} of the volume, the median one {100 * np.median(shards):.2g}%"
    )
