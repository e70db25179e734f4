"""Latency of the machine's memory by working set: what an O(1) query waits for.

The whole curve, for the plots; a query is judged against the latency measured beside it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.latency import LINE, WORDS, chase, random_cycle
from experiments.harness.presets import Preset
from experiments.runs.results import Measurement

STRUCTURES = ("machine",)

SMALLEST = 16 * 1024
STEPS = 50_000


def cases(profile: Preset, structure: str) -> list[Case]:
    """Working sets of 16 KiB and up, two per doubling; ``size`` is in bytes."""
    most = profile.latency_mib * 1024 * 1024
    steps = int(2 * np.log2(most / SMALLEST)) + 1
    sizes = (round(SMALLEST * 2 ** (k / 2) / LINE) * LINE for k in range(steps))
    return [Case(structure, "chase", size) for size in sizes]


def test_latency(case: Case, profile: Preset, benchmark: Any, keep: Keep) -> None:
    """Time the chase; every line must be visited before the first comes again."""
    chain = random_cycle(case.size // LINE)
    assert chase(chain, 0, len(chain) // WORDS) == 0

    place = 0

    def go_on() -> None:
        nonlocal place
        place = chase(chain, place, STEPS)

    benchmark.pedantic(go_on, rounds=profile.rounds, warmup_rounds=1)
    samples = np.array(benchmark.stats.stats.data if benchmark.stats else []) / STEPS
    keep(
        Measurement(
            id=case.id,
            kind="time",
            working_set=case.size,
            handles=STEPS,
            checked=True,
            samples=samples.tolist(),
        )
    )


__all__ = ["STRUCTURES", "cases", "test_latency"]
