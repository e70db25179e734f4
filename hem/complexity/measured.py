"""What a function was measured to cost, and which of it decides what is said of it.

Sizes that fit into the caches tell of work alone. Those that do not wait for memory, in ways that
no loop beside them shows exactly: of them it is asked only that they go on as the others tell.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hem.complexity.estimates import slope
from hem.complexity.judge import Verdict, judge
from hem.complexity.notation import Array, parse

MEMORY_ERROR = 0.05  # relative error of what memory did to a call, beside what was measured …
UNSEEN = 2.0  # … and the slowdown that allocators and caches cause beside it, over the sizes …
BENT = 4.0  # … or this, where sizes in the caches do not tell that there is less
CACHED_ERROR = 0.03  # the same for sizes that are in the caches …
UNSEEN_CACHED = 1.15  # … as a first cache is quicker than a second …
UNSEEN_LARGE = 1.3  # … and where no small size tells the fixed cost
CACHED = 2.0  # factor by which an access takes longer than at the smallest size, in the caches
FEWEST_CACHED = 6  # sizes that may decide for all
KEPT = 256  # the largest of the integers that Python keeps: larger ones are read from memory
STEEP = 1.5  # slope from which on a call works more than it waits …
COSTLY = 1_000  # … and is judged where it takes that part of the largest at least
QUICKER = 0.6  # share of the samples of a size that is looked at, the quicker ones: delays only add


@dataclass(frozen=True, repr=False)
class Measured:
    """What a function cost by size, and what memory takes at each working set."""

    sizes: Array  # (k,)
    samples: list[Array]  # k times seconds per call
    working_sets: Array  # (k,) bytes of a call
    memory: Array  # (3, k) seconds, as `memory_times` tells them of each

    def __repr__(self) -> str:
        sizes = f"{len(self.sizes)} sizes from {self.sizes[0]:g} to {self.sizes[-1]:g}"
        least, most = (float(np.median(self.samples[k])) for k in (0, -1))
        return f"<Measured at {sizes}: {least:.2g} to {most:.2g} s a call>"

    def joined(self, other: "Measured") -> "Measured":
        """These sizes and others."""
        sizes = np.concatenate([self.sizes, other.sizes])
        order, samples = np.argsort(sizes), [*self.samples, *other.samples]
        working_sets = np.concatenate([self.working_sets, other.working_sets])
        memory = np.hstack([self.memory, other.memory])
        rows = [samples[k] for k in order]
        return Measured(sizes[order], rows, working_sets[order], memory[:, order])

    @property
    def names_one_class(self) -> bool:
        """Whether the costs by themselves tell a class, and no other."""
        answer = self.judge(resamples=2).answer
        return bool(answer) and " or " not in answer

    def judge(self, expected: str = "O(1)", **options: Any) -> Verdict:
        """Judge a claim by these costs; options as of `hem.complexity.judge`.

        The sizes that fit into the caches decide where they tell one class. Where they leave two,
        all sizes may rule out the one that grows faster, as waiting for memory only adds to it.
        With ``latency=None`` all sizes are judged as if nothing were known of the memory.
        """
        every = np.ones(len(self.sizes), bool)
        whole = self._judge(every, UNSEEN, expected, options)
        if options.get("latency", 0) is None:
            return whole
        costly = self._cost * COSTLY > self._cost.max()
        steep = bool(slope(self.sizes[costly], self._cost[costly]) > STEEP)
        parts = self._parts(costly if steep else None, expected, options)
        if not parts and not steep:
            whole = self._judge(every, BENT, expected, options)
        told = [it.answer.split(" or ") for it in parts]
        if parts and (min(map(len, told)) == 1 or whole.answer != told[0][0]):
            return min(parts, key=lambda it: it.answer.count(" or "))
        return whole if _names_a_class(whole) else replace(whole, answer="")

    def _parts(
        self, costly: NDArray[np.bool_] | None, expected: str, options: dict[str, Any]
    ) -> list[Verdict]:
        """What some of the sizes tell, the most telling ones first, where the others go on so.

        costly: sizes where a call works more than it waits, of a function that has such.
        """
        fits = self.memory[0] < CACHED * self.memory[0].min()
        room = 1 if fits.all() else 2  # what fills the caches is driven out by the rest
        alone = self.working_sets <= self.working_sets[fits].max() / room
        parts = [] if costly is None else [self._judge(costly, UNSEEN, expected, options)]
        some = (alone, UNSEEN_CACHED), (alone & (self.sizes > KEPT), UNSEEN_LARGE)
        parts += [
            self._judge(few, unseen, expected, options, cached=True)
            for few, unseen in some
            if np.count_nonzero(few) >= min(FEWEST_CACHED, len(few))
        ]
        return [it for it in parts if _names_a_class(it) and self._goes_on(it, fits)]

    @property
    def _cost(self) -> Array:
        return np.array([np.median(row) for row in self.samples])

    def _judge(
        self, of: NDArray[np.bool_], unseen: float, expected: str, options: dict[str, Any],
        cached: bool = False,
    ) -> Verdict:  # fmt: skip
        """Judge some sizes by their quicker samples."""
        given: dict[str, Any] = {"latency": self.memory[:, of], "latency_error": MEMORY_ERROR}
        if cached:
            given = {"latency": np.ones(of.sum()), "latency_error": CACHED_ERROR}
        if options.get("latency", 0) is not None:
            given["unseen"] = unseen
        rows = [row for row, asked in zip(self.samples, of, strict=True) if asked]
        quick = [np.sort(row)[: int(np.ceil(QUICKER * len(row)))] for row in rows]
        return judge(self.sizes[of], quick, expected, **given | options)

    def _goes_on(self, told: Verdict, cached: NDArray[np.bool_]) -> bool:
        """Whether larger sizes cost what smaller ones tell, and no more besides than the memory."""
        terms, rise = told.coefficients[told.best], self.memory[0] / self.memory[0].min()
        off = self._cost / (terms["fixed"] + terms["factor"] * parse(told.best)(self.sizes))
        return bool(np.all(cached | ((off > 1 / UNSEEN) & (off < UNSEEN + rise / 2))))


def _names_a_class(it: Verdict) -> bool:
    """Whether an answer is more than a power law that memory may have bent."""
    return bool(it.answer) and ("^" not in it.answer or it.raw_slope > STEEP)
