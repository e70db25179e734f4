"""Work of the nine queries, counted in array elements read: by size, and by valence.

The counts are exact and the same on every machine. They come from uncompiled code, so the meshes
are small; that is enough, as nothing disturbs them.
"""

from experiments import harness
from experiments.harness import Axis, Case, Experiment, Measurement, Preset, Timer
from hem.contract import QUERIES


def cases(preset: Preset, structure: str) -> list[Case]:
    """The judged family by size, then the hubs by valence."""
    return [
        Case(structure, family, size, query, "random", valence)
        for family, size, valence in preset.work_points()
        for query in QUERIES
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check the query against the triangle list, then count what it reads."""
    s, handles = harness.checked_handles(case)
    work = s.work(case.query.name, handles[: case.repetitions])
    return case.result("work", s, work, handles=1, checked=True)


EXPERIMENT = Experiment(
    title="Work of queries", kind="work", cases=cases, measure=measure, copies=1, turn=10,
    table=harness.QUERIES_TABLE, axes={Axis.WORK_FACES: "random", Axis.WORK_VALENCE: "random"},
)  # fmt: skip
test_work = EXPERIMENT.test
