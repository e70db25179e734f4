"""What a workload takes on a structure: every row times its price, building, and its own part."""

from dataclasses import dataclass, field, replace

import numpy as np

from experiments.advice.prices import Price, Prices
from experiments.advice.workload import Row, Workload, is_edit
from hem.contract import OPERATIONS
from hem.contract.recording import ANEW, COMPILED

UNMODELED = 0.45
"""How far a logarithm is off beside what rounds and sizes tell: what is asked in a program finds
other things in the caches than what is asked alone. Chosen so that nine of ten of the workloads in
`experiments.validation.advice` lie within."""

SIGMAS = 1.645
"""Nine of ten should lie within."""

BUILDING, OWN = "build", "own"


@dataclass(frozen=True)
class Forecast:
    """Seconds of a workload on a structure: the interval, and what each part takes."""

    structure: str
    seconds: float
    low: float
    high: float
    parts: dict[str, float] = field(default_factory=dict)
    untold: tuple[str, ...] = ()
    """What the run does not tell the price of, which is left out."""


def predict(prices: Prices, workload: Workload, structure: str, faces: float) -> Forecast:
    """What a workload takes on a structure and a mesh of so many faces."""
    middle = _grown(workload, faces)
    found: dict[str, list[Price]] = {}
    untold = []
    for row in _with_anew(workload.rows):
        try:
            one = prices.price(structure, row.what, middle, row.in_order, row.caller)
        except KeyError:
            untold.append(row.what)
            continue
        times = row.count(faces, workload.frames)
        found.setdefault(row.what, []).append(Price(times * one.seconds, one.spread))
    if workload.builds:
        if built := prices.build(structure, faces):
            found[BUILDING] = [Price(workload.builds * built.seconds, built.spread)]
        else:
            untold.append(BUILDING)
    if own := _own(prices, workload, faces):
        found[OWN] = [Price(own, 0.0)]
    parts = {what: sum(it.seconds for it in costs) for what, costs in found.items()}
    total = sum(parts.values())
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


def _grown(workload: Workload, faces: float) -> float:
    """The faces half-way through the edits."""
    more = 0.0
    for row in (it for it in workload.rows if it.what in OPERATIONS):
        gain = OPERATIONS[row.what].growth[1] or LOST.get(row.what, 0)
        more += gain * row.count(faces, workload.frames)
    return max(8.0, faces / 8, faces + more / 2)


LOST = {"collapse_edge": -2, "remove_face": -1}
"""Faces that an operation takes away."""


def _with_anew(rows: tuple[Row, ...]) -> tuple[Row, ...]:
    """With rows for neighbors found anew; where none are told, every edit is followed by that."""
    if any(it.what == ANEW for it in rows):
        return rows
    edits = (it for it in rows if is_edit(it.what))
    return (*rows, *(Row(ANEW, it.times, it.each, it.per, 0.0, COMPILED) for it in edits))
