"""Growth models: how cost may depend on size, and how memory may slow it down.

A model says that a cost is

    t(n) = c · r₁(n) + a · f(n) · r₂(n),      c, a ≥ 0

with `f` from `MODELS` and `r` a *rise*: 1 where memory is fast, more where the working set has left
the caches. Every model but O(1) must really grow: its intercept `c` may only be so large that
c + a·f(n) still gains a given factor over the measured range. Without that bound every model would
contain O(1), and no measurement could ever tell them apart.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MODELS: dict[str, Callable[[Array], Array]] = {
    "O(1)": np.ones_like,
    "O(log n)": np.log,
    "O(√n)": np.sqrt,
    "O(n)": np.copy,
    "O(n log n)": lambda n: n * np.log(n),
    "O(n²)": np.square,
}
"""Growth functions by name, slowest growth first."""

NAMES = tuple(MODELS)


def _bare(claim: str) -> str:
    plain = re.sub(r"(?<=n)_\w+", "", claim.lower()).replace("sqrt", "√")
    return re.sub(r"[\s()·]", "", re.sub(r"\^2|\*\*2", "²", plain))


def canonical(claim: str) -> str:
    """Name in `MODELS` of a claim as papers spell it: "O(n_ev)" is "O(n)", "O(sqrt n)" is "O(√n)".

    Raises ValueError for a class that is not modelled.
    """
    for name in NAMES:
        if _bare(name) == _bare(claim):
            return name
    raise ValueError(f"unknown growth class {claim!r}; known are {', '.join(NAMES)}")


@dataclass(frozen=True)
class Rises:
    """Candidate rises, each (s, k): of the fixed part of a cost and of its growing part."""

    fixed: Array
    growing: Array


def no_rise(k: int) -> Rises:
    """Memory does not matter: the cost is a count of work, or is taken at its word."""
    return Rises(np.ones((1, k)), np.ones((1, k)))


def measured_rises(latency: Array, steps: int = 65) -> Rises:
    """Every mixture of computing and waiting for memory, from none to all of the measured rise.

    The fixed part either waits as the growing part does, or not at all.
    """
    slowdown = latency / latency.min() - 1
    top = max(float(slowdown.max()), 1e-9)
    share = (np.geomspace(1, 1 + top, steps) - 1) / top
    mixed = 1 + share[:, None] * slowdown
    return Rises(np.vstack([mixed, np.ones_like(mixed)]), np.vstack([mixed, mixed]))


def unknown_rises(sizes: Array, highest: float) -> Rises:
    """Smooth steps in the range, up to `highest`: what caches might do when nobody measured."""
    x = np.log(sizes)
    center = np.linspace(x.min(), x.max(), 9)[:, None, None, None]
    width = np.array([0.3, 0.7, 1.2])[:, None, None]
    height = np.geomspace(1.5, highest, 6)[:, None]
    step = 1 / (1 + np.exp((center - x) / width))
    low, high = step.min(-1, keepdims=True), step.max(-1, keepdims=True)
    rise = (1 + (height - 1) * (step - low) / np.maximum(high - low, 1e-9)).reshape(-1, len(x))
    return Rises(rise, rise)


@dataclass(frozen=True)
class Basis:
    """Two columns (m, s, k) for m models under s rises whose nonnegative sums are the models.

    `pure` is a·f alone, `mixed` is f with the largest intercept allowed, so that a nonnegative
    combination of both has an intercept between none and the largest.
    """

    pure: Array
    mixed: Array
    intercept: Array
    """(m,) largest intercept beside f/max(f) = 1."""
    scale: Array
    """(m,) max of f over the sizes."""


def basis(sizes: Array, rises: Rises, growth: float) -> Basis:
    """Columns of every model in `MODELS` that gains at least `growth` over the sizes, if it can."""
    f = np.array([model(sizes) for model in MODELS.values()])
    scale = np.maximum(f.max(1), 1e-9)
    f /= scale[:, None]
    intercept = np.maximum((1 - growth * f.min(1)) / (growth - 1), 0)
    intercept[0] = 0.0
    pure = f[:, None] * rises.growing
    return Basis(pure, intercept[:, None, None] * rises.fixed + pure, intercept, scale)


@dataclass(frozen=True)
class Fit:
    """Best nonnegative fit of each model: misfit and coefficients, (m,) each."""

    chi2: Array
    """Squared relative residuals over their variances."""
    fixed: Array
    """Intercept c, in the unit of the costs."""
    factor: Array
    """Factor a of f(n)."""
    rise: NDArray[np.intp]
    """Row of the rises that served best."""


def fit(columns: Basis, cost: Array, error: Array) -> Fit:
    """Weighted nonnegative least squares, in closed form, with relative weights 1/(cost·error).

    Relative weights let a size count for its precision, not for its magnitude.
    cost, error: (k,), the error relative. O(m·s·k).
    """
    weight = 1 / (cost * error)
    u, v, t = columns.pure * weight, columns.mixed * weight, cost * weight
    uu, vv, uv = (np.maximum((p * q).sum(-1), 1e-30) for p, q in ((u, u), (v, v), (u, v)))
    ut, vt = u @ t, v @ t
    det = uu * vv - uv * uv
    regular = det > 1e-12 * uu * vv
    safe = np.where(regular, det, 1.0)
    a, b = (vv * ut - uv * vt) / safe, (uu * vt - uv * ut) / safe
    inside = regular & (a >= 0) & (b >= 0)
    pure_better = ut * ut * vv >= vt * vt * uu
    a = np.where(inside, a, np.where(pure_better, ut / uu, 0.0))
    b = np.where(inside, b, np.where(pure_better, 0.0, vt / vv))
    chi2 = ((a[..., None] * u + b[..., None] * v - t) ** 2).sum(-1)
    row = chi2.argmin(1)
    at = np.arange(len(row)), row
    factor = (a[at] + b[at]) / columns.scale
    return Fit(chi2[at], b[at] * columns.intercept, factor, row)


def predict(sizes: Array, rises: Rises, fitted: Fit) -> tuple[Array, Array]:
    """(m, k) costs that the fitted models predict, and the same with memory at its fastest."""
    f = np.array([model(sizes) for model in MODELS.values()])
    growing = fitted.factor[:, None] * f
    fixed = fitted.fixed[:, None]
    slowed = fixed * rises.fixed[fitted.rise] + growing * rises.growing[fitted.rise]
    return slowed, fixed + growing
