"""Verdicts on runs that follow a known law: what holds is consistent, what does not is violated."""

from __future__ import annotations

import json

import numpy as np
import pytest

from experiments.claims.growth import OPERATIONS, VARIABLES, load_claims
from experiments.claims.judged import judged, save
from experiments.report.tables import by_title, found, markdown, show
from experiments.runs.results import load, write_sealed
from hem.contract import QUERIES
from structures import NAMES, THESIS
from tests.experiments.made_runs import LAWS, SIZES, write_run

PRINTED = {
    "memory": ["36", "116", "228", "228", "N/A", "N/A"],
    "edge_vertices": ["N/A", "N/A", "O(1)", "O(1)", "O(1)", "O(1)"],
    "edge_faces": ["N/A", "N/A", "O(1)", "O(1)", "O(1)", "O(1)"],
    "edge_edges": ["N/A", "N/A", "O(n_ev)", "O(n_ev)", "O(n_ev)", "O(n_ev)"],
    "vertex_edges": ["O(n_t)", "O(n_ev)", "O(n_ev)", "O(n_ev)", "O(n_ev)", "O(n_ev)"],
    "vertex_faces": ["O(n_t)", "O(n_ev)", "O(n_ev)", "O(n_ev)", "O(n_ev)", "O(n_ev)"],
    "face_edges": ["O(1)", "O(1)", "O(1)", "O(1)", "O(1)", "O(1)"],
    "face_vertices": ["O(1)", "O(1)", "O(1)", "O(1)", "O(1)", "O(1)"],
    "face_faces": ["O(n_t)", "O(1)", "O(1)", "O(1)", "O(1)", "O(1)"],
}


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory):
    return load(write_run(tmp_path_factory.mktemp("sound")))


def test_the_claims_are_table_1_as_it_is_printed():
    claims = {(it.subject, it.structure): it for it in load_claims() if it.table != "listings"}
    every = (*PRINTED, "vertex_vertices", *OPERATIONS)
    assert set(claims) == {(what, name) for what in every for name in NAMES}
    for what, cases in PRINTED.items():
        assert [claims[what, name].printed for name in NAMES] == cases
        assert all("table 1" in claims[what, name].source for name in THESIS)


def test_what_grows_as_claimed_is_consistent_by_work_and_by_time(sound):
    table = judged(sound)
    claimed = table[(table["printed"] != "N/A") & (table["subject"] != "memory")]
    assert claimed["table"].value_counts().to_dict() == {
        "queries": 26 + 2 * 8,
        "operations": 16 + 2 * 4,
        "listings": 8,
    }
    assert set(claimed["outcome_work"]) == set(claimed["outcome_time"]) == {"consistent"}
    memory = table[table["subject"] == "memory"]["outcome"]
    assert memory.tolist() == 4 * ["consistent"] + 2 * ["no claim"]
    assert set(table[table["printed"] == "N/A"]["outcome"]) == {"no claim"}


@pytest.mark.parametrize("printed", ["O(1)", "O(n_ev)", "O(n_t)"])
@pytest.mark.parametrize("really", ["O(1)", "O(n_ev)", "O(n_t)", "O(n_t n_ev)"])
def test_what_grows_otherwise_is_violated(tmp_path, printed, really):
    laws = {**LAWS, "O(n_t n_ev)": lambda n_t, n_ev: 1.0 * n_t * n_ev**2}
    run = load(write_run(tmp_path, lambda s, q, p: laws[really] if p == printed else None))
    rows = judged(run).query("printed == @printed and table != 'listings'")
    expected = {"consistent"} if printed == really else {"violated"}
    assert set(rows["outcome"]) == set(rows["outcome_work"]) == expected


@pytest.mark.parametrize(
    ("table", "said"), [("queries", "violated"), ("operations", "undetermined")]
)
def test_a_rise_beyond_the_latency_is_held_against_queries_and_not_against_batches(
    tmp_path, table, said
):
    """Whose mesh was written just before: no chase of it tells what they wait for."""
    risen = dict(zip(SIZES, [5, 5, 5, 5, 5.5, 12, 30], strict=True))
    run = load(write_run(tmp_path, lambda s, q, p: lambda n_t, n_ev: risen.get(n_t, 5.0)))
    rows = judged(run).query("printed == 'O(1)' and table == @table")
    assert set(rows["outcome_time"]) == {said}


def test_a_byte_too_many_is_a_violation(tmp_path):
    folder = write_run(tmp_path)
    path = folder / "bench_memory.half_edge.json"
    content = json.loads(path.read_text())
    content["cases"][0]["samples"] = [228_001.0]
    write_sealed(path, content)
    table = judged(load(folder)).query("subject == 'memory'").set_index("structure")
    assert table.loc["half_edge", "outcome"] == "violated"
    assert table.loc["winged_edge", "outcome"] == "consistent"


def test_a_query_that_was_not_measured_is_undetermined_never_a_pass(tmp_path):
    folder = write_run(tmp_path)
    for path in folder.glob("bench_*work.half_edge.json"):
        path.unlink()
    table = judged(load(folder))
    rows = table[(table["structure"] == "half_edge") & (table["printed"] != "N/A")]
    assert set(rows.query("subject != 'memory'")["outcome"]) == {"undetermined"}


def test_the_class_found_names_its_variables(sound):
    table = judged(sound)
    for row in table.to_dict("records"):
        expected = {"N/A": "O(1)"}.get(row["printed"], row["printed"])
        if row["subject"] == "memory" and row["printed"] == "N/A":
            expected = "0"
        assert found(row) == expected


def test_verdicts_are_kept_as_plain_json(sound, tmp_path):
    path = save(sound, judged(sound), tmp_path)
    claims = json.loads(path.read_text())["claims"]
    assert len(claims) == 16 * len(NAMES) + 8
    assert {"best", "slope", "slope_low", "slope_high", "margin"} <= set(claims[-1]["work_faces"])


def test_the_table_shows_every_row_and_mark(sound, capsys):
    from rich.console import Console

    show(sound.folder, Console(width=100))
    printed = capsys.readouterr().out
    assert printed.count("✓") > 26
    assert all(text in printed for text in ("228 ✓", "O(n_t) ✓", "N/A – O(1)", "26 consistent"))
    assert "16 consistent" in printed
    assert "Plankton" not in printed
    show(sound.folder, Console(width=160), every=True)
    printed = capsys.readouterr().out
    assert all(text in printed for text in ("Plankton", "Objects", "Printed", "O(n_t²) ✓"))
    split = "| Split edge | O(n_t) ✓ | O(n_ev) ✓ | O(1) ✓ | O(1) ✓ | O(1) ✓ | O(1) ✓ |"
    assert split in markdown(sound, "operations")
    assert "| Split edge | O(n_t) ✓ | O(1) ✓ |" in markdown(sound, "listings")
    lines = markdown(sound).splitlines()
    assert len(lines) == 2 + len(PRINTED) + 1
    assert (
        "| ".join(["", "Vertex → Faces ", "O(n_t) ✓ ", *(5 * ["O(n_ev) ✓ "]), ""]).strip() in lines
    )
    assert [title for title, _ in by_title(judged(sound))][1] == QUERIES["edge_vertices"].title


@pytest.mark.parametrize(
    ("entry", "named"),
    [
        ('what = "vertex_corners"\nsource = "x"', "vertex_corners"),
        ('what = "face_faces"\nsource = "x"\nhalf_edges = "O(1)"', "half_edges"),
        ('what = "face_faces"\nsource = "x"\nhalf_edge = "O(n_v)"', r"O\(n_v\)"),
        ('what = "face_faces"\nhalf_edge = "O(1)"', "no source"),
    ],
)
def test_a_claim_that_makes_no_sense_is_refused_by_name(entry, named):
    classes = '[classes]\n"O(1)" = { faces = "O(1)", valence = "O(1)" }\n[[row]]\n'
    with pytest.raises(ValueError, match=named):
        load_claims(classes + entry)


def test_one_entry_adds_a_claim(sound):
    text = """
        [classes]
        "O(1)" = { faces = "O(1)", valence = "O(1)" }
        [[row]]
        what = "vertex_vertices"
        source = "another document"
        half_edge = "O(1)"
    """
    table = judged(sound, load_claims(text))
    assert set(table["outcome"]) == {"consistent"}
    assert table["structure"].tolist() == ["half_edge", "half_edge_objects", "plankton"]
    assert set(VARIABLES) == {"faces", "valence"}
    assert np.isfinite(table["work_per_query"]).all()
