"""Work of the nine queries, counted in array elements read: by size, and by valence.

The counts are exact and the same on every machine. They come from uncompiled code, so the meshes
are small; that is enough, as nothing disturbs them.
"""

from __future__ import annotations

from experiments.bench_queries import CHECKED_HANDLES
from experiments.conftest import Keep
from experiments.harness.cases import Case, pool
from experiments.harness.oracle import check
from experiments.harness.presets import Preset
from hem.contract.queries import QUERIES
from structures import NAMES as STRUCTURES


def cases(profile: Preset, structure: str) -> list[Case]:
    """The judged family by size, then the hubs by valence."""
    return [
        Case(structure, family, size, query, "random", valence)
        for family, size, valence in profile.work_points()
        for query in QUERIES
    ]


def test_work(case: Case, keep: Keep) -> None:
    """Check the query against the triangle list, then count what it reads."""
    s = case.build()
    handles = pool(case, s)[:CHECKED_HANDLES]
    check(s, case.mesh(), case.query, handles)
    reads = s.work(case.query.name, handles)
    keep(case.result("work", s, reads, handles=1, checked=True))


__all__ = ["STRUCTURES", "cases", "test_work"]
