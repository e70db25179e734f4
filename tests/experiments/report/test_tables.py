"""Tables: every claim and its mark, in 80 columns, and numbers as they were measured."""

import re
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import pandas as pd
import pytest
from rich.console import Console

from experiments.bench_workloads import COMPILED, FROM_PYTHON
from experiments.claims import (
    CLAIMED,
    MIXES,
    Kind,
    Outcome,
    break_even,
    class_told,
    curves,
    judge_run,
)
from experiments.report import comparisons
from experiments.report.pages import claims_markdown, frame_table, numbers, verdicts
from experiments.report.session import MissingError, share
from experiments.report.tables import digits, duration, legend, show_claims, tally_rows
from experiments.report.uses import recommended
from experiments.runs import load
from hem.complexity import judge
from structures import NAMED, NAMES, REGISTRY
from tests.experiments.made_runs import LAWS, SIZES, write_run


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


def test_near_a_class_is_explained_for_costs_that_it_explains_too():
    few = judge([100, 200, 400], [[100], [200], [400]], "O(n)", exact=True)
    assert class_told(few) == "near O(n)"
    assert few.errors["O(n)"] == pytest.approx(0, abs=1e-9)  # it explains them, and so do others
    assert "Near a class: the costs do not tell which" in " ".join(legend())


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


@pytest.mark.parametrize("every", [False, True])
def test_a_terminal_says_what_each_short_name_stands_for(run, capsys, every):
    show_claims(run.folder, Console(width=80), every)
    text = " ".join(capsys.readouterr().out.split())
    for it in NAMED.values():
        shown = f" {it.abbreviation} " in text and it.abbreviation != it.title
        assert (f"{it.abbreviation}: {it.title}" in text) == shown


def test_the_tables_as_markdown_have_every_mark(run):
    claims = judge_run(run)
    text = claims_markdown(claims, "queries")
    assert "| Bytes per vertex | 36 ✓ | 116 ✓ | 228 ✓ | 228 ✓ |" in text
    listings = claims_markdown(claims, "listings")
    assert "| Split edge | O(1) (✓✓) | O(1) ✓✓ |" in listings
    assert "| Build from a render mesh | O(n_t) ○○ | O(n_t²) ○○ |" in listings
    assert "| Vertex → Faces | O(n_t) ✓✓✓ | O(n_ev) ✓✓✓ |" in text
    assert "| Edge → Vertices | N/A, found O(1) | N/A, found O(1) | O(1) ✓✓✓ |" in text
    assert "| Vertex → adjacent Vertices | found O(1) |" in text


def test_what_is_published_and_breaks_what_is_said_of_it_is_violated(tmp_path):
    """The thesis says constant of a split that is linear as it is published."""
    run = write_run(
        tmp_path,
        lambda s, q, p: LAWS["O(n_t)"] if s == "as_printed" else None,
        lambda experiment, _: experiment == "bench_printed",
    )
    claims = judge_run(load(run))
    assert "| Split edge | O(1) (✓✓) | O(1) ✗✗, found O(n_t) |" in claims_markdown(
        claims, "listings"
    )


def test_claims_are_counted_by_who_claims_them(run):
    claims = judge_run(run)
    heads, *rows = tally_rows(claims)
    assert len({len(row) for row in (heads, *rows)}) == 1
    counted = {row[0]: row[1:] for row in rows}
    printed = [it for it in claims if it.claim.kind is Kind.PRINTED and it.claim.claims_something]
    in_tables = [it for it in printed if it.claim.structure]
    assert counted["printed, in tables"][:2] == [str(len(in_tables)), f"{len(in_tables)} ✓"]
    assert counted["printed, in tables"][3] == "26 ✓"  # table 1, asked at random
    assert counted["printed, in sentences"][0] == str(len(printed) - len(in_tables))
    assert counted["expected, in tables"][1].endswith("○")
    assert counted["follows, in tables"][1].endswith("(✓)")
    every = sum(int(row[0]) for row in counted.values())
    assert every == sum(it.claim.claims_something for it in claims)


def test_the_legend_has_every_mark():
    text = " ".join(legend())
    for kind in CLAIMED:
        assert kind.about in text
        assert all(kind.marks([it]) in text for it in Outcome if it is not Outcome.NO_CLAIM)


def test_a_table_of_a_page_leads_to_every_claim(run):
    share(None)
    claims = judge_run(run)
    text = verdicts(claims, "operations")
    for judged in claims:
        if judged.claim.table == "operations":
            assert f'href="index.html#{judged.claim.key}"' in text


def test_the_first_cell_of_a_row_of_numbers_or_words_is_its_head(run):
    numbers, words = comparisons.face_finding(run), recommended(run)
    for text in (numbers, words):
        rows = re.findall(r"<tr>(.*?)</tr>", text.partition("<tbody>")[2])
        assert len(rows) > 2
        assert all(it.startswith('<th scope="row"') and it.count("<th") == 1 for it in rows)


def test_walks_and_scans_are_told_apart_by_their_growth(run):
    row = r"<th[^>]*>(walk|jump and walk|scan)</th><td>([\d.]+) "
    slopes = dict(re.findall(row, comparisons.face_finding(run)))
    expected = {"walk": 1 / 2, "jump and walk": 1 / 3, "scan": 1}
    assert {way: float(slope) for way, slope in slopes.items()} == pytest.approx(expected, abs=0.05)


def test_structures_are_compared_with_the_indexed_mesh_at_its_size(run):
    text = comparisons.shattering(run)
    assert re.search(r">Half-Edge</th><td>100,000</td>.*<td>200,000</td></tr>", text)
    assert re.search(r">Indexed</th>.*<td>1\.0</td></tr>", text)
    from_python = comparisons.shattering(run, compiled=False)
    for name, it in REGISTRY.items():
        assert (f">{it.title}</th>" in text) == it.compiled, name
        assert (f">{it.title}</th>" in from_python) != it.compiled, name


def test_times_of_several_machines_are_not_compared(run):
    several = {**run.meta, "machine": {"cpu": "2 machines", "machines": ["a", "b"]}}
    for show in (comparisons.objects_against_arrays, comparisons.shattering):
        alone, apart = (show(replace(run, meta=it)).rows for it in (run.meta, several))
        (place,) = (k for k, head in enumerate(alone[0]) if re.match("slower|times", head))
        assert "–" not in {row[place] for row in alone[1:]}
        assert {row[place] for row in apart[1:]} == {"–"}
    assert len(break_even(curves(run)))
    assert break_even(curves(replace(run, meta=several))).empty


def test_a_structure_has_a_row_and_every_use_a_column_until_building_is_repaid(run):
    table = break_even(curves(run))
    rows = comparisons.overtaking(table).rows
    titles = {REGISTRY[it].title for it in table["structure"]}
    assert (len(rows), {row[0] for row in rows[1:]}) == (len(titles) + 1, titles)
    heads = dict(enumerate(rows[0]))
    for subject, structure, size, times in table.to_numpy():
        told = f"{MIXES[subject]}, {size:,} vertices"
        column = next((at for at, head in heads.items() if head == told), None)
        (row,) = (it for it in rows if it[0] == REGISTRY[structure].title)
        if column is not None:
            assert row[column] == ("never" if times == float("inf") else digits(times))
    assert len(heads) == 1 + table["subject"].nunique()


def test_words_stand_on_the_left_and_numbers_on_the_right():
    assert 'class="numbers"' in numbers([("one", 1.0)], {"": str, "number": digits})
    words = frame_table(pd.DataFrame({"at": ["72ce87e"], "claim": ["HEM split_edge"]}))
    assert 'class="numbers"' not in words
    assert '<td data-head="claim: ">HEM split_edge</td>' in words
    with pytest.raises(MissingError):
        frame_table(pd.DataFrame({"at": []}))


def test_work_and_time_of_objects_and_arrays_are_those_of_the_same_mesh(run):
    largest, by_time = run.cases["faces"].eq(SIZES[-1]), run.cases["kind"].eq("time")
    samples = run.cases["samples"].mask(largest & ~by_time, 2 * run.cases["samples"])
    untimed = largest & by_time & run.cases["structure"].eq("half_edge_objects")
    shown, smaller = (
        comparisons.objects_against_arrays(replace(run, cases=it))
        for it in (run.cases.assign(samples=samples)[~untimed], run.cases[~largest])
    )
    assert shown.rows == smaller.rows


def test_bytes_per_vertex_are_shown_of_every_mesh_and_structure(run):
    cases = run.cases.query("experiment == 'bench_memory' and reference_bytes == 8")
    text = comparisons.bytes_by_mesh(run)
    for name in NAMES:
        assert f">{NAMED[name].title}<" in text
    for it in cases[cases["family"] != "torus"].itertuples():
        (row,) = (line for line in text.split("<tr>") if f">{it.family}</th>" in line)
        assert f"<td>{it.samples[0] / it.vertices:,.1f}</td>" in row
    assert text.count("<tr>") == 1 + cases["family"].nunique()


def test_workloads_are_told_of_the_largest_mesh_each_was_done_on_and_ways_never_mix():
    cases = [
        ("half_edge", 1_000, "impacts", COMPILED, 7e-6),
        ("half_edge", 9_000, "impacts", COMPILED, 1.1e-6),
        ("half_edge", 9_000, "vertex_normals", COMPILED, 2.2e-8),
        ("indexed", 9_000, "vertex_normals", COMPILED, 3.3e-8),
        ("indexed", 1_000, "vertex_normals", COMPILED, 6.6e-8),
        ("indexed", 1_000, "impacts", COMPILED, 1.2e-4),
        ("half_edge", 9_000, "impacts", FROM_PYTHON, 4.4e-5),
        ("half_edge_objects", 400, "impacts", FROM_PYTHON, 5.5e-4),
    ]
    table = pd.DataFrame(cases, columns=["structure", "vertices", "subject", "order", "samples"])
    table = table.assign(experiment="bench_workloads", samples=[[it] for it in table["samples"]])
    run = SimpleNamespace(cases=table)
    assert comparisons.workloads(run, COMPILED).rows[1:] == [
        ["Indexed", "1,000", "–", "120 µs"],
        ["Indexed", "9,000", "33 ns", "–"],
        ["Half-Edge", "9,000", "22 ns", "1.1 µs"],
    ]
    assert comparisons.workloads(run, FROM_PYTHON).rows[1:] == [
        ["Half-Edge", "9,000", "44 µs"],
        ["Half-Edge Objects", "400", "550 µs"],
    ]


def test_every_row_of_slopes_says_its_axis_in_every_block(run, capsys):
    show_claims(run.folder, Console(width=80), slopes=True)
    blocks = re.split(r"(?m)^ ─+ *$", capsys.readouterr().out)[1:]
    rows = [re.findall(r"(?m)^ (\w+ → .*?)  ", it) for it in blocks]
    (above, below), *_ = pairwise(rows)
    assert above == below
    assert all(len(set(it)) == len(it) for it in rows)
    assert {re.sub(".*, ", "", it) for it in above} >= {"work n_t", "work n_ev", "time n_t"}
