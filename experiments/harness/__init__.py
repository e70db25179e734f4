"""How one case is measured: what a case is, how it is timed or counted, and what is kept of it.

Experiments import from here; what each of them measures stands in its ``bench_*.py``.
"""

from experiments.harness.axes import Axis
from experiments.harness.calibration import calibration_loop
from experiments.harness.cases import BASE, Case, in_random_order, queried_handles, shuffled
from experiments.harness.experiment import (
    ANYONE,
    KINDS,
    OPERATIONS,
    OPERATIONS_TABLE,
    QUERIES_TABLE,
    RENDERED,
    Experiment,
    Table,
)
from experiments.harness.latency import latency_now
from experiments.harness.measurement import Keep, Measurement
from experiments.harness.operations import (
    count_elements,
    operation_arguments,
    operation_faces,
    time_operations,
    validate_operated,
)
from experiments.harness.oracle import CHECKED_HANDLES, check_query
from experiments.harness.presets import HUBS, PRESETS, Preset
from experiments.harness.queries import time_checked_query
from experiments.harness.steadiness import Watch, badness, disturbed
from experiments.harness.timer import (
    CLOCK,
    BenchmarkTimer,
    Timed,
    Timer,
    time_rounds,
    why_too_slow,
)
from experiments.harness.workloads import WORKLOADS, Workload

__all__ = [
    "ANYONE",
    "BASE",
    "CHECKED_HANDLES",
    "CLOCK",
    "HUBS",
    "KINDS",
    "OPERATIONS",
    "OPERATIONS_TABLE",
    "PRESETS",
    "QUERIES_TABLE",
    "RENDERED",
    "WORKLOADS",
    "Axis",
    "BenchmarkTimer",
    "Case",
    "Experiment",
    "Keep",
    "Measurement",
    "Preset",
    "Table",
    "Timed",
    "Timer",
    "Watch",
    "Workload",
    "badness",
    "calibration_loop",
    "check_query",
    "count_elements",
    "disturbed",
    "in_random_order",
    "latency_now",
    "operation_arguments",
    "operation_faces",
    "queried_handles",
    "shuffled",
    "time_checked_query",
    "time_operations",
    "time_rounds",
    "validate_operated",
    "why_too_slow",
]
