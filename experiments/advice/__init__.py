"""Which structure should hold a mesh: what a workload would take, predicted from a run.

``find_workload`` reads how often what is asked and done; ``Prices`` tells what one costs, from the
measurements of a run; ``advise`` ranks the structures, with intervals, reasons and limits.
"""

from experiments.advice.advise import ALIKE, NEEDS, Advice, Limits, advise, best
from experiments.advice.prices import SIGMAS, UNMODELED, Prices, predict
from experiments.advice.workload import PRESETS, Measured, Row, Workload, find_workload, recorded

__all__ = [
    "ALIKE", "NEEDS", "PRESETS", "SIGMAS", "UNMODELED", "Advice", "Limits", "Measured", "Prices",
    "Row", "Workload", "advise", "best", "find_workload", "predict", "recorded",
]  # fmt: skip
