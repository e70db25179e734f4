"""Time of the nine queries by valence, in meshes that all have the same number of faces."""

from __future__ import annotations

from typing import Any

from experiments.bench_queries import measure
from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.presets import HUBS, Preset
from hem.contract.queries import QUERIES
from structures import NAMES as STRUCTURES


def cases(profile: Preset, structure: str) -> list[Case]:
    """All cases of one structure; those on the same mesh follow each other."""
    return [
        Case(structure, HUBS, profile.valence_faces, query, "random", valence)
        for valence in profile.valences
        for query in QUERIES
    ]


def test_valence(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Check the query at the hubs against the triangle list, then time it."""
    measure(case, profile, benchmark, keep)


__all__ = ["STRUCTURES", "cases", "test_valence"]
