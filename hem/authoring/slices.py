"""Compiled loops over 0 … n in slices, one per core."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from numba import config

WORTH_A_THREAD = 50_000
"""Items below which a thread costs more than it saves."""

MOST_SLICES = 8
"""The passes are bound by memory, which more cores do not speed up."""


def slice_count(n: int) -> int:
    """How many slices ``in_slices`` cuts ``n`` items into; NUMBA_NUM_THREADS bounds it."""
    return max(1, min(n // WORTH_A_THREAD, int(config.NUMBA_NUM_THREADS), MOST_SLICES))


def in_slices(function: Callable[..., Any], n: int, *arguments: Any) -> list[Any]:
    """Call ``function(begin, end, slice, *arguments)`` for every slice of 0 … n -> the results.

    The slices run side by side if ``function`` is compiled with ``nogil``, so they must not write
    to the same places.
    """
    slices = slice_count(n)
    bounds = [n * i // slices for i in range(slices + 1)]
    calls = [(bounds[i], bounds[i + 1], i, *arguments) for i in range(slices)]
    if slices == 1:
        return [function(*calls[0])]
    with ThreadPoolExecutor(slices) as pool:
        return [task.result() for task in [pool.submit(function, *call) for call in calls]]
