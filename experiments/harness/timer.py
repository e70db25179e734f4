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
from hem.arrays import Array

Call = Callable[..., Any]
Setup = Callable[[], tuple[Any, ...]]
Clock = Callable[[], float]


@dataclass(frozen=True)
class Timed:
    """Rounds of ``per`` units: seconds per unit, and per step of the loop beside each."""

    samples: Array
    calibration: Array
    per: int

    def averaged(self, together: int) -> Self:
        """Every so many successive rounds as one."""
        samples, calibration = (
            it.reshape(-1, together).mean(axis=1) for it in (self.samples, self.calibration)
        )
        return type(self)(samples, calibration, together * self.per)

    @property
    def fields(self) -> dict[str, Any]:
        """What of it the measurement of a checked case keeps."""
        rows = {"samples": self.samples.tolist(), "calibration": self.calibration.tolist()}
        return {**rows, "handles": self.per, "checked": True}


Timer = Callable[..., Timed]  # `time_rounds`, or a `BenchmarkTimer`, which is called likewise


def time_rounds(
    call: Call, *, setup: Setup = tuple, rounds: int, warmup: int = 1, per: int = 1
) -> Timed:
    """Time ``rounds`` of a call, after ``warmup`` rounds that do not count: a sample each.

    Before each the calibration loop is timed, so that a slow machine is seen beside what it slowed.
    ``setup()`` gives the arguments of each round and is not timed. ``per``: how many units a round
    does; samples are seconds per unit.
    """
    samples, calibration = [], []
    for _ in range(warmup + rounds):
        given = setup()
        calibration.append(calibration_loop())
        begin = perf_counter()
        call(*given)
        samples.append((perf_counter() - begin) / per)
    return Timed(np.array(samples[warmup:]), np.array(calibration[warmup:]), per)


def took(call: Call, *given: Any, clock: Clock = perf_counter) -> tuple[Any, float]:
    """What a call gives, and its seconds."""
    begin = clock()
    found = call(*given)
    return found, clock() - begin


class UnitClock:
    """A clock in which a round of ``per`` units lasts as long as one of them.

    pytest-benchmark's statistics are then per unit too: a round takes as many handles as last long
    enough, and `--benchmark-compare` of whole rounds would find every regression to be none.
    """

    per = 1.0

    def __call__(self) -> float:
        """Seconds, divided by ``per``."""
        return perf_counter() / self.per


CLOCK = UnitClock()  # the clock that `conftest` gives to pytest-benchmark


class BenchmarkTimer:
    """The timer of an experiment: pytest-benchmark's, with calibration beside every round."""

    def __init__(self, benchmark: Any) -> None:
        self._benchmark = benchmark
        self._used = False

    def __call__(
        self, call: Call, *, setup: Setup = tuple, rounds: int, warmup: int = 1, per: int = 1
    ) -> Timed:
        """The rounds, timed; none with ``--benchmark-disable``."""
        calibration: list[float] = []

        def ready() -> tuple[tuple[Any, ...], dict[str, Any]]:
            given = setup()
            calibration.append(calibration_loop())
            return given, {}

        self._used, CLOCK.per = True, per
        self._benchmark.pedantic(call, setup=ready, rounds=rounds, warmup_rounds=warmup)
        stats = self._benchmark.stats
        samples = np.array(stats.stats.data if stats else [], float)
        return Timed(samples, np.array(calibration[len(calibration) - len(samples) :], float), per)

    def end(self) -> None:
        """Tell pytest-benchmark of a case that was counted, or not measured at all."""
        if not self._used:
            self._benchmark.pedantic(lambda: None)
