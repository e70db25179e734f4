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
from tests.structures.actions import EULER, KINDS, Action, aim, check, perform
from tests.structures.conftest import shuffled

SHRINKING = ("collapse_edge", "collapse_edge", "flip_edge", "remove_face", "add_face")
MOST_FACES, FEWEST_FACES = 400, 20
NUMBERS = 5040


def main(
    operations: Annotated[int, typer.Option(help="Operations per structure.")] = 100_000,
    every: Annotated[int, typer.Option(help="Operations between two validations.")] = 100,
    seed: Annotated[int, typer.Option(help="Another seed, other operations.")] = 0,
) -> None:
    """Operate at random until something is found or all is done; render meshes follow."""
    rng, found = np.random.default_rng(seed), Counter[str]()
    many = _start(rng)
    renders = [hem.RenderMesh(s) for s in many]
    euler: int | None = check(many, None)
    shrinking = False
    for step in track(range(operations), console=Console(stderr=True), description="Soaking"):
        kind = str(rng.choice(SHRINKING if shrinking else KINDS))
        aimed = aim(many[0], Action(kind, *rng.integers(0, NUMBERS, 3).tolist()))
        if aimed is None:
            continue
        results = [perform(s, aimed) for s in many]
        if any(result != results[0] for result in results):
            raise AssertionError(f"step {step}, seed {seed}: {aimed} gave {results}")
        refused = isinstance(results[0], str)
        found[results[0] if refused else kind] += 1
        if kind in EULER and not refused:
            euler = None
        if step % every == 0:
            euler = check(many, euler)
            _compare(renders, many)
            shrinking = many[0].n_faces > (FEWEST_FACES if shrinking else MOST_FACES)
            if many[0].n_faces < FEWEST_FACES or step % (50 * every) == 0:
                many = _start(rng)
                renders = [hem.RenderMesh(s) for s in many]
                euler = check(many, None)
            elif step % (10 * every) == 0:
                for s in many:
                    s.compact()
    check(many, euler)
    _compare(renders, many)
    for what, count in sorted(found.items(), key=lambda it: -it[1]):
        print(f"{count:8,} {what}")
    print(f"{operations:,} operations on each of {', '.join(structures.NAMES)}: nothing found")


def _start(rng: np.random.Generator) -> list[structures.Structure]:
    family = str(rng.choice(["torus", "sphere", "grid", "cone", "terrain"]))
    mesh = shuffled(hem.generate(family, int(rng.integers(30, 120))), int(rng.integers(99)))
    return [structures.build(name, mesh) for name in structures.NAMES]


def _compare(renders: list[hem.RenderMesh], many: list[structures.Structure]) -> None:
    for render, s in zip(renders, many, strict=True):
        afresh = hem.RenderMesh(s)
        assert np.array_equal(render.points, afresh.points)
        assert np.array_equal(render.indices, afresh.indices)
        afresh.close()


if __name__ == "__main__":
    typer.run(main)
