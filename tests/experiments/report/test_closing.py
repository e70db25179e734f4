"""Laws of what chapters end with: a sentence stands only where the run bears it out."""

import re
from dataclasses import replace

import pandas as pd
import pytest

from experiments.claims import JudgedClaim, Outcome, judge_run
from experiments.harness import Measurement
from experiments.regression import reduce_run
from experiments.report import MissingError, about_run, comparisons, pages, uses
from experiments.report.tables import table_1_in_words
from experiments.runs import CaseFile, Run, load
from hem.contract import QUERIES
from structures import NAMES, REGISTRY, THESIS
from tests.experiments.made_runs import LAWS, SIZES, write_run

HOLDS, DENIED = "half_edge/face_faces", "as_printed/split_edge/listings"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """All claims hold but those on the published splits."""
    folder = write_run(
        tmp_path_factory.mktemp("closing"),
        lambda structure, subject, printed: (
            LAWS["O(n_t)"] if structure == "as_printed" and "split" in subject else None
        ),
        only=lambda _, it: it in (*THESIS, "as_printed") or it not in NAMES,
    )
    latency = CaseFile(folder, "bench_latency", "machine")
    for size in (60 * SIZES[0], 60 * SIZES[-1]):
        seconds = [1e-10 * size / (60 * SIZES[0])]
        latency.add(Measurement(str(size), "time", working_set=size, samples=seconds))
    return load(folder)


@pytest.fixture(scope="module")
def claims(run: Run) -> list[JudgedClaim]:
    return judge_run(run)


@pytest.mark.parametrize(
    ("keys", "follows"),
    [
        ([HOLDS], True),
        ([f"not {DENIED}"], True),
        ([HOLDS, f"not {DENIED}"], True),
        ([DENIED], False),
        ([f"not {HOLDS}"], False),
        ([HOLDS, DENIED], False),
    ],
)
def test_a_sentence_is_borne_out_where_all_that_it_rests_on_is_so(claims, keys, follows) -> None:
    text = pages.closing(claims, {"It is so.": keys})
    assert ("does not bear it out: It is so." in text) != follows
    assert all(f"#{key.removeprefix('not ')}" in text for key in keys)


def test_a_sentence_on_what_cannot_be_told_is_neither_borne_out_nor_denied(claims) -> None:
    unsure = [
        replace(it, outcome=Outcome.UNDETERMINED) if it.claim.key == HOLDS else it for it in claims
    ]
    assert "This run cannot tell: It is so." in pages.closing(unsure, {"It is so.": [HOLDS]})
    assert "does not bear it out: It is so." in pages.closing(
        unsure, {"It is so.": [HOLDS, DENIED]}
    )


def test_what_a_sentence_rests_on_is_told_apart_by_the_words_of_its_links(claims) -> None:
    keys = [it.claim.key for it in claims if it.claim.table == "sentences"]
    links = re.findall(r"<a [^>]*>([^<]+)</a>", pages.closing(claims, {"It is so.": keys}))
    assert len(set(links)) == len(keys) > 30


def test_a_sentence_tells_what_was_found(claims) -> None:
    text = pages.closing(claims, {"It costs {1}, and not {0}.": [HOLDS, f"not {DENIED}"]})
    assert "It costs O(n_t), and not O(1)." in text


def test_a_sentence_cannot_rest_on_a_claim_that_there_is_none_of(claims) -> None:
    with pytest.raises(KeyError, match="half_edge/walks"):
        pages.closing(claims, {"It is so.": ["half_edge/walks"]})


def test_how_much_more_half_edges_take_is_what_they_were_weighed(run) -> None:
    text = comparisons.bytes_in_words(run)
    cases = run.cases.query("experiment == 'bench_memory'")
    for width in (8, 4):
        held = {
            it.structure: it.samples[0] / it.vertices
            for it in cases[cases["reference_bytes"] == width].itertuples()
        }
        assert f"{held['half_edge'] / held['indexed']:.2f} times as many" in text


def test_table_1_is_counted_from_its_cells(claims) -> None:
    assert table_1_in_words(claims).startswith(
        "Of the 30 cells that table 1 of the thesis prints, work and bytes find "
        "30 consistent. By time in order 26 of 26 cells are consistent, 0 violated"
    )


def test_the_fastest_by_valence_is_the_least_of_the_medians(run) -> None:
    table = uses.by_valence(run)
    cases = run.cases[run.cases["valence"].notna() & (run.cases["experiment"] == "bench_queries")]
    for (query, valence), row in table.iterrows():
        asked = cases[(cases["subject"] == query) & (cases["valence"] == valence)]
        medians = {
            it.structure: sorted(it.samples)[len(it.samples) // 2]
            for it in asked.itertuples()
            if REGISTRY[it.structure].compiled
        }
        assert row.to_dict() == pytest.approx(medians)
    assert set(table.index.unique(level=0)) == set(QUERIES)


def test_what_waits_is_told_beside_the_latency(run) -> None:
    text = comparisons.waiting_in_words(run)
    grown = r"grows (0\.9\d|1\.0)-fold in order and (0\.9\d|1\.0)-fold at random"
    assert re.search(grown, text)
    assert "that of a memory access 1,000-fold" in text


def test_a_query_that_reads_nothing_does_no_more_work_on_a_larger_mesh_either(run) -> None:
    counted = run.cases["kind"].eq("work") & run.cases["subject"].eq("edge_vertices")
    unread = run.cases.assign(samples=run.cases["samples"].mask(counted, 0 * run.cases["samples"]))
    told = [comparisons.waiting_in_words(replace(run, cases=it)) for it in (run.cases, unread)]
    assert told[0] == told[1]


@pytest.mark.parametrize(("grown", "waits"), [(1.0, False), (30.0, True), (2_000.0, False)])
def test_a_query_waits_where_its_time_grows_and_by_less_than_an_access(grown, waits) -> None:
    text = pages.part("waiting", 69, (200, 200_000), 1.0, grown, 1_000.0)
    assert ("an O(1) query does not do more, it waits longer" in text) == waits


def test_what_waits_is_not_told_without_the_latency(run) -> None:
    cases = run.cases[run.cases["experiment"] != "bench_latency"]
    with pytest.raises(MissingError, match="counted and timed"):
        comparisons.waiting_in_words(Run(run.folder, run.meta, cases, run.skipped))


def test_what_was_skipped_of_an_experiment_that_is_gone_is_told_by_its_name(run):
    skipped = pd.DataFrame(
        [{"experiment": "bench_gone", "structure": "indexed", "skipped": "too large"}]
    )
    html = str(about_run(Run(run.folder, run.meta, run.cases, skipped)))
    assert "bench_gone, Indexed: 1 case; too large" in html


def test_of_a_baseline_it_is_told_that_the_rest_of_its_run_was_left_out(run):
    assert "Nothing was skipped" in about_run(run)
    reduced = reduce_run(run).run
    told = about_run(reduced)
    assert f"was kept of this run, {run.folder.name}" in told
    assert "Nothing was skipped" not in told
