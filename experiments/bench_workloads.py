"""Time of what people do with meshes, on every structure, by size; building is not included."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

import structures
from experiments.conftest import Keep
from experiments.harness.cases import Cell
from experiments.harness.presets import Profile
from experiments.harness.workloads import IMPACTS, WORKLOADS
from hem.contract.queries import QUERIES
from hem.contract.structure import Structure
from structures import NAMES as STRUCTURES

SECONDS_PER_FACE = 1e-9
"""What a scan takes at the least."""

LONGEST = 20
"""How many times the seconds of a cell a workload may take in all."""

SMALL = 400
"""Vertices of the mesh on which all structures must give the same."""

FEWEST_ROUNDS = 3


def cells(profile: Profile, structure: str) -> list[Cell]:
    """Every workload at every size."""
    return [
        Cell(structure, profile.families[0], size, workload, "workload")
        for size in profile.workload_sizes
        for workload in WORKLOADS
    ]


def test_workload(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Time a workload on copies of a mesh, if it can be done in the time there is."""
    s, workload = cell.build(), WORKLOADS[str(cell.query)]
    allowed = LONGEST * profile.cell_seconds
    expected = _least_seconds(s, cell)
    if FEWEST_ROUNDS * expected > allowed:
        benchmark.pedantic(lambda: None)
        reason = f"takes at least {expected:.0f} s, and {allowed:.0f} s are given to all rounds"
        keep(cell.result("time", s, np.zeros(0), left_out=reason))
        return
    _check(cell)
    ready = _ready(s)
    begin = perf_counter()
    units = workload.run(ready)
    seconds = perf_counter() - begin
    rounds = int(np.clip(profile.cell_seconds / seconds, FEWEST_ROUNDS, profile.rounds))
    benchmark.pedantic(workload.run, setup=lambda: ((_ready(s),), {}), rounds=rounds)
    data = benchmark.stats.stats.data if benchmark.stats else []
    keep(cell.result("time", s, np.array(data) / units, handles=units, checked=True))


def _ready(s: Structure) -> Structure:
    """A copy that was asked everything once, so that its methods are bound."""
    copy = s.copy()
    for query in QUERIES.values():
        getattr(copy, query.name)(int(copy.handles(query.source)[0]))
    copy.can_flip_edge(int(copy.edges()[0]))
    return copy


def _least_seconds(s: Structure, cell: Cell) -> float:
    if s.name != "indexed":
        return 0
    times = IMPACTS if cell.query == "impacts" else s.n_vertices
    return times * WORKLOADS[str(cell.query)].scans * s.n_faces * SECONDS_PER_FACE


def _check(cell: Cell) -> None:
    """On a small mesh the outcome is the same on every structure."""
    mesh = Cell(cell.structure, cell.family, SMALL).mesh()
    mine, other = (structures.build(name, mesh) for name in (cell.structure, "indexed"))
    for s in (mine, other):
        WORKLOADS[str(cell.query)].run(s)
        s.validate()
    corners, expected = (
        np.sort(s.face_vertices(s.faces()).values.reshape(-1, 3), axis=1) for s in (mine, other)
    )
    same_points = np.allclose(mine.points, other.points, atol=1e-5, equal_nan=True)
    if not (np.array_equal(corners, expected) and same_points):
        raise AssertionError(f"{cell.query} on {cell.structure} gives another mesh than indexed")


__all__ = ["STRUCTURES", "cells", "test_workload"]
