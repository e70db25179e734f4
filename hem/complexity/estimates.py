"""From samples to one cost per size, its error, and its log-log slope."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.complexity.notation import Array

FLOOR = 0.02  # relative error between sizes that no repetition at one size shows
WIDEST = 1e60  # of the largest cost to the smallest: products of four are still numbers


@dataclass(frozen=True)
class Costs:
    """One cost per size, ascending, with its relative error; and the samples behind it."""

    sizes: Array
    samples: list[Array]
    latency: Array | None  # (a, k): what the memory took at each size, as any one row has it
    cost: Array
    error: Array
    scatter: float  # relative standard deviation of single samples, as all sizes share it

    def only(self, rows: NDArray[np.intp]) -> "Costs":
        """The costs of some of the sizes, as if no other had been measured."""
        latency = None if self.latency is None else self.latency[:, rows]
        return summarize(self.sizes[rows], [self.samples[i] for i in rows], latency)


def summarize(
    sizes: ArrayLike, samples: Sequence[ArrayLike], latency: ArrayLike | None = None
) -> Costs:
    """Costs of k sizes from k arrays of samples, and the latency (k,) or (a, k) beside them.

    ValueError names what is malformed.
    """
    n = np.asarray(sizes, dtype=np.float64)
    cells = [np.asarray(cell, dtype=np.float64).ravel() for cell in samples]
    waits = np.atleast_2d(np.ones(n.shape) if latency is None else np.asarray(latency, np.float64))
    if n.ndim != 1 or not n.size or not np.all(np.isfinite(n) & (n >= 1)):
        raise ValueError("sizes must be one row of numbers, each at least 1")
    if len(cells) != len(n):
        raise ValueError(f"one array of samples per size: {len(n)} sizes, {len(cells)} arrays")
    for size, cell in zip(n, cells, strict=True):
        if not cell.size or not np.all(np.isfinite(cell) & (cell > 0)):
            raise ValueError(f"samples at size {size:g} must be there, finite and positive")
    if waits.shape[1:] != n.shape or not np.all(np.isfinite(waits) & (waits > 0)):
        raise ValueError("latency must be one positive number per size")
    order = np.argsort(n, kind="stable")
    cells = [cells[i] for i in order]
    error, scatter = _errors(cells)
    cost = np.array([midmean(cell) for cell in cells])
    if any(it.max() / WIDEST > it.min() for it in (cost, waits)):
        raise ValueError(
            f"no cost or latency may be over {WIDEST:g} times another: leave sizes out"
        )
    told = None if latency is None else waits[:, order]
    return Costs(n[order], cells, told, cost, error, scatter)


def midmean(samples: Array) -> Array:
    """Mean of the middle half along the last axis: nearly a mean's precision, deaf to outliers."""
    cut = samples.shape[-1] // 4
    return np.sort(samples, axis=-1)[..., cut : samples.shape[-1] - cut].mean(-1)


def _errors(cells: list[Array]) -> tuple[Array, float]:
    """Relative standard error of each midmean, and the scatter of samples all sizes share.

    Few samples tell their own scatter badly, so it is averaged with that of all sizes.
    """
    count = np.array([len(cell) for cell in cells])
    small = np.sqrt(count / np.maximum(count - 0.8, 0.2))
    off = [np.abs(c / np.median(c) - 1) * f for c, f in zip(cells, small, strict=True)]
    own = 1.4826 * np.array([np.median(o) for o in off])
    shared = 1.4826 * float(np.median(np.concatenate(off)))
    variance = 1.15**2 * (shared**2 + own**2) / 2 / count
    return np.sqrt(variance + FLOOR**2), shared


def slope(sizes: Array, cost: Array) -> Array:
    """Log-log slope along the last axis of costs (..., k), all sizes counting alike."""
    x = np.log(sizes) - np.log(sizes).mean()
    return np.log(cost) @ x / max(float(x @ x), 1e-12)


def resample(costs: Costs, fitted: Array, count: int, seed: int) -> Array:
    """(count, k) bootstrap replicates: samples drawn anew, residuals' signs turned at random.

    A line through few sizes follows each of them, so that residuals are less than errors by the
    size's leverage h: they count for 1 / (1 - h) of themselves (MacKinnon & White 1985, HC3).
    """
    rng = np.random.default_rng(seed)
    cells = (c[rng.integers(len(c), size=(count, len(c)))] for c in costs.samples)
    drawn = np.stack([midmean(cell) for cell in cells], axis=1)
    x = np.log(costs.sizes) - np.log(costs.sizes).mean()
    leverage = 1 / len(x) + x**2 / max(float(x @ x), 1e-12)
    sign = rng.choice([-1.0, 1.0], size=drawn.shape) / np.maximum(1 - leverage, 0.25)
    off = np.clip(np.log(costs.cost / fitted), -20, 20)  # a model may be nothing at size 1
    return drawn * np.exp(off * (sign - 1))
