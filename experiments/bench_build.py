"""Time to build each structure, by size, from meshes as generated and renumbered at random.

What finds its neighbors only when it is asked is timed until it answers, too.
"""

from typing import Any

import numpy as np

import structures
from experiments import harness
from experiments.harness import Case, Experiment, Measurement, Preset, Timer


def cases(preset: Preset, structure: str) -> list[Case]:
    """The judged family by size, at both sizes of a reference."""
    later = (harness.ANSWERING,) if structures.REGISTRY[structure].rebuilds else ()
    return [
        Case(structure, preset.families[0], size, None, order, None, reference_bytes)
        for size in preset.build_sizes
        for order in (*harness.ORDERS, *later)
        for reference_bytes in preset.build_reference_bytes
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check that what was built is valid and gives the mesh back, then time the building."""
    mesh = case.mesh()
    given = case.structure, mesh, case.reference_bytes
    s = structures.build(*given)
    s.validate()
    back = s.to_triangles()
    assert np.array_equal(back.points, mesh.points.astype(np.float32))
    assert np.array_equal(harness.turned(back.triangles), harness.turned(mesh.triangles))

    def build_and_ask(*given: Any) -> None:
        structures.build(*given).vertex_faces(0)

    build = build_and_ask if case.order == harness.ANSWERING else structures.build
    timed = timer(build, setup=lambda: given, rounds=preset.rounds)
    return case.result("time", s, **timed.fields)


EXPERIMENT = Experiment(
    title="Time to build", cases=cases, measure=measure, copies=3, turn=50,
    baseline_orders=("consecutive", harness.ANSWERING),
)  # fmt: skip
test_build = EXPERIMENT.test
