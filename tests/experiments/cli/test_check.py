"""`hem check`: a mistake is one line and never a pass, and what is worse fails the command."""

import shutil
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from experiments.regression import (
    COUNTERS,
    RUN,
    compare_runs,
    load_baseline,
    reduce_run,
    save_baseline,
)
from experiments.report import findings
from experiments.runs import read_meta, write_meta
from tests.experiments.cli.calls import hem, mistake

REFERENCE = Path(__file__).parents[3] / "results/reference"


@pytest.fixture
def baseline(tmp_path: Path) -> Path:
    return Path(shutil.copytree(REFERENCE / COUNTERS, tmp_path / "baseline" / COUNTERS)).parent


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere"], "run"),
        (["--factor", "0.5"], "--factor is more than 1"),
        (["--structure", "halfedge"], "no structure is called 'halfedge'"),
        (["--baseline", "nowhere"], "nowhere/counters holds no run"),
        (["--beside", "nowhere", "--structure", "indexed"], "nowhere is no checkout"),
        (["--markdown", "nowhere/check.md"], "nowhere/check.md: No such file"),
        (["PEERS"], "is of other libraries, of which there is no baseline"),
    ],
)
def test_a_mistake_is_one_line_and_never_a_pass(arguments, said, baseline):
    options = [] if "--baseline" in arguments else ["--baseline", str(baseline)]
    arguments = [str(REFERENCE / "peers") if it == "PEERS" else it for it in arguments]
    assert said in mistake("check", *arguments, *options, code=2)


def test_a_mistake_leaves_no_empty_summary(baseline, tmp_path):
    page = tmp_path / "check.md"
    mistake("check", "nowhere", "--markdown", str(page), "--baseline", str(baseline), code=2)
    assert not page.exists()


@pytest.mark.parametrize(
    "arguments", [("table", "--peers", "--all"), ("report", "--page", "--pdf")]
)
def test_options_that_do_not_go_together_are_refused(arguments):
    assert arguments[1] in mistake(*arguments)


@pytest.mark.parametrize("text", ["{", "[]", '{"schema": 99}'])
def test_a_broken_baseline_is_named_with_the_way_out(text, baseline):
    (baseline / COUNTERS / "run.json").write_text(text)
    said = mistake("check", "--baseline", str(baseline), code=2)
    assert f"{baseline}/counters/run.json" in said
    assert "Make it anew: hem baseline update" in said


def test_an_empty_run_is_refused(tmp_path, base_folder):
    write_meta(tmp_path / "run", read_meta(base_folder) | {"files": {}})
    options = "--reference", str(REFERENCE)
    assert "holds no case" in mistake("check", str(tmp_path / "run"), *options, code=2)


def test_a_worse_structure_fails_the_command_and_shows_the_numbers_in_80_columns(
    baseline, tmp_path
):
    measured = load_baseline(COUNTERS, baseline)
    (row,) = measured.run.cases.query(
        "structure == 'indexed' and id == 'face_vertices/torus/100/random'"
    ).index
    measured.run.cases.at[row, "samples"] = [2, 2, 2]
    save_baseline(COUNTERS, measured, baseline)
    page = tmp_path / "summary.md"
    options = "--structure", "indexed", "--baseline", str(baseline), "--markdown", str(page)
    exit_code, output = hem("check", *options, width=80)
    assert exit_code == 1
    (line,) = [it for it in output.splitlines() if "2, 2, 2 → 3, 3, 3" in it]
    assert "face_vertices/torus/200/random" in line
    assert max(map(len, output.splitlines())) <= 80
    assert "Table 1, Face → Vertices: O(1)" in output
    assert "Something got worse" in page.read_text()


def test_what_holds_of_counters_and_of_a_run_is_said_once(baseline, base_folder, base_run):
    for part, measured in (
        (COUNTERS, load_baseline(COUNTERS, baseline)),
        (RUN, reduce_run(base_run).only(["indexed"])),
    ):
        meta = measured.run.meta | {"versions": {"python": "3.0.0"}}
        save_baseline(part, replace(measured, run=replace(measured.run, meta=meta)), baseline)
    options = "--structure", "indexed", "--baseline", str(baseline)
    assert hem("check", str(base_folder), *options)[1].count("the baseline has 3.0.0") == 1


@pytest.mark.parametrize("differs", [{"machine": {"cpu": "another"}}, {"too_busy": True}])
def test_where_no_times_can_be_compared_the_next_step_is_named(differs, base_run):
    measured = reduce_run(base_run).only(["half_edge"])
    before = replace(measured, run=replace(measured.run, meta=measured.run.meta | differs))
    console = Console(width=80, record=True, file=StringIO())
    findings.show(*compare_runs(before, measured), console)
    assert "hem baseline update RUN" in " ".join(console.export_text().split())
