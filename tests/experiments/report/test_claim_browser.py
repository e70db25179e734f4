"""The claim browser has every claim once, with its words, its figure and its data."""

import csv
import io
from xml.etree import ElementTree

import pytest

from experiments.claims import MEMORY, judge_run, load_claims, sentence_claims
from experiments.harness import Axis
from experiments.report import pages
from experiments.report.figures import claims as figures
from experiments.report.figures import growth
from experiments.report.session import Session, claim_file
from experiments.runs import load
from tests.experiments.made_runs import SIZES, rewrite, write_run

READ = "bench_work"


@pytest.fixture(scope="module")
def claims(session):
    return {judged.claim.key: judged for judged in session.claims}


def test_every_claim_stands_in_the_browser_once_with_its_data(session):
    shown = pages.browser(session)
    keys = [claim.key for claim in (*load_claims(), *sentence_claims())]
    assert shown.count("<details") == shown.count('class="words"') == len(keys)
    for key in keys:
        assert shown.count(f'id="{key}"') == 1
        assert f'href="claims/{key.replace("/", ".")}.csv"' in shown


def test_every_filter_counts_the_claims_that_it_leaves(session):
    values = {
        "outcome": [str(judged.outcome) for judged in session.claims],
        "claimed": [str(judged.claim.claimant) for judged in session.claims],
        "structure": [judged.claim.structure for judged in session.claims],
        "kind": [judged.claim.table for judged in session.claims],
    }
    offered = pages.filters(session.claims)
    assert offered.keys() == values.keys()
    for group, choices in offered.items():
        assert {value: count for value, (_, count) in choices.items()} == {
            value: values[group].count(value) for value in choices
        }


def test_the_data_of_a_claim_are_the_cases_it_was_judged_by(session, claims):
    data = figures.data(session, claims["half_edge/vertex_faces"])
    rows = list(csv.DictReader(io.StringIO(data)))
    work = [row for row in rows if (row["measure"], row["variable"]) == ("work", "faces")]
    assert [int(row["faces"]) for row in work] == SIZES
    assert {float(row["center"]) for row in work} == {20.0}
    assert {row["unit"] for row in rows if row["measure"] == "time"} == {"seconds"}


def test_of_what_was_not_measured_there_are_no_data_and_of_what_reads_nothing_no_access(tmp_path):
    write_run(tmp_path, only=lambda experiment, structure: experiment in ("bench_memory", READ))
    rewrite(tmp_path, READ, "indexed", lambda it: {"samples": [0.0]})
    run = load(tmp_path)
    session = Session(run, judge_run(run))
    told = {it.claim.key: figures.data(session, it).splitlines() for it in session.claims}
    assert "vertex.point" in told[f"half_edge/{MEMORY}"][1]
    assert len(told["half_edge/split_edge"]) == 1  # it has bytes, but they are not of a split
    assert all("is shown" not in it.claim.text for it in session.claims if not it.was_measured)
    heads, *rows = csv.reader(told["indexed/edge_vertices"])
    assert heads == told["half_edge/split_edge"][0].split(",")
    assert rows
    assert {row[heads.index("center")] for row in rows} == {"0"}


def test_bytes_are_given_by_field(session, claims):
    data = figures.data(session, claims[f"indexed/{MEMORY}"])
    assert data.splitlines()[1] == "1000,8,vertex.point,36000,printed"


@pytest.mark.parametrize(
    ("key", "count"), [("half_edge/vertex_faces", 5), ("half_edge/split_edge", 4)]
)
def test_a_cell_has_a_panel_for_each_of_its_verdicts(session, claims, key, count):
    figure = figures.draw(session, claims[key])
    assert len(claims[key].verdicts) == len(figure.axes) == count


def test_nothing_but_a_query_is_said_to_be_timed_in_an_order(session, claims):
    for key, told in (("half_edge/vertex_faces", True), ("half_edge/split_edge", False)):
        titles = [axes.get_title("left") for axes in figures.draw(session, claims[key]).axes]
        assert ("time in order, ns" in titles, titles.count("time, ns")) == (told, 2 - told)
        page = pages.browser(session)
        entry = page[page.index(f'id="{key}"') :].partition("</details>")[0]
        assert ("time in order by n_t" in entry) == told
    figure = growth.listings(session.run, Axis.TIME_FACES)
    assert {it.get_ylabel() for it in figure.axes} == {"", "time, µs"}


def test_every_measured_claim_has_a_figure_that_is_whole(session, tmp_path):
    some = session.claims[:: len(session.claims) // 12]
    figures.write_claims([judged.claim.key for judged in some], tmp_path)
    for judged in some:
        name = claim_file(judged)
        assert (tmp_path / f"{name}.csv").read_text()
        root = ElementTree.parse(tmp_path / f"{name}.svg").getroot()
        assert float(root.get("width", "0").rstrip("pt")) > 100


def test_what_was_not_measured_has_no_figure(tmp_path):
    run = load(write_run(tmp_path, only=lambda experiment, structure: experiment == "bench_work"))
    session = Session(run, judge_run(run))
    judged = next(it for it in session.claims if it.claim.subject == MEMORY)
    assert figures.draw(session, judged) is None
