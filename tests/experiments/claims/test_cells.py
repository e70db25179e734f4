"""The cells of the tables are what the documents, the structures and the experiments claim."""

import pytest

from experiments.claims import MEMORY, NO_CLAIM, Kind, load_claims
from experiments.harness import OPERATIONS
from experiments.runs import experiments, tables
from structures import NAMES, REGISTRY, THESIS
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
TABLES = "queries", "operations"

SAID_OF_OPERATIONS = {
    ("split_edge", "indexed"), ("split_edge", "half_edge"), ("split_face", "half_edge"),
    ("collapse_edge", "indexed"), ("collapse_edge", "half_edge"), ("split_by_corners", "indexed"),
}  # fmt: skip
"""What chapters 4 and 5 say of the cost of an operation, and of which structure."""

SAID_OF_LISTINGS = "split_edge", "split_face", "collapse_edge", "collapse_stepping", "find_edges"
"""Those whose cost chapters 4 to 6 tell."""


def test_the_claims_are_table_1_as_it_is_printed():
    claims = {(it.subject, it.structure): it for it in load_claims() if it.table in TABLES}
    every = (*PRINTED, *NOT_IN_TABLE_1, *OPERATIONS)
    assert set(claims) == {(subject, name) for subject in every for name in NAMES}
    for subject, cells in PRINTED.items():
        assert [claims[subject, name].printed for name in THESIS] == cells
        assert all("table 1" in claims[subject, name].source for name in THESIS)
        assert {claims[subject, name].kind for name in THESIS} == {Kind.PRINTED}


def test_the_other_half_edges_are_claimed_to_cost_what_a_half_edge_mesh_does():
    claims = {(it.subject, it.structure): it for it in load_claims() if it.table in TABLES}
    same = [name for name in LIKE_THE_THESIS if REGISTRY[name].claims.like == "half_edge"]
    for subject, cells in PRINTED.items():
        others = [claims[subject, name] for name in same]
        assert {it.printed for it in others} == {NO_CLAIM if subject == MEMORY else cells[-1]}
        assert {it.kind for it in others} == {Kind.NOBODY if subject == MEMORY else Kind.FOLLOWS}
        assert not any("table 1" in it.source for it in others)


def test_of_a_structure_of_which_no_document_says_what_it_costs_nothing_is_claimed():
    others = (it for name, it in REGISTRY.items() if name not in THESIS)
    silent = {it.name for it in others if not (it.claims.like or it.claims.costs)}
    of_them = [it for it in load_claims() if it.structure in silent and it.table in TABLES]
    assert {it.structure for it in of_them} == silent
    assert {it.printed for it in of_them} == {NO_CLAIM}


def test_nothing_but_what_the_thesis_says_is_told_to_be_printed():
    said: dict[str, list[tuple[str, str]]] = {}
    for it in load_claims():
        if it.kind is Kind.PRINTED and it.claims_something:
            said.setdefault(it.table, []).append((it.subject, it.structure))
    assert len(said["queries"]) == 26 + 4
    assert said["listings"] == [(subject, "as_printed") for subject in SAID_OF_LISTINGS]
    assert {*said["operations"], *said["naming"]} == SAID_OF_OPERATIONS


def test_what_we_expect_says_so_in_its_source():
    own = [it.table for it in experiments().values() if it.claims]  # whose file says who expects it
    every = (it for it in load_claims() if tables()[it.table] not in own)
    claims = [it for it in every if it.structure in THESIS]
    assert all(("we expect" in it.source) == (it.kind is Kind.EXPECTED) for it in claims)


def test_a_claim_of_ours_on_what_is_like_another_stays_ours():
    claims = {(it.subject, it.structure): it.kind for it in load_claims() if it.table in TABLES}
    for name in LIKE_THE_THESIS:
        assert claims["split_edge", name] is Kind.FOLLOWS
        assert claims["flip_edge", name] is Kind.EXPECTED


def test_every_claim_has_a_key_of_its_own_a_source_and_a_sentence():
    claims = load_claims()
    assert len({it.key for it in claims}) == len(claims)
    assert all(it.source and it.text.endswith(".") and it.title for it in claims)


@pytest.mark.parametrize(("entry", "named"), [
    ('source = "x"\nqueries.vertex_corners = {}', "vertex_corners"),
    ('source = "x"\nqueries.face_faces.half_edges = "O(1)"', "half_edges"),
    ('kind = "printed"\nsource = "x"\nqueries.face_faces.half_edge = "O(n_v)"', r"O\(n_v\)"),
    ('kind = "printed"\nqueries.face_faces.half_edge = "O(1)"', "no source"),
    ('source = "x"\nqueries.face_faces.half_edge = "O(1)"', "kind is None"),
    ('kind = "said"\nsource = "x"\nqueries.face_faces.half_edge = "O(1)"', "'said'"),
    ('source = "x"\ntables.face_faces = {}', "tables"),
    ('sources = "x"\nqueries.face_faces = {}', "sources"),
])  # fmt: skip
def test_a_claim_that_makes_no_sense_is_refused_by_name(entry, named):
    classes = '[classes]\n"O(1)" = { faces = "O(1)", valence = "O(1)" }\n[[claim]]\n'
    with pytest.raises(ValueError, match=named):
        load_claims(classes + entry)


def test_what_is_claimed_in_a_variable_that_nobody_measures_is_not_asked():
    listings = [it for it in load_claims() if it.table == "listings" and it.claims_something]
    assert listings
    assert all(set(it.expects.classes) == {"faces"} for it in listings)
    assert all(it.subject != MEMORY for it in listings)
