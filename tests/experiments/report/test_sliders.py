"""Sliders of advice: the page tells the order that is predicted, from disk and alone."""

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pandas as pd
import pytest

from experiments.advice import PRESETS, Prices, predict
from experiments.report import MissingError, advice_sliders
from experiments.runs import Run
from structures import REGISTRY
from tests.experiments.chromium import Browser

SHOWN = "[...document.querySelectorAll('tbody tr')].map(row => row.cells[0].textContent)"
WITHIN = SHOWN.replace("cells[0]", "cells[2]")
UNITS = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}
CHOOSE = "s => { s.value = {place}; s.dispatchEvent(new Event('input')); }"


def test_the_page_tells_the_predicted_order(chromium: Browser, run: Run, tmp_path: Path) -> None:
    html = advice_sliders(run)
    assert "://" not in html
    assert "src=" not in html
    page = tmp_path / "sliders.html"
    page.write_text(f"<meta charset=utf-8>{html}", "utf-8")
    prices, faces = Prices(run).irregular, 20_000  # the sliders begin at 10,000 vertices
    chromium.open(page.as_uri())
    for place, workload in enumerate(PRESETS.values()):
        chromium.run(f"({CHOOSE.replace('{place}', str(place))})(document.querySelector('select'))")
        costs = {
            REGISTRY[name].title: sum(
                row.count(faces, workload.frames)
                * prices.price(name, row.what, faces, row.in_order).seconds
                for row in workload.rows
            )
            for name in REGISTRY
        }
        shown = [costs[title] for title in chromium.run(SHOWN)]
        assert len(shown) == len(REGISTRY)
        assert all(b > 0.95 * a for a, b in pairwise(shown))
        least = chromium.run(SHOWN)[0]
        (name,) = (name for name, it in REGISTRY.items() if it.title == least)
        told = predict(prices, replace(workload, builds=0, measured=None), name, faces)
        low, high = (
            float(number.replace(",", "")) * UNITS[unit]
            for number, unit in re.findall(r"([\d.,]+) (\w+)", chromium.run(WITHIN)[0])
        )
        assert high / low == pytest.approx(told.high / told.low, rel=0.15)
    assert not chromium.errors


def test_a_run_without_queries_says_so(run: Run) -> None:
    empty = Run(run.folder, run.meta, run.cases[:0], pd.DataFrame())
    with pytest.raises(MissingError, match="has not measured what advice rests on"):
        advice_sliders(empty)
