"""Time of the operations: batched by size and by valence; one by one; and with a render mesh.

Always on copies that are restored before every round. One by one, an operation includes the call
from Python and its ``Edit``. The render mesh is followed edit by edit, in one transaction, or built
anew after every edit, as the thesis prints it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import hem
from experiments.claims import OPERATIONS
from experiments.conftest import Keep
from experiments.operating import faces_of, time_operations
from experiments.profiles import HUBS, Profile
from experiments.subjects import Cell
from hem.structure import Structure
from structures import NAMES as STRUCTURES

FEWEST_HUBS = 32
"""In a mesh whose valence is varied; with fewer operations at a time they are not worth timing."""

SINGLE_FACES = 50
BUILT_ANEW = 5  # as many faces as are split where each split takes a scan of the mesh


Ending = Callable[[], Any]


def _alone(s: Structure) -> Ending:
    return lambda: None


def _rendered(s: Structure) -> Ending:
    hem.RenderMesh(s)
    return lambda: None


def _in_a_transaction(s: Structure) -> Ending:
    transaction = hem.RenderMesh(s).transaction()
    transaction.__enter__()
    return lambda: transaction.__exit__(None, None, None)


def _built_anew(s: Structure) -> Ending:
    s.subscribe(lambda edit: hem.RenderMesh(s).close())
    return lambda: None


ONE_BY_ONE: dict[str, Callable[[Structure], Ending]] = {
    "one by one": _alone,
    "rendered": _rendered,
    "in a transaction": _in_a_transaction,
    "render mesh built anew": _built_anew,
}
"""Orders of a cell that splits faces from Python, and what is set up for it -> how it ends."""


def cells(profile: Profile, structure: str) -> list[Cell]:
    """By size and by valence every operation; by size the ways to split faces one by one."""
    family, faces = profile.families[0], profile.operation_faces
    by_size = [(family, size, None) for size in profile.operation_sizes]
    by_valence = [(HUBS, faces, k) for k in profile.valences if k <= faces // FEWEST_HUBS]
    return [
        *(
            Cell(structure, family, size, operation, "batched", valence)
            for family, size, valence in (*by_size, *by_valence)
            for operation in OPERATIONS
        ),
        *(
            Cell(structure, family, size, "split_face", order)
            for size in profile.operation_sizes[::2]
            for order in ONE_BY_ONE
        ),
    ]


def test_operation(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Time one cell, and check what the operations make of the mesh."""
    s = cell.build()
    if cell.order == "batched":
        timed = time_operations(benchmark, cell, profile)
    else:
        timed = _time_one_by_one(benchmark, cell, profile)
    keep(cell.result("time", s, checked=True, **timed))


def _single_faces(cell: Cell) -> list[int]:
    scanned = cell.order == "render mesh built anew"
    return faces_of(cell, BUILT_ANEW if scanned else SINGLE_FACES).tolist()


def _time_one_by_one(benchmark: Any, cell: Cell, profile: Profile) -> dict[str, Any]:
    s, (first, *faces) = cell.build(), _single_faces(cell)

    def fresh() -> tuple[tuple[Structure, Ending], dict[str, Any]]:
        copy = s.copy()
        copy.reserve(2 * SINGLE_FACES)
        end = ONE_BY_ONE[str(cell.order)](copy)
        copy.split_face(first, (0, 0, 0))  # makes room, here and in the render mesh
        return (copy, end), {}

    def split(copy: Structure, end: Ending) -> None:
        for face in faces:
            copy.split_face(face, (0, 0, 0))
        end()

    benchmark.pedantic(split, setup=fresh, rounds=profile.rounds, warmup_rounds=1)
    data = benchmark.stats.stats.data if benchmark.stats else []
    return {"samples": np.array(data) / len(faces), "handles": len(faces)}


__all__ = ["STRUCTURES", "cells", "test_operation"]
