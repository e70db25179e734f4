"""Growth models: how cost may depend on size, and how memory may slow it down.

A model says that a cost is

    t(n) = c · r₁(n) + a · f(n) · (1 + l/n) · r₂(n),      c, a ≥ 0

with `f` from `MODELS` and `r` a *slowdown*: 1 where memory is fast, more where the working set has
left the caches. The lower-order term `l` is 0 but where a caller names others; O(1) to O(√n) have
none. Every model but O(1) must really grow: its intercept `c` may only be so large that
c + a·f(n) still gains a given factor over the measured range. Without that bound every model would
contain O(1), and no measurement could ever tell them apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hem.complexity.estimates import WIDEST
from hem.complexity.notation import Array, Order, parse

MODELS: dict[str, Order] = {
    name: parse(name) for name in ("O(1)", "O(log n)", "O(√n)", "O(n)", "O(n log n)", "O(n²)")
}
"""Growth functions by name, slowest growth first: those that costs are always held against."""

NAMES = tuple(MODELS)
"""Their names."""

STEEP = ("O(n² log n)", "O(n³)", "O(2^n)")
"""Further ones, for costs that grow faster than O(n²)."""


class Slowdowns(NamedTuple):
    """Candidates, each (s, k): of the intercept of a cost and of the part that scales."""

    intercept: Array
    scaling: Array


def measured_slowdowns(latency: Array, steps: int = 65) -> Slowdowns:
    """Every mixture of computing and waiting for memory, from none to all of the measured one.

    latency: (k,), or (a, k) as any one of its rows has it. The intercept either waits as the
    scaling part does, or not at all.
    """
    intercept, scaling = [], []
    for row in np.atleast_2d(latency):
        extra = row / row.min() - 1
        top = max(float(extra.max()), 1e-9)
        share = (np.geomspace(1, 1 + top, steps) - 1) / top
        mixed = 1 + share[:, None] * extra
        intercept += [mixed, np.ones_like(mixed)]
        scaling += [mixed, mixed]
    return Slowdowns(np.vstack(intercept), np.vstack(scaling))


def entire_slowdown(reference: Array) -> Slowdowns:
    """What slows a loop of constant work slows the costs, intercept included, and by as much."""
    slowdown = np.atleast_2d(reference / reference.min())
    return Slowdowns(slowdown, slowdown)


def unknown_slowdowns(sizes: Array, highest: float) -> Slowdowns:
    """Smooth steps in the range, up to `highest`: what caches might do when nobody measured.

    So close that one between them is as a neighbor, or a constant cost would be accused by it.
    """
    x = np.log(sizes)
    center = np.linspace(x.min(), x.max(), 13)[:, None, None, None]
    width = np.array([0.3, 0.7, 1.2])[:, None, None]
    height = np.geomspace(min(1.5, highest**0.5), highest, 8)[:, None]
    step = 1 / (1 + np.exp((center - x) / width))
    low, high = step.min(-1, keepdims=True), step.max(-1, keepdims=True)
    slowdown = (1 + (height - 1) * (step - low) / np.maximum(high - low, 1e-9)).reshape(-1, len(x))
    return Slowdowns(slowdown, slowdown)


@dataclass(frozen=True)
class DesignMatrix:
    """Columns whose nonnegative sums are the costs of m models under s slowdowns, at k sizes."""

    names: tuple[str, ...]
    slowdowns: Slowdowns
    lower: Array  # (t,) lower-order terms, 0 first
    growth: Array  # (m, t, k) f beside each, in proportion to its largest value
    intercept: Array  # (m, t) largest intercept beside it
    scale: Array  # (m,) largest value of f itself

    def columns(self) -> tuple[Array, Array]:
        """(m, t·s, k) f with no intercept, and with the largest: between them lie all others."""
        pure = self.growth[:, :, None] * self.slowdowns.scaling
        mixed = self.intercept[:, :, None, None] * self.slowdowns.intercept + pure
        flat = len(self.names), -1, pure.shape[-1]
        return pure.reshape(flat), mixed.reshape(flat)

    def only(self, model: int) -> "DesignMatrix":
        """The columns of one model."""
        cut = "names", "growth", "intercept", "scale"
        return replace(self, **{it: getattr(self, it)[model : model + 1] for it in cut})


def design(
    sizes: Array, slowdowns: Slowdowns, growth: float, names: Sequence[str] = NAMES,
    lower: Array | None = None,
) -> DesignMatrix:  # fmt: skip
    """Columns of models, O(1) first; each gains at least `growth` over the sizes, if it can.

    lower: lower-order terms that a cost may have, each above minus the smallest size.
    """
    terms = np.concatenate([[0.0], [] if lower is None else lower])
    orders = [parse(name) for name in names]
    f = np.array([order(sizes) for order in orders])
    scale = np.maximum(f.max(1), 1e-9)
    f = np.maximum(f, scale[:, None] / WIDEST)  # log 1 is 0, which has no slope
    # What grows less than n has nothing below: beside any term it is the same, and 0 serves first.
    lowered = np.outer([order >= parse("O(n)") for order in orders], terms)
    beside = 1 + lowered[..., None] / sizes
    f = f[:, None] / scale[:, None, None] * beside
    intercept = np.maximum((f.max(2) - growth * f.min(2)) / (growth - 1), 0)
    intercept[0] = 0.0
    return DesignMatrix(tuple(names), slowdowns, terms, f, intercept, scale)


class Fit(NamedTuple):
    """Best nonnegative fit of each model: misfit and coefficients, (..., m) each."""

    chi2: Array  # squared relative residuals over their variances
    intercept: Array  # the intercept c, in the unit of the costs
    factor: Array  # factor a of f(n)
    slowdown: NDArray[np.intp]  # row of the slowdowns that served best …
    lower: NDArray[np.intp]  # … and place of the lower-order term


def fit(models: DesignMatrix, costs: Array, weight: Array) -> Fit:
    """Nonnegative least squares of weighted costs, in closed form, under the best slowdown each.

    costs: (..., k), rows of like magnitude. weight: (k,) or (..., k), 1/(cost·relative error): a
    size counts for its precision, not for its magnitude. O(m·t·s·k) per row of costs.
    """
    unit = costs.max()  # or squares of large ones were lost
    t, weighted = costs * weight, weight * unit
    u, v = (column * weighted[..., None, None, :] for column in models.columns())
    uu, vv, uv = (np.maximum((p * q).sum(-1), 1e-30) for p, q in ((u, u), (v, v), (u, v)))
    # Not by BLAS, whose threads wait for each other, up to 60 times as long, beside other work.
    ut, vt = (np.einsum("...k,...msk->...ms", t, column) for column in (u, v))
    det = uu * vv - uv * uv
    regular = det > 1e-12 * uu * vv
    safe = np.where(regular, det, 1.0)
    a, b = (vv * ut - uv * vt) / safe, (uu * vt - uv * ut) / safe
    inside = regular & (a >= 0) & (b >= 0)
    pure_better = ut * ut * vv >= vt * vt * uu
    a = np.where(inside, a, np.where(pure_better, ut / uu, 0.0))
    b = np.where(inside, b, np.where(pure_better, 0.0, vt / vv))
    saved = a * (2 * ut - a * uu - b * uv) + b * (2 * vt - b * vv - a * uv)
    row = saved.argmax(-1)
    best = [np.take_along_axis(x, row[..., None], -1)[..., 0] for x in (saved, a, b)]
    chi2 = np.maximum((t * t).sum(-1)[..., None] - best[0], 0)
    best[1:] = (it * unit for it in best[1:])
    factor = (best[1] + best[2]) / models.scale
    term, slowdown = np.divmod(row, len(models.slowdowns.scaling))
    intercept = best[2] * models.intercept[np.arange(len(models.names)), term]
    return Fit(chi2, intercept, factor, slowdown, term)


def predict(models: DesignMatrix, fitted: Fit) -> tuple[Array, Array]:
    """(..., m, k) costs that the fitted models predict, and the same with memory at its fastest."""
    growth = models.growth[np.arange(len(models.names)), fitted.lower]
    scaling = (fitted.factor * models.scale)[..., None] * growth
    intercept = np.broadcast_to(fitted.intercept[..., None], scaling.shape)
    slow, row = models.slowdowns, fitted.slowdown
    slowed = intercept * slow.intercept[row] + scaling * slow.scaling[row]
    return slowed, intercept + scaling
