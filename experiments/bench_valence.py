"""Time of the nine queries by valence, in meshes that all have the same number of faces."""

from experiments.harness import HUBS, QUERIES_TABLE, Axis, Case, Experiment, Preset, time_query
from hem.contract import QUERIES


def cases(preset: Preset, structure: str) -> list[Case]:
    """All cases of one structure, at the hubs; those on the same mesh follow each other."""
    return [
        Case(structure, HUBS, preset.valence_faces, query, "random", valence)
        for valence in preset.valences
        for query in QUERIES
    ]


EXPERIMENT = Experiment(
    title="Time of queries, by valence", cases=cases, measure=time_query, copies=2, turn=41,
    table=QUERIES_TABLE, axes={Axis.TIME_VALENCE: "random"}, baseline_orders=("random",),
)  # fmt: skip
test_valence = EXPERIMENT.test
