"""Tables: every claim and its mark, in 80 columns, and numbers as they were measured."""

from __future__ import annotations

import re

import pytest
from rich.console import Console

from experiments.claims import judge_run
from experiments.report import comparisons
from experiments.report.pages import verdicts
from experiments.report.session import share
from experiments.report.tables import digits, duration, markdown, show_claims
from experiments.runs import load
from structures import NAMED, NAMES


@pytest.fixture(scope="module")
def run(base_folder):
    return load(base_folder)


@pytest.mark.parametrize(
    ("value", "count", "written"),
    [(0.364, 2, "0.36"), (77.12, 2, "77"), (6363.6, 3, "6,360"), (0.0, 2, "0"), (6.333, 3, "6.33")],
)
def test_numbers_are_written_with_the_digits_that_count(value, count, written):
    assert digits(value, count) == written


@pytest.mark.parametrize(
    ("seconds", "written"), [(3.14e-6, "3.1 µs"), (9.99e-7, "1.0 µs"), (0.25, "250 ms")]
)
def test_times_have_the_unit_that_suits_them(seconds, written):
    assert duration(seconds) == written


@pytest.mark.parametrize("every", [False, True])
@pytest.mark.parametrize("slopes", [False, True])
def test_the_table_fits_80_columns_and_cuts_nothing(run, capsys, every, slopes):
    show_claims(run.folder, Console(width=80), every, slopes)
    text = capsys.readouterr().out
    assert all(len(line) <= 80 for line in text.splitlines())
    assert "…" not in re.sub(r"\d…-?\d", "", text)
    for name in NAMES:
        head = NAMED[name].title if slopes else NAMED[name].abbreviation
        assert (head in text.split()) == (every or NAMED[name].thesis) or " " in head


def test_the_tables_as_markdown_have_every_mark(run):
    claims = judge_run(run)
    text = markdown(claims, "queries")
    assert "| Bytes per vertex | 36 ✓ | 116 ✓ | 228 ✓ | 228 ✓ |" in text
    assert "| Split edge | O(1) ✓ | O(n_t) ✓ |" in markdown(claims, "listings")


def test_a_table_of_a_page_leads_to_every_claim(run):
    share(None)
    claims = judge_run(run)
    text = verdicts(claims, "operations")
    for judged in claims:
        if judged.claim.table == "operations":
            assert f'href="index.html#{judged.claim.key}"' in text


def test_walks_and_scans_are_told_apart_by_their_growth(run):
    row = r"<td>(walk|jump and walk|scan)</td><td>([\d.]+) "
    slopes = dict(re.findall(row, comparisons.face_finding(run)))
    expected = {"walk": 1 / 2, "jump and walk": 1 / 3, "scan": 1}
    assert {way: float(slope) for way, slope in slopes.items()} == pytest.approx(expected, abs=0.05)


def test_structures_are_compared_with_the_indexed_mesh_at_its_size(run):
    text = comparisons.shattering(run)
    assert re.search(r"<td>Half-Edge</td><td>100,000</td>.*<td>200,000</td></tr>", text)
    assert re.search(r"<td>Indexed</td>.*<td>1\.0</td></tr>", text)
