"""A long soak: random operations on every structure at once, ``python -m tests.structures.soak``.

Every operation must have the same result on all of them; every so often the meshes are validated
and compared as a whole. The mesh is kept between bounds, so that whatever can happen does happen.
"""

from __future__ import annotations

from collections import Counter
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.progress import track

import hem
import structures
from tests.structures.actions import BATCHES, KINDS, Action
from tests.structures.conftest import shuffled
from tests.structures.world import HANDLING, World

EVERYTHING = (*3 * KINDS, *BATCHES, *HANDLING)
SHRINKING = ("collapse_edge", "collapse_edges", "flip_edge", "remove_face", "add_face")
MOST_FACES, FEWEST_FACES = 400, 20
NUMBERS = 5040


def main(
    operations: Annotated[int, typer.Option(help="Operations per structure.")] = 100_000,
    every: Annotated[int, typer.Option(help="Operations between two validations.")] = 100,
    seed: Annotated[int, typer.Option(help="Another seed, other operations.")] = 0,
) -> None:
    """Do anything at random until something is found or all is done, see ``World``."""
    rng, found = np.random.default_rng(seed), Counter[str]()
    world, shrinking = World(_start(rng)), False
    for step in track(range(operations), console=Console(stderr=True), description="Soaking"):
        kind = str(rng.choice(SHRINKING if shrinking else EVERYTHING))
        try:
            found[world.step(Action(kind, *rng.integers(0, NUMBERS, 3).tolist()))] += 1
            if step % every == 0:
                world.check()
        except AssertionError as error:
            raise AssertionError(f"step {step}, seed {seed}, {kind}: {error}") from error
        if step % every == 0:
            n_faces = world.many[0].n_faces
            shrinking = n_faces > (FEWEST_FACES if shrinking else MOST_FACES)
            if n_faces < FEWEST_FACES or step % (50 * every) == 0:
                world = World(_start(rng))
    world.check()
    for what, count in sorted(found.items(), key=lambda it: -it[1]):
        print(f"{count:8,} {what}")
    print(f"{operations:,} operations on each of {', '.join(structures.NAMES)}: nothing found")


def _start(rng: np.random.Generator) -> hem.TriangleMesh:
    family = str(rng.choice(["torus", "sphere", "grid", "cone", "terrain"]))
    return shuffled(hem.generate(family, int(rng.integers(30, 120))), int(rng.integers(99)))


if __name__ == "__main__":
    typer.run(main)
