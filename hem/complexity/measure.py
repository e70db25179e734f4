"""Measure what a function costs by the size of its input, so that it can be judged.

What spoils such measurements is kept out: the first calls do not count, the timer's own cost is
taken off, and rounds are interleaved over the sizes. Inputs are made anew for each round where
there is time for it: of what it saw before, a processor knows by heart how it branches.
Where an input and its answer fit into the caches they are there when they are timed: those sizes
tell of work alone. Larger ones wait for memory, and are held to what those tell. What may be linear
is asked of many small inputs, too, that are as much together: a linear function takes as long
for them, whatever the memory does.
"""

import gc
import pickle
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.complexity.estimates import slope
from hem.complexity.measured import FEWEST, InParts, Measured
from hem.complexity.memory import CLOCK, memory_times
from hem.complexity.notation import Array

Function = Callable[[Any], object]
MakeInput = Callable[[int], Any]
Clock = Callable[[], float]

BUDGET = 4.0  # seconds per function
COUNT = 20  # sizes, where none are given; fewer where a round has no time for twice as many
TRIED = 8  # the size to see at whether a function changes its input
FIRST = 4  # the first that is tried
STEP, FAR, STRIDE = 1.3, 64, 1.7
"""From one that is tried to the next: small up to `FAR`, as costs may grow exponentially."""
COSTLIER = 1_000_000  # a call of the largest size than one of the smallest, at most …
REACH = 8  # … where the largest size remains so many times the smallest
BATCH = 1 << 18  # bytes of the inputs of a sample, where one takes less: they fit into caches
MOST_CALLS = 4_096  # inputs of a sample
SAMPLE = 1e-4  # seconds of one at least …
LONGER = 10  # … and so many times that at most, where a call takes less
IDLE = range(1_000)  # a loop that tells how fast the machine is …
ALIKE = 1.15  # … and takes up to so many times as long beside samples that count together
ENOUGH = 3  # one sample in so many must count …
MOST_ROUNDS = 2  # … or there are up to so many times as many rounds
SPEEDS = 41  # that are looked at
NEARLY_LINEAR = 0.75, 1.4  # slopes of costs that are compared with those of small inputs …
PART = 4, 12  # … of which each takes so many times as long as a call does beside its work …
WIDER, PARTS = 8, 9  # … up to so many of them at least, at so many sizes …
SHORTER, WIDE = 4, 64  # … of which the largest is so many times smaller than the largest of all,
# if it is as many parts
FREED, SMALL, ARENA = (1 << 25) - (1 << 16), 400, 1 << 20
"""Bytes: of the largest block whose freeing raises what the C library keeps to itself; of an object
that Python itself finds room for, and of what it asks for at once to do so."""


def measure(
    f: Function, make_input: MakeInput, sizes: ArrayLike | None = None, *, budget: float = BUDGET,
    rounds: int = 15, fresh: bool | None = None, amortized: bool = False, most: int = 1_000_000,
    clock: Clock = CLOCK,
) -> Measured:  # fmt: skip
    """Measure f(make_input(n)) for every size n.

    make_input: what makes the input of one call; it is not timed. What it draws at random it draws
    anew each time. Where a cost has several variables, it holds all but one fixed.
    sizes: ascending, at least four over a range of four to be judged. Where none are given, 6 to 20
    up to `most`, as far as the budget allows: about so many seconds in all. What may be linear
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

    Raises ValueError for sizes that are not whole numbers from 1 on; what f raises goes through.
    """
    given = np.unique([] if sizes is None else np.asarray(sizes))
    if sizes is not None and (not given.size or np.any(given < 1) or np.any(given % 1)):
        raise ValueError("sizes must be whole numbers, each at least 1")
    changed = _changes(f, make_input(int(given[0]) if given.size else TRIED))  # warms up, too
    calls = _Calls(f, make_input, changed if fresh is None else fresh, clock, _keep_memory())
    turn = budget / (rounds + 1)
    chosen = [int(n) for n in given] or calls.choose_sizes(turn, most)
    found = calls.measured(chosen, turn, rounds, amortized)
    if not amortized:
        found = replace(found, in_parts=calls.in_parts(found, given.size > 0, turn, rounds))
    between = {round(n) for n in np.sqrt(found.sizes[1:] * found.sizes[:-1])} - {*chosen}
    if sizes is not None or not between or found.is_settled:
        return found
    return found.joined(calls.measured(sorted(between), turn, rounds, amortized))


class _Plan(NamedTuple):
    """How one size is sampled."""

    of: "_Calls"
    n: int
    calls: int
    again: int  # times that each input is used in a sample
    pool: list[Any]  # inputs for all rounds; where there are none, each makes its own


class _Calls(NamedTuple):
    """Calls of a function; ``fresh``: each gets an input of its own; ``held``: keeps memory."""

    f: Function
    make: MakeInput
    fresh: bool
    clock: Clock
    held: list[bytes]

    def measured(self, sizes: Sequence[int], turn: float, rounds: int, amortized: bool) -> Measured:
        """What a call takes by size, or one of n operations; turn: seconds of a round."""
        working_sets, n = self.working_sets(sizes, turn), np.array(sizes, float)
        share = turn / len(sizes) / 2
        plans = [self.plan(*row, share) for row in zip(sizes, working_sets, strict=True)]
        memory = memory_times(working_sets)
        samples = self.interleaved(plans, rounds)
        if amortized:
            samples = [row / size for row, size in zip(samples, n, strict=True)]
        return Measured(n, samples, working_sets, memory)

    def in_parts(self, found: Measured, given: bool, turn: float, rounds: int) -> InParts | None:
        """Calls beside calls on small inputs that are as much together.

        None where that would tell nothing: of costs that are far from linear, of sizes that are
        hardly larger than the small ones, and where the system has to find memory anew.
        """
        n, cost, sets = found.sizes, found.cost, found.working_sets
        long = np.clip(cost.max() / cost.min() / WIDER, *PART) * cost.min()
        part = int(n[np.argmax(cost >= long)])
        room = n[(sets < FREED) & (n <= max(n[-1] / SHORTER, WIDE * part))]
        if cost.max() < long or not room.size or room[-1] < WIDER * part:
            return None
        least, most = NEARLY_LINEAR
        if not least < slope(n[n >= part], cost[n >= part]) < most:
            return None
        between = np.geomspace(2 * part, room[-1], PARTS)
        asked = n[(n > part) & (n <= room[-1])] if given else np.unique(between // 1)

        def make_parts(size: int) -> list[Any]:
            return [self.make(part) for _ in range(size // part)]

        beside = self.beside(part)

        def call_each(inputs: list[Any]) -> object:  # and none works where another one did
            return [(self.f(it), np.empty(beside, np.uint8)) for it in inputs]

        apart, share = self._replace(f=call_each, make=make_parts), turn / len(asked) / 4
        took = np.exp(np.interp(np.log(asked), np.log(n), np.log(sets)))
        pairs = [
            (self.plan(int(size), bytes_, share), apart.plan(int(size), bytes_, share))
            for size, bytes_ in zip(asked, took, strict=True)
        ]
        ratios = _compared(pairs, -(-rounds * 3 // 5))  # of two samples each
        whole = asked // part * part / asked
        return InParts(asked, [row * part for row, part in zip(ratios, whole, strict=True)])

    def interleaved(self, plans: Sequence[_Plan], rounds: int) -> list[Array]:
        """Samples of each size, all up and down in turn, after a round that does not count.

        There are more rounds while at no speed of the machine each size has samples enough.
        """
        samples: list[list[tuple[float, float]]] = [[] for _ in plans]
        enough = -(-rounds // ENOUGH)
        with _uncollected():
            for turn in range(rounds * MOST_ROUNDS + 1):
                for row, plan in list(zip(samples, plans, strict=True))[:: 1 - 2 * (turn % 2)]:
                    row.append(self.sample(plan))
                told = np.array(samples)[:, 1:]
                alike = None if turn < rounds else _at_one_speed(told[..., 1], enough)
                if alike is not None:
                    break
        kept = np.ones(told.shape[:2], bool) if alike is None else alike
        return [row[few, 0] for row, few in zip(told, kept, strict=True)]

    def sample(self, plan: _Plan) -> tuple[float, float]:
        """Seconds per call, and of a loop that says how slow the machine was then."""
        inputs = (plan.pool or [self.make(plan.n) for _ in range(plan.calls)]) * plan.again
        own, before = self.idle(inputs), self.idle(IDLE)
        seconds = self.seconds(inputs)
        return max(seconds - own, 1e-9) / len(inputs), max(before, self.idle(IDLE))

    def idle(self, inputs: Sequence[Any]) -> float:
        """Seconds of the timer and a loop that does nothing."""
        return min(self.seconds(inputs, idle=True) for _ in range(2))

    def seconds(self, inputs: Sequence[Any], idle: bool = False) -> float:
        """What calls take together, the freeing of answers included; or idle: timer and loop."""
        f, clock = self.f, self.clock
        begin = clock()
        if idle:
            for _ in inputs:
                pass
        else:
            for it in inputs:
                f(it)
        return clock() - begin

    def seconds_of_one(self, n: int) -> Array:
        """(2,) what an input takes, and a call: of two, as one that was disturbed says little."""
        taken = []
        for _ in range(2):
            begin = self.clock()
            it = self.make(n)
            made = self.clock()
            self.f(it)
            taken.append((made - begin, self.clock() - made))
            del it
        return np.min(taken, axis=0)

    def plan(self, n: int, size: float, share: float) -> _Plan:
        """As many calls as a clock needs, on inputs that caches hold; few are learned by heart.

        share: seconds that making the inputs of a sample may take.
        """
        made, call = np.maximum(self.seconds_of_one(n), (0, 1e-9))
        most = SAMPLE * LONGER / (made + call if self.fresh else max(made / LONGER, call))
        calls = int(np.clip(min(BATCH / size, most), 1, MOST_CALLS))
        again = 1 if self.fresh else int(np.clip(SAMPLE / (calls * call), 1, MOST_CALLS))
        anew = self.fresh or made * calls < share
        return _Plan(self, n, calls, again, [] if anew else [self.make(n) for _ in range(calls)])

    def choose_sizes(self, turn: float, most: int) -> list[int]:
        """Sizes of equal ratio, up to where a turn of all of them takes as long as it may."""
        n, tried = FIRST, list[tuple[int, float]]()
        while not tried or tried[-1][0] < most:
            made, call = self.seconds_of_one(n)
            tried.append((n, float(call + made * (1 if self.fresh else 0.1))))
            if len(tried) > 1 and _seconds_of_turn(tried, turn) > turn:
                tried.pop()
                break
            n = min(max(n + 1, round(n * (STEP if n < FAR else STRIDE))), most)
        return [int(size) for size in np.unique(_between_ends(tried, turn).round())]

    def working_sets(self, sizes: Sequence[int], longest: float) -> Array:
        """Bytes of a call by size; beyond what takes longer to be told, they go on as they grew."""
        told: list[float] = []
        for n in sizes:
            begin = perf_counter()
            told.append(self.working_set(n))
            if perf_counter() - begin > longest:
                break
        known, few = np.array(sizes[: len(told)], float), slice(-4, None)
        grown = slope(known[few], np.array(told[few])) if told[1:] else 1
        rest = np.array(sizes[len(told) :], float) / known[-1]
        return np.concatenate([told, told[-1] * rest**grown])

    def beside(self, n: int) -> int:
        """Bytes that a call takes beside its input and its answer, and gives back."""
        traced = tracemalloc.is_tracing()
        if not traced:
            tracemalloc.start()
        it = self.make(n)
        before, _ = tracemalloc.get_traced_memory()
        tracemalloc.reset_peak()
        answer = self.f(it)
        after, peak = tracemalloc.get_traced_memory()
        del answer
        if not traced:
            tracemalloc.stop()
        return max(peak - max(after, before), 0)

    def working_set(self, n: int) -> int:
        """Bytes of an input, and of what a call makes beside it; as Python and NumPy tell them."""
        traced = tracemalloc.is_tracing()
        if not traced:
            tracemalloc.start()
        before, _ = tracemalloc.get_traced_memory()
        it = self.make(n)
        tracemalloc.reset_peak()
        self.f(it)
        _, peak = tracemalloc.get_traced_memory()
        if not traced:
            tracemalloc.stop()
        return max(peak - before, 1)


@contextmanager
def _uncollected() -> Iterator[None]:
    """No garbage is collected meanwhile."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def _compared(pairs: Sequence[tuple[_Plan, _Plan]], rounds: int) -> list[Array]:
    """Of each pair what one sample takes, times the other that is taken right beside it.

    After a round that does not count. Pairs in which the machine changed its speed do not, either,
    where there are enough others.
    """
    told: list[list[tuple[float, float]]] = [[] for _ in pairs]
    with _uncollected():
        for turn in range(rounds + 1):
            for row, pair in list(zip(told, pairs, strict=True))[:: 1 - 2 * (turn % 2)]:
                (one, slow), (other, slow_too) = (plan.of.sample(plan) for plan in pair)
                row.append((one / other, max(slow, slow_too) / min(slow, slow_too)))
    found = np.array(told)[:, 1:]
    steady = found[..., 1] <= ALIKE
    steady |= steady.sum(axis=1, keepdims=True) < rounds / ENOUGH
    return [row[few, 0] for row, few in zip(found, steady, strict=True)]


def _ends(tried: list[tuple[int, float]]) -> tuple[int, int]:
    """The smallest size and the largest, of those that were tried, with what each takes."""
    last, longest = tried[-1]
    telling = next(n for n, seconds in tried if seconds * COSTLIER >= longest)
    return max(FIRST, min(telling, last // REACH)), max(last, REACH * FIRST // 2)


def _between_ends(tried: list[tuple[int, float]], turn: float) -> Array:
    """Sizes of equal ratio: the fewer, the less of a turn is left beside the smallest one."""
    few = turn / 2 / max(tried[0][1], SAMPLE * LONGER)
    return np.geomspace(*_ends(tried), int(np.clip(few, FEWEST, COUNT)))


def _seconds_of_turn(tried: list[tuple[int, float]], turn: float) -> float:
    """What one sample of each size takes, were these the sizes."""
    known, seconds = np.log(np.array(tried)).T
    sizes = np.log(_between_ends(tried, turn))
    return float(np.maximum(np.exp(np.interp(sizes, known, seconds)), SAMPLE * LONGER).sum())


def _at_one_speed(slowness: Array, enough: int) -> NDArray[np.bool_] | None:
    """(k, r) samples of the highest speed at which each size has enough of them, if there is one.

    slowness: (k, r) seconds of a loop beside each. Where another program has the other half of a
    core, it takes twice as long, and what functions do 1.4 to 2.3 times: no class survives a mix.
    """
    for least in np.quantile(slowness, np.linspace(0, 1, SPEEDS)):
        alike = (slowness >= least) & (slowness <= ALIKE * least)
        if np.all(alike.sum(axis=1) >= enough):
            return alike
    return None


def _keep_memory() -> list[bytes]:
    """Let memory that calls free stay with the process, as in a long-running one.

    Else every call of some sizes asks the system for pages anew, and waits for it. The C library
    keeps blocks that are no larger than one that it saw freed. Python gives back what it carves
    small objects from once all of these are freed: one of each is returned, to be held.
    """
    np.empty(FREED, np.uint8)
    return [bytes(SMALL) for _ in range(FREED // SMALL)][:: ARENA // (2 * SMALL)]


def _changes(f: Function, it: Any) -> bool:
    """Whether a call changes its input, or may do so unseen."""
    try:
        before = pickle.dumps(it)
    except Exception:  # whatever an object may say to being pickled
        f(it)
        return True
    f(it)
    return pickle.dumps(it) != before
