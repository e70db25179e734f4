"""Breaking a surface on every structure, by size; and finding the face under an impact.

A face is found by walking from the first one, by walking from the nearest of n_t^(1/3) faces, and
by looking at every face: timed, and counted in faces looked at.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

import structures
from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.latency import latency_now
from experiments.harness.presets import Preset
from hem.contract.structure import Structure
from hem.fracture import MATERIALS, Material, nearest_face, scanned, shatter
from hem.fracture.surface.breaking import JUMP
from hem.fracture.surface.nearest import Found
from structures import NAMES as STRUCTURES

Array = NDArray[Any]

SHATTER, FIND = "shatter", "find_face"

BREAKING = {
    compiled: replace(MATERIALS["glass"], circles=(points,) * 5, scale=0.02)
    for compiled, points in ((True, 200), (False, 20))
}
"""1,000 break points near to each other, on structures that are compiled; a tenth on others."""

WAYS: dict[str, Callable[[Structure, Array], Found]] = {
    "walk": lambda s, at: nearest_face(s, at, start=0),
    "jump and walk": lambda s, at: nearest_face(s, at, start=JUMP),
    "scan": scanned,
}
"""How a face is found, by the name of the order in a case."""

VISITED = "faces looked at"
IMPACTS = 64
IMPACT_SEED = 31
MARGIN = 1e-6
"""Nearer than this part of the mesh to where the scan ends is the same place."""

COUNTED_ON = "half_edge"

ASKED_PER_BREAK_POINT = 30
"""Neighbors are asked for at least so often; where that is a scan, it takes what follows."""

SECONDS_PER_FACE = 1e-9
LONGEST = 20
FEWEST_ROUNDS = 3
ROUNDS = FEWEST_ROUNDS + 2
"""With those to check it and to warm up."""


def cases(profile: Preset, structure: str) -> list[Case]:
    """Both at every size; the faces that are looked at, which all structures share, on one."""
    ways = [*WAYS, *(f"{way}, {VISITED}" for way in WAYS if structure == COUNTED_ON)]
    family = profile.families[0]
    return [
        Case(structure, family, size, query, order)
        for size in profile.fracture_sizes
        for query, order in [(SHATTER, None), *((FIND, way) for way in ways)]
    ]


def test_fracture(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Time a fracture, or the search for faces, after its outcome was checked."""
    s = case.build()
    expected = _neighbors_asked(case, s) * s.n_faces * SECONDS_PER_FACE
    if case.structure == "indexed" and ROUNDS * expected > LONGEST * profile.case_seconds:
        benchmark.pedantic(lambda: None)
        reason = f"takes {expected:.0f} s and more, which is too long for all rounds"
        keep(case.result("time", s, np.zeros(0), skipped=reason))
    elif case.subject == SHATTER:
        _shatter(case, s, profile, benchmark, keep)
    else:
        _find(case, s, profile, benchmark, keep)


def _neighbors_asked(case: Case, s: Structure) -> float:
    """How often neighbors are asked for in a round, at the least."""
    if case.subject == SHATTER:
        return ASKED_PER_BREAK_POINT * sum(_material(s).circles)
    per_search = {"walk": np.sqrt(s.n_faces), "jump and walk": np.cbrt(s.n_faces), "scan": 0.0}
    return float(IMPACTS * per_search[str(case.order).partition(",")[0]])


def _shatter(case: Case, s: Structure, profile: Preset, benchmark: Any, keep: Keep) -> None:
    at, material = _impacts(s)[0], _material(s)
    expected = shatter(structures.build("half_edge", case.mesh()), at, material).shards
    begin, copy = perf_counter(), s.copy()
    shards = shatter(copy, at, material).shards
    seconds = perf_counter() - begin
    copy.validate()
    if not np.array_equal([it.points for it in shards], [it.points for it in expected]):
        raise AssertionError(f"{case.structure} gives other shards than half_edge")

    def fresh() -> tuple[tuple[Structure, Array, Any], dict[str, Any]]:
        ready = s.copy()
        ready.reserve(2 * sum(material.circles))
        return (ready, at, material), {}

    rounds = int(np.clip(profile.case_seconds / seconds, FEWEST_ROUNDS, profile.rounds))
    benchmark.pedantic(shatter, setup=fresh, rounds=rounds, warmup_rounds=1)
    data = benchmark.stats.stats.data if benchmark.stats else []
    keep(case.result("time", s, np.array(data) / len(shards), handles=len(shards), checked=True))


def _find(case: Case, s: Structure, profile: Preset, benchmark: Any, keep: Keep) -> None:
    way, _, counted = str(case.order).partition(", ")
    find, impacts = WAYS[way], _impacts(s)
    found = [find(s, at) for at in impacts]
    apart = np.array([it.point for it in found]) - impacts
    if not (np.abs(apart) < MARGIN * np.abs(s.points).max()).all():
        raise AssertionError(f"{case.id} on {case.structure}: a face that is not the nearest")
    if counted:
        benchmark.pedantic(lambda: None)
        visited = [it.visited for it in found]
        keep(case.result("work", s, np.array(visited), handles=1, checked=True))
        return

    def all_of_them() -> None:
        for at in impacts:
            find(s, at)

    latency = latency_now(sum(s.memory().values()))
    benchmark.pedantic(all_of_them, rounds=max(FEWEST_ROUNDS, profile.rounds // 2))
    data = np.array(benchmark.stats.stats.data if benchmark.stats else [])
    more = {"handles": len(impacts), "latency": latency, "checked": True}
    keep(case.result("time", s, data / len(impacts), **more))


def _material(s: Structure) -> Material:
    return BREAKING[s.compiled]


def _impacts(s: Structure) -> NDArray[np.float64]:
    """(IMPACTS, 3): positions on faces chosen at random."""
    rng = np.random.default_rng(IMPACT_SEED)
    faces = s.faces()[rng.integers(0, s.n_faces, IMPACTS)]
    corners = s.points[np.sort(s.face_vertices(faces).values.reshape(-1, 3), axis=1)]
    weights = rng.dirichlet(np.ones(3), IMPACTS)
    return np.asarray((weights[:, :, None] * corners.astype(np.float64)).sum(axis=1))


__all__ = ["STRUCTURES", "cases", "test_fracture"]
