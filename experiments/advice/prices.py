"""What a query or an operation costs on a structure, by size, from the measurements of a run.

And so what a workload takes there: every row times its price, building, and its own part.
"""

from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from experiments.advice.workload import Row, Workload
from experiments.claims import Curve, curves
from experiments.harness import ANSWERING, IRREGULAR
from experiments.runs import Run
from hem.arrays import Array, Triangles
from hem.contract import ANEW, CHECKED, COMPILED, OPERATIONS, PYTHON, is_edit
from hem.meshes import foretold
from structures import REGISTRY

BY_QUERY = {"face_left_of": "edge_faces", "diamond": "edge_faces", "are_joined": "vertex_vertices"}
"""What kernels beside the queries are priced as: what they mostly do."""

REBUILDING, ALONE = "flip_edge", "split_face"
"""Where an edit has all neighbors found anew, the one takes that, and the other does without."""

MOVING, MOVING_ALL = "face_vertices", "vertex_faces"
"""What moving a vertex is priced as: one row is written, or those of all triangles around it, where
each has its position."""

CALL = 9e-7
"""Seconds that an operation takes longer from Python, for a run that did not measure it, or a
baseline, which keeps batches alone: so it was in the standard run that it is of."""

ASKING = 0.27
"""Part of that which a query takes longer, as it tells of no edit: one by one it took 0.36 µs where
a flip took 1.33, on another machine 0.60 and 2.77 (`experiments.validation.speed`)."""

FORETOLD = 0.9
"""How much is ``foretold`` of a regular mesh, at the least. A processor foretells it, too: where it
cannot, a walk takes up to 2.5 times as long on triangle-neighbor, and 1.2 times on half-edges."""

BEYOND = 0.25
"""How much less sure a price is for every factor e beyond the sizes that were measured."""

UNMODELED = 0.45
"""How far a logarithm is off beside what rounds and sizes tell: what is asked in a program finds
other things in the caches than what is asked alone. Chosen so that nine of ten of the workloads in
`experiments.validation.advice` lie within."""

SIGMAS = 1.645
"""Nine of ten should lie within."""

BUILDING, OWN = "build", "own"


class Price(NamedTuple):
    """Seconds, and how far their logarithm may be off (one standard deviation)."""

    seconds: float
    spread: float


class Prices:
    """The prices of a run on a ``family``, or on the regular one that it judges by.

    What it has not measured has none: KeyError that says what. What it has measured on regular
    meshes alone has the price of those.
    """

    def __init__(self, run: Run, family: str = "") -> None:
        self.run, self.family = run, family
        self._points = cache(lambda *case: _points(self._curve(*case)))

    def like(self, triangles: Triangles) -> "Prices":
        """The prices on meshes as regular as this one, if the run has measured any."""
        return self if foretold(triangles) >= FORETOLD else self.irregular

    @cached_property
    def irregular(self) -> "Prices":
        """The prices on irregular meshes, as models are; these, if the run has measured none."""
        measured = (self.run.cases["family"] == IRREGULAR).any()
        return Prices(self.run, IRREGULAR) if measured and not self.family else self

    def price(
        self, structure: str, what: str, faces: float, in_order: float = 0.0, caller: str = ""
    ) -> Price:
        """What one costs on a mesh of so many faces, ``in_order`` the share that is asked so."""
        name = BY_QUERY.get(what, what).removeprefix(CHECKED)
        kind = REGISTRY[structure]
        rebuilds = kind.rebuilds
        if name == "move_vertex":
            name = MOVING_ALL if kind.searches_to_move else MOVING
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
        call = self.call if caller == PYTHON and kind.compiled else 0.0
        call *= 1 if what.removeprefix(CHECKED) in OPERATIONS else ASKING
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
        asked = self.run.cases.query("experiment == 'bench_queries' and valence.isna()")
        sizes = asked["faces"].astype(float)
        return (sizes.min(), sizes.max()) if len(sizes) else (float("nan"), float("nan"))

    @cached_property
    def structures(self) -> frozenset[str]:
        """Those that the run has timed queries of."""
        return frozenset(self.run.cases.query("experiment == 'bench_queries'")["structure"])

    @cached_property
    def step(self) -> float:
        """Seconds per step of the calibration loop, the median beside all rounds."""
        loops = self.run.cases["calibration"]
        return float(loops[loops.map(len) > 0].map(np.median).median())

    @cached_property
    def call(self) -> float:
        """Seconds that an operation takes longer from Python."""
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

    def _curve(self, *case: str) -> Curve:
        found = curves(self.run).named(*case, family=self.family)
        return found if len(found) or not self.family else curves(self.run).named(*case)

    def _at(self, faces: float, *case: str) -> Price:
        """``case``: experiment, structure, subject and order."""
        sizes, costs, spreads = self._points(*case)
        if not len(sizes):
            raise KeyError(f"the run has not measured {' '.join(filter(None, case))}")
        x = np.log(max(faces, 1.0))
        within = float(np.clip(x, sizes[0], sizes[-1]))
        cost, spread = np.interp(within, sizes, costs), np.interp(within, sizes, spreads)
        slope = np.polyfit(sizes[-3:], costs[-3:], 1)[0] if len(sizes) > 1 else 0.0
        seconds = np.exp(cost + np.clip(slope, 0.0, 1.0) * max(x - within, 0.0))
        return Price(float(seconds), float(spread + BEYOND * abs(x - within)))


def _points(curve: Curve) -> tuple[Array, Array, Array]:
    """Logarithms of sizes and costs, and how far these may be off: rounds and bends."""
    costs = np.log(np.maximum(curve.centers, 1e-12))
    spread = [np.subtract(*np.log(np.quantile(it, (0.84, 0.16)))) / 2 for it in curve.samples]
    bends = np.zeros(len(costs))
    bends[1:-1] = costs[1:-1] - (costs[:-2] + costs[2:]) / 2
    return np.log(curve.sizes), costs, np.hypot(spread, bends)


@dataclass(frozen=True)
class Forecast:
    """Seconds of a workload on a structure: the interval, and what each part takes.

    ``untold``: what the run does not tell the price of, which is left out.
    """

    structure: str
    seconds: float
    low: float
    high: float
    parts: dict[str, float] = field(default_factory=dict)
    untold: tuple[str, ...] = ()


def predict(prices: Prices, workload: Workload, structure: str, faces: float) -> Forecast:
    """What a workload takes on a structure and a mesh of so many faces; ValueError for no end."""
    more = sum(row.gain * row.count(faces, workload.frames) for row in workload.rows)
    middle = max(8.0, faces / 8, faces + more / 2)  # faces half-way through the edits
    found: dict[str, list[Price]] = {}
    untold = []
    for row in _with_anew(workload.rows):
        try:
            one = prices.price(structure, row.what, middle, row.in_order, row.caller)
        except KeyError:
            untold.append(row.what)
            continue
        times = workload.often * row.count(faces, workload.frames)
        found.setdefault(row.what, []).append(Price(times * one.seconds, one.spread))
    if workload.builds:
        if built := prices.build(structure, faces):
            found[BUILDING] = [Price(workload.builds * built.seconds, built.spread)]
        else:
            untold.append(BUILDING)
    if own := _own(prices, workload, faces):
        found[OWN] = [Price(own, 0.0)]
    parts = {what: sum(it.seconds for it in costs) for what, costs in found.items()}
    if not (total := sum(parts.values())) < np.inf:
        raise ValueError(f"{workload.title!r} takes longer than a number tells: ask for less")
    shares = [it.seconds * it.spread / total for costs in found.values() for it in costs if total]
    reach = np.exp(SIGMAS * np.hypot(UNMODELED, np.linalg.norm(shares)))
    low, high = float(total / reach), float(total * reach)
    return Forecast(structure, total, low, high, parts, tuple(dict.fromkeys(untold)))


def _own(prices: Prices, workload: Workload, faces: float) -> float:
    """The program's own part: what the whole was measured to take beside what is predicted of it.

    In proportion to how much there is to do.
    """
    if (known := workload.measured) is None:
        return 0.0
    there = 2.0 * known.vertices
    alone = predict(prices, replace(workload, measured=None), known.structure, there)
    then, now = (sum(it.count(n, workload.frames) for it in workload.rows) for n in (there, faces))
    return max(0.0, known.seconds - alone.seconds) * (now / then if then else 1.0)


def _with_anew(rows: tuple[Row, ...]) -> tuple[Row, ...]:
    """With rows for neighbors found anew; where none are told, every edit is followed by that."""
    if any(it.what == ANEW for it in rows):
        return rows
    edits = (it for it in rows if is_edit(it.what))
    return (*rows, *(Row(ANEW, it.times, it.each, it.per, 0.0, COMPILED) for it in edits))
