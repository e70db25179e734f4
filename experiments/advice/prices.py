"""What a query or an operation costs on a structure, by size, from the measurements of a run."""

from functools import cache, cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from experiments.claims import Curve, curves
from experiments.harness import ANSWERING
from experiments.runs import Run
from hem.arrays import Array
from hem.contract import OPERATIONS
from hem.contract.recording import ANEW, CHECKED, PYTHON
from structures import REGISTRY

BY_QUERY = {"face_left_of": "edge_faces", "diamond": "edge_faces", "are_joined": "vertex_vertices"}
"""What kernels beside the queries are priced as: what they mostly do."""

REBUILDING, ALONE = "flip_edge", "split_face"
"""Where an edit has all neighbors found anew, the one takes that, and the other does without."""

CALL = 6e-7
"""Seconds of a call from Python, for a run that did not measure it."""

BEYOND = 0.25
"""How much less sure a price is for every factor e beyond the sizes that were measured."""


class Price(NamedTuple):
    """Seconds, and how far their logarithm may be off (one standard deviation)."""

    seconds: float
    spread: float


class Prices:
    """The prices of a run. What it has not measured has none: KeyError that says what."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self._points = cache(lambda *case: _points(curves(run).named(*case)))

    def price(
        self, structure: str, what: str, faces: float, in_order: float = 0.0, caller: str = ""
    ) -> Price:
        """What one costs on a mesh of so many faces, ``in_order`` the share that is asked so."""
        name = BY_QUERY.get(what, what).removeprefix(CHECKED)
        rebuilds = REGISTRY[structure].rebuilds
        if what == ANEW:
            found = self._at(faces, "bench_operations", structure, REBUILDING, "batched")
            return found if rebuilds else Price(0.0, 0.0)
        if name in OPERATIONS:
            # Finding neighbors anew has a row of its own.
            done = ALONE if rebuilds or name not in self._operations else name
            found = self._at(faces, "bench_operations", structure, done, "batched")
        else:
            seconds = spread = 0.0
            for order, share in (("consecutive", in_order), ("random", 1 - in_order)):
                if share > 0:
                    one = self._at(faces, "bench_queries", structure, name, order)
                    seconds, spread = seconds + share * one.seconds, max(spread, one.spread)
            found = Price(seconds, spread)
        call = self.call if caller == PYTHON and REGISTRY[structure].compiled else 0.0
        return Price(found.seconds + call, found.spread)

    def build(self, structure: str, faces: float) -> Price | None:
        """What building takes, until it answers; None if the run does not tell."""
        order = ANSWERING if REGISTRY[structure].rebuilds else "consecutive"
        try:
            return self._at(faces, "bench_build", structure, "", order)
        except KeyError:
            return None

    @cached_property
    def measured(self) -> tuple[float, float]:
        """The fewest and the most faces that queries were measured at."""
        sizes = self.run.cases.query("experiment == 'bench_queries'")["faces"].astype(float)
        return (sizes.min(), sizes.max()) if len(sizes) else (float("nan"), float("nan"))

    @cached_property
    def structures(self) -> frozenset[str]:
        """Those that the run has timed queries of."""
        return frozenset(self.run.cases.query("experiment == 'bench_queries'")["structure"])

    @cached_property
    def step(self) -> float:
        """Seconds per step of the calibration loop, the median beside all rounds."""
        return float(self.run.cases["calibration"].map(np.median).median())

    @cached_property
    def call(self) -> float:
        """Seconds that an operation takes longer from Python; queries are taken to do as well."""
        found = []
        kinds = [it for it in REGISTRY.values() if it.compiled and not (it.rebuilds or it.searches)]
        for kind, operation in product(kinds, self._operations):
            one, many = (
                curves(self.run).named("bench_operations", kind.name, operation, order)
                for order in ("one by one", "batched")
            )
            if len(one) and len(many):
                beside = np.interp(one.sizes[0], many.sizes, many.centers)
                found.append(one.centers[0] - beside)
        return float(np.median(found)) if found else CALL

    @cached_property
    def _operations(self) -> set[str]:
        return set(self.run.cases.query("experiment == 'bench_operations'")["subject"])

    def _at(self, faces: float, *case: str) -> Price:
        """``case``: experiment, structure, subject and order."""
        sizes, costs, spreads = self._points(*case)
        if not len(sizes):
            raise KeyError(f"the run has not measured {' '.join(filter(None, case))}")
        x = np.log(max(faces, 1.0))
        within = float(np.clip(x, sizes[0], sizes[-1]))
        cost, spread = np.interp(within, sizes, costs), np.interp(within, sizes, spreads)
        seconds = np.exp(cost + _slope(sizes, costs) * max(x - within, 0.0))
        return Price(float(seconds), float(spread + BEYOND * abs(x - within)))


def _points(curve: Curve) -> tuple[Array, Array, Array]:
    """Logarithms of sizes and costs, and how far these may be off: rounds and bends."""
    costs = np.log(np.maximum(curve.centers, 1e-12))
    spread = [np.subtract(*np.log(np.quantile(it, (0.84, 0.16)))) / 2 for it in curve.samples]
    bends = np.zeros(len(costs))
    bends[1:-1] = costs[1:-1] - (costs[:-2] + costs[2:]) / 2
    return np.log(curve.sizes), costs, np.hypot(spread, bends)


def _slope(sizes: Array, costs: Array) -> float:
    """Along which a price is carried on beyond the last size."""
    if len(sizes) < 2:
        return 0.0
    return float(np.clip(np.polyfit(sizes[-3:], costs[-3:], 1)[0], 0.0, 1.0))
