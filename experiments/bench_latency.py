"""Latency of the machine's memory by working set: what an O(1) query waits for.

The whole curve, for the plots; a query is judged against the latency measured beside it.
"""

import numpy as np

from experiments import harness
from experiments.harness import Case, Experiment, Measurement, Preset, Timer, calibration

SMALLEST = 16 * 1024
STEPS = 50_000
LINE = calibration.CACHE_LINE


def cases(preset: Preset, structure: str) -> list[Case]:
    """Working sets of 16 KiB and up, two per doubling; ``size`` is in bytes."""
    steps = int(2 * np.log2(preset.latency_mib * 1024 * 1024 / SMALLEST)) + 1
    sizes = (round(SMALLEST * 2 ** (k / 2) / LINE) * LINE for k in range(steps))
    return [Case(structure, "chase", size) for size in sizes]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time the chase; every line must be visited before the first comes again."""
    chain, place = calibration.random_cycle(case.size // LINE), 0
    assert calibration.chase(chain, 0, len(chain) // calibration.CACHE_LINE_WORDS) == 0

    def go_on() -> None:
        nonlocal place
        place = calibration.chase(chain, place, STEPS)

    timed = timer(go_on, rounds=preset.rounds, per=STEPS)
    return Measurement(case.id, "time", working_set=case.size, **timed.fields)


EXPERIMENT = Experiment(
    title="Latency of the memory", cases=cases, measure=measure, structures=(harness.NO_STRUCTURE,),
    copies=0, turn=30,
)  # fmt: skip
test_latency = EXPERIMENT.test
