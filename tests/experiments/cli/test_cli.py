"""The command line as a newcomer types it, wrong arguments included."""

import json
import os
import shutil
import subprocess
import sys
import threading
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from experiments import report
from experiments.cli import progress
from experiments.cli import study as study_command
from experiments.cli.check import BASELINE
from experiments.presets import PRESETS
from experiments.runs import experiments, load, read_meta, write_meta
from experiments.runs.study import plan
from experiments.runs.worker import Job
from structures import NAMES
from tests.experiments.cli.calls import mistake, output_of
from tests.experiments.made_runs import write_run
from tests.experiments.small_study import samples
from tests.extent import exhaustive
from tests.structures.conftest import NEEDS_MANIFOLD


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["study", "--profile", "fast"], "no preset is called 'fast'; there are smoke, quick"),
        (["study", "--resume"], "there is no unfinished run"),
        (["table"], "there is no run"),
        (["table", "nowhere"], "nowhere holds no run"),
        (["report"], "there is no run"),
        (["info", "no_such_file.ply"], "no_such_file.ply"),
        (["info", "bunnny"], "bunnny"),
        (["history", "show", "--file", "."], ".: Is a directory"),
        (["meshes", "--size", "3"], "reachable"),
    ],
)
def test_a_mistake_gets_one_clear_line_and_an_exit_code(arguments, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert said in mistake(*arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "command", [["meshes"], ["info", "torus:100", "--json"], ["-h"], ["check", "-h"], ["baseline"]]
)
def test_a_reader_who_has_enough_is_no_mistake(command):
    reads, writes = os.pipe()
    os.close(reads)
    run = [sys.executable, "-m", "experiments.cli", *command]
    ended = subprocess.run(run, stdout=writes, stderr=subprocess.PIPE, text=True)
    os.close(writes)
    assert ended.returncode == 141  # neither a mistake nor a verdict
    assert ended.stderr == ""


@pytest.mark.parametrize("how", [[], ["--json"]])
def test_a_verdict_is_told_where_signs_cannot_be_written(tmp_path, how):
    costs = tmp_path / "costs.csv"
    costs.write_text("n,f\n" + "".join(f"{n},{n**0.5}\n" for n in (16, 64, 256, 1024, 4096)))
    run = [sys.executable, "-m", "experiments.cli", "judge", str(costs), "--exact", *how]
    ended = subprocess.run(
        [*run, "--expected", "O(1)"], capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
    )  # fmt: skip
    assert ended.returncode == 1
    assert b"violated" in ended.stdout
    assert not how or json.loads(ended.stdout.decode())[0]["outcome"] == "violated"


def test_a_width_of_nothing_is_none_and_loses_no_line():
    run = [sys.executable, "-m", "experiments.cli"]
    for words in ("info -h", "info torus:100"):
        printed, known = (
            subprocess.check_output([*run, *words.split()], env={**os.environ, "COLUMNS": width})
            for width in ("0", "80")
        )
        assert printed == known


def test_names_are_told_as_they_are_whatever_brackets_they_have(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh, workload = Path("a[/b].obj"), tmp_path / "w.toml"
    mesh.parent.mkdir()
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    workload.write_text('title = "reads [/ops] only"\n[[rows]]\nwhat = "vertex_faces"\ntimes = 1\n')
    assert output_of("info", str(mesh)).startswith("a[/b].obj vertices 3")
    run = str(Path(__file__).parents[3] / "results/reference/run")
    assert "reads [/ops] only, on a[/b].obj (1 triangles)." in output_of(
        "advise", str(mesh), "--workload", str(workload), "--run", run
    )


def test_a_run_that_is_not_ended_is_told_how_it_goes_on(tmp_path):
    run = write_run(tmp_path / "half done", only=lambda _, it: it == "indexed")
    meta = read_meta(run)
    del meta["finished"]
    write_meta(run, meta)
    goes_on = f"hem study --resume --run '{run}'"
    assert goes_on in mistake("history", "add", str(run), "--file", str(tmp_path / "h.jsonl"))
    for path in run.glob("*.jsonl"):
        path.unlink()
    assert f"holds no case; resume it with: {goes_on}" in mistake("table", str(run))


def test_the_table_of_a_run_without_the_structures_of_the_thesis_has_those_that_there_are(tmp_path):
    run = str(write_run(tmp_path, only=lambda _, it: it == "triangle_soup"))
    assert output_of("table", run) == output_of("table", run, "--all")
    assert "Soup" in output_of("table", run)


def test_of_a_run_that_no_table_shows_the_table_says_what_does(tmp_path):
    run = str(write_run(tmp_path, only=lambda it, _: it == "bench_build"))
    assert "hem report shows" in mistake("table", run)


@pytest.mark.parametrize(
    ("experiment", "shown_by"),
    [("memory", ["table", "report"]), ("latency", ["report"]), ("peers", ["table --peers"])],
)
def test_a_study_names_the_commands_that_show_its_run(tmp_path, monkeypatch, experiment, shown_by):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(study_command, "_measure", lambda folder, _, now: print(f"{folder}|{now}"))
    folder, now = output_of("study", "--experiment", experiment, "--preset", "smoke").split("|")
    beside = f" {folder}" if experiment == "peers" else ""  # where the command would not look
    assert now.strip() == ", ".join(f"hem {it}{beside}" for it in shown_by)


def test_what_cannot_be_written_is_told_before_anything_is_measured(tmp_path):
    run = str(BASELINE / "run")
    assert "Is a directory" in mistake("check", run, "--markdown", str(tmp_path), code=2)
    assert "is a folder" in mistake("report", run, "--pdf", "--output", str(tmp_path))


@pytest.mark.parametrize(
    ("option", "said"), [("--mesh", "there is no model ''"), ("--workers", "no cluster answers at")]
)
def test_an_empty_name_is_a_mistake_and_no_study_without_it(option, said, tmp_path):
    assert said in mistake("study", option, "", "--experiment", "naming", "--output", str(tmp_path))
    assert list(tmp_path.iterdir()) == []


def test_a_baseline_that_is_not_there_is_made_where_it_was_looked_for(tmp_path):
    said = mistake("check", "--structure", "indexed", "--baseline", str(tmp_path), code=2)
    assert f"hem baseline update --baseline {tmp_path}" in said


def test_what_is_kept_of_a_run_is_not_resumed():
    said = mistake("study", "--resume", "--run", str(BASELINE / "run"))
    assert "holds what is kept of a run, which cannot be resumed" in said


def test_a_page_goes_where_it_is_told_to(base_folder, tmp_path, monkeypatch):
    monkeypatch.setattr(report, "write_readme", lambda _, folder: folder / "README.md")
    page = output_of("report", str(base_folder), "--page", "--output", "elsewhere")
    assert "elsewhere/README.md" in page
    monkeypatch.chdir(tmp_path)
    said = mistake("report", str(base_folder), "--output", ".")
    assert ". is the folder that you are in: choose one in it" in said


QUICK = [
    ["--version"], ["-h"], ["history", "show", "-h"], ["stdy"], ["study", "--seed", "many"],
    ["study", "--run", "nowhere"], ["study", "--preset", "fast"], ["table", "nowhere"],
    ["report", "nowhere"], ["history", "add", "nowhere"], ["check", "nowhere"],
    ["check", "--factor", "1"], ["baseline", "update", "nowhere"],
    ["fracture", "sphere", "--up", "w"],
]  # fmt: skip


def test_help_and_wrong_arguments_are_told_before_anything_heavy_is_imported():
    heavy = "numpy", "numba", "pandas", "matplotlib", "experiments.harness", "structures"
    code = (
        "import sys; from experiments.cli import app\n"
        f"for arguments in {QUICK}:\n"
        "    try: app(arguments)\n"
        "    except SystemExit: pass\n"
        f"    found = [it for it in {heavy} if it in sys.modules]\n"
        "    assert not found, (arguments, found)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("nowhere holds no run") == 5


@pytest.fixture
def read_only(tmp_path):
    """A run that nobody may write beside: by its mode, which root need not mind, or by a mount."""
    place = write_run(tmp_path / "run", only=lambda _, structure: structure == "half_edge")
    if os.geteuid():
        place.chmod(0o555)
        yield place
        place.chmod(0o755)
        return
    mount = ["mount", "--bind", "-o", "ro", str(place), str(place)]
    if not shutil.which("mount") or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("nothing may be mounted here")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True)


def test_a_run_that_cannot_be_written_beside_has_its_table(read_only):
    assert "Table 1" in output_of("table", str(read_only))
    assert not (read_only / "derived").exists()


def test_info_says_which_structure_can_hold_a_mesh_and_why_another_cannot(tmp_path):
    output = output_of("info", "teapot")
    assert "Half-Edge" in output
    assert "cannot hold" not in output
    output = output_of("info", "face")
    assert output.count("cannot hold it") == len(NEEDS_MANIFOLD)
    assert "1850" in output
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    output = output_of("info", str(tmp_path / "quad.obj"))
    assert output.count("cannot hold it") == len(NAMES) - 1
    assert output.count("triangulate=True") == 1


def test_what_a_file_loses_is_told_in_one_line(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf 1 2 3\n")
    output = output_of("info", str(tmp_path / "a.obj"))
    assert "a.obj has normals, which are dropped: a mesh is positions and faces" in output
    assert "MeshWarning" not in output


EVERY = tuple(name for name, it in experiments().items() if not it.by_name)


def test_meshes_lists_every_family_and_model():
    output = output_of("meshes", "--size", "400")
    assert all(name in output for name in ("torus", "isosurface", "bunny", "28,088", "teapot"))


@exhaustive
@pytest.mark.parametrize(
    ("structure", "measured"),
    [
        (
            "half_edge_objects",  # nothing to compile
            ("bench_latency", "bench_work", "bench_memory", "bench_printed"),
        ),
        pytest.param("indexed", EVERY, id="everything"),
    ],
)
def test_a_study_that_is_killed_is_resumed_where_it_was_and_ends_complete(
    tmp_path, structure, measured
):
    command = [sys.executable, "-m", "experiments.cli", "study", "--output", str(tmp_path)]
    chosen = ["--preset", "smoke", "--structure", structure, "--structure", "as_printed"]
    for name in measured:
        chosen += ["--experiment", name]
    with subprocess.Popen([*command, *chosen], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        for line in child.stdout:  # one for every job
            if f"work on {structure}" in line:
                break
        child.kill()
    (folder,) = tmp_path.iterdir()
    before = samples(folder)
    assert before

    resumed = subprocess.run([*command, "--resume"], capture_output=True, text=True)
    assert resumed.returncode == 0, resumed.stdout + resumed.stderr
    jobs, after = plan(folder), samples(folder)
    assert before.items() <= after.items()
    assert {f"{job.experiment}.{job.structure} {key}" for job in jobs for key in job.ids} == set(
        after
    )
    assert {job.experiment for job in jobs} == set(measured)
    assert {job.structure for job in jobs} == {structure, "as_printed", "machine"}
    assert load(folder).cases.query("experiment != 'bench_latency'")["checked"].all()


def test_profiles_reach_a_million_vertices_and_valence_4096():
    assert max(PRESETS["standard"].sizes) == max(PRESETS["full"].sizes) == 1_000_000
    assert all(set(p.valences) >= {4, 4096} for name, p in PRESETS.items() if name != "smoke")


def test_the_bars_move_when_a_case_ends_and_no_thread_moves_them(tmp_path, monkeypatch):
    terminal = Console(file=StringIO(), force_terminal=True, width=100)
    monkeypatch.setattr(progress, "console", terminal)
    job, before = Job("bench_memory", "indexed", "smoke"), threading.enumerate()
    with progress.show_progress([job], tmp_path) as observer:
        assert threading.enumerate() == before
        for done in range(1, len(job.ids) + 1):
            observer.measured(job, done)
            *_, shown = terminal.file.getvalue().rpartition("memory on indexed")
            assert f"{done}/{len(job.ids)}" in shown
