"""Measure what a function costs by the size of its input, so that it can be judged.

What spoils such measurements is kept out: the first calls do not count, the timer's own cost is
taken off, rounds are interleaved over the sizes, and no input is used twice. Every size is asked
about as much data as the largest, in many calls, so that the caches treat all sizes alike.
"""

import gc
import pickle
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity.judge import Verdict, judge
from hem.complexity.memory import CLOCK, memory_times
from hem.complexity.notation import Array

Function = Callable[[Any], object]
MakeInput = Callable[[int], Any]
Clock = Callable[[], float]

COUNT = 9  # sizes, where none are given
TRIED = 8  # the size to see at whether a function changes its input
FIRST = 4  # the first that is tried
STEP = 1.3  # from one that is tried to the next; small, as costs may grow exponentially
SMALLEST = 64  # where the largest is much larger: below that, it is the call that costs
MOST_CALLS = 4_096  # in a sample
LEAST_SECONDS = 1e-4  # of a sample, where inputs may be used again
MEMORY_ERROR = 0.05  # relative error of what memory did to a call, beside what was measured …
UNSEEN = 2.0  # … and the slowdown that allocators and caches cause beside it, over the sizes


@dataclass(frozen=True)
class Measured:
    """What a function cost by size, and what memory takes at each working set."""

    sizes: Array  # (k,)
    samples: list[Array]  # k times seconds per call
    working_sets: Array  # (3, k) bytes of a call, of all calls of a sample, and in between
    memory: Array  # (9, k) seconds, as `memory_times` tells them of each

    def judge(self, expected: str = "O(1)", **options: Any) -> Verdict:
        """Judge a claim by these costs; options as of `hem.complexity.judge`."""
        given: dict[str, Any] = {"latency": self.memory, "latency_error": MEMORY_ERROR}
        if options.get("latency", 0) is not None:
            given["unseen"] = UNSEEN
        return judge(self.sizes, self.samples, expected, **given | options)


def measure(
    f: Function, make_input: MakeInput, sizes: ArrayLike | None = None, *, budget: float = 5.0,
    rounds: int = 15, fresh: bool | None = None, amortized: bool = False, most: int = 1_000_000,
    clock: Clock = CLOCK,
) -> Measured:  # fmt: skip
    """Measure f(make_input(n)) for every size n.

    make_input: what makes the input of one call; it is not timed. Where a cost has several
    variables, it holds all but one fixed.
    sizes: ascending, at least four over a range of four to be judged. Where none are given, nine up
    to `most`, as far as the budget allows: about so many seconds in all.
    rounds: samples per size. fresh: whether every call gets an input of its own. By default inputs
    that f leaves as they were, as pickle sees it, are used again: quick functions need that.
    clock: with `time.perf_counter` waiting counts, too, for files, the network and other threads.
    amortized: f does a sequence of n operations, and the cost of one of them is asked for.

    Raises ValueError for sizes that are not whole numbers from 1 on; what f raises goes through.
    """
    slot, given = budget / (COUNT * (rounds + 1)), None if sizes is None else _checked(sizes)
    changed = _changes(f, make_input(given[0] if given else TRIED))  # warms up, too
    fresh = changed if fresh is None else fresh
    chosen = given or _choose_sizes(f, make_input, slot, most, clock)
    plans = _plan(f, make_input, chosen, slot, fresh, clock)
    bytes_per_call = np.array([_working_set(f, make_input, n) for n in chosen], float)
    calls = np.array([it.calls for it in plans], float)
    working_sets = bytes_per_call * [calls**0, calls, calls**0.5]
    memory = np.vstack(np.split(memory_times(working_sets.ravel()), 3, axis=1))
    samples: list[list[float]] = [[] for _ in plans]
    collecting = gc.isenabled()
    gc.disable()
    try:
        for turn in range(rounds + 1):
            for row, plan in list(zip(samples, plans, strict=True))[:: 1 - 2 * (turn % 2)]:
                row.append(plan.sample(f, clock))
    finally:
        if collecting:
            gc.enable()
    per = chosen if amortized else np.ones(len(chosen))
    counted = [np.array(row[1:]) / k for row, k in zip(samples, per, strict=True)]
    return Measured(np.array(chosen, float), counted, working_sets, memory)


@dataclass(frozen=True)
class _Plan:
    """How one size is sampled."""

    make: Callable[[], Any]
    calls: int
    again: int  # times that each input is used in a sample; 0 where each call gets its own
    pool: list[Any]

    def sample(self, f: Function, clock: Clock) -> float:
        """Seconds per call."""
        inputs = self.pool * self.again or [self.make() for _ in range(self.calls)]
        own = min(_seconds(None, inputs, clock) for _ in range(2))
        return max(_seconds(f, inputs, clock) - own, 1e-9) / len(inputs)


def _seconds(f: Function | None, inputs: Sequence[Any], clock: Clock) -> float:
    """What calls take together, or no calls: the timer and the loop. Answers are freed after it."""
    answers: list[Any] = []
    keep = answers.append
    if f is None:
        begin = clock()
        for it in inputs:
            keep(it)
        return clock() - begin
    begin = clock()
    for it in inputs:
        keep(f(it))
    return clock() - begin


def _plan(
    f: Function, make: MakeInput, sizes: list[int], slot: float, fresh: bool, clock: Clock
) -> list[_Plan]:
    """As many calls at each size as ask for as much data, and as much work, as the largest."""
    tried = [min(_seconds_of_one(f, make, n, clock) for _ in range(2)) for n in sizes]
    plans = []
    for n, (both, call) in zip(sizes, np.maximum(tried, 1e-9), strict=True):
        most = min(sizes[-1] / n, tried[-1][1] / call, slot / both)
        calls = int(np.clip(most, 1, MOST_CALLS))
        again = 0 if fresh else int(np.clip(LEAST_SECONDS / (calls * call), 1, MOST_CALLS))
        pool = [] if fresh else [make(n) for _ in range(calls)]
        plans.append(_Plan(partial(make, n), calls, again, pool))
    return plans


def _seconds_of_one(f: Function, make: MakeInput, n: int, clock: Clock) -> tuple[float, float]:
    """What an input and a call take, and the call alone."""
    begin = clock()
    it = make(n)
    made = clock()
    f(it)
    end = clock()
    return end - begin, end - made


def _choose_sizes(
    f: Function, make_input: MakeInput, slot: float, most: int, clock: Clock
) -> list[int]:
    """Nine sizes of equal ratio, up to what a call takes the whole slot for."""
    n = FIRST
    while n < most:
        larger = min(max(n + 1, round(n * STEP)), most)
        if all(_seconds_of_one(f, make_input, larger, clock)[0] > slot for _ in range(2)):
            break  # twice, as one that was disturbed says little
        n = larger
    smallest = max(FIRST, min(SMALLEST, n // SMALLEST))
    ends = smallest, max(n, 4 * FIRST)
    return [int(size) for size in np.unique(np.geomspace(*ends, COUNT).round())]


def _changes(f: Function, it: Any) -> bool:
    """Whether a call changes its input, or may do so unseen."""
    try:
        before = pickle.dumps(it)
    except Exception:  # whatever an object may say to being pickled
        f(it)
        return True
    f(it)
    return pickle.dumps(it) != before


def _checked(sizes: ArrayLike) -> list[int]:
    chosen = np.unique(np.asarray(sizes))
    if chosen.ndim != 1 or not chosen.size or np.any(chosen < 1) or np.any(chosen % 1):
        raise ValueError("sizes must be whole numbers, each at least 1")
    return [int(n) for n in chosen]


def _working_set(f: Function, make_input: MakeInput, n: int) -> int:
    """Bytes of an input, and of what a call makes beside it; as Python and NumPy tell them."""
    traced = tracemalloc.is_tracing()
    if not traced:
        tracemalloc.start()
    before, _ = tracemalloc.get_traced_memory()
    it = make_input(n)
    tracemalloc.reset_peak()
    f(it)
    _, peak = tracemalloc.get_traced_memory()
    if not traced:
        tracemalloc.stop()
    return max(peak - before, 1)
