"""Laws of timing against budgets: rounds are interleaved, and few where they take long."""

import numpy as np
import pytest

from experiments.validation import budgets
from experiments.validation.budgets import Task, time_interleaved


@pytest.fixture(autouse=True)
def _left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """However slow the machine all rounds begin, and none searches what other tests have left."""
    monkeypatch.setattr(budgets, "SECONDS", np.inf)
    monkeypatch.setattr("gc.collect", lambda: 0)


def test_rounds_are_interleaved_and_each_has_its_own_setup() -> None:
    calls: list[str] = []
    made = iter(range(100))
    first = Task(lambda given: calls.append(f"first {given}"), lambda: (next(made),))
    time_interleaved([first, Task(lambda: calls.append("second"))], rounds=2)
    assert calls == ["first 0", "second", "first 1", "second", "first 2", "second"]


def test_what_takes_long_is_timed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budgets, "SECONDS", 0.0)
    calls: list[None] = []
    time_interleaved([Task(lambda: calls.append(None))])
    assert len(calls) == 2  # the first one warms up
