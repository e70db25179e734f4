"""Work of the nine queries, counted in array elements read: by size, and by valence.

The counts are exact and the same on every machine. They come from uncompiled code, so the meshes
are small; that is enough, as nothing disturbs them.
"""

from __future__ import annotations

from experiments.bench_queries import CHECKED_HANDLES
from experiments.conftest import Keep
from experiments.profiles import Profile
from experiments.subjects import HUBS, Cell, pool
from experiments.truth import check
from hem.queries import QUERIES
from structures import NAMES as STRUCTURES


def cells(profile: Profile, structure: str) -> list[Cell]:
    """The judged family by size, then the hubs by valence."""
    sizes = [(profile.families[0], size, None) for size in profile.work_sizes]
    few = profile.work_faces // 16  # so that a scan's work is the scan, not what it finds
    valences = [(HUBS, profile.work_faces, k) for k in profile.valences if k <= few]
    return [
        Cell(structure, family, size, query, "random", valence)
        for family, size, valence in (*sizes, *valences)
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
