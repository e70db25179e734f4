"""How steady the machine is while a case is measured.

The calibration loop, which always does the same, is timed before and after each case. One that
takes longer than it can take says that something else was running, or that the processor was
throttled; so does a case during which the process did not get its core. Cases that are disturbed
are measured again, at most ``REPEATS`` times, and the calmest measurement is kept. What is still
disturbed is counted, and past ``BUSY`` the machine was too busy to judge by time.
"""

from __future__ import annotations

from functools import lru_cache
from time import perf_counter, process_time
from typing import Any

import numpy as np

from experiments.harness.calibration import calibration_loop

READINGS = 5
FIRST_READINGS = 50
"""Readings at the start of a process, to know how fast the loop can be."""

SLOWDOWN = 0.25
"""Part by which the loop may be slower than at its fastest …"""
OFF_CPU = 0.10
"""… and part of its time that a case may wait for its core, before it counts as disturbed."""
REPEATS = 2
BUSY = 0.10
"""Share of disturbed cases above which times should not be judged by."""


def calibration() -> float:
    """Seconds per step of the loop just now, the median of some; a fraction of a millisecond."""
    return float(np.median([calibration_loop() for _ in range(READINGS)]))


@lru_cache(maxsize=1)
def fastest() -> float:
    """The fastest of some readings in this process, taken when first asked."""
    calibration_loop()  # compiles
    return min(calibration_loop() for _ in range(FIRST_READINGS))


class Watch:
    """Watches the machine from now until ``seen``."""

    def __init__(self) -> None:
        self.fastest = fastest()
        self.before = calibration()
        self._begin = perf_counter(), process_time()

    def seen(self) -> dict[str, float]:
        """What happened: ``fastest``, ``before``, ``after``, ``slowdown``, ``off_cpu``.

        The first three are seconds per step of the loop; ``slowdown``: by what part the slower
        reading was slower than the fastest; ``off_cpu``: the part of the time for which the process
        was not running.
        """
        wall, ran = perf_counter() - self._begin[0], process_time() - self._begin[1]
        after = calibration()
        least = min(self.fastest, self.before, after)
        return {
            "fastest": least,
            "before": self.before,
            "after": after,
            "slowdown": max(self.before, after) / least - 1,
            "off_cpu": max(0.0, 1 - ran / wall),
        }


def disturbed(noise: dict[str, Any]) -> bool:
    """Whether what a ``Watch`` saw is more than a time should be judged by."""
    return bool(noise) and (noise["slowdown"] > SLOWDOWN or noise["off_cpu"] > OFF_CPU)


def badness(noise: dict[str, Any]) -> float:
    """By how much a case was disturbed, to choose the calmest of several measurements of it."""
    return max(noise["slowdown"] / SLOWDOWN, noise["off_cpu"] / OFF_CPU) if noise else np.inf
