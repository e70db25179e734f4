"""Budgets: what was asked of the speed, what was measured, and whether that is enough."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Any, TypeVar

import numpy as np
from rich.console import Console
from rich.table import Table

from experiments.harness import time_rounds

T = TypeVar("T")

ROUNDS = 5
SECONDS = 6.0
"""After so long no further round begins: what takes seconds is told apart by fewer of them."""


@dataclass(frozen=True)
class Budget:
    """One line of a table."""

    what: str
    asked: str
    measured: str
    met: bool


@dataclass(frozen=True)
class Task:
    """What is timed: ``call`` is given what ``setup``, which is not timed, makes for each round."""

    call: Callable[..., Any]
    setup: Callable[[], Any] | None = None


@dataclass(frozen=True)
class Comparison:
    """One task, done by us and by a peer; ``asked``: how many times faster we are to be."""

    what: str
    asked: float
    peer: str
    ours: Task
    theirs: Task

    def measure(self) -> Budget:
        """Time both, interleaved."""
        ours, theirs = time_interleaved([self.ours, self.theirs])
        ratio = theirs / ours
        measured = f"{ratio:.2f} × ({_milliseconds(ours)}, theirs {_milliseconds(theirs)})"
        met = ratio >= self.asked
        return Budget(f"{self.what}, {self.peer}", f"≥ {self.asked:.3g} ×", measured, met)


def _milliseconds(seconds: float) -> str:
    return f"{1e3 * seconds:,.1f} ms"


def print_budgets(title: str, budgets: Iterable[Budget]) -> None:
    """Print a table, as wide as the terminal or 80 columns."""
    table = Table("", "what", "measured", "asked", title=title, title_justify="left")
    for row in budgets:
        table.add_row("✓" if row.met else "✗", row.what, row.measured, row.asked)
    Console().print(table)


def time_interleaved(tasks: Sequence[Task], rounds: int = ROUNDS) -> list[float]:
    """Median seconds of each task, a round of each after the other, after one that warms up.

    A machine that slows down slows all of them. Freeing what a task returns is not timed.
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
    results: list[Any] = []

    def setup() -> tuple[tuple[Any, ...], dict[str, Any]]:
        given = (task.setup(),) if task.setup else ()
        gc.collect()
        return given, {}

    timed = time_rounds(
        lambda *given: results.append(task.call(*given)), setup=setup, rounds=1, warmup=0
    )
    return float(timed.samples[0])


def run_in_new_process(function: Callable[..., T], *arguments: Any) -> T:
    """Call a function of a module in a process of its own, whose memory is then its alone."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def peak_bytes(function: Callable[[], Any]) -> tuple[Any, int]:
    """What a function returns, and the most resident bytes it added to this process. Linux only."""
    Path("/proc/self/clear_refs").write_text("5")  # the peak begins anew
    before = _status_bytes("VmRSS")
    result = function()
    return result, _status_bytes("VmHWM") - before


def _status_bytes(key: str) -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * int(next(line for line in lines if line.startswith(key)).split()[1])
