"""Time of the nine queries by structure, family, size and order of the handles.

Along one family the valence stays, so the sizes show how a query depends on the number of faces.
"""

from __future__ import annotations

from experiments.harness import (
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
        Case(structure, family, size, query, order)
        for family in preset.families
        for size in preset.sizes
        for query in QUERIES
        for order in preset.orders
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check the query on this mesh against the triangle list, then time it."""
    return time_checked_query(case, preset, timer)


EXPERIMENT = Experiment(
    title="Time of queries, by size",
    kind="time",
    cases=cases,
    measure=measure,
    structures=NAMES,
    copies=2,
    turn=40,
    table=QUERIES_TABLE,
    axes={Axis.TIME_FACES: "consecutive", Axis.RANDOM_FACES: "random"},
    baseline_orders=("consecutive", "random"),
)


def test_query(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
    """Time one case."""
    keep(measure(case, preset, timer))
