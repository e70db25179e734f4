"""Laws of timing: rounds are separate samples, and a delay while calibrating decides nothing."""

from dataclasses import replace
from functools import partial
from importlib import import_module
from time import perf_counter, sleep
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

from experiments.harness import PRESETS, time_rounds
from experiments.harness.queries import _seconds_per_query
from experiments.harness.timer import BenchmarkTimer, UnitClock, took
from experiments.runs import experiments
from hem.contract import Sweep


def busy(seconds: float) -> None:
    end = perf_counter() + seconds
    while perf_counter() < end:
        pass


class Empty(NamedTuple):
    """The records of no mesh."""

    counts: np.ndarray


class Delayed:
    """By its own clock a handle takes a microsecond, and one of the calls two milliseconds more."""

    def __init__(self, slow: int) -> None:
        self.slow = slow
        self.calls = 0
        self.seconds = 0.0

    def loop(self, handles: np.ndarray, *_: object) -> int:
        self.seconds += len(handles) * 1e-6 + (2e-3 if self.calls == self.slow else 0)
        self.calls += 1
        return 0

    def clock(self) -> float:
        return self.seconds


def test_one_delayed_try_leaves_no_round_with_too_few_handles(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    handles = np.arange(64)
    for delayed in range(5):
        s, no_state = Delayed(delayed), SimpleNamespace(records=Empty(np.zeros(0)))
        monkeypatch.setattr("experiments.harness.queries.took", partial(took, clock=s.clock))
        sweep = Sweep(s.loop, handles, None, no_state, b"")
        assert _seconds_per_query(sweep, 2e-4) == pytest.approx(1e-6)


@pytest.mark.parametrize("kind", ["alone", "pytest-benchmark"])
def test_a_timer_gives_a_sample_and_a_calibration_per_round_and_per_unit(kind, benchmark) -> None:
    timer, given = (time_rounds if kind == "alone" else BenchmarkTimer(benchmark)), []

    def setup():
        given.append(len(given))
        return (given[-1],)

    timed = timer(lambda k: busy(1e-3), setup=setup, rounds=4, warmup=2, per=10)
    if kind == "alone":
        benchmark.pedantic(lambda: None)
    rounds = 4 if kind == "alone" or benchmark.enabled else 0  # off where tests run side by side
    assert timed.samples.shape == timed.calibration.shape == (rounds,)
    assert not rounds or given[:6] == list(range(6))
    assert (timed.samples >= 1e-4).all()
    assert (timed.calibration > 0).all()


def test_rounds_that_belong_together_become_one_sample() -> None:
    timed = time_rounds(lambda: None, rounds=6)
    together = timed.averaged(3)
    assert together.samples.tolist() == [timed.samples[:3].mean(), timed.samples[3:].mean()]
    assert together.calibration.shape == (2,)


def test_a_round_of_many_units_lasts_as_long_as_one_of_them() -> None:
    clock = UnitClock()
    clock.per = 1e6
    begin = clock()
    busy(1e-2)
    assert 1e-8 <= clock() - begin < 1e-3


def test_a_case_that_would_search_for_too_long_says_so() -> None:
    preset = PRESETS["quick"]
    assert preset.why_too_slow(10, 1_000, 3) == ""
    assert "all rounds together get 5 s" in preset.why_too_slow(10**6, 10**6, 3)


@pytest.mark.parametrize(
    ("experiment", "subject", "call", "checks"),
    [("fracture", "shatter", "shatter", 2), ("picking", "neighbors", "ask_compiled", 1)],
)
def test_what_is_slow_when_it_is_checked_gets_as_many_rounds_as_any(
    monkeypatch: pytest.MonkeyPatch, experiment: str, subject: str, call: str, checks: int
) -> None:
    its = experiments()[f"bench_{experiment}"]
    preset = replace(PRESETS["smoke"], rounds=4, case_seconds=1.0)
    case = next(it for it in its.cases(preset, "half_edge") if it.subject == subject)
    module, delays = import_module(its.cases.__module__), iter([1.0] * checks)
    sound = getattr(module, call)

    def compiling(*given: object) -> object:
        sleep(next(delays, 0))
        return sound(*given)

    monkeypatch.setattr(module, call, compiling)
    assert len(its.measure(case, preset, time_rounds).samples) == preset.rounds
