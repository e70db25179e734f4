"""How much of a law is tested: what people wait for, and with ``make test-all`` everything.

Most of the time of a test is that of compiling an algorithm for a structure. So a law about
algorithms is tested on one structure of each kind, and on all of them where nobody waits; there
are more random cases there, too.
"""

import os
from collections.abc import Collection, Iterable
from typing import Any

import pytest

from hem.contract import Navigable
from structures import NAMES, REGISTRY

EVERYTHING = os.environ.get("HEM_TEST") == "everything"


def some(count: int) -> int:
    """How many of so many random cases are tried."""
    return count if EVERYTHING else -(-count // 6)


def apart(step: int) -> int:
    """How far apart the elements are that are edited, of one in so many."""
    return step if EVERYTHING else 5 * step


exhaustive = pytest.mark.exhaustive
"""A test of what is tested otherwise, too, with other data; or that waits for many processes."""


def waiting_for(few: Collection[Any], every: Iterable[Any]) -> list[Any]:
    """The parameters of a test, or tuples of some: but for a few they are ``exhaustive``."""
    rows = ((it, it if isinstance(it, tuple) else (it,)) for it in every)
    return [pytest.param(*row, marks=() if it in few else exhaustive) for it, row in rows]


_half_edges_first = sorted(NAMES, key=lambda name: not issubclass(REGISTRY[name], Navigable))
_chosen = {(REGISTRY[it].compiled, REGISTRY[it].searches): it for it in reversed(_half_edges_first)}

OF_EACH_KIND = NAMES if EVERYTHING else tuple(it for it in NAMES if it in _chosen.values())
"""One structure that searches, one that has half-edges, and one of objects; or all of them."""

QUICK_TO_COMPILE = tuple(it for it in OF_EACH_KIND if EVERYTHING or not REGISTRY[it].searches)
"""Of these the latter two, or all: for a search an algorithm may take ten seconds to compile."""
