"""Time of the nine queries by valence, in meshes that all have the same number of faces."""

from __future__ import annotations

from experiments.harness import (
    HUBS,
    QUERIES_TABLE,
    Axis,
    Case,
    Experiment,
    Keep,
    Measurement,
    Preset,
    Timer,
    time_checked_query,
)
from hem.contract import QUERIES
from structures import NAMES


def cases(preset: Preset, structure: str) -> list[Case]:
    """All cases of one structure; those on the same mesh follow each other."""
    return [
        Case(structure, HUBS, preset.valence_faces, query, "random", valence)
        for valence in preset.valences
        for query in QUERIES
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check the query at the hubs against the triangle list, then time it."""
    return time_checked_query(case, preset, timer)


EXPERIMENT = Experiment(
    title="Time of queries, by valence",
    kind="time",
    cases=cases,
    measure=measure,
    structures=NAMES,
    copies=2,
    turn=41,
    table=QUERIES_TABLE,
    axes={Axis.TIME_VALENCE: "random"},
    baseline_orders=("random",),
)


def test_valence(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
    """Time one case."""
    keep(measure(case, preset, timer))
