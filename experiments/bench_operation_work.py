"""Work of the operations, counted in array elements read and written: by size, and by valence.

Each is done uncompiled on a copy of the mesh. The counts are exact and the same on every machine.
"""

from experiments import harness
from experiments.harness import Axis, Case, Experiment, Measurement, Preset, Timer

SEARCHED = 1  # one search of the whole mesh reads as much as another


def cases(preset: Preset, structure: str) -> list[Case]:
    """The judged family by size, then the hubs by valence."""
    return [
        Case(structure, family, size, operation, "counted", valence)
        for family, size, valence in preset.work_points()
        for operation in harness.measured_operations(preset)
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Count what operations read and write, and check what they make of the mesh."""
    s, operation = case.build().copy(), str(case.subject)
    many = SEARCHED if s.searches or s.rebuilds else case.repetitions
    faces = harness.operation_faces(case, many)
    rows = harness.operation_arguments(s, operation, faces).tolist()
    s = s.copy()  # which knows nothing of what was asked meanwhile
    work = [s.operation_work(operation, *row) for row in rows]
    harness.validate_operated(s, case)
    return case.result("work", case.build(), work, handles=1, checked=True)


EXPERIMENT = Experiment(
    title="Work of operations", kind="work", cases=cases, measure=measure, copies=3, turn=11,
    table=harness.OPERATIONS_TABLE, axes={Axis.WORK_FACES: "counted", Axis.WORK_VALENCE: "counted"},
)  # fmt: skip
test_operation_work = EXPERIMENT.test
