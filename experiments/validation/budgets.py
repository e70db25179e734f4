"""Budgets: what was asked of the speed, what was measured, and whether that is enough."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from experiments.harness import time_rounds

ROUNDS = 5
SECONDS = 4.0
"""After so long no further round begins: fewer of them tell apart what takes seconds."""


@dataclass(frozen=True)
class Budget:
    """One line of a table."""

    what: str
    asked: str
    measured: str
    met: bool


@dataclass(frozen=True)
class Task:
    """What is timed: ``call`` gets what ``setup``, which is not timed, makes for each round."""

    call: Callable[..., Any]
    setup: Callable[[], Any] | None = None


def print_budgets(title: str, budgets: Iterable[Budget]) -> None:
    """Print a table, as wide as the terminal or 80 columns."""
    table = Table("", "what", "measured", "asked", title=title, title_justify="left")
    for row in budgets:
        table.add_row("✓" if row.met else "✗", row.what, row.measured, row.asked)
    Console().print(table)


def time_interleaved(tasks: Sequence[Task], rounds: int = ROUNDS) -> list[float]:
    """Median seconds of each task, a round of each after the other, after one that warms up.

    A machine that slows down slows all of them.
    """
    samples: list[list[float]] = [[] for _ in tasks]
    begin = perf_counter()
    for turn in range(rounds + 1):
        if turn > 1 and perf_counter() - begin > SECONDS:
            break
        for task, kept in zip(tasks, samples, strict=True):
            kept.append(_time_once(task))
    return [float(np.median(kept[1:])) for kept in samples]


def _time_once(task: Task) -> float:
    results: list[Any] = []  # kept, so that freeing them is not timed

    def setup() -> tuple[tuple[Any, ...], dict[str, Any]]:
        given = (task.setup(),) if task.setup else ()
        gc.collect()
        return given, {}

    def call(*given: Any) -> None:
        results.append(task.call(*given))

    return float(time_rounds(call, setup=setup, rounds=1, warmup=0).samples[0])
