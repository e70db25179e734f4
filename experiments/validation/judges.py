"""Rival judges of growth, on the same curves: who names how many right.

Each takes sizes and samples and names a class of `hem.complexity.models`, or none. They are given
nanoseconds, as some of them have thresholds in absolute units, and asked only about the classes
that are judged here. None of them knows of a latency.
"""

from __future__ import annotations

import atexit
from collections.abc import Callable, Sequence
from importlib.util import find_spec

import numpy as np

from experiments.validation.synthetic import GROWTH, Array
from hem.complexity import judge

Judge = Callable[[Array, Sequence[Array], Array | None], str | None]

NANOSECONDS = 1e9
ROOTLESS = [name for name in GROWTH if name != "O(√n)"]
"""What those know that have no O(√n)."""


def hem_judge(sizes: Array, samples: Sequence[Array], latency: Array | None) -> str | None:
    """`hem.complexity.judge`: the class that is consistent, of all it could be asked."""
    best = judge(sizes, samples, latency=latency, resamples=2).best
    verdict = judge(sizes, samples, best, latency, resamples=2)
    return best if verdict.outcome == "consistent" else None


def google_benchmark(
    sizes: Array, samples: Sequence[Array], latency: Array | None = None
) -> str | None:
    """Google Benchmark's rule, src/complexity.cc: MinimalLeastSq with oAuto.

    Least squares of each curve without intercept over all points; the least root mean square error
    relative to the mean wins, and O(1) where nothing beats it. It has no O(√n), and O(n³) is not
    asked about.
    """
    n, t = _points(sizes, samples)
    return min(ROOTLESS, key=lambda name: _normalized_rms(GROWTH[name](n), t))


def _normalized_rms(curve: Array, t: Array) -> float:
    coefficient = (t @ curve) / (curve @ curve)
    return float(np.sqrt(np.mean((t - coefficient * curve) ** 2)) / t.mean())


def big_o(sizes: Array, samples: Sequence[Array], latency: Array | None = None) -> str | None:
    """The package big-o (P. Berkes): least squares with an intercept, least residuals win.

    It is given the least time of each size, as it measures. It has no O(√n).
    """
    from big_o import complexities, infer_big_o_class

    theirs = "Constant", "Logarithmic", "Linear", "Linearithmic", "Quadratic"
    names = {getattr(complexities, own): name for own, name in zip(theirs, ROOTLESS, strict=True)}
    least = np.array([np.min(case) for case in samples])
    best, _ = infer_big_o_class(sizes, NANOSECONDS * least, classes=list(names))
    return names[type(best)] if best is not None else None


def bigo(sizes: Array, samples: Sequence[Array], latency: Array | None = None) -> str | None:
    """The package bigo (E. Berger, S. Freund): least squares with an intercept, Akaike's criterion.

    It drops outliers by itself, and curves that it cannot fit.
    """
    from bigO import bigO, models

    atexit.unregister(bigO.save_performance_data)  # or it leaves a file where one happens to be
    theirs = "O(1)", "O(log(n))", "O(sqrt(n))", "O(n)", "O(n*log(n))", "O(n**2)"
    names = dict(zip(theirs, GROWTH, strict=True))
    n, t = _points(sizes, samples)
    fitted = models.infer_bound(n, NANOSECONDS * t).models
    return next((names[fit.model.name] for fit in fitted if fit.model.name in names), None)


def _points(sizes: Array, samples: Sequence[Array]) -> tuple[Array, Array]:
    n = np.repeat(sizes, [len(case) for case in samples])
    return n, np.concatenate([np.asarray(case, float) for case in samples])


JUDGES: dict[str, Judge] = {
    "hem": hem_judge,
    "bigo": bigo,
    "big-o": big_o,
    "Google Benchmark": google_benchmark,
}
"""By name. Those of packages that are not installed fail when asked: see ``installed_judges``."""

PACKAGES = {"bigo": "bigO", "big-o": "big_o"}
"""The judges that are packages of their own, and the module of each."""


def installed_judges() -> dict[str, Judge]:
    """The judges that can be asked here. Not every package has a distribution for every Python."""
    missing = {name for name, module in PACKAGES.items() if find_spec(module) is None}
    return {name: judge for name, judge in JUDGES.items() if name not in missing}
