"""Splitting a face, named by its index or by its three corners: work and time by size.

The thesis compares a half-edge mesh, whose faces are known, with an indexed mesh in which a face is
looked for by its corners. So both are measured, where neighbors are searched for: one call per
split from Python, with the room made before.
"""

import numpy as np

from experiments import harness
from experiments.harness import Axis, Case, Experiment, Measurement, Preset, Table, Timer
from hem.contract import Structure
from structures import NAMES, REGISTRY

BY_INDEX, BY_CORNERS = "split_by_index", "split_by_corners"
NAMINGS = {BY_INDEX: "Named by its index", BY_CORNERS: "Named by its three corners"}
COUNTED, TIMED = "counted", "timed"  # the kinds of cases: work, and time
SPLITS = 10
CENTER = (0.0, 0.0, 0.0)


def cases(preset: Preset, structure: str) -> list[Case]:
    """Both ways to name a face: work and time at the sizes of operations."""
    sizes = [(COUNTED, it) for it in preset.work_sizes]
    sizes += [(TIMED, it) for it in preset.operation_sizes]
    family = preset.families[0]
    return [Case(structure, family, size, it, order) for order, size in sizes for it in NAMINGS]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Count one split, or time some, and check what they made."""
    s, faces = case.build(), harness.operation_faces(case, SPLITS).tolist()
    named = [tuple(s.face_vertices(face).tolist()) for face in faces]
    by_index = case.subject == BY_INDEX
    if any(s.find_face(*corners) != face for face, corners in zip(faces, named, strict=True)):
        raise AssertionError(f"{case.id} on {case.structure}: another face has these corners")
    if case.order == COUNTED:
        copy = s.copy()
        work = copy.operation_work("split_face", faces[0])
        if not by_index:  # the search of `find_face`, and a look at every face that it finds
            around, looks = s.vertex_faces(named[0][0]), np.array([named[0][0]])
            work += s.work("vertex_faces", looks).sum() + s.work("face_vertices", around).sum()
        harness.validate_operated(copy, case)
        return case.result("work", s, [work], handles=1, checked=True)

    def ready() -> tuple[Structure]:  # a copy with room for the splits, whose methods are bound
        copy = s.copy()
        copy.reserve(2 * SPLITS)
        copy.find_face(*copy.face_vertices(0).tolist())
        return (copy,)

    def split(copy: Structure) -> None:
        for face, corners in zip(faces, named, strict=True):
            found = face if by_index else copy.find_face(*corners)
            assert found is not None  # which was checked above
            copy.split_face(found, CENTER)

    (copy,) = ready()
    split(copy)
    harness.validate_operated(copy, case)
    del copy  # which would take memory while others are timed
    latency = harness.latency_now(sum(s.memory().values()))
    timed = timer(split, setup=ready, rounds=preset.fewest_rounds + 2, per=len(faces))
    return case.result("time", s, **timed.fields, latency=latency)


EXPERIMENT = Experiment(
    title="Splitting a face by its name", cases=cases, measure=measure, copies=3, turn=44,
    structures=tuple(name for name in NAMES if REGISTRY[name].searches), counted=(COUNTED,),
    table=Table("naming", "Split face, by how the face is named", NAMINGS, "operations"),
    axes={Axis.WORK_FACES: COUNTED, Axis.TIME_FACES: TIMED},
    just_written=frozenset({Axis.TIME_FACES}), baseline_orders=(TIMED,),
)  # fmt: skip
test_naming = EXPERIMENT.test
