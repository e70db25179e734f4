"""Time of the operations: batched by size and by valence; one by one; and with a render mesh.

Always on copies that are restored before every round. One by one, an operation includes the call
from Python and its ``Edit``. The render mesh is followed edit by edit, in one transaction, or built
anew after every edit, as the thesis prints it.
"""

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import numpy as np

import hem
from experiments import harness
from experiments.harness import Axis, Case, Experiment, Measurement, Preset, Timer
from hem.contract import Structure

FEWEST_HUBS = 64  # in a mesh whose valence is varied; fewer are not worth timing
SINGLE_FACES = 50
SCANNED_FACES = 5  # how many are operated on one by one where each takes a scan of the mesh

Ending = Callable[[], hem.RenderMesh | None]
RENDERED = EACH, TOGETHER, ANEW = "rendered", "in a transaction", "render mesh built anew"
"""Ways to keep a render mesh up to date, by the name of the order in a case."""


def cases(preset: Preset, structure: str) -> list[Case]:
    """Batched by size and by valence; one by one, and with a render mesh, at some of the sizes.

    Batched at some of them on irregular meshes as well, which advice on models rests on.
    """
    family, faces = preset.families[0], preset.operation_faces
    meshes: list[tuple[str, int, int | None]]
    meshes = [(family, size, None) for size in preset.operation_sizes]
    if harness.IRREGULAR in preset.families[1:]:
        meshes += [(harness.IRREGULAR, size, None) for size in preset.operation_sizes[1::2]]
    meshes += [(harness.HUBS, faces, k) for k in preset.valences if k <= faces // FEWEST_HUBS]
    operations = harness.measured_operations(preset)
    batched = [
        Case(structure, where, size, operation, "batched", valence)
        for where, size, valence in meshes
        for operation in operations
    ]
    singly = [(operation, "one by one") for operation in operations]
    singly += [("split_face", order) for order in RENDERED]
    sizes = preset.single_sizes
    return batched + [Case(structure, family, size, *it) for size in sizes for it in singly]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time one case, and check what the operations make of the mesh."""
    time = harness.time_operations if case.order == "batched" else _time_one_by_one
    return case.result("time", case.build(), **time(case, preset, timer))


def _follow(order: str, s: Structure, followed: ExitStack) -> Ending:
    """Have a render mesh follow what is done, in some orders -> how that ends, which gives it.

    ``followed`` is told how to let go of the mesh, which is freed no sooner.
    """
    if order == ANEW:
        followed.callback(s.subscribe(lambda edit: hem.RenderMesh(s).close()))
    if order not in (EACH, TOGETHER):
        return lambda: None
    render = hem.RenderMesh(s)
    followed.callback(render.close)
    if order == EACH:
        return lambda: render
    transaction = render.transaction()
    transaction.__enter__()

    def commit() -> hem.RenderMesh:
        transaction.__exit__(None, None, None)
        return render

    return commit


def _time_one_by_one(case: Case, preset: Preset, timer: Timer) -> dict[str, Any]:
    s, operation, order = case.build(), str(case.subject), str(case.order)
    few = SCANNED_FACES if order == ANEW or case.searches else SINGLE_FACES
    first, *faces = harness.operation_faces(case, few).tolist()
    done = len(harness.operation_arguments(s.copy(), operation, np.array(faces)))
    given = 3 if operation == "add_face" else 1
    point = ((0.0, 0.0, 0.0),) if operation.startswith("split") else ()
    followed = ExitStack()

    def fresh() -> tuple[Structure, Any, list[list[int]], Ending]:
        followed.close()
        copy = s.copy()
        copy.reserve(2 * SINGLE_FACES)
        rows = harness.operation_arguments(copy, operation, np.array(faces))[:, :given].tolist()
        end = _follow(order, copy, followed)
        copy.split_face(first, (0, 0, 0))  # makes room, here and in the render mesh
        return copy, getattr(copy, operation), rows, end

    def operate(_: Structure, method: Any, rows: list[list[int]], end: Ending) -> Any:
        for row in rows:
            method(*row, *point)
        return end()

    trial = fresh()
    harness.validate_operated(trial[0], case, operate(*trial))
    del trial  # which would take memory while others are timed
    return timer(operate, setup=fresh, rounds=preset.rounds, per=done).fields


EXPERIMENT = Experiment(
    title="Time of operations", cases=cases, measure=measure, copies=22, turn=42,
    table=harness.OPERATIONS_TABLE, axes={Axis.TIME_FACES: "batched", Axis.TIME_VALENCE: "batched"},
    just_written=frozenset({Axis.TIME_FACES}), baseline_orders=("batched",),
)  # fmt: skip
test_operation = EXPERIMENT.test
