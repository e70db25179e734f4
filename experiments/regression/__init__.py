"""Whether it is worse than the baseline, than another checkout, than the commits before.

Three comparisons, all of which give findings: `compare_counters` (deterministic, exact),
`compare_runs` (statistics over curves) and `compare_trees` (interleaved). `exit_code` sums findings
up. The baseline is what a run is held against; the history is a line per run, and `Trends` says
what became of every claim.
"""

from experiments.regression.baseline import (
    COUNTERS,
    RUN,
    Measured,
    load_baseline,
    reduce_run,
    save_baseline,
)
from experiments.regression.compare import FACTOR as RUN_FACTOR
from experiments.regression.compare import (
    Compared,
    compare_counters,
    compare_runs,
    describe_difference,
)
from experiments.regression.counters import measure_counters
from experiments.regression.findings import CaseKey, Change, Finding, Kind, exit_code
from experiments.regression.history import append_run, read_history, record_run
from experiments.regression.interleaved import HERE, compare_trees, require_tree
from experiments.regression.significance import FACTOR as INTERLEAVED_FACTOR
from experiments.regression.snapshots import ClaimName
from experiments.regression.trends import MEASURES, OUTCOMES, Trends

__all__ = [
    "COUNTERS", "HERE", "INTERLEAVED_FACTOR", "MEASURES", "OUTCOMES", "RUN", "RUN_FACTOR",
    "CaseKey", "Change", "ClaimName", "Compared", "Finding", "Kind", "Measured", "Trends",
    "append_run", "compare_counters", "compare_runs", "compare_trees", "describe_difference",
    "exit_code", "load_baseline", "measure_counters", "read_history", "record_run", "reduce_run",
    "require_tree", "save_baseline",
]  # fmt: skip
