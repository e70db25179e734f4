"""Time of the nine queries by valence, in meshes that all have the same number of faces."""

from __future__ import annotations

from typing import Any

from experiments.bench_queries import measure
from experiments.conftest import Keep
from experiments.harness.cases import Cell
from experiments.harness.presets import HUBS, Profile
from hem.contract.queries import QUERIES
from structures import NAMES as STRUCTURES


def cells(profile: Profile, structure: str) -> list[Cell]:
    """All cells of one structure; those on the same mesh follow each other."""
    return [
        Cell(structure, HUBS, profile.valence_faces, query, "random", valence)
        for valence in profile.valences
        for query in QUERIES
    ]


def test_valence(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Check the query at the hubs against the triangle list, then time it."""
    measure(cell, profile, benchmark, keep)


__all__ = ["STRUCTURES", "cells", "test_valence"]
