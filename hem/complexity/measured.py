"""What a function was measured to cost, and what is said of it."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hem.complexity.asked import Asked, Sampled
from hem.complexity.in_parts import InParts
from hem.complexity.judge import Verdict
from hem.complexity.notation import parse

WIDE = 64  # of the largest size to the smallest: over less, a constant may hide what grows


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
