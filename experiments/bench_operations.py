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
from experiments.claims.growth import OPERATIONS
from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.operations import NOT_SCANNED, arguments, faces_of, time_operations
from experiments.harness.presets import HUBS, Preset
from hem.contract.structure import Structure
from structures import NAMES as STRUCTURES

FEWEST_HUBS = 64
"""In a mesh whose valence is varied; with fewer operations at a time they are not worth timing."""

SINGLE_FACES = 50
SCANNED_FACES = 5
"""How many are operated on where every operation takes a scan of the mesh."""


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


RENDERED: dict[str, Callable[[Structure], Ending]] = {
    "rendered": _rendered,
    "in a transaction": _in_a_transaction,
    "render mesh built anew": _built_anew,
}
"""Ways to keep a render mesh up to date: the order of a case, and what is set up -> how it ends."""


def cases(profile: Preset, structure: str) -> list[Case]:
    """Batched by size and by valence; one by one, and with a render mesh, at some of the sizes."""
    family, faces = profile.families[0], profile.operation_faces
    by_size = [(family, size, None) for size in profile.operation_sizes]
    by_valence = [(HUBS, faces, k) for k in profile.valences if k <= faces // FEWEST_HUBS]
    some = profile.operation_sizes[::2]
    singly = [(operation, "one by one") for operation in OPERATIONS]
    rendered = [("split_face", order) for order in RENDERED]
    return [
        *(
            Case(structure, family, size, operation, "batched", valence)
            for family, size, valence in (*by_size, *by_valence)
            for operation in OPERATIONS
        ),
        *(
            Case(structure, family, size, operation, order)
            for size in some
            for operation, order in (*singly, *rendered)
        ),
    ]


def test_operation(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Time one case, and check what the operations make of the mesh."""
    s = case.build()
    if case.order == "batched":
        timed = time_operations(benchmark, case, profile)
    else:
        timed = _time_one_by_one(benchmark, case, profile)
    keep(case.result("time", s, checked=True, **timed))


def _single_faces(case: Case) -> list[int]:
    scanned = case.structure == "indexed" and case.subject not in NOT_SCANNED
    few = scanned or case.order == "render mesh built anew"
    return faces_of(case, SCANNED_FACES if few else SINGLE_FACES).tolist()


def _time_one_by_one(benchmark: Any, case: Case, profile: Preset) -> dict[str, Any]:
    s, operation, (first, *faces) = case.build(), str(case.subject), _single_faces(case)
    set_up = RENDERED.get(str(case.order), _alone)
    given = 3 if operation == "add_face" else 1
    point = ((0.0, 0.0, 0.0),) if operation.startswith("split") else ()

    def fresh() -> tuple[tuple[Any, list[list[int]], Ending], dict[str, Any]]:
        copy = s.copy()
        copy.reserve(2 * SINGLE_FACES)
        rows = arguments(copy, operation, np.array(faces))[:, :given].tolist()
        end = set_up(copy)
        copy.split_face(first, (0, 0, 0))  # makes room, here and in the render mesh
        return (getattr(copy, operation), rows, end), {}

    def operate(method: Callable[..., Any], rows: list[list[int]], end: Ending) -> None:
        for row in rows:
            method(*row, *point)
        end()

    benchmark.pedantic(operate, setup=fresh, rounds=profile.rounds, warmup_rounds=1)
    data = benchmark.stats.stats.data if benchmark.stats else []
    return {"samples": np.array(data) / len(faces), "handles": len(faces)}


__all__ = ["STRUCTURES", "cases", "test_operation"]
