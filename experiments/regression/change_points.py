"""Where a series of figures, one per commit, steps from one level to another.

Counts and bytes are exact: every other value is a step. Times are noisy: `ruptures` finds the best
places for any number of steps, and an F test how many the series' own noise does not explain.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import comb, log

import numpy as np
import ruptures
from numpy.typing import ArrayLike
from scipy.stats import f as f_distribution

from hem.arrays import Floats

ALARM = 2e-3
"""The share of series of nothing but normal noise in which a step may be found, at most: less than
one false step in the three hundred series that the claims of a preset are on one machine."""
SHORTEST = 3  # noisy values that make a level: a step is seen from the third value after it on
SMALLEST = 0.05  # noisy steps below this ratio are not told: real or not, they matter to nobody
FARTHEST = 4.0  # standard deviations from its surroundings at which a value is cut off
MOST = 6  # steps in one series


@dataclass(frozen=True)
class Step:
    """A new level. ``index``: its first value; ``before``, ``after``: the levels' medians."""

    index: int
    before: float
    after: float


def find_steps(values: ArrayLike, *, exact: bool = False) -> list[Step]:
    """The steps in ``values``: (n,) in the order of the commits, none of them missing.

    exact: the values have no noise, and may be anything. Else they are positive, and their noise is
    relative; a series of less than ``2 * SHORTEST`` has no step. Takes milliseconds for a hundred
    values.
    """
    series = np.asarray(values, np.float64)
    if not len(series):
        return []
    starts = np.flatnonzero(np.diff(series)) + 1 if exact else _noisy(np.log(series))
    levels = [float(np.median(it)) for it in np.split(series, starts)]
    steps = map(Step, map(int, starts), levels, levels[1:])
    return [it for it in steps if exact or abs(log(it.after / it.before)) >= log(1 + SMALLEST)]


def _noisy(series: Floats) -> list[int]:
    """The first indices of the levels: more of them as long as the noise does not explain it.

    One step more is tried and then two, as what goes up and comes down again shows only whole.
    """
    series = _hampel(series)
    most = min(MOST, len(series) // SHORTEST - 1)
    search = ruptures.KernelCPD(kernel="linear", min_size=SHORTEST).fit(series[:, None])
    # Places for 0, 1, 2 … steps: of the least squares around them.
    best = [[], *(search.predict(count)[:-1] for count in range(1, most + 1))]
    chosen, more = 0, 1
    while more <= 2 and chosen + more < len(best):
        if _chance(series, best[chosen], best[chosen + more]) < ALARM / 2:
            chosen, more = chosen + more, 1
        else:
            more += 1
    levels = pairwise(np.split(series, best[chosen]))
    return [start for start, it in zip(best[chosen], levels, strict=True) if _parted(*it)]


def _parted(before: Floats, after: Floats) -> bool:
    """Whether the values that meet are of two levels: one too short to tell takes in another's."""
    middle = (before.mean() + after.mean()) / 2
    return bool((before[-1] - middle) * (after[0] - middle) < 0)


def _hampel(series: Floats) -> Floats:
    """The series, with what stands out of its surroundings cut off: one slow run is no level."""
    around = np.array([np.median(series[max(k - 2, 0) : k + 3]) for k in range(len(series))])
    off = series - around
    if not off.any():
        return series
    spread = np.median(np.abs(off[off != 0]))  # one in five is the median itself, and tells nothing
    reach = FARTHEST * 1.4826 * float(spread)
    return around + np.clip(off, -reach, reach)


def _chance(series: Floats, fewer: Sequence[int], more: Sequence[int]) -> float:
    """A bound on the chance that noise gains as much from as many more steps, placed at best."""
    extra, left = len(more) - len(fewer), len(series) - len(more) - 1
    rest = _squares(series, more)
    gained = max(_squares(series, fewer) - rest, 0.0)
    if rest <= 1e-24 * gained:
        return 0.0 if gained > 0 else 1.0
    places = comb(len(series) - 2 * SHORTEST + 1, extra)
    return float(places * f_distribution.sf(gained / extra / (rest / left), extra, left))


def _squares(series: Floats, starts: Sequence[int]) -> float:
    return float(sum(((it - it.mean()) ** 2).sum() for it in np.split(series, starts)))
