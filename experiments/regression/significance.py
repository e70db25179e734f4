"""Whether a case became slower: significant by rank *and* large by an interval, or not said.

Rounds of one run are not independent, and two runs of the same code differ by more than their
rounds tell. So times are taken relative to a probe of the same run, as far as they may
have followed it; ranks are compared after a
tolerated drift between runs is granted; and the interval is widened by how much each round
resembles the one before.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import mannwhitneyu, rankdata, t

Array = NDArray[np.float64]
Outcome = Literal["worse", "better", "same", "undetermined"]

FACTOR = 1.15
"""How much slower is worth telling."""
ALPHA = 1e-4
"""Chance of a false alarm that the ranks alone may leave: 9 rounds on each side can show it."""
CONFIDENCE = 0.95
"""That the ratio lies above the interval's lower end, and, apart, below the upper one."""
DRIFT = 1.05
"""Factor by which the level of a run may differ from that of the next for no reason in the code."""
SINGLE_ERROR = 0.03
"""Relative error of a probe that was read once."""
TRIMMED = 5
"""One in so many samples is left out at either end: what a neighbor delayed moves nothing."""
LARGEST_EXACT = 2500
"""Pairs of samples up to which the rank test is exact, if no two samples are equal."""


class Comparison(NamedTuple):
    """What two runs say about one case.

    ratio: time after over time before, each relative to its probe. low, high: the ends of its
    interval, each crossed with a chance of 1 - `CONFIDENCE`. p: of the rank test, two-sided.
    """

    outcome: Outcome
    ratio: float
    low: float
    high: float
    p: float


def compare(
    before: Sequence[float],
    after: Sequence[float],
    probe_before: Sequence[float],
    probe_after: Sequence[float],
    factor: float = FACTOR,
    alpha: float = ALPHA,
    least_share: float = 0.0,
) -> Comparison:
    """Compare the rounds of one case in two runs.

    before, after: seconds per round, in the order they were measured; 9 rounds each can decide at
    the default `alpha`. probe_before, probe_after: seconds of a reference in the same run, taken
    beside the case; of a single reading the error is taken to be `SINGLE_ERROR`. Any unit will do.
    least_share: how much of the probe's change the case must at least have followed, from 0 to 1. A
    memory latency can change tenfold beside a case that never waits for it, so by default a case
    may have followed to any degree, and is worse only if it is so at every one of them. Give 1 for
    a probe that surely slows as the case does, as between two machines.

    "worse": the ranks differ by more than `DRIFT` explains (Mann-Whitney, p < alpha), and the
    interval of the ratio lies above `factor`; "better" is its mirror image. "same": the interval
    lies within a factor. All else is "undetermined": too few rounds, too noisy, or in between.
    The trimmed mean's error is Tukey and McLaughlin's (Sankhyā A 25, 1963), in logarithms; it grows
    with the rounds' autocorrelation. Raises ValueError for what is no positive time, an empty
    probe, a factor of at most 1 or a share beyond 0 and 1. O(n log n), a millisecond.
    """
    if not (factor > 1 and 0 <= least_share <= 1):
        raise ValueError(f"factor must be over 1, a share in 0 to 1: {factor}, {least_share}")
    old, new = _logs("before", before), _logs("after", after)
    old_probe, new_probe = _logs("probe_before", probe_before), _logs("probe_after", probe_after)
    if not old_probe.size or not new_probe.size:
        raise ValueError("a probe was never read: times of two runs compare only beside one")
    if min(len(old), len(new)) < 3:
        return Comparison("undetermined", np.nan, 0.0, np.inf, 1.0)
    changes = [_change(old, new, old_probe, new_probe, share) for share in (1.0, least_share)]
    low = float(np.exp(min(change - margin for change, margin in changes)))
    high = float(np.exp(max(change + margin for change, margin in changes)))
    faster = float(np.median(new_probe) - np.median(old_probe))
    p = max(_rank_p(old, new - share * faster) for share in (1.0, least_share))
    decidable = 2 / comb(len(old) + len(new), len(old)) < alpha
    outcome = _outcome(low, high, factor, p < alpha) if decidable else "undetermined"
    return Comparison(outcome, float(np.exp(changes[0][0])), low, high, p)


def _outcome(low: float, high: float, factor: float, significant: bool) -> Outcome:
    if significant and low > factor:
        return "worse"
    if significant and high < 1 / factor:
        return "better"
    return "same" if 1 / factor < low and high < factor else "undetermined"


def _logs(name: str, times: Sequence[float]) -> Array:
    values = np.asarray(times, dtype=np.float64).ravel()
    if not np.all(np.isfinite(values) & (values > 0)):
        raise ValueError(f"{name} must be positive, finite times")
    logs: Array = np.log(values)
    return logs


def _change(
    old: Array, new: Array, old_probe: Array, new_probe: Array, share: float
) -> tuple[float, float]:
    """Logarithm of the ratio, less that share of the probe's, and the margin on either side."""
    signs, total, spread = (-1, 1, share, -share), 0.0, 0.0
    ties = [_tie([old, new])] * 2 + [_tie([old_probe, new_probe])] * 2
    change = 0.0
    for logs, sign, tie in zip((old, new, old_probe, new_probe), signs, ties, strict=True):
        center, variance, freedom = _center(logs)
        change += sign * center
        total += sign**2 * variance * tie
        spread += (sign**2 * variance * tie) ** 2 / freedom
    margin = float(t.ppf(CONFIDENCE, total**2 / spread)) * float(np.sqrt(total))
    return change, margin


def _center(logs: Array) -> tuple[float, float, int]:
    """Trimmed mean, the variance of that mean, and its degrees of freedom."""
    n = len(logs)
    if n < 3:
        return float(logs.mean()), SINGLE_ERROR**2, 10
    cut = n // TRIMMED
    ranked = np.sort(logs)
    kept = n - 2 * cut
    winsorized = np.clip(logs, ranked[cut], ranked[n - cut - 1])
    variance = winsorized.var(ddof=1) / n * (n / kept) ** 2
    least = 1e-12  # where all rounds took as long
    return float(ranked[cut : n - cut].mean()), max(variance, least), kept - 1


def _tie(pair: list[Array]) -> float:
    """How many rounds count as one, from how much each resembles the one before: (1+r)/(1-r).

    Ranks stand for the rounds, as a single delayed round would hide what the others share. So few
    of them tell r too low, by (1+3r)/n (Kendall, Biometrika 41, 1954), and badly: what chance alone
    would show is taken off.
    """
    off = [rankdata(rounds) - (len(rounds) + 1) / 2 for rounds in pair if len(rounds) > 2]
    power = sum(float(it @ it) for it in off)
    if power == 0:
        return 1.0
    count = sum(len(it) for it in off)
    r = sum(float(it[1:] @ it[:-1]) for it in off) / power
    r += (1 + 3 * r) * len(off) / count - 1 / np.sqrt(count)
    r = float(np.clip(r, 0, 0.9))
    return (1 + r) / (1 - r)


def _rank_p(old: Array, new: Array) -> float:
    """Mann-Whitney's p that one run's rounds are larger by more than the drift, two-sided."""
    few = len(old) * len(new) <= LARGEST_EXACT
    tied = len(np.unique(np.concatenate([old, new]))) < len(old) + len(new)
    method: Literal["exact", "asymptotic"] = "exact" if few and not tied else "asymptotic"
    drift = np.log(DRIFT) * np.sign(np.median(new) - np.median(old))
    alternative: Literal["greater", "less"] = "greater" if drift >= 0 else "less"
    one_sided = mannwhitneyu(new - drift, old, alternative=alternative, method=method).pvalue
    return float(min(2 * one_sided, 1.0))
