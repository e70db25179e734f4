"""Time to build each structure, by size, from meshes as generated and renumbered at random."""

from __future__ import annotations

from typing import Any

import numpy as np

import structures
from experiments.conftest import Keep
from experiments.harness.cases import Cell
from experiments.harness.presets import Profile
from structures import NAMES as STRUCTURES


def cells(profile: Profile, structure: str) -> list[Cell]:
    """The judged family by size, at both sizes of a reference."""
    return [
        Cell(structure, profile.families[0], size, None, order, None, reference_bytes)
        for size in profile.build_sizes
        for order in profile.orders
        for reference_bytes in (4, 8)
    ]


def test_build(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Check that what was built is valid and gives the mesh back, then time the building."""
    mesh = cell.mesh()
    s = structures.build(cell.structure, mesh, cell.reference_bytes)
    s.validate()
    assert np.array_equal(np.sort(s.to_triangles().triangles), np.sort(mesh.triangles))
    arguments = cell.structure, mesh, cell.reference_bytes
    benchmark.pedantic(structures.build, arguments, rounds=profile.rounds, warmup_rounds=1)
    samples = benchmark.stats.stats.data if benchmark.stats else []
    keep(cell.result("time", s, np.array(samples), handles=1, checked=True))


__all__ = ["STRUCTURES", "cells", "test_build"]
