"""Synthetic curves of known growth class, as a machine might measure them, to try judges on.

A curve has 5 to 9 sizes, faces of a mesh or valences of a vertex, and 5 to 30 samples at each; an
intercept of nothing or as much as the smallest size costs; noise of 2, 5 or 10 %; and the slowdown
that the memory causes. Everything follows from a seed.
"""

from collections.abc import Callable, Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GROWTH: dict[str, Callable[[Array], Array]] = {
    "O(1)": lambda n: n**0.0,
    "O(log n)": lambda n: np.log2(n),
    "O(√n)": lambda n: n**0.5,
    "O(n)": lambda n: n,
    "O(n log n)": lambda n: n * np.log2(n),
    "O(n²)": lambda n: n**2.0,
}
"""Growth by class; spelled here and not taken from the judge's own models."""

CONDITIONS = {
    "steady": "no slowdown, no latency given",
    "prefetched": "no slowdown, though a latency that grows is given",
    "latency known": "a tenfold slowdown, and the latency given",
    "latency unknown": "a tenfold slowdown, and no latency given",
}
"""What the memory does to a curve, and whether the judge is told its latency."""
SLOWED = ("latency known", "latency unknown")
TOLD = ("prefetched", "latency known")
KINDS = list(product((0.0, 1.0), (0.02, 0.05, 0.1)))  # intercepts, and noises


class SyntheticCurve(NamedTuple):
    """A curve, and what it is."""

    growth: str
    condition: str
    sizes: Array  # (k,)
    samples: list[Array]  # k times seconds
    latency: Array | None  # (k,) nanoseconds per access, with an error of 2 to 5 %


def make_curves(
    growth: str, condition: str, count: int = 144, seed: int = 0
) -> Iterator[SyntheticCurve]:
    """Make ``count`` curves of one class and condition, as many of each intercept and noise.

    ``count`` must be a multiple of 6: ValueError else. The same seed gives the same curves.
    """
    if count % len(KINDS):
        raise ValueError(f"count must be a multiple of {len(KINDS)}, not {count}")
    place = list(GROWTH).index(growth), list(CONDITIONS).index(condition)
    rng = np.random.default_rng([seed, *place])
    for kind in KINDS:
        for _ in range(count // len(KINDS)):
            yield make_curve(rng, growth, condition, *kind)


def make_curve(
    rng: np.random.Generator, growth: str, condition: str, intercept: float, noise: float
) -> SyntheticCurve:
    """Make a curve with an intercept, slowed or not, in units of its start; noise is relative."""
    faces = bool(rng.random() < 0.5)  # of a mesh, or valences of a vertex; and the bytes of one
    first, last = (100, rng.choice([1e5, 1e6])) if faces else (4, 4096)
    sizes = np.geomspace(first, float(last), int(rng.integers(5, 10))).round()
    size_bytes = np.exp(rng.uniform(*np.log((30, 400) if faces else (3e3, 4e4))))
    latency = machine_latency(sizes * size_bytes)
    growing = GROWTH[growth](sizes)
    fixed = intercept * growing[0]
    slow = np.ones_like(sizes)
    if condition in SLOWED:  # about tenfold, or less where the latency grows less
        own = latency / latency[0]
        slow += min(rng.uniform(8, 12) - 1, own.max() - 1) / (own.max() - 1) * (own - 1)
    cost = (fixed + growing) * slow if rng.random() < 0.5 else fixed + growing * slow
    count = rng.integers(5, 31)
    samples = [3e-9 * c * np.exp(rng.normal(0, noise, count)) for c in cost]
    seen = latency * np.exp(rng.normal(0, rng.uniform(0.02, 0.05), len(sizes)))
    return SyntheticCurve(growth, condition, sizes, samples, seen if condition in TOLD else None)


def machine_latency(working_set: Array) -> Array:
    """Nanoseconds per dependent load: steps at 32 KB, 1 MB and 30 MB, smooth in the logarithm."""
    x = np.log(working_set)
    latency = np.full_like(x, 1.2)
    for at, factor in ((32e3, 4 / 1.2), (1e6, 15 / 4), (30e6, 100 / 15)):
        latency *= factor ** (1 / (1 + np.exp((np.log(at) - x) / 0.35)))
    return latency
