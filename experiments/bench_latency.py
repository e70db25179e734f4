"""Latency of the machine's memory by working set: what an O(1) query waits for.

A pointer chase visits every cache line of an array once, in random order; each access must wait for
the one before. Queries are judged against the latency at their own working set.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from experiments.conftest import Keep
from experiments.profiles import Profile
from experiments.results import CellResult
from experiments.subjects import Cell

STRUCTURES = ("machine",)

LINE = 64
WORDS = LINE // 8
SMALLEST = 16 * 1024
STEPS = 50_000


def cells(profile: Profile, structure: str) -> list[Cell]:
    """Working sets of 16 KiB and up, two per doubling; ``size`` is in bytes."""
    most = profile.latency_mib * 1024 * 1024
    steps = int(2 * np.log2(most / SMALLEST)) + 1
    sizes = (round(SMALLEST * 2 ** (k / 2) / LINE) * LINE for k in range(steps))
    return [Cell(structure, "chase", size) for size in sizes]


def test_latency(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Time the chase; every line must be visited before the first comes again."""
    chain = random_cycle(cell.size // LINE)
    assert chase(chain, 0, len(chain) // WORDS) == 0

    place = 0

    def go_on() -> None:
        nonlocal place
        place = chase(chain, place, STEPS)

    benchmark.pedantic(go_on, rounds=profile.rounds, warmup_rounds=1)
    samples = np.array(benchmark.stats.stats.data if benchmark.stats else []) / STEPS
    keep(
        CellResult(
            id=cell.id,
            kind="time",
            working_set=cell.size,
            handles=STEPS,
            checked=True,
            samples=samples.tolist(),
        )
    )


def random_cycle(lines: int) -> NDArray[np.int64]:
    """(8 · lines,) int64: the first word of each line names the line to visit after it."""
    order = np.random.default_rng(0).permutation(lines)
    chain = np.zeros(WORDS * lines, np.int64)
    chain[WORDS * order] = np.roll(order, -1)
    return chain


@njit(cache=True)
def chase(chain: NDArray[np.int64], line: int, steps: int) -> int:
    """The line reached from ``line`` after so many steps."""
    for _ in range(steps):
        line = chain[WORDS * line]
    return line
