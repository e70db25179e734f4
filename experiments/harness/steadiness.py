"""How steady the machine was while a run measured.

A probe, a short compiled loop that always does the same, is timed before and after each case. One
that takes longer than it can take says that something else was running, or that the processor was
throttled; so does a case during which the process did not get its core. Cases that are disturbed
by more than ``STRAY`` are measured again at the end of their process, at most ``REPEATS`` times,
and the calmest result is kept. What is still disturbed is counted, and past ``BUSY`` the machine
was too busy to judge by time.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from experiments.runs.results import Run

STEPS = 100_000
SAMPLES = 5
CALIBRATION = 10
"""Probes at the start of a process, to know how fast the loop can be."""

STRAY = 0.25
"""Part by which a probe may be slower than the fastest one …"""
WAITED = 0.10
"""… and part of its time that a case may wait for its core, before it counts as disturbed."""
REPEATS = 2
BUSY = 0.10
"""Share of disturbed cases above which times should not be judged by."""


@njit(cache=True)
def _loop(steps: int) -> int:
    state = 1
    for _ in range(steps):
        state = (state * 1103515245 + 12345) & 0x7FFFFFFF
    return state


def probe() -> float:
    """Seconds that the loop takes just now, the median of some; about a millisecond in all."""
    seconds = []
    for _ in range(SAMPLES):
        begin = perf_counter()
        _loop(STEPS)
        seconds.append(perf_counter() - begin)
    return float(np.median(seconds))


@lru_cache(maxsize=1)
def fastest() -> float:
    """Seconds of the fastest of some probes in this process, taken when first asked."""
    _loop(1)  # compiles
    return min(probe() for _ in range(CALIBRATION))


class Watch:
    """Watches the machine from now until ``seen``."""

    def __init__(self) -> None:
        self.fastest = fastest()
        self.before = probe()
        self._begin = perf_counter(), process_time()

    def seen(self) -> dict[str, float]:
        """What happened: ``probes`` (seconds), ``waited`` and ``stray`` (parts).

        ``fastest``, ``before``, ``after``: seconds of the probe; ``waited``: the part of the time
        for which the process was not running; ``stray``: by what part the slower probe was slower
        than the fastest.
        """
        wall, ran = perf_counter() - self._begin[0], process_time() - self._begin[1]
        after = probe()
        least = min(self.fastest, self.before, after)
        return {
            "fastest": least,
            "before": self.before,
            "after": after,
            "stray": max(self.before, after) / least - 1,
            "waited": max(0.0, 1 - ran / wall),
        }


def disturbed(noise: dict[str, Any]) -> bool:
    """Whether what a ``Watch`` saw is more than a time should be judged by."""
    return bool(noise) and (noise["stray"] > STRAY or noise["waited"] > WAITED)


def badness(noise: dict[str, Any]) -> float:
    """By how much a case was disturbed, to choose the calmest of several results of it."""
    return max(noise["stray"] / STRAY, noise["waited"] / WAITED) if noise else np.inf


@dataclass(frozen=True)
class Noise:
    """How steady the machine was during a run, over its timed cases.

    ``cases``: how many said so; ``disturbed``: how many were even when they were repeated;
    ``repeated``: how many were measured more than once; ``probe_spread``: the 90th percentile of
    the probes over their fastest, less one; ``worst``: the processes with most disturbed cases.
    """

    cases: int
    disturbed: int
    repeated: int
    probe_spread: float
    worst: dict[str, int] = field(default_factory=dict)

    @property
    def share(self) -> float:
        """The disturbed part of the timed cases."""
        return self.disturbed / max(self.cases, 1)

    @property
    def too_busy(self) -> bool:
        """Whether the machine was too busy to judge by time."""
        return self.share > BUSY

    @property
    def words(self) -> str:
        """All that in a sentence or two."""
        if not self.cases:
            return "The run did not watch how steady the machine was."
        found = (
            f"{self.disturbed:,} of {self.cases:,} timed cases ({self.share:.0%}) were disturbed, "
            f"{self.repeated:,} were repeated; a fixed loop took up to {self.probe_spread:.0%} "
            "longer than at its fastest in nine of ten probes."
        )
        if not self.too_busy:
            return f"The machine was steady: {found}"
        most = ", ".join(f"{name} ({count})" for name, count in self.worst.items())
        return f"The machine was too busy to judge by time: {found} Most: {most}."


def noise(run: Run) -> Noise:
    """How steady the machine was during a run; no cases for runs that did not watch."""
    cases = run.cases
    timed = cases[(cases["kind"] == "time") & cases["noise"].map(bool)]
    seen = list(timed["noise"])
    bad = timed[[disturbed(it) for it in seen]] if seen else timed
    names = (bad["experiment"] + " on " + bad["structure"]).value_counts().head(3)
    return Noise(
        cases=len(seen),
        disturbed=len(bad),
        repeated=sum(it.get("measured", 1) > 1 for it in seen),
        probe_spread=_spread(seen),
        worst={str(name): int(count) for name, count in names.items()},
    )


def _spread(seen: list[dict[str, Any]]) -> float:
    if not seen:
        return 0.0
    over = [it[when] / it["fastest"] - 1 for it in seen for when in ("before", "after")]
    return float(np.quantile(over, 0.9))
