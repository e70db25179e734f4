"""The cells of the tables are what the documents, the structures and the experiments claim."""

from __future__ import annotations

import pytest

from experiments.claims import MEMORY, NO_CLAIM, load_claims
from experiments.harness import OPERATIONS
from structures import NAMES, THESIS
from tests.experiments.made_runs import LIKE_THE_THESIS

PRINTED = {
    "memory": ["36", "116", "228", "228"],
    "edge_vertices": ["N/A", "N/A", "O(1)", "O(1)"],
    "edge_faces": ["N/A", "N/A", "O(1)", "O(1)"],
    "edge_edges": ["N/A", "N/A", "O(n_ev)", "O(n_ev)"],
    "vertex_edges": ["O(n_t)", "O(n_ev)", "O(n_ev)", "O(n_ev)"],
    "vertex_faces": ["O(n_t)", "O(n_ev)", "O(n_ev)", "O(n_ev)"],
    "face_edges": ["O(1)", "O(1)", "O(1)", "O(1)"],
    "face_vertices": ["O(1)", "O(1)", "O(1)", "O(1)"],
    "face_faces": ["O(n_t)", "O(1)", "O(1)", "O(1)"],
}


NOT_IN_TABLE_1 = ("vertex_vertices",)


def test_the_claims_are_table_1_as_it_is_printed():
    claims = {(it.subject, it.structure): it for it in load_claims() if it.table != "listings"}
    every = (*PRINTED, *NOT_IN_TABLE_1, *OPERATIONS)
    assert set(claims) == {(subject, name) for subject in every for name in NAMES}
    for subject, cells in PRINTED.items():
        assert [claims[subject, name].printed for name in THESIS] == cells
        assert all("table 1" in claims[subject, name].source for name in THESIS)


def test_the_other_half_edges_are_claimed_to_cost_what_a_half_edge_mesh_does():
    claims = {(it.subject, it.structure): it for it in load_claims() if it.table != "listings"}
    for subject, cells in PRINTED.items():
        others = [claims[subject, name] for name in LIKE_THE_THESIS]
        assert {it.printed for it in others} == {"N/A" if subject == MEMORY else cells[-1]}
        assert not any("table 1" in it.source for it in others)


def test_of_a_structure_of_which_no_document_says_what_it_costs_nothing_is_claimed():
    silent = {it for it in NAMES if it not in THESIS and it not in LIKE_THE_THESIS}
    of_them = [it for it in load_claims() if it.structure in silent]
    assert {it.structure for it in of_them} == silent
    assert {it.printed for it in of_them} == {NO_CLAIM}


def test_every_claim_has_a_key_of_its_own_a_source_and_a_sentence():
    claims = load_claims()
    assert len({it.key for it in claims}) == len(claims)
    assert all(it.source and it.text.endswith(".") and it.title for it in claims)


@pytest.mark.parametrize(
    ("entry", "named"),
    [
        ('what = "vertex_corners"\nsource = "x"', "vertex_corners"),
        ('what = "face_faces"\nsource = "x"\nhalf_edges = "O(1)"', "half_edges"),
        ('what = "face_faces"\nsource = "x"\nhalf_edge = "O(n_v)"', r"O\(n_v\)"),
        ('what = "face_faces"\nhalf_edge = "O(1)"', "no source"),
        ('what = "face_faces"\nsource = "x"\ntable = "tables"', "tables"),
    ],
)
def test_a_claim_that_makes_no_sense_is_refused_by_name(entry, named):
    classes = '[classes]\n"O(1)" = { faces = "O(1)", valence = "O(1)" }\n[[row]]\n'
    with pytest.raises(ValueError, match=named):
        load_claims(classes + entry)


def test_what_is_claimed_in_a_variable_that_nobody_measures_is_not_asked():
    listings = [it for it in load_claims() if it.table == "listings"]
    assert listings
    assert all(set(it.expects.classes) == {"faces"} for it in listings)
    assert all(it.subject != MEMORY for it in listings)
