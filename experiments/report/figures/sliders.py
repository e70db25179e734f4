"""Advice to play with: sliders for a mesh and a workload, and the structures in order."""

from __future__ import annotations

from typing import Any

import numpy as np

from experiments.advice import PRESETS, Prices
from experiments.report.pages import Html, page
from experiments.report.session import MissingError
from experiments.runs import Run
from structures import REGISTRY

POINTS = 9
"""Sizes that prices are given at; between them their logarithms follow straight lines."""


def advice_sliders(run: Run) -> Html:
    """The prices of a run, for what the presets count, in a page part that needs nothing else.

    Raises MissingError where the run has not measured them.
    """
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
    data = {"sizes": sizes.tolist(), "structures": structures, "workloads": _presets()}
    return page("sliders.html.j2", data=data)


def _prices(prices: Prices, name: str, whats: list[str], sizes: Any) -> dict[str, Any]:
    """Seconds by what is asked: at random and in order, at each size."""
    costs = {
        what: [
            [float(f"{prices.price(name, what, n, share).seconds:.3g}") for n in sizes]
            for share in (0.0, 1.0)
        ]
        for what in whats
    }
    return {"title": REGISTRY[name].title, "costs": costs}


def _presets() -> list[dict[str, Any]]:
    """Rows as ``[what, times, faces each, per frame, in order, edit]``."""
    return [
        {
            "title": it.title,
            "frames": it.frames,
            "rows": [
                [row.what, row.times, row.share_of_faces, row.per_frame, row.in_order, row.edits]
                for row in it.rows
            ],
        }
        for it in PRESETS.values()
    ]
