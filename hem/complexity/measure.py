"""Measure what a function costs by the size of its input, so that it can be judged.

What spoils such measurements is kept out: the first calls do not count, the timer's own cost is
taken off, and rounds are interleaved over the sizes. Inputs are made anew for each round where
there is time for it: of what it saw before, a processor knows by heart how it branches.
Where an input and its answer fit into the caches they are there when they are timed: those sizes
tell of work alone. Larger ones wait for memory, and are held to what those tell. What may be linear
is asked of many small inputs, too, that are as much together: a linear function takes as long
for them, whatever the memory does.
"""

import inspect
import pickle
from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity.asked import FEWEST
from hem.complexity.calls import (
    FREED,
    LONGER,
    SAMPLE,
    Calls,
    Clock,
    Function,
    MakeInput,
    compared,
    interleaved,
    keep_memory,
)
from hem.complexity.estimates import slope
from hem.complexity.measured import InParts, Measured
from hem.complexity.memory import CLOCK, memory_times
from hem.complexity.notation import Array

BUDGET = 4.0
"""Seconds per function, where nothing else is said."""
COUNT = 20  # sizes, where none are given; fewer where a round has no time for twice as many
TRIED = 8  # the size to see at whether a function changes its input
FIRST = 4  # the first that is tried
STEP, FAR, STRIDE = 1.3, 64, 1.7
"""From one that is tried to the next: small up to `FAR`, as costs may grow exponentially."""
EXPLODES = 6  # slope from one size to the next that no power has
COSTLIER = 1_000_000  # a call of the largest size than one of the smallest, at most …
REACH = 8  # … where the largest size remains so many times the smallest
NEARLY_LINEAR = 0.75, 1.4  # slopes of costs that are compared with those of small inputs …
PART = 2, 12  # … of which each takes so many times as long as a call does beside its work …
BESIDE, LEAST_WORK = 0.12, 0.3  # … a part of it that bends their costs, and the rest at least …
WIDER, PARTS, FEWEST_PARTS = 6, 9, 4  # … up to so many of them, at so many sizes, or these at least
SHORTER, WIDE = 4, 64  # of the largest size to the largest in parts; or it is so many of them
LAZY = inspect.isgenerator, inspect.isawaitable, inspect.isasyncgen


def measure(
    f: Function, make_input: MakeInput, sizes: ArrayLike | None = None, *, budget: float = BUDGET,
    rounds: int = 15, fresh: bool | None = None, amortized: bool = False, most: int = 1_000_000,
    clock: Clock = CLOCK,
) -> Measured:  # fmt: skip
    """Measure f(make_input(n)) for every size n.

    make_input: what makes the input of one call; it is not timed. What it draws at random it draws
    anew each time. Where a cost has several variables, it holds all but one fixed.
    sizes: ascending, at least four over a range of four to be judged. Where none are given, up to
    20 up to `most`, as far as the budget allows: about so many seconds in all. What may be linear
    takes as long again for small inputs. Where all this leaves the class open, the sizes between
    are measured, too, in the same time once more.
    rounds: samples per size; up to twice as many, in twice the time, while other programs keep
    changing the machine's speed, of which those at one speed count. fresh: whether every call gets
    an input of its own. By default inputs that f leaves as they were, as pickle sees it, are used
    again: quick functions need that.
    clock: with `time.perf_counter` waiting counts, too, for files, the network and other threads.
    amortized: f does a sequence of n operations, and the cost of one of them is asked for.

    From then on the process keeps the memory that it frees, up to blocks of 32 MB, if its C library
    is GNU's.

    Raises ValueError for sizes that are not whole numbers from 1 on, for too small a `most` and for
    no budget or rounds; what f raises goes through.
    """
    given = np.empty(0) if sizes is None else _given(sizes)
    if most < FIRST or most % 1:
        raise ValueError(f"most must be a whole number from {FIRST} on, not {most}")
    if not budget > 0 or rounds < 1 or rounds % 1:
        told = f"{budget} s and {rounds}"
        raise ValueError(f"budget must be positive and rounds a whole number, not {told}")
    most, rounds = int(most), int(rounds)
    tried = int(given[0]) if given.size else min(TRIED, most)
    changed = _changes(f, make_input(tried))  # warms up, too
    calls = Calls(f, make_input, changed if fresh is None else fresh, clock, keep_memory())
    turn = budget / (rounds + 1)
    chosen = [int(n) for n in given] or _choose_sizes(calls, turn, most)
    found = _measured(calls, chosen, turn, rounds, amortized)
    if not amortized:
        found = replace(found, in_parts=_in_parts(calls, found, given.size > 0, turn, rounds))
    between = {round(n) for n in np.sqrt(found.sizes[1:] * found.sizes[:-1])} - {*chosen}
    if sizes is not None or not between or found.is_settled:
        return found
    return found.joined(_measured(calls, sorted(between), turn, rounds, amortized))


def _given(sizes: ArrayLike) -> Array:
    """Sizes as they were given, ascending; ValueError for what are none."""
    given = np.ravel(np.asarray(sizes))
    numbers = given.size and given.dtype.kind in "iuf" and np.isfinite(given).all()
    if not numbers or np.any(given < 1) or np.any(given % 1):
        raise ValueError("sizes must be whole numbers, each at least 1")
    return np.unique(given)


def _measured(
    calls: Calls, sizes: Sequence[int], turn: float, rounds: int, amortized: bool
) -> Measured:
    """What a call takes by size, or one of n operations; turn: seconds of a round."""
    working_sets, n = _working_sets(calls, sizes, turn), np.array(sizes, float)
    share = turn / len(sizes) / 2
    samplers = [calls.sampler(*row, share) for row in zip(sizes, working_sets, strict=True)]
    memory = memory_times(working_sets)
    samples = interleaved(samplers, rounds)
    if amortized:
        samples = [row / size for row, size in zip(samples, n, strict=True)]
    return Measured(n, samples, working_sets, memory, amortized=amortized)


def _in_parts(
    calls: Calls, found: Measured, given: bool, turn: float, rounds: int
) -> InParts | None:
    """Calls beside calls on small inputs that are as much together; None where they tell nothing.

    All answers are held to the end, and as much memory beside them as a call takes and gives
    back: so the small ones find nothing in the caches that another one left there.
    """
    part, asked = _parts(found, given)
    if len(asked) < FEWEST_PARTS:
        return None
    _, beside = calls.memory(part)

    def make_parts(size: int) -> list[Any]:
        return [calls.make(part) for _ in range(size // part)]

    def call_each(inputs: list[Any]) -> object:
        return [(calls.f(it), np.empty(beside, np.uint8)) for it in inputs]

    apart, share = calls._replace(f=call_each, make=make_parts), turn / len(asked) / 4
    known = np.log(found.sizes), np.log(found.cost)
    sets = np.interp(np.log(asked), known[0], np.log(found.working_sets))
    rows = [(int(n), size, share) for n, size in zip(asked, np.exp(sets), strict=True)]
    pairs = [(calls.sampler(*row), apart.sampler(*row)) for row in rows]
    ratios = compared(pairs, -(-rounds * 3 // 5))  # of two samples each
    whole, one = (np.exp(np.interp(np.log(n), *known)) for n in (asked, part))
    # What a call does beside its work, the small ones do each: it is taken off of both.
    beside_work, many = found.cost.min() * (found.cost.min() > BESIDE * one), asked // part
    work = 1 - many * beside_work / whole * [np.median(row) for row in ratios]
    scale = (1 - beside_work / whole) / np.maximum(work, LEAST_WORK)
    scale *= many * part / asked  # as the small ones are whole
    return InParts(asked, [row * it for row, it in zip(ratios, scale, strict=True)])


def _choose_sizes(calls: Calls, turn: float, most: int) -> list[int]:
    """Sizes of equal ratio, up to where a turn of all of them takes as long as it may."""
    n, tried, least = FIRST, list[tuple[int, float]](), min(REACH * FIRST // 2, most)
    while not tried or tried[-1][0] < most:
        made, call, waited = calls.seconds_of_one(n)
        tried.append((n, float(call + waited + made * (1 if calls.fresh else 0.1))))
        if len(tried) > 1 and _seconds_of_turn(tried, turn, least) > turn:
            (last, took), (before, less) = tried.pop(), tried[-1]
            if np.log(took / less) > EXPLODES * np.log(last / before):
                least = before  # any larger one may take forever
            break
        n = min(max(n + 1, round(n * (STEP if n < FAR else STRIDE))), most)
    return [int(size) for size in np.unique(_of_equal_ratio(tried, turn, least).round())]


def _working_sets(calls: Calls, sizes: Sequence[int], longest: float) -> Array:
    """Bytes of a call by size; beyond what takes longer to be told, they go on as they grew."""
    told: list[float] = []
    for n in sizes:
        begin = perf_counter()
        told.append(calls.memory(n)[0])
        if perf_counter() - begin > longest:
            break
    known, few = np.array(sizes[: len(told)], float), slice(-4, None)
    grown = slope(known[few], np.array(told[few])) if told[1:] else 1
    rest = np.array(sizes[len(told) :], float) / known[-1]
    return np.concatenate([told, told[-1] * rest**grown])


def _parts(found: Measured, given: bool) -> tuple[int, Array]:
    """A small size, and larger ones to compare with it; of those that were given, if they were.

    None where it would tell nothing: where costs are far from linear, or no size is much larger
    than one at which a call works, or where the system has to find memory anew.
    """
    n, cost = found.sizes, found.cost
    times = PART[0], np.clip(cost.max() / cost.min() / WIDER, *PART)
    first, wished = (int(np.argmax(cost >= it * cost.min())) for it in times)
    small = found.working_sets < FREED
    for k in range(wished, first - 1, -1):
        room = n[small & (n <= max(n[-1] / SHORTER, WIDE * n[k]))]
        if room.size and room[-1] >= WIDER * n[k] and cost[k] >= times[0] * cost.min():
            break
    else:
        return int(n[first]), np.empty(0)
    part = int(n[k])
    least, most = NEARLY_LINEAR
    if not least < slope(n[n >= part], cost[n >= part]) < most:
        return part, np.empty(0)
    if given:
        return part, n[(n > part) & (n <= room[-1])]
    return part, np.unique(np.geomspace(2 * part, room[-1], PARTS) // 1)


def _of_equal_ratio(tried: list[tuple[int, float]], turn: float, least: int) -> Array:
    """Sizes up to the largest that was tried, or ``least``; tried: with what each takes.

    The fewer, the less of a turn is left beside the smallest one.
    """
    last, longest = tried[-1]
    telling = next(n for n, seconds in tried if seconds * COSTLIER >= longest)
    first = max(FIRST, min(telling, last // REACH))
    few = turn / 2 / max(tried[0][1], SAMPLE * LONGER)
    return np.geomspace(first, max(last, least), int(np.clip(few, FEWEST, COUNT)))


def _seconds_of_turn(tried: list[tuple[int, float]], turn: float, least: int) -> float:
    """What one sample of each size takes, were these the sizes."""
    known, seconds = np.log(np.array(tried)).T
    sizes = np.log(_of_equal_ratio(tried, turn, least))
    return float(np.maximum(np.exp(np.interp(sizes, known, seconds)), SAMPLE * LONGER).sum())


def _changes(f: Function, it: Any) -> bool:
    """Whether a call changes its input, or may do so unseen."""
    before = _pickled(it)
    answer = f(it)
    if any(lazy(answer) for lazy in LAZY):
        raise ValueError(
            f"what is measured returns a {type(answer).__name__}, which does its work later: "
            "measure what runs it, such as lambda it: list(f(it))"
        )
    return before is None or _pickled(it) != before


def _pickled(it: Any) -> bytes | None:
    try:
        return pickle.dumps(it)
    except Exception:  # whatever an object may say to that
        return None
