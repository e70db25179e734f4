"""How one case is measured: what a case is, how it is timed or counted, and what is kept of it.

What each experiment measures stands in its ``bench_*.py``.
"""

from experiments.harness.cases import BASE, Case, Measurement
from experiments.harness.experiment import OPERATIONS, QUERIES_TABLE, Axis, Experiment, Table
from experiments.harness.operations import operation_faces
from experiments.harness.queries import time_query
from experiments.harness.steadiness import badness, disturbed
from experiments.harness.timer import Timer, time_rounds
from experiments.presets import ANSWERING, HUBS, ORDERS, PRESETS, Preset

__all__ = [
    "ANSWERING", "BASE", "HUBS", "OPERATIONS", "ORDERS", "PRESETS", "QUERIES_TABLE", "Axis", "Case",
    "Experiment", "Measurement", "Preset", "Table", "Timer", "badness", "disturbed",
    "operation_faces", "time_query", "time_rounds",
]  # fmt: skip
