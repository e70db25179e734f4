"""How one case is measured: what a case is, how it is timed or counted, and what is kept of it.

What each experiment measures stands in its ``bench_*.py``. Of the files ``calibration``,
``memory``, ``own_mesh`` and ``steadiness`` are asked for by name.
"""

from experiments.harness.calibration import calibration_loop, latency_now
from experiments.harness.cases import (
    BASE,
    Case,
    Measurement,
    NothingToMeasureError,
    elements_at,
    in_random_order,
)
from experiments.harness.experiment import (
    NO_STRUCTURE,
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
    time_operations,
    validate_operated,
)
from experiments.harness.oracle import (
    CheckFailedError,
    check_query,
    check_rows,
    check_told,
    pack_pairs,
    row,
    turned,
)
from experiments.harness.queries import checked_handles, time_query
from experiments.harness.steadiness import (
    BUSY,
    REPEATS,
    Watch,
    allowed_cores,
    badness,
    disturbed,
    pin,
)
from experiments.harness.timer import CLOCK, BenchmarkTimer, Clock, Timed, Timer, time_rounds, took
from experiments.presets import ANSWERING, HUBS, IRREGULAR, ORDERS, PRESETS, Preset

__all__ = [
    "ANSWERING", "BASE", "BUSY", "CLOCK", "HUBS", "IRREGULAR", "NO_STRUCTURE", "OPERATIONS",
    "OPERATIONS_TABLE", "ORDERS", "PRESETS", "QUERIES_TABLE", "REPEATS", "Axis",
    "BenchmarkTimer", "Case", "CheckFailedError", "Clock", "Experiment", "Keep", "Measurement",
    "NothingToMeasureError", "Preset", "Table", "Timed", "Timer", "Watch", "allowed_cores",
    "badness", "calibration_loop", "check_query", "check_rows", "check_told", "checked_handles",
    "disturbed", "elements_at", "in_random_order", "latency_now", "measured_operations",
    "operation_arguments", "operation_faces", "pack_pairs", "pin", "row", "time_operations",
    "time_query", "time_rounds", "took", "turned", "validate_operated",
]  # fmt: skip
