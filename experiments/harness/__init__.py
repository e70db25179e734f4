"""How one case is measured: what a case is, how it is timed or counted, and what is kept of it.

Experiments import from here; what each of them measures stands in its ``bench_*.py``.
"""

from experiments.harness.cases import BASE, Case, Measurement, in_random_order, shuffled
from experiments.harness.experiment import (
    ANYONE,
    OPERATIONS,
    OPERATIONS_TABLE,
    QUERIES_TABLE,
    Axis,
    Experiment,
    Keep,
    Table,
    measured_operations,
)
from experiments.harness.operations import (
    operation_arguments,
    operation_faces,
    searches,
    time_operations,
    validate_operated,
)
from experiments.harness.queries import checked_handles, time_query
from experiments.harness.steadiness import Watch, badness, disturbed
from experiments.harness.timer import CLOCK, BenchmarkTimer, Timer, time_rounds
from experiments.presets import ANSWERING, HUBS, ORDERS, PRESETS, Preset

__all__ = [
    "ANSWERING", "ANYONE", "BASE", "CLOCK", "HUBS", "OPERATIONS", "OPERATIONS_TABLE",
    "ORDERS", "PRESETS", "QUERIES_TABLE", "Axis", "BenchmarkTimer", "Case", "Experiment", "Keep",
    "Measurement", "Preset", "Table", "Timer", "Watch", "badness", "checked_handles", "disturbed",
    "in_random_order", "measured_operations", "operation_arguments", "operation_faces", "searches",
    "shuffled", "time_operations", "time_query", "time_rounds", "validate_operated",
]  # fmt: skip
