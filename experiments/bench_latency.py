"""Latency of the machine's memory by working set: what an O(1) query waits for.

The whole curve, for the plots; a query is judged against the latency measured beside it.
"""

import numpy as np

from experiments.harness import (
    CACHE_LINE,
    CACHE_LINE_WORDS,
    Case,
    Experiment,
    Measurement,
    Preset,
    Timer,
    chase,
    random_cycle,
)

SMALLEST = 16 * 1024
STEPS = 50_000


def cases(preset: Preset, structure: str) -> list[Case]:
    """Working sets of 16 KiB and up, two per doubling; ``size`` is in bytes."""
    steps = int(2 * np.log2(preset.latency_mib * 1024 * 1024 / SMALLEST)) + 1
    sizes = (round(SMALLEST * 2 ** (k / 2) / CACHE_LINE) * CACHE_LINE for k in range(steps))
    return [Case(structure, "chase", size) for size in sizes]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time the chase; every line must be visited before the first comes again."""
    chain, place = random_cycle(case.size // CACHE_LINE), 0
    assert chase(chain, 0, len(chain) // CACHE_LINE_WORDS) == 0

    def go_on() -> None:
        nonlocal place
        place = chase(chain, place, STEPS)

    timed = timer(go_on, rounds=preset.rounds, per=STEPS)
    return Measurement(case.id, "time", working_set=case.size, **timed.fields)


EXPERIMENT = Experiment(
    title="Latency of the memory", cases=cases, measure=measure, structures=("machine",),
    copies=0, turn=30,
)  # fmt: skip
test_latency = EXPERIMENT.test
