"""Measure what a function costs by the size of its input, so that it can be judged.

What spoils such measurements is kept out: the first calls do not count, the timer's own cost is
taken off, and rounds are interleaved over the sizes. Where an input and its answer fit into the
caches they are there when they are timed: those sizes tell of work alone. Larger ones wait for
memory, and are held to what those tell.
"""

import gc
import pickle
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity.estimates import slope
from hem.complexity.measured import Measured
from hem.complexity.memory import CLOCK, memory_times
from hem.complexity.notation import Array

Function = Callable[[Any], object]
MakeInput = Callable[[int], Any]
Clock = Callable[[], float]

COUNT = 20  # sizes, where none are given
TRIED = 8  # the size to see at whether a function changes its input
FIRST = 4  # the first that is tried
STEP, FAR, WIDER = 1.3, 64, 1.7
"""From one that is tried to the next: small up to `FAR`, as costs may grow exponentially."""
COSTLIER = 1_000_000  # a call of the largest size than one of the smallest, at most …
REACH = 8  # … where the largest size remains so many times the smallest
BATCH = 1 << 18  # bytes of the inputs of a sample, where one takes less: they fit into caches
MOST_CALLS = 4_096  # in a pass
PASS = 2e-4  # seconds of one at least …
LONGER = 5  # … and so many times that at most, where a call takes less
PASSES = 2  # of which the quickest counts, as the first finds its inputs out of the caches


def measure(
    f: Function, make_input: MakeInput, sizes: ArrayLike | None = None, *, budget: float = 5.0,
    rounds: int = 15, fresh: bool | None = None, amortized: bool = False, most: int = 1_000_000,
    clock: Clock = CLOCK,
) -> Measured:  # fmt: skip
    """Measure f(make_input(n)) for every size n.

    make_input: what makes the input of one call; it is not timed. What it draws at random it draws
    anew each time. Where a cost has several variables, it holds all but one fixed.
    sizes: ascending, at least four over a range of four to be judged. Where none are given, 20 up
    to `most`, as far as the budget allows: about so many seconds in all.
    rounds: samples per size. fresh: whether every call gets an input of its own. By default inputs
    that f leaves as they were, as pickle sees it, are used again: quick functions need that.
    clock: with `time.perf_counter` waiting counts, too, for files, the network and other threads.
    amortized: f does a sequence of n operations, and the cost of one of them is asked for.

    Raises ValueError for sizes that are not whole numbers from 1 on; what f raises goes through.
    """
    given = np.unique([] if sizes is None else np.asarray(sizes))
    if sizes is not None and (not given.size or np.any(given < 1) or np.any(given % 1)):
        raise ValueError("sizes must be whole numbers, each at least 1")
    changed = _changes(f, make_input(int(given[0]) if given.size else TRIED))  # warms up, too
    fresh = changed if fresh is None else fresh
    turn = budget / (rounds + 1)
    own = [int(n) for n in given]
    chosen = own or _choose_sizes(f, make_input, turn, most, fresh, clock)
    working_sets = _working_sets(f, make_input, chosen, turn)
    both = zip(chosen, working_sets, strict=True)
    plans = [_plan(f, partial(make_input, n), size, fresh, clock) for n, size in both]
    memory = memory_times(working_sets)
    samples = _interleaved(f, plans, rounds, clock)
    ns = np.array(chosen, float)
    counted = list(np.array(samples) / (ns[:, None] if amortized else 1))
    return Measured(ns, counted, working_sets, memory)


@dataclass(frozen=True)
class _Plan:
    """How one size is sampled."""

    make: Callable[[], Any]
    calls: int
    again: int  # times that each input is used in a pass
    passes: int
    pool: list[Any]  # inputs for all rounds; where there are none, each makes its own

    def sample(self, f: Function, clock: Clock) -> float:
        """Seconds per call, of the quickest pass."""
        passes, inputs = [], (self.pool or [self.make() for _ in range(self.calls)]) * self.again
        for _ in range(self.passes):
            own = min(_seconds(None, inputs, clock) for _ in range(2))
            passes.append(max(_seconds(f, inputs, clock) - own, 1e-9))
        return min(passes) / len(inputs)


def _interleaved(
    f: Function, plans: Sequence[_Plan], rounds: int, clock: Clock
) -> list[list[float]]:
    """Samples of each size, rounds of all up and down in turn, after one that does not count."""
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
    return [row[1:] for row in samples]


def _seconds(f: Function | None, inputs: Sequence[Any], clock: Clock) -> float:
    """What calls take together, the freeing of answers included; or no calls: timer and loop."""
    if f is None:
        begin = clock()
        for _ in inputs:
            pass
        return clock() - begin
    begin = clock()
    for it in inputs:
        f(it)
    return clock() - begin


def _plan(f: Function, make: Callable[[], Any], size: float, fresh: bool, clock: Clock) -> _Plan:
    """As many calls as a clock needs, on inputs that caches hold; few are learned by heart."""
    made, call = np.min([_seconds_of_one(f, make, clock) for _ in range(2)], axis=0)
    call = max(call, 1e-9)
    each_round = fresh or made < call
    most = PASS * LONGER / (made + call if each_round else max(made / LONGER, call))
    calls = int(np.clip(min(BATCH / size, most), 1, MOST_CALLS))
    again = 1 if fresh else int(np.clip(PASS / (calls * call), 1, MOST_CALLS))
    passes = PASSES if not fresh and calls * call <= PASS * LONGER else 1
    return _Plan(make, calls, again, passes, [] if each_round else [make() for _ in range(calls)])


def _seconds_of_one(f: Function, make: Callable[[], Any], clock: Clock) -> tuple[float, float]:
    """What an input takes, and what a call."""
    begin = clock()
    it = make()
    made = clock()
    f(it)
    end = clock()
    return made - begin, end - made


def _choose_sizes(
    f: Function, make_input: MakeInput, turn: float, most: int, fresh: bool, clock: Clock
) -> list[int]:
    """Sizes of equal ratio, up to where a turn of all of them takes as long as it may."""
    n, tried = FIRST, list[tuple[int, float]]()
    while not tried or tried[-1][0] < most:
        taken = [_seconds_of_one(f, partial(make_input, n), clock) for _ in range(2)]
        made, call = np.min(taken, axis=0)  # of two, as one that was disturbed says little
        tried.append((n, float(call + made * (1 if fresh else 0.1))))
        if len(tried) > 1 and _seconds_of_turn(tried) > turn:
            tried.pop()
            break
        n = min(max(n + 1, round(n * (STEP if n < FAR else WIDER))), most)
    low, high = _ends(tried)
    return [int(size) for size in np.unique(np.geomspace(low, high, COUNT).round())]


def _ends(tried: list[tuple[int, float]]) -> tuple[int, int]:
    """The smallest size and the largest, of those that were tried, with what each takes."""
    last, longest = tried[-1]
    telling = next(n for n, seconds in tried if seconds * COSTLIER >= longest)
    return max(FIRST, min(telling, last // REACH)), max(last, REACH * FIRST // 2)


def _seconds_of_turn(tried: list[tuple[int, float]]) -> float:
    """What one sample of each size takes, were these the sizes."""
    known, seconds = np.log(np.array(tried)).T
    low, high = np.log(_ends(tried))
    sizes = np.linspace(low, high, COUNT)
    return float(np.maximum(np.exp(np.interp(sizes, known, seconds)), PASS * LONGER).sum())


def _changes(f: Function, it: Any) -> bool:
    """Whether a call changes its input, or may do so unseen."""
    try:
        before = pickle.dumps(it)
    except Exception:  # whatever an object may say to being pickled
        f(it)
        return True
    f(it)
    return pickle.dumps(it) != before


def _working_sets(
    f: Function, make_input: MakeInput, sizes: Sequence[int], longest: float
) -> Array:
    """Bytes of a call by size; beyond what takes longer to be told, they go on as they grew."""
    told: list[float] = []
    for n in sizes:
        begin = perf_counter()
        told.append(_working_set(f, make_input, n))
        if perf_counter() - begin > longest:
            break
    few = slice(-4, len(told))
    grown = slope(np.array(sizes, float)[: len(told)][few], np.array(told[few])) if told[1:] else 1
    rest = np.array(sizes[len(told) :], float) / sizes[len(told) - 1]
    return np.concatenate([told, told[-1] * rest**grown])


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
