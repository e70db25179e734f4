"""Advice to play with: sliders for a mesh and a workload, and the structures in order."""

from typing import Any

import numpy as np

from experiments.advice import PRESETS, Prices, Row
from experiments.report.pages import Html, page
from experiments.report.session import MissingError
from experiments.runs import Run
from structures import REGISTRY

POINTS = 9
"""Sizes that prices are given at; between them their logarithms follow straight lines."""


def advice_sliders(run: Run) -> Html:
    """The prices of a run, for what the presets count, on a page; MissingError without them."""
    prices = Prices(run)
    low, high = prices.measured
    if run.machines or not low < high:
        raise MissingError("This run has not measured what advice rests on.")
    sizes = np.geomspace(low, high, POINTS)
    whats = sorted({row.what for it in PRESETS.values() for row in it.rows})
    try:
        structures = [_prices(prices, name, whats, sizes) for name in REGISTRY]
    except KeyError as error:
        raise MissingError(f"This run cannot advise: {error.args[0]}.") from error
    presets = [
        {"title": it.title, "frames": it.frames, "rows": list(map(_row, it.rows))}
        for it in PRESETS.values()
    ]
    data = {"sizes": sizes.tolist(), "structures": structures, "workloads": presets}
    return page("sliders.html.j2", data=data)


def _prices(prices: Prices, name: str, whats: list[str], sizes: Any) -> dict[str, Any]:
    """Seconds by what is asked: at random and in order, at each size."""
    costs = {}
    for what in whats:
        priced = [[prices.price(name, what, n, it).seconds for n in sizes] for it in (0.0, 1.0)]
        costs[what] = [[float(f"{it:.3g}") for it in seconds] for seconds in priced]
    return {"title": REGISTRY[name].title, "costs": costs}


def _row(row: Row) -> list[Any]:
    """What, times, faces each, per frame, in order, edit."""
    return [row.what, row.times, row.share_of_faces, row.per_frame, row.in_order, row.edits]
