"""A long soak: random histories of everything, ``python -m tests.structures.soak``.

A history is a mesh, in every structure that can hold it, and a thousand operations on it; half of
the histories are of triangles, half of polygons. What follows the meshes (render meshes, attributes
of each kind) is drawn for every history, as it takes most of the time. What each operation must do
is predicted; what was refused and what the edits told is compared at every step. All that was left
is looked at every so many steps only, see ``World.check``. Where that finds something, the history
is run again with all of it at every step, which names the step.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from enum import StrEnum
from functools import partial
from typing import Annotated, NamedTuple

import numpy as np
import typer

import hem
from tests.structures.conftest import shuffled
from tests.structures.histories.actions import BATCHES, KINDS, NUMBERS, POLYGON_KINDS, Action
from tests.structures.histories.world import FOLLOWERS, HANDLING, World
from tests.structures.test_polygons import CUBE, mixed, sheet

EVERYTHING = (*3 * KINDS, *BATCHES, *HANDLING)
ON_POLYGONS = (*2 * POLYGON_KINDS, *EVERYTHING)
SHRINKING = ("collapse_edge", "collapse_edges", "flip_edge", "remove_face", "add_face")
MOST_FACES, FEWEST_FACES = 200, 10
LENGTH = 1000
"""Operations in a history."""

FOLLOWING = 0.08
"""How likely each of the followers is; but every twentieth history has all of them."""

PATIENCE = 60
"""Seconds between two lines that tell how far it is."""


class Meshes(StrEnum):
    """What histories are of."""

    BOTH = "both"
    TRIANGLES = "triangles"
    POLYGONS = "polygons"


class History(NamedTuple):
    """A history that can be run again: all of it follows from its seed and number."""

    seed: int
    number: int
    of_polygons: bool
    length: int

    def run(self, every: int) -> Counter[str]:
        """How often what was done. AssertionError, with the step, where something is wrong."""
        rng = np.random.default_rng((self.seed, self.number))
        chosen = np.array(FOLLOWERS)[rng.random(len(FOLLOWERS)) < FOLLOWING].tolist()
        followers = FOLLOWERS if self.number % 20 == 0 else chosen
        world, kinds, found = World(self._start(rng), followers), self._kinds(0), Counter[str]()
        for step in range(self.length):
            action = Action(str(rng.choice(kinds)), *rng.integers(0, NUMBERS, 3).tolist())
            try:
                found[world.step(action)] += 1
                if step % every == 0 or step == self.length - 1:
                    world.check(thorough=every == 1)
            except Exception as error:
                raise AssertionError(f"{self}, step {step}, {action}: {error!r}") from error
            kinds = self._kinds(len(world.surface.faces), kinds)
        return found

    def narrowed(self, every: int) -> Counter[str]:
        """As ``run``; what goes wrong is told of the first step where it does."""
        try:
            return self.run(every)
        except AssertionError:
            self.run(1)
            raise

    def told(self, every: int) -> Counter[str] | str:
        """As ``narrowed``, but what goes wrong is told in words."""
        try:
            return self.narrowed(every)
        except AssertionError as fault:
            return str(fault)

    def _kinds(self, n_faces: int, before: tuple[str, ...] = ()) -> tuple[str, ...]:
        """What may come next: the mesh is kept between bounds."""
        if n_faces > (FEWEST_FACES if before is SHRINKING else MOST_FACES):
            return SHRINKING
        return ON_POLYGONS if self.of_polygons else EVERYTHING

    def _start(self, rng: np.random.Generator) -> hem.TriangleMesh | hem.PolygonMesh:
        if self.of_polygons:
            made = (lambda: CUBE, mixed, sheet, lambda: sheet(2), lambda: sheet(7))
            return made[rng.integers(len(made))]()
        family = str(rng.choice(["torus", "sphere", "grid", "cone", "terrain"]))
        return shuffled(hem.generate(family, int(rng.integers(20, 60))), int(rng.integers(99)))


def histories(meshes: Meshes, steps: int, seed: int) -> Iterator[History]:
    """So many operations in all."""
    for number, begun in enumerate(range(0, steps, LENGTH)):
        of_polygons = meshes is Meshes.POLYGONS or (meshes is Meshes.BOTH and number % 2 == 1)
        yield History(seed, number, of_polygons, min(LENGTH, steps - begun))


def main(
    steps: Annotated[int, typer.Option(help="Operations per structure.")] = 100_000,
    every: Annotated[int, typer.Option(help="Operations between two whole checks.")] = 50,
    seed: Annotated[int, typer.Option(help="Another seed, other operations.")] = 0,
    workers: Annotated[int, typer.Option(help="Processes that do histories at once.")] = 1,
    meshes: Annotated[Meshes, typer.Option(help="What histories are of.")] = Meshes.BOTH,
) -> None:
    """Do anything at random, see ``World``, and tell what goes wrong; then the exit code is 1."""
    all_of_them, found, faults = list(histories(meshes, steps, seed)), Counter[str](), 0
    begun = told = time.monotonic()
    with ProcessPoolExecutor(workers) as pool:
        for done in pool.map(partial(History.told, every=every), all_of_them):
            if isinstance(done, str):
                faults += 1
                print(done, flush=True)
            else:
                found += done
            if time.monotonic() > told + PATIENCE:
                told = time.monotonic()
                print(f"{found.total():,} of {steps:,} after {told - begun:,.0f} s", flush=True)
    for what, count in sorted(found.items(), key=lambda it: -it[1]):
        print(f"{count:8,} {what}")
    print(f"{found.total():,} operations on every structure that holds the mesh: {faults} faults")
    raise typer.Exit(faults > 0)


if __name__ == "__main__":
    typer.run(main)
