"""Sentences and break-even: judged on runs whose costs are known."""

from __future__ import annotations

import json

import numpy as np
import pytest

from experiments.claims import sentences
from experiments.claims.breakeven import break_even
from experiments.runs.results import load, write_sealed
from tests.experiments.made_runs import BUILD, SIZES, write_run

SOURCES = ("thesis", "article", "claim", "the")
"""The documents, a claim that is mended here, and the question that a document leaves open."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory):
    return load(write_run(tmp_path_factory.mktemp("run")))


def outcome(run, quantity: str) -> str:
    every = dict(zip(sentences.QUANTITIES, sentences.judged(run), strict=True))
    return every[quantity].outcome


def test_every_sentence_has_a_quantity_of_its_own_and_a_source(run):
    every = sentences.judged(run)
    assert len(every) == len(sentences.QUANTITIES)
    assert all(it.source.partition(" ")[0].strip(",") in SOURCES for it in every)
    assert all(it.low > -np.inf or it.high < np.inf for it in every)


def test_what_lies_within_its_bounds_is_consistent(run):
    assert outcome(run, "bytes_ratio") == "consistent"
    assert outcome(run, "winged_half") == "consistent"
    assert outcome(run, "dynamic") == "consistent"
    assert outcome(run, "static") == "consistent"
    assert outcome(run, "edits_per_build") == "consistent"
    assert outcome(run, "answers") == "consistent"


def test_what_the_article_says_is_run(run):
    for quantity in ("books_built", "polygon_corners", "article_invariants", "cube_vertices"):
        assert outcome(run, quantity) == "consistent"


def test_the_listings_are_judged_by_how_they_grow(run):
    assert outcome(run, "printed_splits") == "violated"  # they are linear
    assert outcome(run, "printed_collapse") == "consistent"
    assert outcome(run, "mended_splits") == outcome(run, "mended_collapse") == "consistent"


def test_what_lies_outside_its_bounds_is_violated(tmp_path):
    law = {"winged_edge": lambda n_t, n_ev: 1e6}
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s)))
    assert outcome(run, "winged_half") == "violated"


def test_where_nothing_was_measured_nothing_is_told(tmp_path):
    folder = write_run(tmp_path)
    for path in folder.glob("bench_workloads.*"):
        path.unlink()
    run = load(folder)
    assert outcome(run, "dynamic") == "undetermined"
    assert sentences.span(sentences.judged(run)[5]) == "–"


def test_a_sentence_that_holds_in_part_is_undetermined(tmp_path):
    folder = write_run(tmp_path)
    path = folder / "bench_workloads.half_edge.json"
    content = json.loads(path.read_text())
    for case in content["cases"]:
        if case["subject"] == "impacts" and case["vertices"] > 10_000:
            case["samples"] = [1.0]
    write_sealed(path, content)
    assert outcome(load(folder), "dynamic") == "undetermined"


def test_bounds_and_spans_are_told_in_words(run):
    told = [(sentences.bounds(it), sentences.span(it)) for it in sentences.judged(run)]
    assert told[0] == ("at least 6", "6.33")
    assert told[1] == ("1", "1")
    assert told[2][0] == "0.5 to 2"
    assert told[5][0] == "at most 1"


def test_break_even_is_where_building_and_asking_cost_the_same(run):
    table = break_even(run)
    asked = table[(table["what"] == "vertex_faces") & (table["structure"] == "half_edge")]
    assert asked["vertices"].tolist() == [n // 2 for n in SIZES]
    for n_t, times in zip(SIZES, asked["times"], strict=True):
        mine = BUILD["half_edge"] * n_t + times * 1e-9 * (2 + 3 * 6)
        base = BUILD["indexed"] * n_t + times * 1e-9 * (10 + 3 * n_t)
        assert mine == pytest.approx(base, rel=0.15)


def test_who_never_catches_up_does_so_after_infinitely_many(tmp_path):
    law = {"half_edge": lambda n_t, n_ev: 1e9}
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s)))
    table = break_even(run)
    assert np.isinf(table[table["structure"] == "half_edge"]["times"]).all()
    assert np.isfinite(table[table["structure"] == "winged_edge"]["times"]).all()
