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
from experiments.harness import (
    HUBS,
    OPERATIONS,
    OPERATIONS_TABLE,
    RENDERED,
    Axis,
    Case,
    Experiment,
    Keep,
    Measurement,
    Preset,
    Timer,
    count_elements,
    operation_arguments,
    operation_faces,
    time_operations,
)
from hem.contract import Structure
from structures import NAMES

FEWEST_HUBS = 64
"""In a mesh whose valence is varied; with fewer operations at a time they are not worth timing."""

SINGLE_FACES = 50

ANEW = "render mesh built anew"

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


SET_UP: dict[str, Callable[[Structure], Ending]] = dict(
    zip(RENDERED, (_rendered, _in_a_transaction, _built_anew), strict=True)
)
"""Ways to keep a render mesh up to date: the order of a case, and what is set up -> how it ends."""


def cases(preset: Preset, structure: str) -> list[Case]:
    """Batched by size and by valence; one by one, and with a render mesh, at some of the sizes."""
    family, faces = preset.families[0], preset.operation_faces
    by_size = [(family, size, None) for size in preset.operation_sizes]
    by_valence = [(HUBS, faces, k) for k in preset.valences if k <= faces // FEWEST_HUBS]
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
            for size in preset.single_sizes
            for operation, order in (*singly, *rendered)
        ),
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time one case, and check what the operations make of the mesh."""
    timed = (time_operations if case.order == "batched" else _time_one_by_one)(case, preset, timer)
    return case.result("time", case.build(), checked=True, **timed)


def _time_one_by_one(case: Case, preset: Preset, timer: Timer) -> dict[str, Any]:
    s, operation = case.build(), str(case.subject)
    few = count_elements(case, SINGLE_FACES, scanned=case.order == ANEW)
    first, *faces = operation_faces(case, few).tolist()
    set_up = SET_UP.get(str(case.order), _alone)
    given = 3 if operation == "add_face" else 1
    point = ((0.0, 0.0, 0.0),) if operation.startswith("split") else ()

    def fresh() -> tuple[tuple[Any, list[list[int]], Ending], dict[str, Any]]:
        copy = s.copy()
        copy.reserve(2 * SINGLE_FACES)
        rows = operation_arguments(copy, operation, np.array(faces))[:, :given].tolist()
        end = set_up(copy)
        copy.split_face(first, (0, 0, 0))  # makes room, here and in the render mesh
        return (getattr(copy, operation), rows, end), {}

    def operate(method: Callable[..., Any], rows: list[list[int]], end: Ending) -> None:
        for row in rows:
            method(*row, *point)
        end()

    timed = timer(operate, setup=fresh, rounds=preset.rounds, per=len(faces))
    return {**timed.fields, "handles": len(faces)}


EXPERIMENT = Experiment(
    title="Time of operations",
    kind="time",
    cases=cases,
    measure=measure,
    structures=NAMES,
    copies=18,
    turn=42,
    table=OPERATIONS_TABLE,
    axes={Axis.TIME_FACES: "batched", Axis.TIME_VALENCE: "batched"},
    just_written=frozenset({Axis.TIME_FACES}),
    baseline_orders=("batched",),
)


def test_operation(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
    """Time one case."""
    keep(measure(case, preset, timer))
