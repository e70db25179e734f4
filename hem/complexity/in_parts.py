"""Calls beside calls on many small inputs: what is linear takes as long for these."""

from dataclasses import dataclass, replace

import numpy as np

from hem.complexity.asked import KEPT, REACH
from hem.complexity.judge import Outcome, Verdict
from hem.complexity.notation import Array, parse

FLAT, QUITE_FLAT = 0.2, 0.1  # powers of log n by which linear costs rise beside small inputs …
RISING, EVENLY = 0.6, 0.075  # … and others do, straying so little …
LOG, CLOSELY = 0.33, 0.025  # … or so little that it is no cache's doing
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
    def is_settled(self) -> bool:
        """Whether they tell that costs are linear."""
        return self.logs()[0] < FLAT or self.levels_off

    def hold(self, told: Verdict) -> Verdict:
        """What is told, held to what small inputs take that are as much together.

        They take the same memory, so that only the work can differ. What does not grow beside them
        is linear. What does may be slower at random access, or of O(n log n): where it grows
        evenly, linear costs are not certain, and where both are open no cache grows so evenly:
        but more and more integers that Python does not keep do.
        """
        power, stray = self.logs()
        if stray > UNEVEN:
            return told
        flat = QUITE_FLAT if told.classes == LOGLINEAR else FLAT
        bent = self.sizes[0] < 2 * KEPT < 2 * self.sizes[-1] < 2 * REACH * KEPT
        as_log = power > LOG and stray < CLOSELY and not bent
        evenly = as_log or (power > RISING and stray < EVENLY)
        few = told.classes == LOGLINEAR and len(self.sizes) < 2 * HALF
        is_flat = power < flat or self.levels_off
        if is_flat:
            classes = EITHER if few else LINEAR
        elif told.classes == LINEAR and evenly:
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
