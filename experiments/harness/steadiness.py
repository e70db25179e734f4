"""How steady the machine is while a case is measured, and which core is the calmest.

A loop that fills its core is timed before and after each case. A case beside a slow loop, or
without its core, was disturbed: it is measured again, and the calmest measurement is kept.
"""

import os
from contextlib import suppress
from functools import lru_cache
from time import perf_counter, process_time
from typing import Any

import numpy as np
import psutil

from experiments.harness.calibration import filling_loop

READINGS = 5
FIRST_READINGS = 50  # readings at the start of a process, to know how fast the loop can be
SLOWDOWN = 0.25  # part by which the loop may be slower than at its fastest …
OFF_CPU = 0.10  # … and part of its time that a case may wait for its core: beyond, it is disturbed
IMPOSSIBLE = 0.1  # the same of its rounds that took less than can be, idle calls taken off
REPEATS = 2  # how often a disturbed case is measured again, at most
BUSY = 0.10  # share of disturbed cases above which times should not be judged by
WATCHED_SECONDS = 0.1
SHORT_WAIT = 1e-3  # seconds, which spoil one round at most: what reads progress takes as long


def reading() -> float:
    """Seconds per step of the loop just now, the median of some; a fraction of a millisecond."""
    return float(np.median([filling_loop() for _ in range(READINGS)]))


class Watch:
    """Watches the machine from now until ``seen``."""

    fastest = np.inf  # seconds per step of the loop, the least that this process read

    def __init__(self) -> None:
        if Watch.fastest == np.inf:
            filling_loop()  # compiles
            Watch.fastest = min(filling_loop() for _ in range(FIRST_READINGS))
        self.before = reading()
        self._begin = perf_counter(), _ran()

    def seen(self) -> dict[str, float]:
        """What happened: ``fastest``, ``before``, ``after``, ``off_cpu``.

        The first three are seconds per step of the loop, the first being the least so far;
        ``off_cpu``: the part of the time for which neither the process nor one that it waited for
        was running.
        """
        wall, ran = perf_counter() - self._begin[0], _ran() - self._begin[1]
        after = reading()
        Watch.fastest = min(Watch.fastest, self.before, after)
        readings = {"fastest": Watch.fastest, "before": self.before, "after": after}
        return {**readings, "off_cpu": 1 - ran / wall if wall > ran + SHORT_WAIT else 0.0}


def _ran() -> float:
    """Seconds for which this process ran, and those that it started and that have ended."""
    mine = process_time()
    with suppress(ImportError):  # as on Windows, which tells of this process alone
        from resource import RUSAGE_CHILDREN, getrusage

        ended = getrusage(RUSAGE_CHILDREN)
        return mine + ended.ru_utime + ended.ru_stime
    return mine


def disturbed(noise: dict[str, Any]) -> bool:
    """Whether what a ``Watch`` saw is more than a time should be judged by, or cannot be."""
    return bool(noise) and badness(noise) > 1


def badness(noise: dict[str, Any]) -> float:
    """By how much a case was disturbed, to choose the calmest of several measurements of it."""
    if not noise:
        return np.inf
    slowdown = max(noise["before"], noise["after"]) / noise["fastest"] - 1
    impossible = noise.get("impossible", 0.0) / IMPOSSIBLE
    return max(slowdown / SLOWDOWN, noise["off_cpu"] / OFF_CPU, impossible)


@lru_cache(maxsize=1)
def allowed_cores() -> list[int]:
    """The cores this process was given; none where the system does not say."""
    return sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else []


def pin() -> int | None:
    """Keep this process and its threads on the calmest core -> which; None where that cannot be."""
    with suppress(OSError):
        if cores := allowed_cores():
            os.sched_setaffinity(0, cores)
            core = calmest(cores)
            os.sched_setaffinity(0, {core})
            return core
    return None


def calmest(cores: list[int], seconds: float = WATCHED_SECONDS) -> int:
    """The core that was idle for longest just now; of equals the last one."""
    busy = dict(enumerate(psutil.cpu_percent(seconds, percpu=True)))
    return max(cores, key=lambda core: (-busy.get(core, 0), core))
