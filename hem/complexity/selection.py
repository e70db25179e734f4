"""Growth models held against one another, with what caches may have done to the costs.

Models are compared by the evidence of one, f, against another, g,

    (p + d) · ln((p + χ²(g)) / (p + χ²(f))),

the log-likelihood ratio for an error that the samples tell to p degrees of freedom, and the
residuals to d; where the fits are good it is about χ²(g) less χ²(f). The simplest model is the
best that explains the costs about as well as the closest one does.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity.estimates import Costs
from hem.complexity.models import (
    NAMES,
    Array,
    Rises,
    any_of,
    basis,
    fit,
    measured_rises,
    no_rise,
    predict,
    unknown_rises,
)

LATENCY_ERROR = 0.03
"""Relative error of a measured latency, unless a caller knows better."""
PRIOR = 10.0
"""Degrees of freedom p to which the samples tell the error."""
AGAINST_SIMPLER = 6.5
"""Evidence that rules out a model in favor of a more complex one."""
AGAINST_COMPLEX = 1.5
"""Evidence that rules out a more complex rival of a claim …"""
AGAINST_COMPLEX_CLAIM = 4.0
"""… and a claim more complex than what explains the costs: a violation accuses …"""
NO_BETTER = 2.0
"""… provided that the simpler one explains the costs worse by less evidence than this."""
GROWTH = 1.3
"""Factor by which a model must grow over the sizes, intercept included, to be told from O(1) …"""
CLEAR_GROWTH = 2.1
"""… and by which it would have to grow to be rejected in favor of a simpler one."""
ACCUSING_GROWTH = 2.0
"""Factor by which times must grow over the sizes to violate a claim of slower growth: cells of the
same code were measured to differ by 1.8 where neighbors share the caches."""
HIGHEST_RISE = 12.0
"""Slowdown over the sizes that unmeasured caches are reckoned with."""
MISFIT = 2.5
"""χ² per degree of freedom that a model may have and still explain times without a latency …"""
MISFIT_EXPLAINED = 12.0
"""… and with it, or exact counts: caches are accounted for, what is left is small print."""


@dataclass(frozen=True)
class Caches:
    """What caches may have done to costs."""

    measured: Rises
    """Rises that the measured latency, or its absence, allows."""
    unmeasured: Rises | None
    """Rises that are possible besides, because nobody measured them: they violate nothing."""
    told: bool
    """Whether a latency tells what to confirm, or none is needed; else `unmeasured` casts doubt."""
    accusing: float
    """Growth over the sizes from which on a model violates a simpler claim."""
    misfit: float
    """χ² per degree of freedom up to which a model explains the costs."""
    parameters: int
    """Free parameters of a model: intercept, factor, and the rise if there is one."""


def account(
    costs: Costs,
    sizes: ArrayLike,
    latency: ArrayLike | None,
    exact: bool,
    latency_error: float = LATENCY_ERROR,
    unseen: bool = False,
) -> tuple[Costs, Caches]:
    """The costs, with the latency's error added to theirs, and what caches may have done to them.

    sizes: (k,) in the order of latency: (k,), or (a, k) for as many possibilities.
    unseen: whether costs may besides have risen in a way that the latency misses.
    """
    unmeasured = None
    if not exact and (latency is None or unseen):
        unmeasured = unknown_rises(costs.sizes, HIGHEST_RISE)
    if latency is None:
        return costs, Caches(
            no_rise(len(costs.sizes)),
            unmeasured,
            told=exact,
            accusing=1.0 if exact else ACCUSING_GROWTH,
            misfit=MISFIT_EXPLAINED if exact else MISFIT,
            parameters=2,
        )
    if exact:
        raise ValueError("exact counts wait for no memory: give either latency or exact")
    waits = np.atleast_2d(np.asarray(latency, dtype=np.float64))
    if waits.shape[1:] != costs.sizes.shape or not np.all(np.isfinite(waits) & (waits > 0)):
        raise ValueError("latency must be one positive number per size")
    order = np.argsort(np.asarray(sizes, dtype=np.float64), kind="stable")
    rises = any_of([measured_rises(row[order]) for row in waits])
    error = np.sqrt(costs.error**2 + latency_error**2)
    return replace(costs, error=error), Caches(
        rises,
        unmeasured,
        told=True,
        accusing=ACCUSING_GROWTH,
        misfit=MISFIT_EXPLAINED,
        parameters=3,
    )


class Comparison:
    """All models fitted to the same costs. Models go by their indices in `NAMES`."""

    def __init__(self, costs: Costs, caches: Caches) -> None:
        self.costs = costs
        self.freedom = max(len(costs.sizes) - caches.parameters, 1)
        self.weight = 1 / (costs.cost * costs.error)
        self.basis = basis(costs.sizes, caches.measured, GROWTH)
        self.fit = fit(self.basis, costs.cost, self.weight)
        self.chi2 = self.fit.chi2
        _, steady = predict(self.basis, self.fit)
        self.accuses = steady.max(axis=1) >= caches.accusing * steady.min(axis=1)
        self.clear = self._misfit(caches.measured, CLEAR_GROWTH)
        self.unmeasured, self.told = caches.unmeasured is not None, caches.told
        self.excused, self.clear_excused = self.chi2, self.clear
        if caches.unmeasured is not None:
            excused = self._misfit(caches.unmeasured, GROWTH)
            clear = self._misfit(caches.unmeasured, CLEAR_GROWTH)
            self.excused = np.minimum(self.chi2, excused)
            self.clear_excused = np.minimum(self.clear, clear)
        closest = self.chi2.min()
        level = (self.evidence(closest, chi2) < NO_BETTER for chi2 in self.chi2)
        self.best = list(level).index(True)
        self.runner_up = min(set(range(len(NAMES))) - {self.best}, key=lambda m: self.chi2[m])
        self.margin = self.evidence(self.chi2[self.best], self.chi2[self.runner_up])
        self.explained = bool(self.chi2[self.best] <= caches.misfit * self.freedom)

    def _misfit(self, rises: Rises, growth: float) -> Array:
        return fit(basis(self.costs.sizes, rises, growth), self.costs.cost, self.weight).chi2

    def steady(self, costs: Array) -> Array:
        """Costs (..., k) with the memory's part, as the best model sees it in each row, removed."""
        best = self.basis.only(self.best)
        slowed, fast = predict(best, fit(best, costs, self.weight))
        steady: Array = costs * (fast / slowed)[..., 0, :]
        return steady

    def evidence(self, better: float, worse: float) -> float:
        """Evidence of a model with misfit `better` against one with misfit `worse`."""
        return float((PRIOR + self.freedom) * np.log((PRIOR + worse) / (PRIOR + better)))

    def confirms(self, claimed: int, rival: int) -> bool:
        """Whether a claim beats a rival that caches of no known latency do not make better."""
        found = self.chi2[claimed]
        if rival < claimed:
            ruled_out = self.evidence(found, self.chi2[rival]) >= AGAINST_SIMPLER
            return ruled_out and (self.told or self.excused[rival] >= found)
        ruled_out = self.evidence(found, self.clear[rival]) >= AGAINST_COMPLEX
        unbent = self.told or self.clear_excused[rival] >= found
        return ruled_out and unbent and self._no_better(rival, claimed)

    def refutes(self, favored: int, claimed: int) -> bool:
        """Whether a model rules out a claim, even one that unmeasured caches may have bent."""
        found = self.chi2[favored]
        if claimed < favored:
            ruled_out = self.evidence(found, self.excused[claimed]) >= AGAINST_SIMPLER
            return ruled_out and bool(self.accuses[favored])
        ruled_out = self.evidence(found, self.clear_excused[claimed]) >= AGAINST_COMPLEX_CLAIM
        return ruled_out and self._no_better(claimed, favored)

    def _no_better(self, complex_: int, simpler: int) -> bool:
        return self.evidence(self.chi2[complex_], self.chi2[simpler]) < NO_BETTER
