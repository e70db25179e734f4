"""Time of what people do with meshes, on every structure, by size; building is not included."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

import structures
from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.presets import Preset
from experiments.harness.workloads import IMPACTS, WORKLOADS
from hem.contract.queries import QUERIES
from hem.contract.structure import Structure
from structures import NAMES as STRUCTURES

SECONDS_PER_FACE = 1e-9
"""What a scan takes at the least."""

LONGEST = 20
"""How many times the seconds of a case a workload may take in all."""

SMALL = 400
"""Vertices of the mesh on which all structures must give the same."""

FEWEST_ROUNDS = 3


def cases(profile: Preset, structure: str) -> list[Case]:
    """Every workload at every size."""
    return [
        Case(structure, profile.families[0], size, workload, "workload")
        for size in profile.workload_sizes
        for workload in WORKLOADS
    ]


def test_workload(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Time a workload on copies of a mesh, if it can be done in the time there is."""
    s, workload = case.build(), WORKLOADS[str(case.subject)]
    allowed = LONGEST * profile.case_seconds
    expected = _least_seconds(s, case)
    if FEWEST_ROUNDS * expected > allowed:
        benchmark.pedantic(lambda: None)
        reason = f"takes at least {expected:.0f} s, and {allowed:.0f} s are given to all rounds"
        keep(case.result("time", s, np.zeros(0), skipped=reason))
        return
    _check(case)
    ready = _ready(s)
    begin = perf_counter()
    units = workload.run(ready)
    seconds = perf_counter() - begin
    rounds = int(np.clip(profile.case_seconds / seconds, FEWEST_ROUNDS, profile.rounds))
    benchmark.pedantic(workload.run, setup=lambda: ((_ready(s),), {}), rounds=rounds)
    data = benchmark.stats.stats.data if benchmark.stats else []
    keep(case.result("time", s, np.array(data) / units, handles=units, checked=True))


def _ready(s: Structure) -> Structure:
    """A copy that was asked everything once, so that its methods are bound."""
    copy = s.copy()
    for query in QUERIES.values():
        getattr(copy, query.name)(int(copy.handles(query.source)[0]))
    copy.can_flip_edge(int(copy.edges()[0]))
    return copy


def _least_seconds(s: Structure, case: Case) -> float:
    if s.name != "indexed":
        return 0
    times = IMPACTS if case.subject == "impacts" else s.n_vertices
    return times * WORKLOADS[str(case.subject)].scans * s.n_faces * SECONDS_PER_FACE


def _check(case: Case) -> None:
    """On a small mesh the outcome is the same on every structure."""
    mesh = Case(case.structure, case.family, SMALL).mesh()
    mine, other = (structures.build(name, mesh) for name in (case.structure, "indexed"))
    for s in (mine, other):
        WORKLOADS[str(case.subject)].run(s)
        s.validate()
    corners, expected = (
        np.sort(s.face_vertices(s.faces()).values.reshape(-1, 3), axis=1) for s in (mine, other)
    )
    same_points = np.allclose(mine.points, other.points, atol=1e-5, equal_nan=True)
    if not (np.array_equal(corners, expected) and same_points):
        raise AssertionError(f"{case.subject} on {case.structure} gives another mesh than indexed")


__all__ = ["STRUCTURES", "cases", "test_workload"]
