"""A run of some structures, or of one experiment, is a run: pages show what there is."""

import re
import sys
from contextlib import suppress
from dataclasses import replace
from functools import partial

import pytest
from rich.console import Console

from experiments.bench_real_time import RESERVED
from experiments.claims import break_even, curves, judge_families, judge_run
from experiments.harness import OPERATIONS, Axis
from experiments.report import comparisons, notebooks, pages, uses
from experiments.report.figures import fracture as pictures
from experiments.report.figures import growth, memory, real_time
from experiments.report.session import MissingError, Session, share
from experiments.report.tables import show_claims
from experiments.runs import experiments, load, tables
from hem.contract import QUERIES
from structures import NAMES
from tests.experiments.made_runs import VALENCES, rewrite, write_run
from tests.extent import exhaustive, waiting_for

OF_RUN = (
    *(partial(growth.scaling, axis=axis) for axis in Axis),
    partial(growth.scaling, axis=Axis.TIME_FACES, subjects=OPERATIONS),
    growth.overview, growth.listings, growth.building, growth.rendering, growth.workloads,
    growth.overtaking, growth.shards_per_second, growth.face_finding,
    memory.by_field, memory.references,
    comparisons.workloads, comparisons.objects_against_arrays, comparisons.bytes_by_mesh,
    comparisons.bytes_in_words, comparisons.waiting_in_words, comparisons.shattering,
    partial(comparisons.shattering, compiled=False), comparisons.face_finding,
    lambda run: comparisons.overtaking(break_even(curves(run))),
    lambda run: comparisons.by_family(judge_families(run, judge_run(run))),
    uses.fastest_by_valence, uses.recommended,
    partial(uses.beside, one="plankton", other="half_edge"),
    real_time.waits, real_time.frames, partial(real_time.frames, order=RESERVED),
    real_time.compactions, real_time.keeping_up, real_time.weights,
    real_time.picks, real_time.picks_in_words,
)  # fmt: skip
"""What the chapters show of a run, beside its claims."""

PARTS = [*NAMES, *(name for name, it in experiments().items() if not it.by_name)]
FEW = ("bench_queries",)
LAYOUT = "matplotlib.layout_engine.ConstrainedLayoutEngine"


@pytest.fixture(autouse=True)
def _no_run_is_left():
    yield
    share(None)


def open_part(tmp_path, part: str) -> Session:
    folder = write_run(tmp_path, only=lambda experiment, structure: part in (experiment, structure))
    run = load(folder)
    session = Session(run, judge_run(run))
    share(session)
    return session


def is_shown(show, *given) -> bool:
    """Whether it is there to be shown, and tells numbers; else it says what is missing."""
    with suppress(MissingError):
        assert not re.search(r"\b(None|nan)\b", re.sub("<.*?>", "", str(show(*given))))
        return True
    return False


@pytest.mark.parametrize("part", waiting_for(FEW, (it for it in PARTS if it != "bench_latency")))
def test_what_was_measured_is_shown_and_the_rest_is_named_as_missing(tmp_path, monkeypatch, part):
    # What is shown is looked at here, and not where it stands.
    for placing in ("experiments.report.style.label_ends", f"{LAYOUT}.execute"):
        monkeypatch.setattr(placing, lambda *given: None)
    session = open_part(tmp_path, part)
    sentences = [pages.sentences(session.claims, kind) for kind in ("printed", "expected")]
    of_any_run = *sentences, pages.tally(session.claims), pages.reasons(session.claims, "queries")
    assert None not in of_any_run
    shown = [is_shown(show, session.run) for show in OF_RUN]
    for table in tables():
        shown += [is_shown(how, session.claims, table) for how in (pages.verdicts, pages.slopes)]
    assert any(shown)
    assert not all(shown)


def test_what_is_told_beside_a_half_edge_mesh_names_it_where_it_was_not_measured(tmp_path):
    run = open_part(tmp_path, "directed_edge").run
    for asked in ("kind == 'work'", "kind == 'time'"):
        assert "vertex_faces" in set(run.cases.query(asked)["subject"])  # what is there
    with pytest.raises(MissingError, match="of a half-edge mesh"):
        comparisons.waiting_in_words(run)


def test_of_a_stopped_run_each_query_is_told_at_the_valences_that_it_has(tmp_path):
    run = open_part(tmp_path, "winged_edge").run
    missing = run.cases["subject"].eq("face_faces") & run.cases["valence"].eq(VALENCES[-1])
    html = uses.fastest_by_valence(replace(run, cases=run.cases[~missing]))
    assert f"{VALENCES[-1]:,} edges" in html  # of all queries but this one …
    assert f"{VALENCES[-2]:,} edges" in html  # … whose largest valence no other is told at
    assert html.count(">–</td>") == len(QUERIES)


@pytest.mark.parametrize(
    "part", waiting_for(["winged_edge"], ["winged_edge", "bench_memory", "bench_latency"])
)
def test_the_front_page_says_what_was_not_measured(tmp_path, part):
    open_part(tmp_path, part)
    body = notebooks.body("index")
    assert body.count('class="answer missing"') == 5
    assert body.count("<details") > 100


def test_the_front_page_compares_the_medians_of_an_even_number_of_rounds_too(tmp_path):
    write_run(tmp_path, only=lambda experiment, structure: structure in ("half_edge", "indexed"))

    def scattered(it):
        return {"samples": [k * it.samples[0] for k in (1, 1, 3, 3)]}

    rewrite(tmp_path, "bench_build", "half_edge", scattered)  # at first 31 times as long
    rewrite(tmp_path, "bench_workloads", "half_edge", scattered)  # and as long
    run = load(tmp_path)
    share(Session(run, judge_run(run)))
    front = notebooks.read(notebooks.FRONT)
    del front.cells[4:]  # what does not answer
    answers = notebooks.execute(front, notebooks.FRONT)["answers"]
    assert "takes 62 times as long to build" in answers[1].text
    assert "takes 2.00 times as long on a half-edge mesh" in answers[3].text


@exhaustive
def test_without_what_breaks_bodies_the_chapter_names_what_brings_it(tmp_path, monkeypatch):
    open_part(tmp_path, "half_edge")
    pictures.broken_by_force.cache_clear()
    monkeypatch.setitem(sys.modules, "manifold3d", None)
    body = notebooks.body("fracture")
    assert body.count("pip install 'hem-mesh[fracture]'") == 3
    assert body.count("<img") >= 2  # what is broken on its surface is shown


@pytest.mark.parametrize("part", waiting_for(["plankton"], ["plankton", "bench_work"]))
@pytest.mark.parametrize("slopes", [False, True])
def test_the_table_in_a_terminal_shows_what_there_is(tmp_path, capsys, part, slopes):
    session = open_part(tmp_path, part)
    show_claims(session.run.folder, Console(width=80), every=True, slopes=slopes)
    assert all(len(line) <= 80 for line in capsys.readouterr().out.splitlines())
