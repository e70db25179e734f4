"""Work of the nine queries, counted in array elements read: by size, and by valence.

The counts are exact and the same on every machine. They come from uncompiled code, so the meshes
are small; that is enough, as nothing disturbs them.
"""

from __future__ import annotations

from experiments.bench_queries import CHECKED_HANDLES
from experiments.conftest import Keep
from experiments.harness.cases import Cell, pool
from experiments.harness.oracle import check
from experiments.harness.presets import Profile
from hem.contract.queries import QUERIES
from structures import NAMES as STRUCTURES


def cells(profile: Profile, structure: str) -> list[Cell]:
    """The judged family by size, then the hubs by valence."""
    return [
        Cell(structure, family, size, query, "random", valence)
        for family, size, valence in profile.work_points()
        for query in QUERIES
    ]


def test_work(cell: Cell, keep: Keep) -> None:
    """Check the query against the triangle list, then count what it reads."""
    s = cell.build()
    handles = pool(cell, s)[:CHECKED_HANDLES]
    check(s, cell.mesh(), cell.asked, handles)
    reads = s.work(cell.asked.name, handles)
    keep(cell.result("work", s, reads, handles=1, checked=True))


__all__ = ["STRUCTURES", "cells", "test_work"]
