"""Breaking a surface on every structure, by size; and finding the face under an impact.

A face is found by walking from the first one, by walking from the nearest of n_t^(1/3) faces, and
by looking at every face: timed, and counted in faces looked at.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import structures
from experiments.harness import Case, Experiment, Measurement, Preset, Timer, latency_now, took
from hem.arrays import Array, Floats
from hem.contract import Structure
from hem.fracture import JUMP, MATERIALS, Found, nearest_face, scanned, shatter

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
MARGIN = 1e-6  # nearer than this part of the mesh to where the scan ends is the same place
REFERENCE = "half_edge"  # the others must give its shards; looks at faces are counted on it
ASKED_PER_BREAK_POINT = 30  # how often neighbors are asked for at least, each a scan for some


def cases(preset: Preset, structure: str) -> list[Case]:
    """Both at every size; the faces that are looked at, which all structures share, on one."""
    ways = [*WAYS, *(f"{way}, {VISITED}" for way in WAYS if structure == REFERENCE)]
    kinds, family = [(SHATTER, None), *((FIND, way) for way in ways)], preset.families[0]
    return [Case(structure, family, size, *it) for size in preset.fracture_sizes for it in kinds]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time a fracture, or the search for faces, after its outcome was checked."""
    s = case.build()
    searches = s.searches or (s.rebuilds and case.subject == SHATTER)
    per_search = {"walk": np.sqrt(s.n_faces), "jump and walk": np.cbrt(s.n_faces), "scan": 0.0}
    if case.subject == SHATTER:
        scans = ASKED_PER_BREAK_POINT * sum(BREAKING[s.compiled].circles) * searches
    else:
        scans = IMPACTS * per_search[str(case.order).partition(",")[0]] * searches
    # With a round to check it, and one to see how long it takes.
    if reason := preset.why_too_slow(scans, s.n_faces, preset.fewest_rounds + 2):
        return case.result(EXPERIMENT.kind_of(case.order), s, skipped=reason)
    return (_shatter if case.subject == SHATTER else _find)(case, s, preset, timer)


def _shatter(case: Case, s: Structure, preset: Preset, timer: Timer) -> Measurement:
    at, material = _impacts(s)[0], BREAKING[s.compiled]
    expected = shatter(structures.build(REFERENCE, case.mesh()), at, material).shards
    copy = s.copy()
    shards = shatter(copy, at, material).shards  # compiles
    copy.validate()
    if not np.array_equal([it.points for it in shards], [it.points for it in expected]):
        raise AssertionError(f"{case.structure} gives other shards than {REFERENCE}")

    def fresh() -> tuple[Structure, Array, Any]:
        ready = s.copy()
        ready.reserve(2 * sum(material.circles))
        return ready, at, material

    rounds = preset.affordable_rounds(took(shatter, *fresh())[1])
    timed = timer(shatter, setup=fresh, rounds=rounds, warmup=0, per=len(shards))
    return case.result("time", s, **timed.fields)


def _find(case: Case, s: Structure, preset: Preset, timer: Timer) -> Measurement:
    way, _, counted = str(case.order).partition(", ")
    find, impacts = WAYS[way], _impacts(s)
    found = [find(s, at) for at in impacts]
    apart = np.array([it.point for it in found]) - impacts
    if not (np.abs(apart) < MARGIN * np.abs(s.points).max()).all():
        raise AssertionError(f"{case.id} on {case.structure}: a face that is not the nearest")
    if counted:
        visited = [it.visited for it in found]
        return case.result("work", s, np.array(visited), handles=1, checked=True)

    latency = latency_now(sum(s.memory().values()))
    rounds = max(preset.fewest_rounds, preset.rounds // 2)
    timed = timer(lambda: [find(s, at) for at in impacts], rounds=rounds, warmup=0, per=IMPACTS)
    return case.result("time", s, latency=latency, **timed.fields)


def _impacts(s: Structure) -> Floats:
    """(IMPACTS, 3): positions on faces chosen at random."""
    rng = np.random.default_rng(IMPACT_SEED)
    faces = s.faces()[rng.integers(0, s.n_faces, IMPACTS)]
    corners = s.points[np.sort(s.face_vertices(faces).values.reshape(-1, 3), axis=1)]
    weights = rng.dirichlet(np.ones(3), IMPACTS)
    return np.asarray((weights[:, :, None] * corners.astype(np.float64)).sum(axis=1))


EXPERIMENT = Experiment(
    title="Breaking a surface", cases=cases, measure=measure, copies=10, turn=70,
    counted=tuple(f"{way}, {VISITED}" for way in WAYS),
)  # fmt: skip
test_fracture = EXPERIMENT.test
