"""Whether a case became slower: significant by rank *and* large by an interval, or not said.

Rounds of one run are not independent, and two runs of the same code differ by more than their
rounds tell. So rounds are divided by the calibration loop read beside them, as far as they may have
followed it; ranks are compared after a tolerated drift between runs is granted; and the interval of
the trimmed means (Yuen, Biometrika 61, 1974) is widened by how much each round resembles the last.
"""

from collections.abc import Sequence
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import mannwhitneyu, rankdata, ttest_ind

from experiments.regression.findings import Change
from hem.arrays import Array

FACTOR = 1.15  # how much slower is worth telling
ALPHA = 1e-4  # chance of a false alarm that the ranks alone may leave: 9 rounds each can show it
CONFIDENCE = 0.95  # that the ratio lies above the lower end of the interval; likewise the upper one
DRIFT = 1.05  # factor by which runs may differ in their level for no reason in the code
TRIMMED = 0.2  # share of the rounds left out at either end: delays by other tenants move nothing
FEWEST = 3  # rounds below which nothing is computed
LARGEST_EXACT = 2500  # pairs of rounds up to which the rank test is exact, if no two are equal


class Comparison(NamedTuple):
    """What two runs say about one case.

    ratio: time after over time before, both over the calibration loop. low, high: the ends of its
    interval, each crossed with a chance of 1 - `CONFIDENCE`.
    """

    change: Change
    ratio: float
    low: float
    high: float


def compare_rounds(
    before: ArrayLike, after: ArrayLike, loop_before: ArrayLike, loop_after: ArrayLike,
    factor: float = FACTOR,
) -> Comparison:  # fmt: skip
    """Compare the rounds of one case in two runs.

    before, after: seconds per round, in the order they were measured; 9 rounds each can decide.
    loop_before, loop_after: readings of the calibration loop of the same run, one beside each
    round, or one beside all. Any unit will do.

    The loop may slow down beside a case that does not follow it. So a case is worse only if it is
    so both as measured and relative to the loop: its ranks differ by more than `DRIFT` explains
    (Mann-Whitney, p < `ALPHA`), and both intervals lie above ``factor``. "better" is the mirror
    image. "same": both intervals lie within a factor. All else is "undetermined".

    Raises ValueError for what is no positive time, a loop without readings, or a factor of at most
    1. O(n log n), some milliseconds.
    """
    if not factor > 1:
        raise ValueError(f"factor must be over 1, not {factor}")
    old, new = _logs("before", before), _logs("after", after)
    loops = _logs("loop_before", loop_before), _logs("loop_after", loop_after)
    if not all(len(loop) for loop in loops):
        raise ValueError("no calibration loop was read: times of two runs compare only beside one")
    if min(len(old), len(new)) < FEWEST:
        return Comparison(Change.UNDETERMINED, np.nan, 0.0, np.inf)
    relative = old - loops[0], new - loops[1]
    ends = np.exp(_intervals(*zip(relative, (old, new), strict=True)))
    ratio, low, high = float(np.sqrt(ends[0].prod())), float(ends.min()), float(ends.max())
    change = Change.SAME if 1 / factor < low and high < factor else Change.UNDETERMINED
    if low > factor or high < 1 / factor:
        significant = all(_rank_p(*pair) < ALPHA for pair in (relative, (old, new)))
        beyond = Change.WORSE if low > factor else Change.BETTER
        change = beyond if significant else Change.UNDETERMINED
    decidable = 2 / comb(len(old) + len(new), len(old)) < ALPHA
    return Comparison(change if decidable else Change.UNDETERMINED, ratio, low, high)


def _logs(name: str, times: ArrayLike) -> Array:
    values = np.asarray(times, dtype=np.float64).ravel()
    if not np.all(np.isfinite(values) & (values > 0)):
        raise ValueError(f"{name} must be positive, finite times")
    return np.log(values)


def _intervals(old: Sequence[Array], new: Sequence[Array]) -> Array:
    """(k, 2): of k pairs the ends of the difference of the trimmed means."""
    first, second = np.array(old), np.array(new)
    shift = np.median(second, axis=1) - np.median(first, axis=1)
    first, second = (it - np.median(it, axis=1, keepdims=True) for it in (first, second))
    test = ttest_ind(second, first, axis=1, equal_var=False, trim=TRIMMED)
    ends = np.nan_to_num(test.confidence_interval(2 * CONFIDENCE - 1))  # where all took as long
    center, margin = ends.mean(axis=0), (ends[1] - ends[0]) / 2
    margin = margin * np.sqrt([_rounds_in_one(*pair) for pair in zip(old, new, strict=True)])
    return np.stack([shift + center - margin, shift + center + margin], axis=1)


def _rounds_in_one(*pair: Array) -> float:
    """How many rounds count as one, from how much each resembles the one before: (1+r)/(1-r).

    Ranks stand for the rounds, as a single delayed round would hide what the others share. So few
    of them tell r too low, by (1+3r)/n (Kendall, Biometrika 41, 1954), and badly: what chance alone
    would show is taken off.
    """
    off = [rankdata(rounds) - (len(rounds) + 1) / 2 for rounds in pair]
    power = sum(float(ranks @ ranks) for ranks in off)
    if power == 0:
        return 1.0
    count = sum(len(ranks) for ranks in off)
    r = sum(float(ranks[1:] @ ranks[:-1]) for ranks in off) / power
    r += (1 + 3 * r) * len(off) / count - 1 / np.sqrt(count)
    r = float(np.clip(r, 0, 0.9))
    return (1 + r) / (1 - r)


def _rank_p(old: Array, new: Array) -> float:
    """Mann-Whitney's p that one run's rounds are larger by more than the drift, two-sided."""
    few = len(old) * len(new) <= LARGEST_EXACT
    drift = np.log(DRIFT) * np.sign(np.median(new) - np.median(old))
    tied = bool(np.isin(new - drift, old).any())  # only between the two: U is no integer then
    one_sided = mannwhitneyu(
        new - drift, old,
        alternative="greater" if drift >= 0 else "less",
        method="exact" if few and not tied else "asymptotic",
    ).pvalue  # fmt: skip
    return float(min(2 * one_sided, 1.0))
