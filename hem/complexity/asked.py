"""Which of the sizes that were measured decide what is said of a claim.

Sizes that fit into the caches tell of work alone; so do those where a call works for longer than it
could wait. The others wait for memory, in ways that no loop beside them shows exactly: of them it
is asked only that they go on as those tell. Where a steep cost does not, the largest sizes decide,
if they tell one class closely.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.complexity.estimates import slope
from hem.complexity.judge import MIN_SIZES, Verdict, judge
from hem.complexity.notation import Array, parse

MEMORY_ERROR = 0.05  # relative error of what memory did to a call, beside what was measured …
UNSEEN = 2.0  # … and the slowdown that allocators and caches cause beside it, over the sizes …
BENT = 4.0  # … or this, where sizes in the caches do not tell that there is less
UNSEEN_CACHED = 1.15  # the same for sizes in the caches, as a first one is quicker than a second …
UNSEEN_COSTLY = 1.3  # … and for sizes where a call works longer than it waits
CACHED = 2.0  # factor by which an access takes longer than at the smallest size, in the caches …
NEAR_CACHED = 1.2  # … and in the first ones …
NEARLY = 1.05  # … or the very first
FEWEST = 6  # sizes that may decide for all
KEPT = 256  # the largest of the integers that Python keeps: larger ones are read from memory …
FREE = (-KEPT / 2, -KEPT)  # … so that a call may cost as if there were so many fewer
FAR = 1_000  # from here on what is done beside a call's work no longer bends its cost
LESS = 0.8  # part of what a class tells that a larger size costs at least
CLOSE = 0.015  # relative error that a class may have to be told without reserve …
QUITE_CLOSE = 0.04  # … and by the largest sizes alone
REACH = 16  # of the largest size to the smallest that tells the same: there lower terms fade
BEHIND = 0.25  # of a slope: by so much a class may fall behind what works more than it waits
READS = 8  # so many times as long as reading its working set takes what does more than that
WORD = 8  # bytes that a call reads at once: it may wait for each, but no longer
STEEP = 1.5  # slope from which on a call works more than it waits …
LESS_STEEP, TIMES = 1.3, 10  # … or this, where it takes so many times as long as it could wait
ASTRAY = 0.4  # of a slope: by so much a class may fall behind at the largest sizes
OVERLAP = 2  # factor by which a lookup in a cache is quicker than a step there: hits overlap
LOWER_TERMS = 9  # tried where a call works more than it waits
QUICKER = 0.6  # share of the samples of a size that is looked at, the quicker ones: delays only add
CONSTANT, IN_PROPORTION = ["O(1)"], parse("O(n)")
Sizes = NDArray[np.bool_]


@dataclass(frozen=True, repr=False)
class Sampled:
    """What a function cost by size, and what memory takes at each working set."""

    sizes: Array  # (k,)
    samples: list[Array]  # k times seconds per call
    working_sets: Array  # (k,) bytes of a call
    memory: Array  # (3, k) seconds, as `memory_times` tells them of each
    amortized: bool = False  # whether costs are those of one of the n operations of a call

    @property
    def cost(self) -> Array:
        """(k,) seconds of a call: the median of its samples."""
        return np.array([np.median(row) for row in self.samples])


@dataclass(frozen=True)
class Asked:
    """A claim that parts of what was measured are judged by; each the quicker of its samples."""

    of: Sampled
    expected: str
    options: dict[str, Any]

    @property
    def _fits(self) -> Sizes:
        """(k,) whether what a call works on is in the caches."""
        return self._slower < CACHED

    @property
    def _slower(self) -> Array:
        """(k,) times as long as at the smallest size that an access takes."""
        return self.of.memory[0] / self.of.memory[0].min()

    def _works(self, some: Sizes) -> bool:
        """Whether a call of some of the sizes does much more than to read what it works on."""
        return bool(np.median((self.of.cost / self._bytes / self.of.memory[1])[some]) > READS)

    @property
    def steep(self) -> float:
        """The slope from which on the larger half of the sizes tells of work."""
        larger = slice(len(self.of.sizes) // 2, None)
        works = np.all(self.of.cost[larger] > TIMES * self._waiting[larger])
        return LESS_STEEP if works else STEEP

    @property
    def _bytes(self) -> Array:
        """(k,) what a call works on, or one of its operations."""
        return self.of.working_sets / (self.of.sizes if self.of.amortized else 1)

    @property
    def _waiting(self) -> Array:
        """(k,) seconds that what costs are of waits if it waits for each word that it works on."""
        return self._bytes / WORD * self.of.memory[0]

    def told(self) -> Verdict:
        """What is told by the sizes that decide."""
        told = self.by_work() or self.without_reserve() or self.with_reserve()
        told = _agreeing(told if _names_a_class(told, self.steep) else replace(told, classes=[]))
        if self.bends_up(told):
            told = _open_upward(told)
        return _untold(told if told.classes else self.at_the_top() or told)

    def whole(self, unseen: float = UNSEEN) -> Verdict:
        """What all sizes tell."""
        return self._judge(np.ones(len(self.of.sizes), bool), unseen)

    def by_work(self) -> Verdict | None:
        """What sizes tell where a call takes longer than waiting for all that it reads would.

        Costs that grow still faster there than the class which explains them best are of none.
        """
        of = self.of
        costly = of.cost > self._waiting
        large = costly & (of.sizes * REACH >= np.max(of.sizes, where=costly, initial=0))
        if np.count_nonzero(large) < FEWEST:
            return None
        sizes, half = of.sizes[large], np.count_nonzero(large) // 2
        if slope(sizes[half:], of.cost[large][half:]) <= self.steep:
            return None
        plain = [self._judge(some, UNSEEN_COSTLY) for some in (costly, large)]
        if law := next(filter(_is_a_law, reversed(plain)), None):
            return law
        lower = np.geomspace(sizes[0], sizes[-1], LOWER_TERMS)
        told = self._judge(large, UNSEEN_COSTLY, lower=lower)
        if _names_one(plain[1]) and _names_one(told):
            told = replace(told, classes=_either(plain[1], told))
        last = sizes >= sizes[-max(3, len(sizes) // 3)]
        least = told.predicted(told.best, sizes)[last]
        if told.classes and slope(sizes[last], of.cost[large][last] / least) > BEHIND:
            return replace(told, classes=[])
        return self._if_so(told, of.sizes < sizes[0])

    def without_reserve(self) -> Verdict | None:
        """What sizes in the caches tell that one class explains closely, as if nothing bent it."""
        for beyond, lower in ((KEPT, FREE), (FAR, ())):
            told = self._in_caches(beyond, 0, lower)
            if told and _names_one(told) and told.errors[told.best] < CLOSE:
                return told
        return None

    def bends_up(self, told: Verdict) -> bool:
        """Whether the largest sizes, in the caches or of all, cost more and more beside a class.

        Where some are in no cache these tell of a constant.
        """
        constant = told.classes == CONSTANT and not self._fits.all()
        if not told.classes or _is_a_law(told) or constant:
            return False
        least = told.predicted(told.best, self.of.sizes)
        return self._bends_up_in_caches(least) or self._bends_up_beyond(least)

    def _bends_up_in_caches(self, least: Array) -> bool:
        """What reads along may, as it leaves the first cache: as much as its bytes take longer."""
        of, access = self.of, self._slower
        byte, works = of.cost / self._bytes, self._works(self._fits)
        fits = np.flatnonzero(access < (NEAR_CACHED if works else CACHED))
        last = fits[-max(MIN_SIZES, len(fits) // 4) :]
        if len(last) < MIN_SIZES:
            return False
        sizes, excess = of.sizes[last], (of.cost / least)[last]
        beyond = float(np.median(np.diff(np.log(excess)) / np.diff(np.log(sizes))))
        longer = max(float(slope(sizes, byte[last])), 0.0) + float(slope(sizes, access[last]))
        return beyond - (0 if works else longer) > BEHIND

    def _bends_up_beyond(self, least: Array) -> bool:
        """What is steep, and works much on what it reads, costs at any size as its class tells."""
        last, sizes = self._last(3), self.of.sizes
        steep = self._works(last) and slope(sizes[last], least[last]) > STEEP
        return bool(steep and slope(sizes[last], (self.of.cost / least)[last]) > ASTRAY)

    def at_the_top(self) -> Verdict | None:
        """What the largest third and the largest half of the sizes both tell of a steep cost."""
        of, parts, told = self.of, (self._last(3), self._last(2)), []
        steep = slope(of.sizes[parts[0]], of.cost[parts[0]]) > STEEP and self._works(parts[0])
        if not steep or np.array_equal(*parts):
            return None
        for part in parts:
            sizes = of.sizes[part]
            lower = np.geomspace(sizes[0], sizes[-1], LOWER_TERMS)
            told.append(self._judge(part, UNSEEN_CACHED, lower=lower))
        same = _names_one(told[0]) and told[0].classes == told[1].classes
        return told[0] if same and told[0].errors[told[0].best] < QUITE_CLOSE else None

    def _last(self, share: int) -> Sizes:
        """The largest of the sizes, a third of them or another share."""
        n = len(self.of.sizes)
        return np.arange(n) >= n - max(MIN_SIZES, n // share)

    def with_reserve(self) -> Verdict:
        """What they tell where caches and allocators may have bent the costs a little, or all do.

        Where no part tells anything, growth that the memory alone may cause is of no class. Where
        all sizes tell another class than a part, both may be: only of O(1) the memory makes others.
        """
        parts, cost, memory = self._told_in_caches, self.of.cost, self.of.memory[0]
        whole = self.whole(UNSEEN if parts else BENT)
        told, goes_on = _combined(parts, whole), self._goes_on(whole)
        if told is not whole:
            return _beside(told, whole) if goes_on else told
        alone = not parts and whole.classes != CONSTANT
        hits = OVERLAP if parse(whole.best) < IN_PROPORTION else 1
        bent = alone and cost[-1] / cost[0] < hits * memory.max() / memory.min()
        if bent and whole.outcome != "undetermined":
            reason = "The costs grow by no more than the memory alone may cause."
            return replace(whole, classes=[], outcome="undetermined", reason=reason)
        return whole if goes_on and not bent else replace(whole, classes=[])

    @property
    def is_sublinear(self) -> bool:
        """Whether sizes in the caches tell that costs may grow by less than in proportion."""
        return any(
            parse(name) < IN_PROPORTION for it in self._told_in_caches for name in it.classes
        )

    @cached_property
    def _told_in_caches(self) -> list[Verdict]:
        """What sizes in the caches tell, of those that a small integer may bend and of all."""
        sizes = self.of.sizes
        bent = sizes[0] < KEPT < np.quantile(sizes, 3 / 4) and sizes[-1] < REACH * KEPT
        every = 0, UNSEEN if bent else UNSEEN_CACHED
        found = (self._in_caches(*it) for it in ((KEPT, UNSEEN_CACHED, FREE), every))
        told, last = [it for it in found if it], self._last(6)
        if told or slope(sizes[last], self.of.cost[last]) > ASTRAY:
            return told
        first = self._in_caches(*every, fits=self._slower < NEARLY)
        return [first] if first else []

    def _in_caches(
        self, beyond: float, unseen: float, lower: ArrayLike = (), fits: Sizes | None = None
    ) -> Verdict | None:
        """What those of the sizes in the caches tell that are larger than one."""
        fits, sets = self._fits if fits is None else fits, self.of.working_sets
        room = 1 if fits.all() else 2  # what fills the caches is driven out by the rest
        few = (sets <= sets[fits].max() / room) & (self.of.sizes > beyond)
        if np.count_nonzero(few) < min(FEWEST, len(few)):
            return None
        return self._if_so(self._judge(few, unseen, cached=True, lower=lower), fits)

    def _if_so(self, told: Verdict, excused: Sizes | bool = False) -> Verdict | None:
        """A verdict that names a class which all sizes go on as."""
        return told if _names_a_class(told, self.steep) and self._goes_on(told, excused) else None

    def _judge(
        self, sizes: Sizes, unseen: float, cached: bool = False, lower: ArrayLike = ()
    ) -> Verdict:
        """Judge some of the sizes, by what the memory was measured to do there."""
        memory = self.of.memory[0, sizes] if cached else self.of.memory[:, sizes]
        given: dict[str, Any] = {"latency": memory, "latency_error": MEMORY_ERROR, "lower": lower}
        if self.options.get("latency", 0) is not None:
            given["unseen"] = unseen
        rows = [row for row, asked in zip(self.of.samples, sizes, strict=True) if asked]
        share = 1 if self.options.get("exact") else QUICKER
        quick = [np.sort(row)[: int(np.ceil(share * len(row)))] for row in rows]
        return judge(self.of.sizes[sizes], quick, self.expected, **given | self.options)

    def _goes_on(self, told: Verdict, excused: Sizes | bool = False) -> bool:
        """Whether the larger sizes cost what a class tells, and no more besides than the memory.

        What they cost more is no larger than the memory's slowdown, nor longer than waiting for all
        that a call reads.
        """
        of, memory = self.of, self.of.memory
        slowdown = (memory / memory.min(axis=1, keepdims=True)).max(axis=0)
        least = told.predicted(told.best, of.sizes)
        overlap = OVERLAP if told.classes == CONSTANT else 1
        most = np.minimum((UNSEEN + 2 * overlap * slowdown) * least, least / LESS + self._waiting)
        kept = (of.cost > LESS * least) & (of.cost < most)
        small = np.arange(len(kept)) < len(kept) // 2
        return bool(np.all(kept | small | excused)) and not self._leaves(told, least)

    def _leaves(self, told: Verdict, least: Array) -> bool:
        """Whether at the very largest sizes a sublinear cost grows by more than the memory there.

        What is hidden beside a constant shows there first, from size to size, and however slow
        memory had become before is no excuse. A jump is none of that.
        """
        last, of = self._last(6), self.of
        sizes, memory = of.sizes[last], of.memory[:, last]
        beyond = (of.cost / least)[last] / memory[slope(sizes, memory).argmax()]
        steps = np.diff(np.log(beyond)) / np.diff(np.log(sizes))
        grows = min(float(slope(sizes, beyond)), float(np.median(steps)))
        return parse(told.best) < IN_PROPORTION and grows > ASTRAY


def _combined(parts: Sequence[Verdict], whole: Verdict) -> Verdict:
    """Of what parts of the sizes tell and what all do, the most telling that none contradicts."""
    if not parts or not set.intersection(*(set(it.classes) for it in parts)):
        return whole
    shortest = min(parts, key=lambda it: len(it.classes))
    slower, *others = shortest.classes
    return whole if others and whole.classes == [slower] else shortest


def _beside(told: Verdict, whole: Verdict) -> Verdict:
    """What a part tells, or both classes where all sizes tell another."""
    both = _either(told, whole)
    if told.classes == CONSTANT or not whole.classes or {*told.classes} & {*whole.classes}:
        return told
    return replace(told, classes=both if len(both) == 2 else [])


def _agreeing(it: Verdict) -> Verdict:
    """A verdict whose outcome is undetermined where its answer says otherwise."""
    named = it.expected in it.classes
    told = it.classes and not _is_a_law(it) and it.bound == "tight"
    if (named and it.outcome == "violated") or (told and not named and it.outcome == "consistent"):
        reason = f"Some of the sizes tell {it.answer}."
        return replace(it, outcome="undetermined", reason=reason)
    return it


def _untold(it: Verdict) -> Verdict:
    """A verdict that confirms no claim where no class is told, nor accuses it by a slower one."""
    accused = it.outcome == "violated" and parse(it.best) < parse(it.expected)
    confirmed = it.outcome == "consistent" and it.bound != "upper"
    if it.classes or not (accused or confirmed):
        return it
    reason = f"{it.best} comes closest, but larger sizes do not go on as it does."
    return replace(it, outcome="undetermined", reason=reason)


def _open_upward(it: Verdict) -> Verdict:
    """A verdict that names no class, and lets every claim of as fast a growth, or faster, stand."""
    it = replace(it, classes=[])
    if parse(it.expected) < parse(it.best):
        return it
    reason = f"The largest sizes grow still faster than {it.best}, which fits best."
    return replace(it, outcome="undetermined", reason=reason)


def _either(one: Verdict, other: Verdict) -> list[str]:
    return sorted({*one.classes, *other.classes}, key=parse)


def _names_one(it: Verdict) -> bool:
    return len(it.classes) == 1


def _is_a_law(it: Verdict) -> bool:
    """Whether it tells a power law, or that costs are exponential."""
    return any("^" in name for name in it.classes)


def _names_a_class(it: Verdict, steep: float) -> bool:
    """Whether an answer is more than a power law that memory may have bent, and nobody claimed."""
    plain = not _is_a_law(it) or it.expected in it.classes
    return bool(it.classes) and (plain or it.raw_slope > steep)
