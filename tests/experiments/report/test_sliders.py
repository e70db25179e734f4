"""Sliders of advice: the page tells the order that is predicted, from disk and alone."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from experiments.advice import PRESETS, Prices, predict
from experiments.report import MissingError, advice_sliders
from experiments.runs import Run
from structures import REGISTRY
from tests.experiments.chromium import Browser

SHOWN = "[...document.querySelectorAll('tbody tr')].map(row => row.cells[{}].textContent)"
UNITS = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}
SLIDE = """(where, value) => {
    const it = document.querySelector(where);
    it.value = value;
    it.dispatchEvent(new Event('input'));
}"""


@pytest.mark.parametrize(("vertices", "edits"), [(10_000, 1), (100, 1000), (1_000_000, 0.1)])
def test_the_page_tells_what_is_predicted(
    chromium: Browser, run: Run, tmp_path: Path, vertices: float, edits: float
) -> None:
    html = advice_sliders(run)
    assert "://" not in html
    assert "src=" not in html
    page = tmp_path / "sliders.html"
    page.write_text(f"<meta charset=utf-8>{html}", "utf-8")
    prices = Prices(run).irregular
    chromium.open(page.as_uri())
    for name, value in (("vertices", vertices), ("edits", edits)):
        chromium.run(f"({SLIDE})('[name={name}]', {np.log10(value)})")
        said = f"document.querySelector('[name={name}]').ariaValueText"
        assert float(chromium.run(said).replace(",", "")) == value
    for place, (name, workload) in enumerate(PRESETS.items()):
        chromium.run(f"({SLIDE})('select', {place})")
        frames = "document.querySelector('[name=frames]').ariaValueText"
        assert float(chromium.run(frames)) == workload.frames, "not those of its title"
        titles, times, within = (chromium.run(SHOWN.format(it)) for it in range(3))
        assert set(titles) == {it.title for it in REGISTRY.values()}
        given = replace(workload.more_edits(edits), builds=0, measured=None)
        for title, time, interval in zip(titles, times, within, strict=True):
            (structure,) = (it for it, kind in REGISTRY.items() if kind.title == title)
            told = predict(prices, given, structure, 2 * vertices)
            assert seconds(time) == pytest.approx([told.seconds], rel=0.15), (name, title)
            assert seconds(interval) == pytest.approx([told.low, told.high], rel=0.15), (
                name,
                title,
            )
    assert not chromium.errors


def seconds(text: str) -> list[float]:
    """The times that a text names."""
    found = re.findall(r"([\d.,]+) (\w+)", text)
    return [float(number.replace(",", "")) * UNITS[unit] for number, unit in found]


def test_a_run_without_queries_says_so(run: Run) -> None:
    empty = Run(run.folder, run.meta, run.cases[:0], pd.DataFrame())
    with pytest.raises(MissingError, match="has not measured what advice rests on"):
        advice_sliders(empty)
