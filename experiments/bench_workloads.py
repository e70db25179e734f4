"""Time of what programs do with meshes, on every structure, by size; building is not included."""

from __future__ import annotations

from time import perf_counter

import numpy as np

import structures
from experiments.harness import (
    BASE,
    Case,
    Experiment,
    Keep,
    Measurement,
    Preset,
    Timer,
    why_too_slow,
)
from experiments.harness.workloads import IMPACTS, WORKLOADS
from hem.contract import QUERIES, Structure

SMALL = 400
"""Vertices of the mesh on which all structures must give the same."""

FEWEST_ROUNDS = 3


def cases(preset: Preset, structure: str) -> list[Case]:
    """Every workload of the preset at every size."""
    return [
        Case(structure, preset.families[0], size, workload, "workload")
        for size in preset.workload_sizes
        for workload in preset.workloads or WORKLOADS
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time a workload on copies of a mesh, if it can be done in the time there is."""
    s, workload = case.build(), WORKLOADS[str(case.subject)]
    reason = why_too_slow(_scans(s, case), s.n_faces, FEWEST_ROUNDS, preset)
    if reason:
        return case.result("time", s, skipped=reason)
    _check(case)
    ready = _ready(s)
    begin = perf_counter()
    units = workload.run(ready)
    seconds = perf_counter() - begin
    rounds = int(np.clip(preset.case_seconds / seconds, FEWEST_ROUNDS, preset.rounds))
    timed = timer(
        workload.run, setup=lambda: ((_ready(s),), {}), rounds=rounds, warmup=0, per=units
    )
    return case.result("time", s, handles=units, checked=True, **timed.fields)


def _ready(s: Structure) -> Structure:
    """A copy that was asked everything once, so that its methods are bound."""
    copy = s.copy()
    for query in QUERIES.values():
        getattr(copy, query.name)(int(copy.handles(query.source)[0]))
    copy.can_flip_edge(int(copy.edges()[0]))
    return copy


def _scans(s: Structure, case: Case) -> float:
    """How often a round searches the whole mesh, at the least."""
    if not s.searches:
        return 0
    times = IMPACTS if case.subject == "impacts" else s.n_vertices
    return times * WORKLOADS[str(case.subject)].scans


def _check(case: Case) -> None:
    """On a small mesh the outcome is the same on every structure."""
    mesh = Case(case.structure, case.family, SMALL).mesh()
    mine, other = (structures.build(name, mesh) for name in (case.structure, BASE))
    for s in (mine, other):
        WORKLOADS[str(case.subject)].run(s)
        s.validate()
    corners, expected = (
        np.sort(s.face_vertices(s.faces()).values.reshape(-1, 3), axis=1) for s in (mine, other)
    )
    same_points = np.allclose(mine.points, other.points, atol=1e-5, equal_nan=True)
    if not (np.array_equal(corners, expected) and same_points):
        raise AssertionError(f"{case.subject} on {case.structure} gives another mesh than {BASE}")


EXPERIMENT = Experiment(
    title="Workloads",
    kind="time",
    cases=cases,
    measure=measure,
    structures=structures.NAMES,
    copies=4,
    turn=60,
)


def test_workload(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
    """Time one case."""
    keep(measure(case, preset, timer))
