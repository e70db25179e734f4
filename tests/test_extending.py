"""A structure is one file, an experiment is one file: both are found by table, report and check.

The files are those that the tutorial shows. The map of the rooms is what the imports are.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from tests.extent import exhaustive

ROOT = Path(__file__).parents[1]
COPIED = ("hem", "structures", "experiments", "notebooks", "results/reference", "tests")

MAP = (ROOT / "ARCHITECTURE.md").read_text()
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


NO_STRUCTURE = "claims of ['indexedd'], which are no structures"


@exhaustive
def test_a_structure_or_an_experiment_that_forgets_something_is_an_error_that_names_it(shown):
    walks = EXPERIMENT.replace("test_walk", "test_half_done")
    other = STRUCTURE.replace("QEM", "HDM").replace('"D", ":"', '"P", ":"')
    costs = '{"vertex_faces": "O(n_x)"}'
    of_structure, of_experiment = "structures/half_done.py", "experiments/bench_half_done.py"
    for path, text, named in [
        (of_structure, STRUCTURE.replace("claims =", "claimed ="), "claims"),
        (of_structure, other.replace('"half_edge")', '"halfedge")'), "'halfedge'"),
        (of_structure, other.replace('like="half_edge"', costs), "'O(n_x)' is none of"),
        (of_structure, other.replace("False, 10", "True, 10"), "claims nothing of 'half_done'"),
        (of_experiment, walks, "bench_half_done and bench_random_walk both decide walks"),
        *[
            (of_experiment, walks.replace(was, now), told)
            for was, now, told in [
                ("copies=1", 'copies=1, structures=("indexedd",)', NO_STRUCTURE),
                ('"indexed"', '"indexedd"', NO_STRUCTURE),
                ('"Random walks"', '"Half"', "have different tables called 'walks'"),
                ("query_scaling", "query_scalling", "'query_scalling', its chapter"),
                ("WORK_FACES:", "TIME_FACES:", "['time_faces']: an order has"),
                ('axes={Axis.WORK_FACES: "walked"},', "", "axes and the table they decide"),
                ("test_half_done", "walk", "test_half_done = EXPERIMENT.test"),
            ]
        ],
        (of_experiment, '"""Nothing."""\n', "EXPERIMENT"),
    ]:
        file = shown / path
        file.write_text(text.replace("quarter_edge", "half_done"))
        try:
            said = python(shown, "-m", "experiments.cli", "table", "run", code=1)
        finally:
            file.unlink()
        assert "half_done" in said
        assert named in said


TURNS = """
import hem, structures
from experiments.harness import OPERATIONS, PRESETS
from experiments.harness.operations import operation_arguments
from experiments.runs import experiments
s = structures.build("half_edge", hem.generate("torus", 100), compiled=False)
(turned, *_), *_ = operation_arguments(s, "turn_edge", s.faces()[7:8])
assert turned == s.face_edges(7)[0] != 7
before = set(s.edge_vertices(turned))
s.operate("turn_edge", turned)
s.validate()
assert not before & set(s.edge_vertices(turned))
assert OPERATIONS["turn_edge"] == "Turn edge"
for name in ("operations", "operation_work"):
    cases = experiments()[f"bench_{name}"].cases(PRESETS["standard"], "half_edge")
    assert "turn_edge" in {it.subject for it in cases}, name
"""


def test_an_operation_is_one_module_and_its_name_where_it_is_measured(extended):
    module = extended / "hem/authoring/operations/turn_edge.py"
    named = extended / "experiments/harness/experiment.py"
    was = named.read_text()
    module.write_text(
        "from hem.authoring.operations.flip_edge import Operation, make\n"
        'OPERATIONS = {"turn_edge": Operation(make, "edge")}\n'
    )
    named.write_text(was.replace('MEASURED = "', 'MEASURED = "turn_edge", "'))
    try:
        python(extended, "-c", TURNS)
        module.write_text(module.read_text().replace("OPERATIONS", "OPERATION"))
        said = python(extended, "-c", "import hem.contract", code=1)
        assert "operations.turn_edge' has no attribute 'OPERATIONS'" in said
        module.unlink()
        said = python(extended, "-c", "import experiments.harness", code=1)
        assert "no operation of hem.authoring is called 'turn_edge'" in said
    finally:
        module.unlink(missing_ok=True)
        named.write_text(was)


def test_the_map_of_the_rooms_draws_every_import_between_them_and_no_other():
    drawn = re.search(r"subgraph experiments\n.*?\n(.*?)\n    end", MAP, re.S)
    assert drawn
    rows = [re.findall(r"(\w+)(?:\[.*?\])?", it) for it in drawn[1].splitlines()]
    arrows = {pair for row in rows for pair in pairwise(row)}
    imports = set()
    for path in (ROOT / "experiments").rglob("*.py"):
        room = path.relative_to(ROOT / "experiments").parts[0]
        for other in re.findall(r"(?m)^\s*(?:from|import) experiments\.(\w+)", path.read_text()):
            imports.add((re.sub("bench_.*", "bench", room), re.sub("bench_.*", "bench", other)))
    rooms = {room for pair in arrows for room in pair}
    imports = {(b, a) for a, b in imports if a != b and {a, b} <= rooms}
    assert arrows - imports == {("bench", "runs")}  # found by name
    below = {room: {room} for room in rooms}
    for _ in rooms:
        for a, b in arrows:
            below[b] |= below[a]
    assert all(a in below[b] for a, b in imports)
