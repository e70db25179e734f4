"""Time to build each structure, by size, from meshes as generated and renumbered at random."""

from __future__ import annotations

from typing import Any

import numpy as np

import structures
from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.presets import Preset
from structures import NAMES as STRUCTURES


def cases(profile: Preset, structure: str) -> list[Case]:
    """The judged family by size, at both sizes of a reference."""
    return [
        Case(structure, profile.families[0], size, None, order, None, reference_bytes)
        for size in profile.build_sizes
        for order in profile.orders
        for reference_bytes in (4, 8)
    ]


def test_build(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Check that what was built is valid and gives the mesh back, then time the building."""
    mesh = case.mesh()
    s = structures.build(case.structure, mesh, case.reference_bytes)
    s.validate()
    assert np.array_equal(np.sort(s.to_triangles().triangles), np.sort(mesh.triangles))
    arguments = case.structure, mesh, case.reference_bytes
    benchmark.pedantic(structures.build, arguments, rounds=profile.rounds, warmup_rounds=1)
    samples = benchmark.stats.stats.data if benchmark.stats else []
    keep(case.result("time", s, np.array(samples), handles=1, checked=True))


__all__ = ["STRUCTURES", "cases", "test_build"]
