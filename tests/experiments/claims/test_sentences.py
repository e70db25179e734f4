"""Sentences and break-even: judged on runs whose costs are known."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.claims import (
    EXPECTATIONS,
    SENTENCES,
    Outcome,
    break_even,
    curves,
    judge_sentences,
    sentence_claims,
)
from experiments.claims.claim import MET
from experiments.claims.quantities import QUANTITIES
from experiments.report.tables import sentences_markdown
from experiments.runs import load
from tests.experiments.made_runs import BUILD, SIZES, rewrite, write_run

SOURCES = ("thesis", "article", "claim", "the")
"""The documents, a claim that is corrected here, and the question that a document leaves open."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory):
    return load(write_run(tmp_path_factory.mktemp("run")))


def outcome(run, quantity: str) -> str:
    return next(it for it in judge_sentences(run) if it.claim.expects.quantity == quantity).outcome


def test_every_sentence_has_a_quantity_of_its_own_and_a_source():
    every = sentence_claims()
    assert [it.expects.quantity for it in every] == list(QUANTITIES)
    by = {it.expects.quantity: it.source.partition(" ")[0].strip(",") for it in every}
    own = {it.expects.quantity for it in every if it.table == EXPECTATIONS}
    assert {it for it, word in by.items() if word not in SOURCES} == own
    assert {by[it] for it in own} == {"our"}
    assert all(it.expects.low > -np.inf or it.expects.high < np.inf for it in every)


def test_what_this_study_expects_has_no_mark_of_what_a_document_says(run):
    said = {it.claim.expects.quantity: it for it in judge_sentences(run)}
    own = said["directed_queries"]
    assert (own.outcome, own.words) == ("consistent", "as expected")
    assert {it.mark for it in Outcome}.isdisjoint(mark for mark, _ in MET.values())
    assert said["bytes_ratio"].words == "consistent"
    assert own.mark in sentences_markdown([*said.values()], EXPECTATIONS)
    assert said["bytes_ratio"].claim.text not in sentences_markdown([*said.values()], EXPECTATIONS)
    assert own.claim.text not in sentences_markdown([*said.values()], SENTENCES)


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
    assert outcome(run, "published_splits") == "violated"  # they are linear
    assert outcome(run, "published_collapse") == "consistent"
    assert outcome(run, "corrected_splits") == outcome(run, "corrected_collapse") == "consistent"


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
    assert judge_sentences(run)[5].found == "–"


def slow_on_large_meshes(case) -> dict:
    return {"samples": [1.0]} if case.vertices > 10_000 else {}


def test_a_sentence_that_holds_in_part_is_undetermined(tmp_path):
    folder = write_run(tmp_path)
    rewrite(folder, "bench_workloads", "half_edge", slow_on_large_meshes)
    assert outcome(load(folder), "dynamic") == "undetermined"


def test_bounds_and_spans_are_given_in_words(run):
    told = [(it.claim.expects.words, it.found) for it in judge_sentences(run)]
    assert told[0] == ("at least 6", "6.33")
    assert told[1] == ("1", "1")
    assert told[2][0] == "0.5 to 2"
    assert told[5][0] == "at most 1"


def test_break_even_is_where_building_and_asking_cost_the_same(run):
    table = break_even(curves(run))
    asked = table[(table["subject"] == "vertex_faces") & (table["structure"] == "half_edge")]
    assert asked["vertices"].tolist() == [n // 2 for n in SIZES]
    for n_t, times in zip(SIZES, asked["times"], strict=True):
        mine = BUILD["half_edge"] * n_t + times * 1e-9 * (2 + 3 * 6)
        base = BUILD["indexed"] * n_t + times * 1e-9 * (10 + 3 * n_t)
        assert mine == pytest.approx(base, rel=0.15)


def test_who_never_catches_up_does_so_after_infinitely_many(tmp_path):
    law = {"half_edge": lambda n_t, n_ev: 1e9}
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s)))
    table = break_even(curves(run))
    assert np.isinf(table[table["structure"] == "half_edge"]["times"]).all()
    assert np.isfinite(table[table["structure"] == "winged_edge"]["times"]).all()
