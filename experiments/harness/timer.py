"""The one timer: rounds of the same call, and a fixed loop beside each of them.

``time_rounds`` needs the clock alone; ``BenchmarkTimer`` does the same through pytest-benchmark,
whose own command line then works on the experiments.
"""

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Self

import numpy as np

from experiments.harness.calibration import calibration_loop
from experiments.presets import Preset
from hem.arrays import Array

Call = Callable[..., Any]
Given = tuple[tuple[Any, ...], dict[str, Any]]
Setup = Callable[[], Given] | None


@dataclass(frozen=True)
class Timed:
    """Rounds of a call: ``samples``, seconds per unit, and ``calibration``, seconds per step."""

    samples: Array
    calibration: Array

    def averaged(self, together: int) -> Self:
        """Every so many successive rounds as one."""
        both = self.samples, self.calibration
        return type(self)(*(it.reshape(-1, together).mean(axis=1) for it in both))

    @property
    def fields(self) -> dict[str, Any]:
        """What of it a measurement keeps."""
        return {"samples": self.samples.tolist(), "calibration": self.calibration.tolist()}


Timer = Callable[..., Timed]
"""``time_rounds``, or a ``BenchmarkTimer``, which is called likewise."""


def time_rounds(
    call: Call, *, setup: Setup = None, rounds: int, warmup: int = 1, per: float = 1
) -> Timed:
    """Time ``rounds`` of a call, after ``warmup`` rounds that do not count: a sample each.

    Before each the calibration loop is timed, so that a slow machine is seen beside what it slowed.
    ``setup()`` gives the arguments of each round and is not timed. ``per``: how many units a round
    does; samples are seconds per unit.
    """
    samples, calibration = [], []
    for _ in range(warmup + rounds):
        given, named = setup() if setup else ((), {})
        calibration.append(calibration_loop())
        begin = perf_counter()
        call(*given, **named)
        samples.append((perf_counter() - begin) / per)
    return Timed(np.array(samples[warmup:]), np.array(calibration[warmup:]))


class UnitClock:
    """A clock in which a round of ``per`` units lasts as long as one of them.

    pytest-benchmark's statistics are then per unit too: a round takes as many handles as last long
    enough, and `--benchmark-compare` of whole rounds would find every regression to be none.
    """

    per = 1.0

    def __call__(self) -> float:
        """Seconds, divided by ``per``."""
        return perf_counter() / self.per


CLOCK = UnitClock()
"""The clock that ``conftest`` gives to pytest-benchmark."""


class BenchmarkTimer:
    """The timer of an experiment: pytest-benchmark's, with calibration beside every round."""

    def __init__(self, benchmark: Any) -> None:
        self._benchmark = benchmark
        self._used = False

    def __call__(
        self, call: Call, *, setup: Setup = None, rounds: int, warmup: int = 1, per: float = 1
    ) -> Timed:
        """The rounds, timed; none with ``--benchmark-disable``."""
        calibration: list[float] = []

        def ready() -> Given:
            given = setup() if setup else ((), {})
            calibration.append(calibration_loop())
            return given

        self._used, CLOCK.per = True, per
        self._benchmark.pedantic(call, setup=ready, rounds=rounds, warmup_rounds=warmup)
        stats = self._benchmark.stats
        samples = np.array(stats.stats.data if stats else [], float)
        return Timed(samples, np.array(calibration[len(calibration) - len(samples) :], float))

    def end(self) -> None:
        """Tell pytest-benchmark of a case that was counted, or not measured at all."""
        if not self._used:
            self._benchmark.pedantic(lambda: None)


SECONDS_PER_FACE = 1e-9
"""What a scan of the mesh takes at the least."""
LONGEST = 20
"""How many times the seconds of a case all its rounds may take, where each searches the mesh."""


def why_too_slow(scans: float, faces: int, rounds: int, preset: Preset) -> str:
    """Why a case that scans the mesh so often per round is skipped; empty if it can be afforded."""
    seconds, allowed = scans * faces * SECONDS_PER_FACE, LONGEST * preset.case_seconds
    if rounds * seconds <= allowed:
        return ""
    return f"takes {seconds:.0f} s and more a round, and {allowed:.0f} s are given to all rounds"
