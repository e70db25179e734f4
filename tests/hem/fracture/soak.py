"""The laws of destruction, for 100 seeds on every model: ``python -m tests.hem.fracture.soak``."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.progress import track

import structures
from hem.fracture import MATERIALS, Fracture, require_body, shatter, tetrahedra, voronoi
from hem.fracture.surface.shatter import TOLERANCE
from tests.hem.fracture.laws import (
    MODELS,
    body,
    require_body_laws,
    require_surface_laws,
    struck,
    surface,
)

FORCES = (0.1, 1.0, 5.0, 25.0)
NAMES = tuple(MATERIALS)


def by_surface(model: str) -> Callable[[int], Fracture]:
    """Shatter on every structure: the same shards, and the laws of a surface."""
    mesh = surface(model)
    least = TOLERANCE * float(np.linalg.norm(np.ptp(mesh.points.astype(float), axis=0)))
    originals = [structures.build(name, mesh) for name in structures.NAMES]

    def check(seed: int) -> Fracture:
        first, *others = (
            shatter(it.copy(), struck(mesh, seed), NAMES[seed % len(NAMES)], seed)
            for it in originals
        )
        for other in others:
            same = np.array_equal(
                [it.points for it in other.shards], [it.points for it in first.shards]
            )
            if not same or other.counts != first.counts:
                raise AssertionError(f"{model}, seed {seed}: other shards on another structure")
        require_surface_laws(mesh, first, least)
        return first

    return check


def by_tetrahedra(model: str) -> Callable[[int], Fracture]:
    """Tetrahedra on the half-edge mesh, and the laws of bodies."""
    mesh = body(model)
    original = structures.build("half_edge", mesh)

    def check(seed: int) -> Fracture:
        how = NAMES[seed % len(NAMES)], FORCES[seed % len(FORCES)], seed
        broken = tetrahedra(original.copy(), struck(mesh, seed), *how)
        require_body_laws(mesh, broken)
        return broken

    return check


def by_voronoi(model: str) -> Callable[[int], Fracture]:
    """Voronoi cells, and the laws of bodies."""
    mesh = body(model)
    whole = require_body(mesh)

    def check(seed: int) -> Fracture:
        how = NAMES[seed % len(NAMES)], FORCES[seed % len(FORCES)], seed
        broken = voronoi(whole, struck(mesh, seed), *how)
        require_body_laws(mesh, broken)
        return broken

    return check


METHODS = {"surface": by_surface, "tetra": by_tetrahedra, "voronoi": by_voronoi}


def main(
    seeds: Annotated[int, typer.Option(help="How many of each model and method.")] = 100,
    method: Annotated[list[str] | None, typer.Option(help="Just this; may be repeated.")] = None,
) -> None:
    """Break everything so many times, until a law does not hold or all is done."""
    console = Console(stderr=True)
    for name in method or METHODS:
        for model in MODELS:
            check, pieces, begin = METHODS[name](model), 0, perf_counter()
            for seed in track(range(seeds), f"{name}, {model}", console=console):
                pieces += len(check(seed).pieces)
            took = perf_counter() - begin
            print(
                f"{name:8} {model:7} {seeds} seeds, {pieces:,} pieces, {took:.0f} s: nothing found"
            )


if __name__ == "__main__":
    typer.run(main)
