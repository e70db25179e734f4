"""Time of the nine queries by structure, family, size and order of the handles.

Along one family the valence stays, so the sizes show how a query depends on the number of faces.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from experiments.conftest import Keep
from experiments.harness.cases import Case, pool
from experiments.harness.oracle import check
from experiments.harness.presets import Preset
from experiments.harness.timer import TooSlowError, time_query
from hem.contract.queries import QUERIES
from structures import NAMES as STRUCTURES

CHECKED_HANDLES = 3


def cases(profile: Preset, structure: str) -> list[Case]:
    """All cases of one structure; those on the same mesh follow each other."""
    return [
        Case(structure, family, size, query, order)
        for family in profile.families
        for size in profile.sizes
        for query in QUERIES
        for order in profile.orders
    ]


def test_query(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Check the query on this mesh against the triangle list, then time it."""
    measure(case, profile, benchmark, keep)


def measure(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Check and time one case, here and where the valence varies."""
    s = case.build()
    handles = pool(case, s)
    check(s, case.mesh(), case.query, handles[:CHECKED_HANDLES])
    try:
        timed = time_query(benchmark, s, case.query.name, handles, profile)
    except TooSlowError as reason:
        benchmark.pedantic(lambda: None)
        keep(case.result("time", s, np.zeros(0), skipped=str(reason)))
    else:
        keep(case.result("time", s, checked=True, **timed))


__all__ = ["STRUCTURES", "cases", "measure", "test_query"]
