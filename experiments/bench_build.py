"""Time to build each structure, by size, from meshes as generated and renumbered at random."""

from __future__ import annotations

import numpy as np

import structures
from experiments.harness import Case, Experiment, Keep, Measurement, Preset, Timer


def cases(preset: Preset, structure: str) -> list[Case]:
    """The judged family by size, at both sizes of a reference."""
    return [
        Case(structure, preset.families[0], size, None, order, None, reference_bytes)
        for size in preset.build_sizes
        for order in preset.orders
        for reference_bytes in preset.build_reference_bytes
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check that what was built is valid and gives the mesh back, then time the building."""
    mesh = case.mesh()
    given = case.structure, mesh, case.reference_bytes
    s = structures.build(*given)
    s.validate()
    assert np.array_equal(np.sort(s.to_triangles().triangles), np.sort(mesh.triangles))
    timed = timer(structures.build, setup=lambda: (given, {}), rounds=preset.rounds)
    return case.result("time", s, handles=1, checked=True, **timed.fields)


EXPERIMENT = Experiment(
    title="Time to build",
    kind="time",
    cases=cases,
    measure=measure,
    structures=structures.NAMES,
    copies=3,
    turn=50,
)


def test_build(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
    """Time one case."""
    keep(measure(case, preset, timer))
