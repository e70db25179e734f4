"""The reference: it changes only when somebody says so, who has seen what would change."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from experiments import cli
from experiments.regression import baseline, counters, gate
from experiments.runs.results import write_json
from tests.experiments.made_runs import write_run

COMMITTED = Path(__file__).parents[3] / "results/reference"
KEY = "work/half_edge/vertex_faces/torus/100/random"


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> Path:
    return write_run(tmp_path_factory.mktemp("run"))


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A copy of the committed reference, with nothing to measure for it."""
    measured = baseline.load_exact(COMMITTED)
    monkeypatch.setattr(counters, "measure", lambda: measured)
    return Path(shutil.copytree(COMMITTED, tmp_path / "reference"))


def update(folder: Path, *arguments: str, said: str | None = None) -> tuple[int, str]:
    cli.console.width = cli.errors.width = 400
    command = ["reference", "update", *arguments, "--reference", str(folder)]
    result = CliRunner().invoke(cli.app, command, input=said)
    return result.exit_code, result.stdout + result.stderr


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def another_count(folder: Path) -> None:
    kept = baseline.load_exact(folder)
    kept.cases[KEY] = [7, 7]
    baseline.save_exact(kept, folder)


def test_where_nothing_changed_nothing_is_asked_and_nothing_written(folder):
    before = contents(folder)
    code, output = update(folder)
    assert (code, contents(folder)) == (0, before)
    assert "says just this already" in output


def test_a_change_is_shown_on_both_sides_and_written_once_one_agrees(folder):
    good = contents(folder)
    another_count(folder)
    code, output = update(folder, said="y\n")
    assert code == 0
    assert f"- {KEY}: [7, 7]" in output
    assert f"+ {KEY}: {baseline.load_exact(COMMITTED).cases[KEY]}" in output
    assert contents(folder) == good


@pytest.mark.parametrize("answer", ["n\n", "\n", ""])
def test_who_does_not_agree_keeps_what_there_is(folder, answer):
    another_count(folder)
    before = contents(folder)
    code, output = update(folder, said=answer)
    assert (code, contents(folder)) == (1, before)
    assert f"- {KEY}: [7, 7]" in output


def test_with_a_run_all_of_it_becomes_the_reference(folder, run):
    code, output = update(folder, str(run), "--yes")
    assert code == 0
    assert "± run.json, started:" in output
    assert "cases anew" in output
    kept = baseline.load_measured(folder)
    assert kept == baseline.measured(gate.load(run))
    assert update(folder, str(run)) == (0, f"{folder} says just this already.\n")


def test_a_reference_that_cannot_be_read_is_replaced(folder, run):
    for name in ("exact.json", "run.json", "times.json"):
        (folder / name).write_text("{")
    assert update(folder, str(run), "--yes")[0] == 0
    assert baseline.load_exact(folder).cases == baseline.load_exact(COMMITTED).cases
    assert baseline.load_measured(folder).times


def test_what_cannot_be_measured_replaces_nothing(folder, monkeypatch):
    monkeypatch.setattr(
        counters, "measure", lambda: counters.Exact({}, {KEY: "ValueError: broken"})
    )
    before = contents(folder)
    code, output = update(folder, "--yes")
    assert (code, contents(folder)) == (1, before)
    assert f"hem: {KEY} could not be measured" in output


def test_a_run_that_is_not_finished_is_no_reference(folder, tmp_path):
    unfinished = tmp_path / "run"
    write_json(unfinished / "run.json", {"schema": 1, "profile": "quick"})
    code, output = update(folder, str(unfinished), "--yes")
    assert code == 1
    assert "hem study --resume" in output
