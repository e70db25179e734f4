"""Time of the nine queries by structure, family, size, valence and order of the handles.

Along one family the valence stays, so the sizes show how a query depends on the number of faces; at
the hubs the number of faces stays.
"""

from experiments import harness
from experiments.harness import Axis, Case, Experiment, Preset
from hem.contract import QUERIES


def cases(preset: Preset, structure: str) -> list[Case]:
    """All cases of one structure, mesh by mesh; of families not judged every second size."""
    judged, *others = preset.families
    meshes = [(judged, preset.sizes), *((family, preset.sizes[::2]) for family in others)]
    by_size = [
        Case(structure, family, size, query, order)
        for family, sizes in meshes
        for size in sizes
        for query in QUERIES
        for order in harness.ORDERS
    ]
    return by_size + [
        Case(structure, harness.HUBS, preset.valence_faces, query, "random", valence)
        for valence in preset.valences
        for query in QUERIES
    ]


EXPERIMENT = Experiment(
    title="Time of queries", cases=cases, measure=harness.time_query, copies=3, turn=40,
    table=harness.QUERIES_TABLE, axes={
        Axis.TIME_FACES: "consecutive", Axis.RANDOM_FACES: "random", Axis.TIME_VALENCE: "random",
    },
    baseline_orders=("consecutive", "random"),
)  # fmt: skip
test_query = EXPERIMENT.test
