"""Growth models held against one another, with what caches may have done to the costs.

Models are compared by the evidence of one, f, against another, g,

    (p + d) · ln((p + χ²(g)) / (p + χ²(f))),

the log-likelihood ratio for an error that the samples tell to p degrees of freedom, and the
residuals to d; where the fits are good it is about χ²(g) less χ²(f). The simplest model is the
best that explains the costs about as well as the closest one does.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hem.complexity import models as growth_models
from hem.complexity.estimates import Costs, slope
from hem.complexity.models import NAMES, DesignMatrix, Fit, Slowdowns, design, fit, predict
from hem.complexity.notation import Array

LATENCY_ERROR = 0.03  # relative error of a measured latency, unless a caller knows better
PRIOR = 10.0  # degrees of freedom p to which the samples tell the error
AGAINST_SIMPLER = 6.5  # evidence that rules out a model in favor of a more complex one
AGAINST_COMPLEX = 1.5  # evidence that rules out a more complex rival of a claim …
AGAINST_COMPLEX_CLAIM = 4.0  # … and a claim more complex than what explains the costs: it accuses …
NO_BETTER = 2.0  # … provided that the simpler one explains them worse by less evidence than this
GROWTH = 1.3  # factor by which a model must grow, intercept included, to be told from O(1) …
CLEAR_GROWTH = 2.1  # … and by which it would have to grow to be rejected in favor of a simpler one
ACCUSING_GROWTH = 2.0
"""Factor by which times must grow over the sizes to violate a claim of slower growth: cells of the
same code were measured to differ by 1.8 where neighbors share the caches."""
HIGHEST_SLOWDOWN = 12.0  # slowdown over the sizes that unmeasured caches are reckoned with
MISFIT = 2.5  # χ² per degree of freedom with which a model explains times without a latency …
MISFIT_EXPLAINED = 12.0  # … and with it, or exact counts: what is left is small print
MOST_WOBBLE = 0.1  # relative error up to which times may stray from a model that explains them else
NEAR = 0.25  # share of a class's slope that it must have, as fitted, at the largest sizes …
UNLIKE = 0.3  # … where it may differ by so much from the slope of the costs; where that is more
# than one, by that share of it


@dataclass(frozen=True)
class Memory:
    """What caches may have done to costs."""

    slowdowns: Slowdowns  # what the measured latency, or its absence, allows
    unmeasured: Slowdowns | None  # what is possible besides, unmeasured: it violates nothing
    latency_known: bool  # whether nothing unmeasured casts doubt on what is confirmed
    exact: bool  # the costs are counts of work


def account_for_memory(
    costs: Costs, exact: bool, latency_error: float, allow_unmeasured: float, entire: bool
) -> tuple[Costs, Memory]:
    """The costs, with the latency's error added to theirs, and what caches may have done to them.

    exact: they are counts of work, which no cache slows. Times without a latency may have slowed
    smoothly and unseen; with ``allow_unmeasured`` those beside a latency, too: by so much at most,
    where it is more than 1, and then nothing is confirmed in spite of it either. ``entire``: the
    latency is of a loop that waits as the costs do, so that they rise as much as it does.
    """
    if exact and costs.latency is not None:
        raise ValueError("exact counts wait for no memory: give either latency or exact")
    nothing = growth_models.entire_slowdown(np.ones(len(costs.sizes)))
    if exact:
        return costs, Memory(nothing, None, True, exact)
    limited = allow_unmeasured > 1
    highest = allow_unmeasured if limited else HIGHEST_SLOWDOWN
    unseen = growth_models.unknown_slowdowns(costs.sizes, highest)
    if costs.latency is None:
        return costs, Memory(nothing, unseen, False, exact)
    slow = growth_models.entire_slowdown if entire else growth_models.measured_slowdowns
    beside = unseen if allow_unmeasured else None
    memory = Memory(slow(costs.latency), beside, not limited, exact)
    return replace(costs, error=np.sqrt(costs.error**2 + latency_error**2)), memory


@dataclass(frozen=True)
class Comparison:
    """All models fitted to the same costs. Models go by their indices in `names`.

    What decides for a model f against another, g, is the evidence of chi2[f] against a χ² of g:

    ============  ===============================  =========================================
    ..            g simpler than f                 g more complex than f, and fits no better
    ============  ===============================  =========================================
    f is claimed  chi2                             chi2_at_clear_growth
    g is claimed  chi2_if_slowed, and f must grow  chi2_at_clear_growth_if_slowed
    ============  ===============================  =========================================
    """

    costs: Costs
    memory: Memory
    weight: Array
    design: DesignMatrix
    fit: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """The models, slowest growth first."""
        return self.design.names

    @cached_property
    def predicted(self) -> tuple[Array, Array]:
        """(m, k) each: the costs that the models predict, and those with memory at its fastest."""
        return predict(self.design, self.fit)

    @property
    def errors(self) -> Array:
        """(m,) root mean square of the relative residuals of each model."""
        return np.sqrt(np.mean((self.predicted[0] / self.costs.cost - 1) ** 2, axis=1))

    @property
    def chi2(self) -> Array:
        """(m,) misfit of each model with the slowdowns that are known of."""
        return self.fit.chi2

    @cached_property
    def chi2_if_slowed(self) -> Array:
        """(m,) that, or with unmeasured slowdowns, whichever fits better."""
        return np.minimum(self.chi2, self._misfit(self.memory.unmeasured, GROWTH))

    @cached_property
    def chi2_at_clear_growth(self) -> Array:
        """(m,) misfit of each model that grows clearly over the sizes."""
        return self._misfit(self.memory.slowdowns, CLEAR_GROWTH)

    @cached_property
    def chi2_at_clear_growth_if_slowed(self) -> Array:
        """(m,) that, or with unmeasured slowdowns, whichever fits better."""
        unmeasured = self._misfit(self.memory.unmeasured, CLEAR_GROWTH)
        return np.minimum(self.chi2_at_clear_growth, unmeasured)

    def _misfit(self, slowdowns: Slowdowns | None, growth: float) -> Array:
        if slowdowns is None:
            return np.full(len(self.names), np.inf)
        models = design(self.costs.sizes, slowdowns, growth, self.names, self.design.lower[1:])
        return fit(models, self.costs.cost, self.weight).chi2

    @property
    def freedom(self) -> int:
        """Degrees of freedom of the residuals: a model has an intercept, a factor, and a slowdown
        where there are several.
        """
        parameters = 2 + (len(self.memory.slowdowns.scaling) > 1)
        return max(int(np.count_nonzero(self.weight)) - parameters, 1)

    @property
    def explained(self) -> bool:
        """Whether the best model explains the costs, and those of the largest sizes are of it."""
        return self.fits and (self.memory.exact or self._near(self.best))

    @property
    def fits(self) -> bool:
        """Whether the costs stray from the best model no more than they may."""
        told = self.memory.exact or self.costs.latency is not None
        most = MISFIT_EXPLAINED if told else MISFIT
        return bool(self.chi2[self.best] <= most * self.freedom)

    @cached_property
    def best(self) -> int:
        """The simplest model that explains the costs about as well as the closest one."""
        closest = self.chi2.min()
        level = (self.evidence(closest, chi2) < NO_BETTER for chi2 in self.chi2)
        return list(level).index(True)

    def without_each(self) -> Iterator["Comparison"]:
        """The models fitted to all sizes but one, by its place."""
        weights = np.where(np.eye(len(self.weight), dtype=bool), 0, self.weight)
        for weight, *row in zip(weights, *fit(self.design, self.costs.cost, weights), strict=True):
            yield replace(self, weight=weight, fit=Fit(*row))

    def steady(self, costs: Array) -> Array:
        """Costs (..., k) with the memory's part, as the best model sees it in each row, removed."""
        best = self.design.only(self.best)
        slowed, fast = predict(best, fit(best, costs, self.weight))
        return costs * (fast / slowed)[..., 0, :]

    def evidence(self, better: float, worse: float) -> float:
        """Evidence of a model with misfit `better` against one with misfit `worse`."""
        return float((PRIOR + self.freedom) * np.log((PRIOR + worse) / (PRIOR + better)))

    def confirms(self, claimed: int, rival: int) -> bool:
        """Whether a claim beats a rival that no unmeasured caches make better than the claim."""
        own, known = self.chi2[claimed], self.memory.latency_known
        if rival < claimed:
            ruled_out = self.evidence(own, self.chi2[rival]) >= AGAINST_SIMPLER
            return ruled_out and (known or self.chi2_if_slowed[rival] >= own)
        ruled_out = self.evidence(own, self.chi2_at_clear_growth[rival]) >= AGAINST_COMPLEX
        unbent = known or self.chi2_at_clear_growth_if_slowed[rival] >= own
        return ruled_out and unbent and self.evidence(self.chi2[rival], own) < NO_BETTER

    def refutes(self, favored: int, claimed: int) -> bool:
        """Whether a model rules out a claim, even one that unmeasured caches may have bent."""
        own = self.chi2[favored]
        if claimed < favored:
            ruled_out = self.evidence(own, self.chi2_if_slowed[claimed]) >= AGAINST_SIMPLER
            steady = self.predicted[1][favored]
            enough = 1.0 if self.memory.exact else ACCUSING_GROWTH
            return ruled_out and bool(steady.max() >= enough * steady.min())
        clear = self.chi2_at_clear_growth_if_slowed[claimed]
        ruled_out = self.evidence(own, clear) >= AGAINST_COMPLEX_CLAIM
        return ruled_out and self.evidence(self.chi2[claimed], own) < NO_BETTER

    def outgrows(self, claimed: int) -> bool:
        """Whether times grow more than a claim could by any slowdown, whichever size is left out.

        What violates a claim like that needs no class that explains the costs. The largest sizes
        have to grow more, too: a single step between them, such as of a stack that outgrows a
        cache, is no growth.
        """
        slow = self.memory.slowdowns.scaling
        if self.memory.unmeasured is not None:
            slow = np.vstack([slow, self.memory.unmeasured.scaling])
        f, cost = self.design.growth[claimed, 0], self.costs.cost
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            grown = np.where(f > 1e-300, f[:, None] / f, np.inf)  # steep growth may leave no digits
        excused = (slow[:, :, None] / slow[:, None, :]).max(0) * grown
        beyond = np.tril(cost[:, None] / cost > ACCUSING_GROWTH * excused)
        pairs = np.argwhere(beyond)
        rising = np.all(cost[1:] > (1 - MOST_WOBBLE) * cost[:-1])  # noise alone is not
        without = (np.any((pairs != size).all(axis=1)) for size in range(len(cost)))
        last = slice(-max(3, len(cost) // 3), None)
        told, own = (
            slope(self.costs.sizes[last], np.maximum(it[last], 1e-300)) for it in (cost, f)
        )
        return bool(rising and told - own > UNLIKE) and not self.memory.exact and all(without)

    def _near(self, model: int) -> bool:
        """Whether a model, as fitted, comes near its own slope at the largest sizes, and theirs.

        Beside a large intercept a steep class explains a last size that rose for another reason.
        """
        last = slice(-max(3, len(self.costs.sizes) // 3), None)
        slowed, steady = (it[model, last] for it in self.predicted)
        sizes = self.costs.sizes[last]
        growth = self.design.growth[model, self.fit.lower[model], last]
        own, told = slope(sizes, np.maximum(growth, 1e-300)), slope(sizes, self.costs.cost[last])
        like = abs(slope(sizes, slowed) - told) <= UNLIKE * np.maximum(1, told)
        return bool(like and slope(sizes, steady) >= NEAR * own - 1e-9)


def compare_models(
    costs: Costs, memory: Memory, names: Sequence[str] = NAMES, lower: Array | None = None
) -> Comparison:
    """Fit models to the costs, under every slowdown that may have happened, beside lower terms.

    Times that stray from all of them, but evenly and little, are fitted again with what they stray
    as their error: sizes differ by more than their samples tell, and a class may still stand out.
    """
    models = design(costs.sizes, memory.slowdowns, GROWTH, names, lower)
    weight = 1 / (costs.cost * costs.error)
    found = Comparison(costs, memory, weight, models, fit(models, costs.cost, weight))
    stray = np.sqrt(found.chi2[found.best] / found.freedom)
    if memory.exact or found.fits or stray * np.median(costs.error) > MOST_WOBBLE:
        return found
    strayed, weight = replace(costs, error=stray * costs.error), weight / stray
    return Comparison(strayed, memory, weight, models, fit(models, costs.cost, weight))
