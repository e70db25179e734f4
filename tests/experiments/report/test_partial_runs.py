"""A run of some structures, or of one experiment, is a run: pages show what there is."""

from __future__ import annotations

import sys
from contextlib import suppress

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
from structures import NAMES
from tests.experiments.made_runs import write_run
from tests.extent import waiting_for

SHOWN = {
    **{axis.key: lambda run, claims, axis=axis: growth.scaling(run, axis) for axis in Axis},
    "operations": lambda run, claims: growth.scaling(run, Axis.TIME_FACES, OPERATIONS),
    "overview": lambda run, claims: growth.overview(run),
    "listings": lambda run, claims: growth.listings(run),
    "building": lambda run, claims: growth.building(run),
    "rendering": lambda run, claims: growth.rendering(run),
    "workloads": lambda run, claims: growth.workloads(run),
    "times of workloads": lambda run, claims: comparisons.workloads(run),
    "overtaking": lambda run, claims: growth.overtaking(run),
    "shards": lambda run, claims: growth.shards_per_second(run),
    "face finding": lambda run, claims: growth.face_finding(run),
    "memory": lambda run, claims: memory.by_field(run),
    "references": lambda run, claims: memory.references(run),
    "objects": lambda run, claims: comparisons.objects_against_arrays(run),
    "bytes by mesh": lambda run, claims: comparisons.bytes_by_mesh(run),
    "bytes in words": lambda run, claims: comparisons.bytes_in_words(run),
    "waiting": lambda run, claims: comparisons.waiting_in_words(run),
    "families": lambda run, claims: comparisons.by_family(judge_families(run, claims)),
    "by valence": lambda run, claims: uses.fastest_by_valence(run),
    "uses": lambda run, claims: uses.recommended(run),
    "pairs": lambda run, claims: uses.beside(run, "plankton", "half_edge"),
    "waits": lambda run, claims: real_time.waits(run),
    "frames": lambda run, claims: real_time.frames(run),
    "frames with room": lambda run, claims: real_time.frames(run, RESERVED),
    "compactions": lambda run, claims: real_time.compactions(run),
    "keeping up": lambda run, claims: real_time.keeping_up(run),
    "weights": lambda run, claims: real_time.weights(run),
    "picks": lambda run, claims: real_time.picks(run),
    "picks in words": lambda run, claims: real_time.picks_in_words(run),
    "shattering": lambda run, claims: comparisons.shattering(run),
    "shattering from Python": lambda run, claims: comparisons.shattering(run, compiled=False),
    "finding": lambda run, claims: comparisons.face_finding(run),
    "break even": lambda run, claims: comparisons.overtaking(break_even(curves(run))),
    "sentences": lambda run, claims: pages.sentences(claims, "printed"),
    "expectations": lambda run, claims: pages.sentences(claims, "expected"),
    "tally": lambda run, claims: pages.tally(claims),
    "reasons": lambda run, claims: pages.reasons(claims, "queries"),
    **{
        f"{kind} of {name}": lambda run, claims, kind=kind, name=name: pages.part(
            kind, claims, name
        )
        for kind in ("verdicts", "slopes")
        for name in tables()
    },
}
"""What the chapters show of a run."""

EVERYWHERE = {"sentences", "expectations", "tally", "reasons"}
PARTS = [*NAMES, *(name for name, it in experiments().items() if not it.by_name)]
FEW = "half_edge", "bench_queries"
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


@pytest.mark.parametrize("part", waiting_for(FEW, (it for it in PARTS if it != "bench_latency")))
def test_what_was_measured_is_shown_and_the_rest_is_named_as_missing(tmp_path, monkeypatch, part):
    # What is shown is looked at here, and not where it stands.
    for placing in ("experiments.report.style.label_ends", f"{LAYOUT}.execute"):
        monkeypatch.setattr(placing, lambda *given: None)
    session = open_part(tmp_path, part)
    shown = set()
    for name, show in SHOWN.items():
        with suppress(MissingError):
            assert show(session.run, session.claims) is not None
            shown.add(name)
    assert shown > EVERYWHERE
    assert len(shown) < len(SHOWN)


@pytest.mark.parametrize(
    "part", waiting_for(["winged_edge"], ["winged_edge", "bench_memory", "bench_latency"])
)
def test_the_front_page_says_what_was_not_measured(tmp_path, part):
    open_part(tmp_path, part)
    body = notebooks.body("index")
    assert body.count('class="answer missing"') == 5
    assert body.count("<details") > 100


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
