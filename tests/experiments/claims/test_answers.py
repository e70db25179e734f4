"""The front page's sentences: numbers of the run, and an open word where there are none."""

from __future__ import annotations

import re

import pytest

from experiments.claims import answers
from experiments.claims.answers import CONDITIONS, NUMBERS, Findings, Number
from experiments.claims.judged import judged
from experiments.report.chapters import CHAPTERS
from experiments.report.entries import entries
from experiments.runs.results import load
from tests.experiments.made_runs import BUILD, LAWS, SIZES, write_run

ROWS = answers._content()["answer"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return load(write_run(tmp_path_factory.mktemp("run")))


@pytest.fixture(scope="module")
def table(run):
    return judged(run)


def without(run, experiment: str):
    cases = run.cases[~run.cases["experiment"].str.startswith(experiment)]
    return type(run)(run.folder, run.meta, cases.reset_index(drop=True), run.skipped)


@pytest.mark.parametrize(
    ("value", "spec", "written"),
    [
        (12345.1, "count", "12,346"),
        (3.14e-6, "time", "3.1 µs"),
        (9.99e-7, "time", "1.0 µs"),
        (0.25, "time", "250 ms"),
        (6.3333, "factor", "6.33"),
        (0.364, "factor", "0.36"),
        (77.12, "factor", "77"),
        (6363.6, "factor", "6,360"),
        (228.0, "plain", "228"),
        (0.0, "factor", "0"),
    ],
)
def test_numbers_are_written_with_the_digits_that_count(value, spec, written):
    assert f"{Number(value):{spec}}" == written


def test_there_are_five_and_every_name_in_them_is_known():
    assert len(ROWS) == 5
    for row in ROWS:
        for template in filter(None, (row["says"], row.get("otherwise"))):
            assert set(answers.names(template)) <= set(NUMBERS)
        assert not answers.names(row["missing"])
        assert ("otherwise" in row) == ("holds" in row)
        assert row.get("holds", "soon_even") in CONDITIONS


def test_numbers_are_those_of_the_run(run, table):
    found = Findings(run, table)
    assert NUMBERS["ring_faces"](found) == max(SIZES)
    law = LAWS["O(n_t)"](max(SIZES), 6)
    assert NUMBERS["ring_indexed"](found) == pytest.approx(1e-9 * law, rel=0.1)
    assert NUMBERS["build_ratio"](found) == pytest.approx(BUILD["half_edge"] / BUILD["indexed"])
    assert NUMBERS["bytes_ratio"](found) == pytest.approx(228 / 36)
    assert NUMBERS["normals_ratio"](found) == pytest.approx(1)
    assert NUMBERS["violated"](found) == 0
    told = [it.text for it in answers.answers(run, table)]
    assert "228 bytes per vertex where an indexed mesh takes 36, 6.33 times" in told[1]


def test_a_number_that_was_not_measured_leaves_a_sentence_that_says_so(run, table):
    for number, lacking in ((0, "bench_queries"), (1, "bench_memory"), (2, "bench_build")):
        told = answers.answers(without(run, lacking), table)
        assert not told[number].measured
        assert told[number].text == ROWS[number]["missing"]
    assert not any(it.measured for it in answers.answers(without(run, "bench"), table[:0]))


def test_what_does_not_hold_is_not_said(run, table, tmp_path):
    said = re.sub(r"\{.*", "", ROWS[4]["says"])
    assert answers.answers(run, table)[4].text.startswith(said)
    wrong = table.copy()
    wrong.loc[wrong["subject"] == "face_faces", "outcome"] = "violated"
    assert answers.answers(run, wrong)[4].text.startswith("Of ")
    assert " 6 violated" in answers.answers(run, wrong)[4].text

    def flat(structure, what, printed):
        return LAWS["O(1)"] if what == "vertex_faces" else None

    other = load(write_run(tmp_path / "flat", flat))
    assert "was not found in this run" in answers.answers(other, judged(other))[0].text


def test_every_sentence_leads_to_a_claim_or_a_chapter(run, table):
    keys = {f"#{it.key}" for it in entries(run, table)} | {"#claims"}
    pages = {f"{name}.html" for name in CHAPTERS}
    for row in ROWS:
        assert row["rests"]
        assert set(row["rests"].values()) <= keys | pages
