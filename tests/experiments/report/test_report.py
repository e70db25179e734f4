"""The report opens from disk, says what was found, and can be read."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from experiments.claims.growth import OPERATIONS
from experiments.report import figures, operation_figures, readme
from experiments.report.site import write
from experiments.report.style import spread_apart
from experiments.runs.results import ResultsError, load
from tests.experiments.made_runs import write_run
from tests.experiments.small_study import wait_for


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory):
    return write_run(tmp_path_factory.mktemp("run"))


@pytest.mark.parametrize("there", ["a file", "a folder of others"])
def test_nothing_but_a_report_is_replaced(run_folder, tmp_path, there):
    if there == "a file":
        output = kept = tmp_path / "thesis.txt"
    else:
        output, kept = tmp_path, tmp_path / "thesis.txt"
    kept.write_text("years of work")
    with pytest.raises(ResultsError, match=r"is no report.*choose a folder"):
        write(run_folder, output)
    assert kept.read_text() == "years of work"


def test_a_report_that_fails_leaves_the_old_one(run_folder, tmp_path, monkeypatch):
    (tmp_path / "html").mkdir()
    (tmp_path / "html" / "index.html").write_text("old")
    monkeypatch.setattr("experiments.report.chapters.CHAPTERS", {"no_such": "No such chapter"})
    with pytest.raises((OSError, ResultsError)):
        write(run_folder, tmp_path / "html")
    assert (tmp_path / "html" / "index.html").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["html"]


def test_an_interrupt_in_a_notebook_leaves_the_old_report_and_no_kernel(run_folder, tmp_path):
    """A notebook has a loop running, and the signal reaches it alone."""
    (tmp_path / "html").mkdir()
    (tmp_path / "html" / "index.html").write_text("old")
    script = (
        "import asyncio, sys; from pathlib import Path; from experiments import chapters, report\n"
        "chapters.CHAPTERS = {'memory': 'Memory', 'errata': 'Errata', 'fracture': 'Fracture'}\n"
        "async def cell(): report.write(Path(sys.argv[1]), Path(sys.argv[2]) / 'html')\n"
        "asyncio.new_event_loop().run_until_complete(cell())"
    )
    command = [sys.executable, "-c", script, str(run_folder), str(tmp_path)]
    caller = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: kernels_of(caller.pid))
    kernels = kernels_of(caller.pid)
    caller.send_signal(signal.SIGINT)
    _, said = caller.communicate(timeout=20)
    assert "KeyboardInterrupt" in said
    assert not any(Path(f"/proc/{kernel}").exists() for kernel in kernels)
    assert (tmp_path / "html" / "index.html").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["html"]


def kernels_of(process: int) -> list[int]:
    command = ["ps", "--ppid", str(process), "-o", "pid=,args="]
    listed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    return [int(line.split()[0]) for line in listed.splitlines() if "ipykernel" in line]


def test_the_committed_page_has_the_table_and_its_pictures(run_folder, tmp_path):
    page = readme.write(run_folder, tmp_path / "report")
    text = page.read_text()
    assert "| Bytes per vertex | 36 ✓ | 116 ✓ | 228 ✓ | 228 ✓ |" in text
    assert "| Split face | O(n_t) ✓ | O(1) ✓ | O(1) ✓ | O(1) ✓ |" in text
    assert "6.33 | ✓ consistent |" in text
    for picture in re.findall(r"\((\w+\.png)\)", text):
        assert (page.parent / picture).stat().st_size > 10_000


FIGURES = {
    "queries by time": lambda run: figures.scaling(run, "time", "faces"),
    "queries by work": lambda run: figures.scaling(run, "work", "valence"),
    "operations": lambda run: figures.scaling(run, "time", "faces", OPERATIONS),
    "workloads": operation_figures.workloads,
    "overtaking": operation_figures.overtaking,
    "rendering": operation_figures.rendering,
}


@pytest.mark.parametrize("name", FIGURES)
def test_labels_do_not_overlap_and_stay_inside_the_figure(run_folder, name):
    figure = FIGURES[name](load(run_folder))
    figure.draw_without_rendering()
    for axes in (it for it in figure.axes if it.get_visible()):
        boxes = [text.get_window_extent() for text in axes.texts]
        assert boxes
        for i, box in enumerate(boxes):
            assert figure.bbox.x1 >= box.x1
            assert not any(box.overlaps(other) for other in boxes[i + 1 :])


def test_labels_are_moved_as_little_as_need_be():
    assert spread_apart([0.0, 30.0], 10) == [0.0, 30.0]
    assert spread_apart([0.0, 0.0], 10) == [-5.0, 5.0]
    rng = np.random.default_rng(0)
    for _ in range(50):
        heights = sorted(rng.uniform(0, 60, 5).tolist())
        spread = spread_apart(heights, 10)
        assert (np.diff(spread) >= 10 - 1e-9).all()
        assert np.isclose(np.mean(spread), np.mean(heights))
