"""Time calls of a function, at several sizes in turn."""

import gc
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hem.complexity.notation import Array

Function = Callable[[Any], object]
MakeInput = Callable[[int], Any]
Clock = Callable[[], float]
Sampler = Callable[[], tuple[float, float]]
"""Takes a sample: seconds per call, and of a loop that says how slow the machine was then."""

BATCH = 1 << 18  # bytes of the inputs of a sample, where one takes less: they fit into caches
MOST_CALLS = 4_096  # inputs of a sample
SAMPLE = 1e-4  # seconds of one at least …
LONGER = 10  # … and so many times that at most, where a call takes less
IDLE = range(1_000)  # a loop that tells how fast the machine is …
ALIKE = 1.15  # … and takes up to so many times as long beside samples that count together
ENOUGH = 3  # one sample in so many must count …
MOST_ROUNDS = 2  # … or there are up to so many times as many rounds
SPEEDS = 41  # that are looked at
FREED, SMALL, ARENA = (1 << 25) - (1 << 16), 400, 1 << 20
"""Bytes: of the largest block whose freeing raises what the C library keeps to itself; of an object
that Python itself finds room for, and of what it asks for at once to do so."""


class Calls(NamedTuple):
    """Calls of a function; ``fresh``: each gets an input of its own; ``held``: keeps memory."""

    f: Function
    make: MakeInput
    fresh: bool
    clock: Clock
    held: list[bytes]

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
        """(3,) what an input takes, a call, and both beside the clock, such as asleep.

        Of two, as one that was disturbed says little.
        """
        taken = []
        for _ in range(2):
            first, begin = perf_counter(), self.clock()
            it = self.make(n)
            made = self.clock()
            self.f(it)
            end = self.clock()
            waited = max(perf_counter() - first - (end - begin), 0.0)
            taken.append((made - begin, max(end - made, 1e-9), waited))
            del it
        return np.min(taken, axis=0)

    def sampler(self, n: int, size: float, share: float) -> Sampler:
        """As many calls as a clock needs, on inputs that caches hold; few are learned by heart.

        size: bytes of a call. share: seconds that making the inputs of a sample may take.
        """
        made, call, waited = self.seconds_of_one(n)
        call = max(call, waited * (waited > SAMPLE))  # less is what it takes to read clocks
        most = SAMPLE * LONGER / (made + call if self.fresh else max(made / LONGER, call))
        calls = int(np.clip(min(BATCH / size, most), 1, MOST_CALLS))
        again = 1 if self.fresh else int(np.clip(SAMPLE / (calls * call), 1, MOST_CALLS))
        anew = self.fresh or made * calls < share  # or all samples have the same inputs
        pool = [] if anew else [self.make(n) for _ in range(calls)]

        def sample() -> tuple[float, float]:
            inputs = (pool or [self.make(n) for _ in range(calls)]) * again
            own, before = self.idle(inputs), self.idle(IDLE)
            seconds = self.seconds(inputs)
            return max(seconds - own, 1e-9) / len(inputs), max(before, self.idle(IDLE), 1e-9)

        return sample

    def memory(self, n: int) -> tuple[int, int]:
        """Bytes of an input and of what a call makes beside it; and what of these it gives back.

        As Python and NumPy tell them.
        """
        traced = tracemalloc.is_tracing()
        if not traced:
            tracemalloc.start()
        try:
            before, _ = tracemalloc.get_traced_memory()
            it = self.make(n)
            made, _ = tracemalloc.get_traced_memory()
            tracemalloc.reset_peak()
            answer = self.f(it)
            after, peak = tracemalloc.get_traced_memory()
            del answer
        finally:
            if not traced:
                tracemalloc.stop()
        return max(peak - before, 1), peak - max(after, made)


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


def interleaved(samplers: Sequence[Sampler], rounds: int) -> list[Array]:
    """Samples of each size, all up and down in turn, after a round that does not count.

    There are more rounds while at no speed of the machine each size has samples enough.
    """
    samples: list[list[tuple[float, float]]] = [[] for _ in samplers]
    enough = -(-rounds // ENOUGH)
    with _uncollected():
        for turn in range(rounds * MOST_ROUNDS + 1):
            for row, sample in list(zip(samples, samplers, strict=True))[:: 1 - 2 * (turn % 2)]:
                row.append(sample())
            told = np.array(samples)[:, 1:]
            alike = None if turn < rounds else _at_one_speed(told[..., 1], enough)
            if alike is not None:
                break
    kept = np.ones(told.shape[:2], bool) if alike is None else alike
    return [row[few, 0] for row, few in zip(told, kept, strict=True)]


def compared(pairs: Sequence[tuple[Sampler, Sampler]], rounds: int) -> list[Array]:
    """Of each pair what one sample takes, times the other that is taken right beside it.

    After a round that does not count. Pairs in which the machine changed its speed do not, either,
    where there are enough others.
    """
    told: list[list[tuple[float, float]]] = [[] for _ in pairs]
    with _uncollected():
        for turn in range(rounds + 1):
            for row, pair in list(zip(told, pairs, strict=True))[:: 1 - 2 * (turn % 2)]:
                (one, slow), (other, slow_too) = (sample() for sample in pair)
                row.append((one / other, max(slow, slow_too) / min(slow, slow_too)))
    found = np.array(told)[:, 1:]
    steady = found[..., 1] <= ALIKE
    steady |= steady.sum(axis=1, keepdims=True) < rounds / ENOUGH
    return [row[few, 0] for row, few in zip(found, steady, strict=True)]


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


def keep_memory() -> list[bytes]:
    """Let memory that calls free stay with the process, as in a long-running one.

    Else every call of some sizes asks the system for pages anew, and waits for it. The C library
    keeps blocks that are no larger than one that it saw freed. Python gives back what it carves
    small objects from once all of these are freed: one of each is returned, to be held.
    """
    np.empty(FREED, np.uint8)
    return [bytes(SMALL) for _ in range(FREED // SMALL)][:: ARENA // (2 * SMALL)]
