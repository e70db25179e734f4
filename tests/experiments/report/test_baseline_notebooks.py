"""Notebooks open where nothing was measured yet: on the committed baseline, and they say so."""

import os
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from experiments import carried
from experiments.report import notebooks, session
from experiments.report import peers as libraries
from experiments.runs import load
from tests.extent import exhaustive, waiting_for

FEW = ("index", "comparison_table", "memory", "real_time")


@pytest.fixture(autouse=True)
def _nothing_measured(tmp_path, monkeypatch):
    """No run is named, none is in the folder, and none in the checkout."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(session.RUN_VARIABLE, raising=False)
    monkeypatch.setattr(session, "RUNS", tmp_path / "runs")
    session.share(None)
    yield
    session.share(None)


@pytest.mark.parametrize("name", waiting_for(FEW, notebooks.page_titles()))
def test_a_notebook_runs_to_its_end_on_the_baseline(name):
    text = notebooks.body(name)
    assert "<h1" in text
    if "open_run(" in (carried("notebooks") / f"{name}.ipynb").read_text("utf-8"):
        assert "this is the committed baseline" in text or libraries.MISSING in text


def test_the_run_that_is_opened_is_the_baseline_and_a_newer_one_takes_its_place(base_folder):
    opened = session.open_run().run
    assert opened.folder == carried("results/reference/run")
    assert len(opened.cases) == len(load(opened.folder).cases) > 1000
    session.share(None)
    session.RUNS.mkdir()
    (session.RUNS / "20300101-000000-quick").symlink_to(base_folder)
    assert session.open_run().run.folder.resolve() == base_folder.resolve()


@exhaustive
def test_in_jupyter_what_is_missing_is_said_and_the_cells_below_are_run(tmp_path, monkeypatch):
    kept = carried("results/reference/run")
    monkeypatch.setenv(session.RUN_VARIABLE, str(kept))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(Path(__file__).parents[3])]))
    name = "real_time"  # of which the baseline has nothing
    notebook = nbformat.read(carried("notebooks") / f"{name}.ipynb", as_version=4)
    client = NotebookClient(notebook, timeout=600, kernel_name="python3")
    client.execute(cwd=str(tmp_path))
    said = [it for cell in notebook.cells for it in cell.get("outputs", [])]
    told = [it["text"] for it in said if it["output_type"] == "stream"]
    assert sum(text.startswith("This run has not ") and text.count("\n") == 1 for text in told) > 1
    assert not any(it["output_type"] == "error" for it in said)
