"""What a function was measured to cost, and what is said of it.

Beside calls on many small inputs, too, that are as much together: what is linear takes as long for
these.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hem.complexity.asked import KEPT, REACH, Asked, Sampled
from hem.complexity.judge import Outcome, Verdict
from hem.complexity.notation import Array, parse

WIDE = 64  # of the largest size to the smallest: over less, a constant may hide what grows
FLAT, QUITE_FLAT = 0.2, 0.1  # powers of log n by which linear costs rise beside small inputs …
EVENLY = 12  # … and others do, so many times as much as they stray …
LOG, CLOSELY = 0.33, 0.025  # … or by so much, straying so little that it is no cache's doing …
STEEPER = 1.5  # … or by more than log n does
UNEVEN = 0.5  # relative scatter of costs beside small inputs from which on they tell nothing
HALF = 4  # sizes, at least, that may tell alone that a rise has ended
LINEAR, LOGLINEAR = ["O(n)"], ["O(n log n)"]
EITHER = LINEAR + LOGLINEAR
KEEPS: dict[bool, Outcome] = {True: "consistent", False: "violated"}


@dataclass(frozen=True)
class InParts:
    """What calls take, beside calls on small inputs that are as much together."""

    sizes: Array  # (j,)
    ratios: list[Array]  # j times how often a call takes as long as the others together

    def logs(self, first: int = 0) -> tuple[float, float]:
        """The power of log n by which the ratios rise, and how far they stray from that.

        The power is the median of what all pairs of sizes tell: one that was disturbed says little.
        """
        rows = self.ratios[first:]
        x, y = np.log(np.log(self.sizes[first:])), np.log([np.median(row) for row in rows])
        one, other = np.triu_indices(len(x), 1)
        power = np.median((y[other] - y[one]) / (x[other] - x[one]))
        return float(power), float(np.std(y - power * x))

    @property
    def levels_off(self) -> bool:
        """Whether they rise, but those of the larger half no more; of few sizes it is not said.

        What costs more from some size on, as it has left a cache or as no processor can know it by
        heart, does so; log n goes on.
        """
        half = len(self.sizes) // 2
        return half >= HALF and self.logs(half)[0] < FLAT <= self.logs()[0]

    @property
    def rises(self) -> bool:
        """Whether they rise, however slowly, and more evenly than a linear cost ever does."""
        power, stray = self.logs()
        return power > max(QUITE_FLAT, EVENLY * stray) and not self.levels_off

    @property
    def is_settled(self) -> bool:
        """Whether they tell that costs are linear."""
        return (self.logs()[0] < FLAT and not self.rises) or self.levels_off

    def hold(self, told: Verdict) -> Verdict:
        """What is told, held to what small inputs take that are as much together.

        They take the same memory, so that only the work can differ. What does not grow beside them
        is linear. What does may be slower at random access, or of O(n log n): where it grows
        evenly, however slowly, linear costs are not certain, and where both are open no cache
        grows so evenly: but more and more integers that Python does not keep do.
        """
        power, stray = self.logs()
        if stray > UNEVEN:
            return told
        flat = QUITE_FLAT if told.classes == LOGLINEAR else FLAT
        bent = self.sizes[0] < 2 * KEPT < 2 * self.sizes[-1] < 2 * REACH * KEPT
        as_log = power > LOG and stray < CLOSELY and not bent
        few = told.classes == LOGLINEAR and len(self.sizes) < 2 * HALF
        is_flat = (power < flat and not self.rises) or self.levels_off
        if is_flat:
            classes = EITHER if few else LINEAR
        elif power > STEEPER and self.rises and told.classes == LOGLINEAR:
            reason = "Small inputs, as much together, take ever less: by more than log n."
            return replace(told, classes=[], outcome="undetermined", reason=reason)
        elif told.classes == LINEAR and self.rises:
            classes = EITHER
        elif told.classes == EITHER and as_log:
            classes = LOGLINEAR
        else:
            return told
        upper, claim = told.bound == "upper", parse(told.expected)
        kept = {claim == it or (upper and claim > it) for it in map(parse, classes)}
        outcome: Outcome = "undetermined" if len(kept) > 1 else KEEPS[kept.pop()]
        grows = "in proportion" if is_flat else "less"
        reason = f"Small inputs, as much together, take {grows}: {' or '.join(classes)}."
        return replace(told, classes=classes, best=classes[0], outcome=outcome, reason=reason)


@dataclass(frozen=True, repr=False)
class Measured(Sampled):
    """What a function cost by size, beside small inputs too where that was asked for."""

    in_parts: InParts | None = None

    def __repr__(self) -> str:
        sizes = f"{len(self.sizes)} sizes from {self.sizes[0]:g} to {self.sizes[-1]:g}"
        least, most = (float(np.median(self.samples[k])) for k in (0, -1))
        return f"<Measured at {sizes}: {least:.2g} to {most:.2g} s a call>"

    def joined(self, other: "Measured") -> "Measured":
        """These sizes and others, whose costs are brought to one level with these.

        A machine is quicker at one time than at another, by as much at every size.
        """
        between = np.interp(np.log(other.sizes), np.log(self.sizes), np.log(self.cost))
        level = np.exp(np.median(np.log(other.cost) - between))
        order = np.argsort([*self.sizes, *other.sizes])
        samples = [*self.samples, *(row / level for row in other.samples)]
        both: dict[str, Any] = {
            name: np.hstack([getattr(self, name), getattr(other, name)])[..., order]
            for name in ("sizes", "working_sets", "memory")
        }
        return replace(self, samples=[samples[k] for k in order], **both)

    @property
    def is_settled(self) -> bool:
        """Whether some costs tell one class so closely that no further sizes are needed."""
        if self.in_parts:
            return self.in_parts.is_settled
        asked = Asked(self, "O(1)", {"resamples": 2})
        told = asked.by_work() or asked.without_reserve()
        return told is not None and len(told.classes) == 1

    def judge(self, expected: str = "O(1)", **options: Any) -> Verdict:
        """Judge a claim by these costs; options as of `hem.complexity.judge`.

        What tells of work alone decides where it tells one class. Where it leaves two, all sizes
        may rule out the one that grows faster, as waiting for memory only adds to it. Where the
        largest rise beside what is told, they decide, or nothing does. With ``latency=None`` all
        sizes are judged as if nothing were known of the memory, and so they are by a latency or a
        reference of one's own, and where costs are ``exact``. Over a short range nothing violates
        a claim of faster growth.
        """
        if options.get("exact") or options.get("reference") is not None:
            options = {"latency": None} | options
        asked = Asked(self, expected, options)
        if "latency" in options:
            return self._unhidden(asked.whole())
        told = asked.told()
        if self.in_parts and not asked.is_sublinear:
            told = self.in_parts.hold(told)
        return self._unhidden(told)

    def _unhidden(self, it: Verdict) -> Verdict:
        """A verdict that accuses no claim of a growth which a constant may hide at these sizes."""
        accused = it.outcome == "violated" and parse(it.best) < parse(it.expected)
        if not accused or self.sizes[-1] >= WIDE * self.sizes[0]:
            return it
        hidden = f"a constant may still hide {it.expected}: a larger budget reaches further"
        reason = f"The sizes reach only n = {self.sizes[-1]:g}, where {hidden}."
        return replace(it, outcome="undetermined", reason=reason)
