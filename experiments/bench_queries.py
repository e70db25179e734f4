"""Time of the nine queries by structure, family, size and order of the handles.

Along one family the valence stays, so the sizes show how a query depends on the number of faces.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from experiments.conftest import Keep
from experiments.harness.cases import Cell, pool
from experiments.harness.oracle import check
from experiments.harness.presets import Profile
from experiments.harness.timer import TooSlowError, time_query
from hem.contract.queries import QUERIES
from structures import NAMES as STRUCTURES

CHECKED_HANDLES = 3


def cells(profile: Profile, structure: str) -> list[Cell]:
    """All cells of one structure; those on the same mesh follow each other."""
    return [
        Cell(structure, family, size, query, order)
        for family in profile.families
        for size in profile.sizes
        for query in QUERIES
        for order in profile.orders
    ]


def test_query(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Check the query on this mesh against the triangle list, then time it."""
    measure(cell, profile, benchmark, keep)


def measure(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Check and time one cell, here and where the valence varies."""
    s = cell.build()
    handles = pool(cell, s)
    check(s, cell.mesh(), cell.asked, handles[:CHECKED_HANDLES])
    try:
        timed = time_query(benchmark, s, cell.asked.name, handles, profile)
    except TooSlowError as reason:
        benchmark.pedantic(lambda: None)
        keep(cell.result("time", s, np.zeros(0), left_out=str(reason)))
    else:
        keep(cell.result("time", s, checked=True, **timed))


__all__ = ["STRUCTURES", "cells", "measure", "test_query"]
