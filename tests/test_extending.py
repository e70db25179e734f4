"""A structure is one file, an experiment is one file: both are found by table, report and check.

The files are those that the tutorial shows.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
COPIED = ("hem", "structures", "experiments", "notebooks", "results/reference", "tests")

PAGE = (ROOT / "docs/structure.md").read_text()
(STRUCTURE_FILE, STRUCTURE), (EXPERIMENT_FILE, EXPERIMENT) = re.findall(
    r'(?ms)^```python title="(.*?)"\n(.*?)^```', PAGE
)
"""What the page on adding them shows, and where it says that it belongs."""


@pytest.fixture(scope="module")
def extended(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the project with one more structure and one more experiment, and a run of it."""
    tree = tmp_path_factory.mktemp("extended")
    for part in COPIED:
        shutil.copytree(ROOT / part, tree / part, symlinks=True)  # times stay: the cache is valid
    (tree / STRUCTURE_FILE).write_text(STRUCTURE)
    (tree / EXPERIMENT_FILE).write_text(EXPERIMENT)
    return tree


SHOWS = """
from contextlib import redirect_stdout
from pathlib import Path
from experiments.cli import app
from tests.experiments.made_runs import write_run
write_run(Path("run"), only=lambda _, it: it in ("half_edge", "quarter_edge"))
with Path("table.txt").open("w") as file, redirect_stdout(file):
    app(["table", "run", "--all"], standalone_mode=False)
from experiments.report.notebooks import body
pages = map(body, ("index", "query_scaling", "structures"))
Path("pages.html").write_text("".join(pages), "utf-8")
"""


@pytest.fixture(scope="module")
def shown(extended: Path) -> Path:
    """That copy, with a run of two structures, its table and some chapters, by one process."""
    python(extended, "-c", SHOWS, run="run")
    return extended


def python(tree: Path, *arguments: str, code: int = 0, run: str = "") -> str:
    command, environment = [sys.executable, *arguments], {**os.environ, "HEM_RUN": run}
    ran = subprocess.run(
        command, cwd=tree, capture_output=True, text=True, timeout=600, env=environment
    )
    assert ran.returncode == code, ran.stdout + ran.stderr
    return ran.stdout + ran.stderr


def test_the_table_shows_a_new_structure_and_a_new_experiment(shown):
    printed = (shown / "table.txt").read_text()
    assert "QEM" in printed
    assert "Random walks" in printed
    assert "Walk over faces" in printed


def test_the_report_shows_them_on_its_front_page_and_in_the_chapter_of_their_table(shown):
    pages = (shown / "pages.html").read_text("utf-8")
    assert '<h2 id="quarter_edge">Quarter-Edge</h2>' in pages
    for words in ("Quarter-Edge", "Random walks", "Walk over faces"):
        assert words in pages


def test_the_check_measures_them_and_says_what_is_next(extended):
    command = ("-m", "experiments.cli", "check", "--json", "--structure", "quarter_edge")
    said = python(extended, *command, code=2)  # what the baseline lacks cannot be told
    assert "random_walk" in said
    assert "quarter_edge" in said
    assert "hem baseline update" in said


def test_a_structure_or_an_experiment_that_forgets_something_is_an_error_that_names_it(extended):
    for path, text, named in [
        ("structures/half_done.py", STRUCTURE.replace("claims =", "claimed ="), "claims"),
        ("experiments/bench_half_done.py", '"""Nothing."""\n', "EXPERIMENT"),
    ]:
        file = extended / path
        file.write_text(text.replace("quarter_edge", "half_done"))
        try:
            said = python(extended, "-m", "experiments.cli", "table", "run", code=1)
        finally:
            file.unlink()
        assert "half_done" in said
        assert named in said
