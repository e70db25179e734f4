"""The verdict board has every claim once, with its words, its plots and its data."""

from __future__ import annotations

import csv
import io
from xml.etree import ElementTree

import numpy as np
import pytest

from experiments.claims.growth import MEMORY, load_claims
from experiments.claims.judged import judged
from experiments.claims.sentences import QUANTITIES
from experiments.report import claim_browser, svg
from experiments.report.chapters import CHAPTERS
from experiments.report.entries import KINDS, entries, key_of
from experiments.runs.results import load
from tests.experiments.made_runs import SIZES, write_run


@pytest.fixture(scope="module")
def every(tmp_path_factory):
    run = load(write_run(tmp_path_factory.mktemp("run")))
    return entries(run, judged(run))


def test_every_claim_has_one_entry_under_a_key_of_its_own(every):
    keys = [it.key for it in every]
    cells = [key_of(it.table, it.structure, it.subject) for it in load_claims()]
    assert len(keys) == len(set(keys))
    assert set(keys) == {*cells, *(f"sentence/{it}" for it in QUANTITIES)}
    assert {it.kind for it in every} == set(KINDS)


def test_every_claim_stands_on_the_board_with_its_words_its_source_and_its_data(every):
    shown = claim_browser.board(every, CHAPTERS)
    for it in every:
        assert f'id="{it.key}" data-outcome="{it.outcome}"' in shown
        assert f'href="claims/{it.file}.csv"' in shown
    assert shown.count("<details") == shown.count('class="words"') == len(every)


def test_a_cell_has_a_plot_for_each_of_its_verdicts(every):
    for it in every:
        if it.verdicts:
            names = [f"{measure}_{variable}" for measure, variable in it.verdicts]
            assert [plot.name for plot in it.plots] == names
            assert "work_faces" in names
        elif it.outcome != "undetermined":
            assert len(it.plots) == 1


def test_the_data_of_a_claim_are_the_cells_it_was_judged_by(every):
    claim = next(it for it in every if it.key == "half_edge/vertex_faces")
    rows = list(csv.DictReader(io.StringIO(claim.data)))
    work = [it for it in rows if (it["measure"], it["variable"]) == ("work", "faces")]
    assert [int(it["faces"]) for it in work] == SIZES
    assert {float(it["center"]) for it in work} == {20.0}
    assert {it["unit"] for it in rows if it["measure"] == "time"} == {"seconds"}


def test_bytes_are_given_by_field(every):
    claim = next(it for it in every if it.key == f"indexed/{MEMORY}")
    assert claim.data.splitlines()[1] == "1000,8,vertex.point,36000"
    assert claim.found == "36"


def test_every_drawing_is_whole_and_its_marks_lie_inside(every):
    for it in every:
        for plot in it.plots:
            root = ElementTree.fromstring(plot.drawing)
            width, height = (float(root.get(side, 0)) for side in ("width", "height"))
            circles = list(root.iter("{http://www.w3.org/2000/svg}circle"))
            assert circles
            for circle in circles:
                assert 0 <= float(circle.get("cx", -1)) <= width, (it.key, plot.name)
                assert 0 <= float(circle.get("cy", -1)) <= height, (it.key, plot.name)


def test_files_are_written_for_all_that_the_board_shows(every, tmp_path):
    claim_browser.write_files(every, tmp_path)
    names = {path.name for path in (tmp_path / "claims").iterdir()}
    assert len(names) == len(every) + sum(len(it.plots) for it in every)


def test_an_axis_takes_its_ends_to_its_ends_and_has_some_ticks():
    rng = np.random.default_rng(0)
    for _ in range(200):
        values = 10 ** rng.uniform(-2, 6, 1) * np.array([1, 10 ** rng.uniform(0, 5)])
        axis = svg.logarithmic(values, 40, 300)
        assert axis([axis.low, axis.high]) == pytest.approx([40, 300])
        assert (axis(values) >= 40).all()
        assert (axis(values) <= 300).all()
        assert 2 <= len(axis.ticks()) <= 8
        assert all(axis.low <= it <= axis.high for it in axis.ticks())
        straight = svg.Axis(values[0], values[0] + rng.uniform(0.01, 99), 0, 1, logarithmic=False)
        assert 2 <= len(straight.ticks()) <= 10
