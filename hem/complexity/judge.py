"""From sizes and samples to a verdict on a growth class.

Every model of `hem.complexity.models` is fitted to one robust cost per size, with relative weights.
"Consistent" and "violated" need evidence against all that would say otherwise; without it, or where
no model explains the costs, the verdict is "undetermined".
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity.estimates import Costs, resample, slope, summarize
from hem.complexity.models import NAMES, canonical, predict
from hem.complexity.selection import (
    LATENCY_ERROR,
    Comparison,
    account_for_memory,
    compare_models,
)

Outcome = Literal["consistent", "violated", "undetermined"]
Bound = Literal["tight", "upper"]

MIN_SIZES = 4
MIN_RANGE = 4.0
MAX_SCATTER = 0.4  # relative scatter of samples beyond which nothing is concluded
MAX_ERROR = 0.12  # relative error of a size's cost beyond which the size is left out …
MOST_LEFT_OUT = 0.25  # … if so few of the sizes are like that; otherwise nothing is concluded


@dataclass(frozen=True)
class Verdict:
    """What measurements say about a claimed growth class.

    slope, slope_low, slope_high: log-log slope with the memory's part, as `best` sees it, taken
    out, and its bootstrap interval; raw_slope: of the costs as measured. margin: evidence of `best`
    against `runner_up`, negative where `best` is preferred for being simpler. noise: relative
    scatter of samples. coefficients: per model `fixed`, `factor` and `rise` of
    fixed·r + factor·f(n)·r, where r rises with the memory's latency from 1 to `rise`. errors: per
    model, the root mean square of the relative residuals.
    """

    outcome: Outcome
    expected: str
    bound: Bound
    best: str
    runner_up: str
    margin: float
    slope: float
    slope_low: float
    slope_high: float
    raw_slope: float
    confidence: float
    noise: float
    coefficients: Mapping[str, Mapping[str, float]]
    errors: Mapping[str, float]
    reason: str


def judge(
    sizes: ArrayLike, samples: Sequence[ArrayLike], expected: str = "O(1)",
    latency: ArrayLike | None = None, *, exact: bool = False,
    latency_error: float = LATENCY_ERROR, unseen: bool = False, bound: Bound = "tight",
    confidence: float = 0.95, resamples: int = 200, seed: int = 0,
) -> Verdict:  # fmt: skip
    """Judge whether costs measured at several sizes grow as claimed.

    sizes: (k,) at least 1, the variable of the claim; 4 distinct ones over a range of 4 can decide.
    samples: k arrays of positive costs, of any lengths: seconds, or read counts.
    expected: a class of `MODELS` in any usual spelling; "O(n_t)" and "O(n_ev)" are linear.
    latency: (k,) the machine's memory latency at each working set, in any unit. A cost may then
    wait for memory to any degree, from not at all to entirely. Or (a, k): as any one row tells it.
    latency_error: how far, relatively, the latency may miss what the costs really waited for.
    exact: the costs are counts of work, which no cache slows. With neither latency nor exact, a
    smooth slowdown of up to `selection.HIGHEST_SLOWDOWN` may have happened unseen: what it could
    explain violates nothing, and where it explains the costs better, nothing is confirmed.
    unseen: beside a latency, too, what such a slowdown could explain violates nothing; for costs
    of what was found in the caches in another state than what the latency was measured on.
    bound: "tight" takes the claim for the class itself, as a table of growth classes means it;
    "upper" for a bound, which slower growth keeps too.

    A size whose own samples tell its cost worse than `MAX_ERROR` is left out, up to a quarter of
    the sizes: a neighbor who took the machine for some milliseconds spoils a cell, not the curve.
    Growth below `selection.GROWTH` over the sizes is taken for O(1): beside so large an intercept
    no class shows. Beside a tenfold slowdown by caches, growth below 1.5 may be missed as well.
    Times that grow by less than `selection.ACCUSING_GROWTH` violate no claim of slower growth.
    The same input gives the same verdict. Takes milliseconds. Raises ValueError for malformed
    input; data that are too few or too noisy are "undetermined".
    """
    if bound not in ("tight", "upper"):
        raise ValueError(f'bound must be "tight" or "upper", not {bound!r}')
    claim = NAMES.index(canonical(expected))
    measured = _without_noisy_sizes(summarize(sizes, samples, latency))
    costs, memory = account_for_memory(measured, exact, latency_error, unseen)
    models = compare_models(costs, memory)
    outcome, reason = _decide(measured, models, claim, bound)
    fitted, _ = predict(models.design, models.fit)
    errors = np.sqrt(np.mean((fitted / costs.cost - 1) ** 2, axis=1))
    replicates = resample(costs, fitted[models.best], resamples, seed)
    tails = [(1 - confidence) / 2, (1 + confidence) / 2]
    low, high = np.quantile(slope(costs.sizes, models.steady(replicates)), tails)
    return Verdict(
        outcome, NAMES[claim], bound, NAMES[models.best], NAMES[models.runner_up], models.margin,
        slope=float(slope(costs.sizes, models.steady(costs.cost))),
        slope_low=float(low), slope_high=float(high),
        raw_slope=float(slope(costs.sizes, costs.cost)),
        confidence=confidence, noise=costs.scatter, coefficients=_coefficients(models),
        errors=dict(zip(NAMES, errors.tolist(), strict=True)), reason=reason,
    )  # fmt: skip


def _decide(costs: Costs, models: Comparison, claim: int, bound: Bound) -> tuple[Outcome, str]:
    doubt = _doubt(costs, models)
    if doubt:
        return "undetermined", doubt
    best, kept = models.best, range(0 if bound == "upper" else claim, claim + 1)
    if best in kept:
        rivals = [m for m in range(len(NAMES)) if m not in kept and not models.confirms(best, m)]
        if not rivals:
            return "consistent", f"{NAMES[best]} explains the costs, and no other class does."
    else:
        rivals = [m for m in kept if not models.refutes(best, m)]
        if not rivals:
            return "violated", f"{NAMES[best]} explains the costs, {NAMES[claim]} does not."
    close, memory = ", ".join(NAMES[m] for m in rivals), models.memory
    bent = memory.unmeasured is not None and not (memory.latency_known and best in kept)
    allowed = " once caches that no latency tells of are allowed for" if bent else ""
    reason = f"{NAMES[best]} explains the costs best, but {close} cannot be ruled out{allowed}."
    return "undetermined", reason


def _without_noisy_sizes(costs: Costs) -> Costs:
    """The costs of the sizes that are not drowned in noise, or of all if too many are."""
    clear = np.flatnonzero(costs.error <= MAX_ERROR)
    few_left_out = len(costs.sizes) - len(clear) <= MOST_LEFT_OUT * len(costs.sizes)
    return costs.only(clear) if few_left_out and len(clear) < len(costs.sizes) else costs


def _doubt(costs: Costs, models: Comparison) -> str:
    """Why these costs cannot decide anything; empty if they can."""
    distinct, reach = len(np.unique(costs.sizes)), costs.sizes[-1] / costs.sizes[0]
    if distinct < MIN_SIZES:
        return f"Too few sizes: {distinct}, where {MIN_SIZES} are needed."
    if reach < MIN_RANGE:
        return f"Too short a range: the largest size is {reach:.1f} times the smallest."
    if costs.scatter > MAX_SCATTER or costs.error.max() > MAX_ERROR:
        return f"Too noisy: the samples of a size scatter by {costs.scatter:.0%}."
    if models.chi2[models.best] > models.memory.misfit * models.freedom:
        unknown = ", and caches that no latency tells of might have bent them"
        hint = unknown if models.memory.unmeasured is not None else ""
        return f"No class explains the costs: {NAMES[models.best]} comes closest{hint}."
    return ""


def _coefficients(models: Comparison) -> dict[str, dict[str, float]]:
    rise = models.design.slowdowns.scaling[models.fit.slowdown].max(axis=1)
    values = (it.tolist() for it in (models.fit.intercept, models.fit.factor, rise))
    rows = zip(NAMES, *values, strict=True)
    return {name: {"fixed": c, "factor": a, "rise": r} for name, c, a, r in rows}
