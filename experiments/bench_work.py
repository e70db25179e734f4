"""Work of the nine queries, counted in array elements read: by size, and by valence.

The counts are exact and the same on every machine. They come from uncompiled code, so the meshes
are small; that is enough, as nothing disturbs them.
"""

from __future__ import annotations

from experiments.harness import (
    CHECKED_HANDLES,
    QUERIES_TABLE,
    Axis,
    Case,
    Experiment,
    Keep,
    Measurement,
    Preset,
    Timer,
    check_query,
    queried_handles,
    time_rounds,
)
from hem.contract import QUERIES
from structures import NAMES


def cases(preset: Preset, structure: str) -> list[Case]:
    """The judged family by size, then the hubs by valence."""
    return [
        Case(structure, family, size, query, "random", valence)
        for family, size, valence in preset.work_points()
        for query in QUERIES
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check the query against the triangle list, then count what it reads."""
    s = case.build()
    handles = queried_handles(case, s)[:CHECKED_HANDLES]
    check_query(s, case.mesh(), case.query, handles)
    return case.result("work", s, s.work(case.query.name, handles), handles=1, checked=True)


EXPERIMENT = Experiment(
    title="Work of queries",
    kind="work",
    cases=cases,
    measure=measure,
    structures=NAMES,
    copies=1,
    turn=10,
    table=QUERIES_TABLE,
    axes={Axis.WORK_FACES: "random", Axis.WORK_VALENCE: "random"},
)


def test_work(case: Case, preset: Preset, keep: Keep) -> None:
    """Count one case."""
    keep(measure(case, preset, time_rounds))
