"""From sizes and samples to a verdict on a growth class.

Every model of `hem.complexity.models` is fitted to one robust cost per size, with relative weights.
"Consistent" and "violated" need evidence against all that would say otherwise; without it, or where
no model explains the costs, the verdict is "undetermined".
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hem.complexity import selection
from hem.complexity.estimates import Costs, resample, slope, summarize
from hem.complexity.models import NAMES, STEEP
from hem.complexity.notation import Array, Order, canonical, parse
from hem.complexity.selection import LATENCY_ERROR, MOST_WOBBLE, Comparison, Memory, compare_models

Outcome = Literal["consistent", "violated", "undetermined"]
"""What measurements say about a claim."""
Bound = Literal["tight", "upper"]
"""Whether a claim is the class itself, or a bound that slower growth keeps, too."""
COEFFICIENTS = "fixed", "factor", "lower", "slowdown"

MIN_SIZES = 4
"""How many distinct sizes it takes to decide a claim."""
MIN_RANGE = 4.0
MIN_GROWTH = 64.0  # of costs over sizes of a shorter range: what is exponential has no longer one
MAX_SCATTER = 0.4  # relative scatter of samples beyond which nothing is concluded
MAX_ERROR = 0.12  # relative error of a size's cost beyond which the size is skipped …
MOST_SKIPPED = 0.25  # … if so few of the sizes are like that; otherwise nothing is concluded
STEEPER = 2.1  # slope of the larger half of the sizes beyond which steep classes are asked about
NEAR_HALF = 0.06  # of exponents: a power law so close to a half is told as that
STEADY = 0.2  # of exponents: by so much the halves of a power law may differ
APART, ABOVE = 0.2, 0.3  # of exponents: what is closer to a class is that, bent, or with log n
LESS = np.linspace(-0.5, 0, 8, endpoint=False)  # of the smallest size: terms taken off of counts


@dataclass(frozen=True, repr=False)
class Verdict:
    """What measurements say about a claimed growth class.

    slope, slope_low, slope_high: log-log slope with the memory's part, as `best` sees it, taken
    out, and its bootstrap interval; raw_slope: of the costs as measured. noise: relative scatter of
    samples. coefficients: per model `fixed`, `factor`, `lower` and `slowdown` of
    fixed·r + factor·f(n)·(1 + lower/n)·r, where r goes with the memory's latency from 1 to
    `slowdown`, and `lower` is 0 unless lower-order terms were allowed; `predicted` are its costs.
    errors: per model, the root mean square of the relative residuals. classes: what the costs say
    by themselves: one class, two that cannot be told apart, a power law that fits where no class
    does ("O(n^1.62)"), or none.
    """

    outcome: Outcome
    expected: str
    bound: Bound
    best: str
    slope: float
    slope_low: float
    slope_high: float
    raw_slope: float
    noise: float
    coefficients: Mapping[str, Mapping[str, float]]
    errors: Mapping[str, float]
    reason: str
    classes: list[str] = field(default_factory=list)

    @property
    def answer(self) -> str:
        """The classes in words: "O(n) or O(n log n)"; empty where the costs tell none."""
        return " or ".join(self.classes)

    def __repr__(self) -> str:
        slope = f"slope {self.slope:.2f} ({self.slope_low:.2f} … {self.slope_high:.2f})"
        told = f"The costs tell {self.answer or 'no class'}."
        return f"<Verdict on {self.expected}: {self.outcome}, {slope}. {told} {self.reason}>"

    def predicted(self, name: str, sizes: Array) -> Array:
        """(k,) what a model that was fitted costs at the sizes, with memory at its fastest."""
        it = self.coefficients[name]
        return it["fixed"] + it["factor"] * parse(name)(sizes) * (1 + it["lower"] / sizes)


def judge(
    sizes: ArrayLike, samples: Sequence[ArrayLike], expected: str = "O(1)",
    latency: ArrayLike | None = None, *, exact: bool = False,
    latency_error: float = LATENCY_ERROR, unseen: float = False, bound: Bound = "tight",
    reference: ArrayLike | None = None, lower: ArrayLike = (),
    confidence: float = 0.95, resamples: int = 200, seed: int = 0, variable: str | None = None,
) -> Verdict:  # fmt: skip
    """Judge whether costs measured at several sizes grow as claimed.

    sizes: (k,) at least 1, the variable of the claim; 4 distinct ones over a range of 4 can decide.
    samples: k arrays of positive costs, of any lengths: seconds, or read counts.
    expected: a growth class in any usual spelling; "O(n_t)" and "O(n_ev)" are linear. Where it
    names several variables, `variable` says which one the sizes are of; the others are held fixed.
    latency: (k,) the machine's memory latency at each working set, in any unit. A cost may then
    wait for memory to any degree, from not at all to entirely. Or (a, k): as any one row tells it.
    latency_error: how far, relatively, the latency may miss what the costs really waited for.
    reference: (k,) instead of a latency, what the same code costs where it does the same work at
    every size, on as much memory and in the same order: costs are judged in proportion to it.
    exact: the costs are counts of work, which no cache slows. With neither latency nor exact, a
    smooth slowdown of up to `selection.HIGHEST_SLOWDOWN` may have happened unseen: what it could
    explain violates nothing, and where it explains the costs better, nothing is confirmed.
    unseen: beside a latency, too, what such a slowdown could explain violates nothing; for costs
    of what was found in the caches in another state than what the latency was measured on. A number
    above 1 says how high: then it also confirms nothing that such a slowdown explains better.
    lower: coefficients l that a class f from O(n) on may come with, as f(n)·(1 + l/n), each above
    minus the smallest size: the lower-order terms that a cost may have.
    bound: "tight" takes the claim for the class itself, as a table of growth classes means it;
    "upper" for a bound, which slower growth keeps too.

    A size whose own samples tell its cost worse than `MAX_ERROR` is skipped, up to a quarter of
    the sizes: another tenant of the machine spoils a size for some milliseconds, not the curve.
    Times that grow more than any slowdown excuses violate a claim even where no class explains
    them. None is violated in favor of a class whose slope the largest sizes do not come near, nor
    by counts that it explains with a lower term taken off.
    Growth below `selection.GROWTH` over the sizes is taken for O(1): beside so large an intercept
    no class shows. Beside a tenfold slowdown by caches, growth below 1.5 may be missed as well.
    Times that grow by less than `selection.ACCUSING_GROWTH` violate no claim of slower growth.
    No size decides times alone: where without it a consistent claim would be violated, or a
    violated one the best, they are undetermined. The same input gives the same verdict. Takes
    milliseconds. Raises ValueError for malformed input; data that are too few or too noisy are
    "undetermined".
    """
    require_bound(bound)
    if resamples < 1:
        raise ValueError(f"resamples must be at least 1, not {resamples}")
    if not 0 < confidence < 1:
        raise ValueError(f"confidence must be between 0 and 1, not {confidence}")
    if not all(0 <= it < np.inf for it in (latency_error, unseen)):
        raise ValueError("latency_error and unseen must be numbers from 0 on")
    claimed = canonical(expected, variable)
    if reference is not None and latency is not None:
        raise ValueError("give either latency or reference")
    terms = np.ravel(np.asarray(lower, float))
    waits, entire = (latency, False) if reference is None else (np.ravel(reference), True)
    measured = summarize(sizes, samples, waits)
    if not np.all((terms > -measured.sizes[0]) & (terms < np.inf)):
        raise ValueError(f"lower must be numbers above minus the smallest size, not {lower!r}")
    noisy = measured.error > MAX_ERROR
    if 0 < noisy.mean() <= MOST_SKIPPED and np.count_nonzero(~noisy) >= MIN_SIZES:
        measured = measured.only(np.flatnonzero(~noisy))
    costs, memory = selection.account_for_memory(measured, exact, latency_error, unseen, entire)
    models = _fitted(costs, memory, claimed, terms)
    names, claim = models.names, models.names.index(claimed)
    outcome, reason = _decide(measured, models, claim, bound)
    if not exact and (size := _hinge(outcome, measured, models, claim, bound)):
        outcome, reason = "undetermined", f"One size decides: without {size:,g}, it is otherwise."
    best, classes = names[models.best], _classes(measured, models)
    exactly = exact and outcome == "violated" and not terms.size
    if exactly and (other := _less_a_term(measured, memory, claimed, bound)):
        outcome, both = "undetermined", sorted({*classes, other}, key=parse)
        classes = both if classes and len(both) <= 2 else []
        reason = f"{best} explains the counts; {claimed} does, too, with a lower term taken off."
    if outcome == "consistent" and (worse := [it for it in _open(models) if it != best]):
        are = "is" if len(worse) == 1 else "are"
        reason = f"{best} explains the costs best, and {' and '.join(worse)} {are} not ruled out."
    replicates = resample(costs, models.predicted[0][models.best], resamples, seed)
    tails = [(1 - confidence) / 2, (1 + confidence) / 2]
    told = float(slope(costs.sizes, models.steady(costs.cost)))  # a model may miss it by a little
    low, high = np.quantile(slope(costs.sizes, models.steady(replicates)), tails)
    return Verdict(
        outcome, claimed, bound, names[models.best],
        slope=told, slope_low=min(float(low), told), slope_high=max(float(high), told),
        raw_slope=float(slope(costs.sizes, costs.cost)), noise=costs.scatter,
        coefficients=_coefficients(models),
        errors=dict(zip(names, models.errors.tolist(), strict=True)), reason=reason,
        classes=classes,
    )  # fmt: skip


def _fitted(costs: Costs, memory: Memory, claimed: str, lower: Array) -> Comparison:
    """The models that a claim is held against: the usual ones, and steep ones for steep costs."""
    names, half = sorted({*NAMES, claimed}, key=parse), len(costs.sizes) // 2
    models = compare_models(costs, memory, names, lower)
    asked = costs.cost if lower.size else models.steady(costs.cost)  # the memory's part may be more
    if slope(costs.sizes[half:], asked[half:]) <= STEEPER:
        return models
    return compare_models(costs, memory, sorted({*names, *STEEP}, key=parse), lower)


def _coefficients(models: Comparison) -> dict[str, dict[str, float]]:
    """By model what its fit consists of, see `Verdict`."""
    design, fit = models.design, models.fit
    slowdown = design.slowdowns.scaling[fit.slowdown].max(axis=1)
    rows = np.stack([fit.intercept, fit.factor, design.lower[fit.lower], slowdown], axis=1)
    told = (dict(zip(COEFFICIENTS, row, strict=True)) for row in rows.tolist())
    return dict(zip(models.names, told, strict=True))


def require_bound(bound: str) -> None:
    """Raise ValueError for what is no bound."""
    if bound not in ("tight", "upper"):
        raise ValueError(f'bound must be "tight" or "upper", not {bound!r}')


def _decide(costs: Costs, models: Comparison, claim: int, bound: Bound) -> tuple[Outcome, str]:
    names, best = models.names, models.best
    if doubt := _doubt(costs):
        return "undetermined", doubt
    if models.outgrows(claim):
        return "violated", f"The costs grow more than {names[claim]} does, however slow the memory."
    kept = _kept(claim, bound)
    below = bound == "upper" and best in kept  # then it matters little which class it is
    if not (models.fits if below else models.explained):
        unknown = ", and caches that no latency tells of might have bent them"
        hint = unknown if models.memory.unmeasured is not None else ""
        return "undetermined", f"No class explains the costs: {names[best]} comes closest{hint}."
    if best in kept:
        rivals = [m for m in range(len(names)) if m not in kept and not models.confirms(best, m)]
        if not rivals:
            return "consistent", f"{names[best]} explains the costs, and no other class does."
    else:
        rivals = [m for m in kept if not models.refutes(best, m)]
        if not rivals:
            return "violated", f"{names[best]} explains the costs, {names[claim]} does not."
    close, memory = ", ".join(names[m] for m in rivals), models.memory
    bent = memory.unmeasured is not None and not (memory.latency_known and best in kept)
    allowed = " once caches that no latency tells of are allowed for" if bent else ""
    reason = f"{names[best]} explains the costs best, and {close} about as well{allowed}."
    return "undetermined", reason


def _kept(claim: int, bound: Bound) -> range:
    """The models that keep a claim."""
    return range(0 if bound == "upper" else claim, claim + 1)


def _hinge(
    outcome: Outcome, costs: Costs, models: Comparison, claim: int, bound: Bound
) -> float | None:
    """The size that decides alone: without it the outcome is another, or the claim fits best."""
    if outcome == "undetermined" or models.outgrows(claim):
        return None
    for size, fewer in zip(costs.sizes, models.without_each(), strict=True):
        keeps = fewer.best in _kept(claim, bound)
        accused = not keeps and _decide(costs, fewer, claim, bound)[0] == "violated"
        if accused if outcome == "consistent" else keeps:
            return float(size)
    return None


def _less_a_term(costs: Costs, memory: Memory, claimed: str, bound: Bound) -> str:
    """What explains counts best where a lower term may be taken off; empty if that excuses nothing.

    n - 1 comparisons of a few things grow like n log n.
    """
    models = _fitted(costs, memory, claimed, LESS * costs.sizes[0])
    outcome, _ = _decide(costs, models, models.names.index(claimed), bound)
    return "" if outcome == "violated" else models.names[models.best]


def _open(models: Comparison) -> list[str]:
    """The classes that the best one does not rule out, itself among them."""
    best, every = models.best, range(len(models.names))
    ruled_out = [m for m in every if models.confirms(best, m) and models.refutes(best, m)]
    return [models.names[m] for m in every if m == best or m not in ruled_out]


def _classes(costs: Costs, models: Comparison) -> list[str]:
    if _doubt(costs):
        return []
    if models.explained:
        open_ = _open(models)
        return open_ if len(open_) <= 2 else []
    cost = models.costs
    exponent = round(max(float(slope(cost.sizes, cost.cost)), 0.0), 2)
    if any(-APART < exponent - known < ABOVE for known in (0, 0.5, 1, 2, 3)):
        return []
    first, last = map(slope, np.array_split(cost.sizes, 2), np.array_split(cost.cost, 2))
    if abs(last - first) > STEADY:
        return []
    near = round(2 * exponent) / 2
    exponents = [near, exponent] if abs(near - exponent) < NEAR_HALF else [exponent]
    powers = (Order(power=it).name for it in exponents)
    return next(([it] for it in powers if _is_told(it, models)), [])


def _is_told(power: str, models: Comparison) -> bool:
    """Whether a power law, and no constant, explains the costs closely."""
    law = compare_models(models.costs, models.memory, sorted({NAMES[0], power}, key=parse))
    closely = law.explained and law.errors[-1] <= MOST_WOBBLE
    return bool(closely and law.names[law.best] == power)


def _doubt(costs: Costs) -> str:
    """Why these costs cannot decide anything, whatever explains them; empty if they can."""
    distinct, reach = len(np.unique(costs.sizes)), costs.sizes[-1] / costs.sizes[0]
    if distinct < MIN_SIZES:
        return f"Too few sizes: {distinct}, where {MIN_SIZES} are needed."
    if reach < MIN_RANGE and costs.cost[-1] < MIN_GROWTH * costs.cost[0]:
        return f"Too short a range: the largest size is {reach:.1f} times the smallest."
    if costs.scatter > MAX_SCATTER:
        return f"Too noisy: the samples of a size scatter by {costs.scatter:.0%}."
    if (worst := costs.error.max()) > MAX_ERROR:
        return f"Too noisy: samples tell the cost of a size to no more than {worst:.0%}."
    return ""
