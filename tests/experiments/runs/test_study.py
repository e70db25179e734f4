"""Whatever happens to a study, nothing finished is lost."""

import os
import shutil
import signal
import subprocess
from pathlib import Path
from threading import Event

import pytest

from experiments.harness import Measurement
from experiments.harness.steadiness import REPEATS
from experiments.runs import (
    CannotWriteError,
    CaseFile,
    Job,
    ResultsError,
    load,
    provenance,
    read_meta,
    study,
    worker,
    write_meta,
)
from experiments.runs.store import DamagedError, InUseError, case_files, lock_run
from experiments.runs.worker import AGAIN, COMPILE, WorkerDiedError, perform
from tests.experiments.cli.calls import hem
from tests.experiments.made_runs import STEADY
from tests.experiments.small_study import (
    begin,
    damage,
    go_on,
    in_new_process,
    samples,
    wait_for,
    workers_of,
)
from tests.extent import exhaustive, waiting_for


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 1 MB, where one may be mounted."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "none", str(place)]
    if not shutil.which("mount") or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("no file system may be mounted here")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True)


def fill(disk: Path) -> None:
    """Leave not a byte of a file system."""
    with (disk / "filler").open("wb", buffering=0) as file:
        for size in (1 << 16, 1 << 12, 1):
            try:
                while True:
                    file.write(bytes(size))
            except OSError:
                continue


def test_a_study_of_some_experiments_on_some_structures_is_a_run(finished):
    run = load(finished)
    assert set(run.cases["experiment"]) == {"bench_memory"}
    assert set(run.cases["structure"]) == {"indexed"}
    assert set(run.cases["id"]) == set().union(*(job.ids for job in study.plan(finished)))
    assert run.meta["files"] == {"bench_memory.indexed.jsonl": len(run.cases)}
    assert run.meta["finished"] >= run.meta["started"]
    assert {"commit", "dirty", "machine", "versions", "preset"} <= set(run.meta)


def test_an_experiment_that_became_part_of_another_keeps_its_name_and_its_older_results(tmp_path):
    folder = begin(tmp_path, "valence", structures=["half_edge"])
    assert {job.experiment for job in study.plan(folder)} == {"bench_queries"}
    older = CaseFile(folder, "bench_valence", "half_edge")
    older.add(Measurement("a", "time", samples=[1.0], valence=8))
    assert load(folder).cases["experiment"].tolist() == ["bench_queries"]


def test_a_study_heeds_no_settings_of_the_project_that_it_is_installed_in(tmp_path, monkeypatch):
    site = tmp_path / "project" / "site-packages"
    site.mkdir(parents=True)
    for package in ("experiments", "hem", "structures"):
        (site / package).symlink_to(worker.EXPERIMENTS.parent / package)
    (site.parent / "pytest.ini").write_text("[pytest]\naddopts = --of-another-plugin\n")
    (site.parent / "conftest.py").write_text("raise OSError")
    monkeypatch.setattr(worker, "EXPERIMENTS", site / "experiments")
    folder = begin(tmp_path)
    assert go_on(folder) == []
    assert len(load(folder).cases)


def test_a_run_tells_no_commit_of_the_project_that_it_is_installed_in(tmp_path, monkeypatch):
    def git(*arguments: str) -> str:
        name = "-c", "user.name=a", "-c", "user.email=a@b"
        command = ["git", "-C", str(tmp_path), *name, *arguments]
        return subprocess.check_output(command, text=True).strip()

    own = tmp_path / "provenance.py"
    own.touch()
    (tmp_path / "theirs.py").touch()
    git("init", "--quiet")
    git("add", "theirs.py")
    git("commit", "--quiet", "-m", "theirs")
    monkeypatch.setattr(provenance, "__file__", str(own))

    def told() -> tuple[str, bool | None]:
        head = provenance.describe("smoke")
        return head["commit"], head["dirty"]

    assert told() == ("unknown", None)
    git("add", own.name)
    git("commit", "--quiet", "-m", "ours")
    assert told() == (git("rev-parse", "HEAD"), False)


def test_what_leaves_nothing_to_measure_is_refused_and_leaves_no_run(tmp_path):
    with pytest.raises(ValueError, match="nothing to measure: printed is of as_printed, "):
        begin(tmp_path, "printed", structures=["half_edge", "indexed"])
    assert not list(tmp_path.iterdir())


def test_names_that_there_are_not_are_told_with_those_there_are(tmp_path):
    with pytest.raises(ValueError, match=r"no experiment is called 'nothing'; there are .*memory"):
        begin(tmp_path, "nothing")
    with pytest.raises(ValueError, match="no structure is called 'nothing'; there are indexed"):
        begin(tmp_path, structures=["nothing"])
    assert list(tmp_path.iterdir()) == []


def test_resuming_sets_a_damaged_file_aside_and_measures_its_cases_again(run):
    (path,) = case_files(run)
    before = samples(run)
    damage(path, "another number")
    broken = path.read_bytes()
    assert "was damaged and is set aside" in go_on(run)[0]
    assert samples(run) == before  # bytes are the same each time
    assert path.with_name(f"{path.name}.damaged").read_bytes() == broken
    assert len(load(run).meta["resumed"]) == 1


def test_a_file_that_is_gone_from_a_finished_run_is_missed(run):
    (path,) = case_files(run)
    path.unlink()
    with pytest.raises(DamagedError, match=r"bench_memory\.indexed\.jsonl is missing"):
        load(run)
    code, output = hem("table", str(run))
    assert (code, output.count("hem study --resume --run")) == (1, 1)


def test_disturbed_cases_are_measured_again_by_a_new_process(run):
    file = CaseFile(run, "bench_memory", "indexed")
    busy = {**STEADY, "off_cpu": 0.9}
    first, *others = file.measurements
    first.kind, first.noise = "time", busy
    file.path.unlink()
    CaseFile(run, "bench_memory", "indexed").add(first, *others)
    jobs = study.plan(run)
    assert [len(job.file(run).disturbed) for job in jobs] == [1]
    assert list(perform(run, jobs, AGAIN)) == jobs
    again = CaseFile(run, "bench_memory", "indexed").measurements
    assert [it.id for it in again] == [it.id for it in (first, *others, first)]


def test_disturbed_cases_are_measured_again_no_more_often_than_they_may(run, monkeypatch):
    actions, told = [], []
    observer = study.Observer()
    observer.repeating = lambda cases, seconds: told.append(cases)
    monkeypatch.setattr(CaseFile, "disturbed", {"a case"})
    monkeypatch.setattr(study, "perform", lambda *given: (actions.append(given[2:]) for _ in "a"))
    study._measure_again(run, study.plan(run), float("inf"), observer)
    assert actions == [(AGAIN,)] * REPEATS
    study._measure_again(run, study.plan(run), 0, observer)
    assert told == [1] * (REPEATS + 1)
    assert len(actions) == len(told)
    most = [key for job in study.plan(run) for key in job.ids]
    monkeypatch.setattr(CaseFile, "disturbed", set(most))  # it would be as busy once more
    study._measure_again(run, study.plan(run), float("inf"), observer)
    assert len(actions) == REPEATS + 1


@exhaustive
def test_a_full_disk_stops_the_study_and_loses_nothing(small_disk):
    """The disk fills up after some cases; there is room again; the run is resumed and ends."""
    folder = begin(small_disk, "work")
    kept: dict[str, list[float]] = {}
    filler = small_disk / "filler"

    def fill_up(job: study.Job, done: int) -> None:
        if not filler.exists():
            fill(small_disk)
            kept.update(samples(folder))

    with pytest.raises(CannotWriteError, match=r"No space left on device.*make room"):
        go_on(folder, fill_up)
    assert kept
    assert kept.items() <= samples(folder).items()
    with pytest.raises(CannotWriteError, match="make room"):
        go_on(folder)
    filler.unlink()
    assert go_on(folder) == []
    assert kept.items() <= samples(folder).items()
    assert "finished" in load(folder).meta


@pytest.fixture
def read_only(tmp_path, request):
    """A folder that nobody may write to: by its mode, which root need not mind, or by its mount."""
    if os.geteuid() == 0:
        place = request.getfixturevalue("small_disk")
        subprocess.run(["mount", "-o", "remount,ro", str(place)], check=True)
        return place
    place = tmp_path / "read only"
    place.mkdir(mode=0o555)
    return place


def require_named(place: Path, said: str) -> None:
    code, output = hem("study", "--preset", "smoke", "--output", str(place))
    assert code == 1
    assert output.startswith("hem:")
    assert str(place) in output
    assert "choose another folder" in output
    assert said in output


def test_a_folder_that_cannot_be_written_is_named_in_one_line(read_only):
    require_named(read_only, "writable")


def test_a_file_in_the_place_of_a_folder_is_named_in_one_line(tmp_path):
    (tmp_path / "file").write_text("")
    require_named(tmp_path / "file" / "runs", "a file")


def test_a_run_is_not_resumed_by_other_code(run):
    write_meta(run, {**read_meta(run), "commit": "0123456789abcdef"})
    with pytest.raises(ResultsError, match=r"was begun at commit 0123456789ab.*go back to that"):
        go_on(run)


def test_a_folder_without_a_run_cannot_be_resumed(tmp_path):
    code, output = hem("study", "--resume", "--run", str(tmp_path))
    assert (code, "holds no run" in output) == (1, True)


def test_a_run_is_resumed_as_it_was_begun(run):
    code, output = hem("study", "--resume", "--run", str(run), "--seed", "5")
    assert (code, "leave out --seed" in output) == (1, True)
    code, output = hem("study", "--run", str(run))
    assert (code, "say --resume as well" in output) == (1, True)
    code, output = hem("study", "--resume", "--run", str(run), "--preset", "smoke", "--seed", "1")
    assert (code, "The machine was" in output or "No timed case" in output) == (0, True)


def test_of_two_studies_in_one_folder_the_second_is_told_who_has_it(run):
    script = "with store.lock_run(folder): print('held', flush=True); time.sleep(600)"
    with in_new_process(script, run) as holder:
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(InUseError, match=rf"process {holder.pid} on .*wait"):
            go_on(run)
        code, output = hem("study", "--resume", "--run", str(run))
        assert (code, f"process {holder.pid}" in output) == (1, True)
        holder.kill()
    assert go_on(run) == []  # a lock that is left behind is nobody's


def test_two_studies_begun_in_the_same_second_have_folders_of_their_own(tmp_path):
    assert len({begin(tmp_path) for _ in range(3)}) == 3


def test_a_worker_that_is_killed_costs_no_finished_case_and_stops_no_other_job(tmp_path):
    folder = begin(tmp_path, "work", structures=("indexed", "half_edge"))
    kept: dict[str, list[float]] = {}

    def kill(job: study.Job, done: int) -> None:
        if not kept:
            kept.update(samples(folder))
            for worker in workers_of(folder):
                worker.kill()

    with pytest.raises(study.StudyFailedError, match=r"^work on indexed"):
        go_on(folder, kill)
    after = samples(folder)
    assert kept.items() <= after.items()
    killed, other = study.plan(folder)
    assert killed.left(folder)
    assert not other.left(folder)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_whoever_stops_a_study_leaves_no_process_behind(tmp_path, how):
    """As an interrupt in a notebook: the signal reaches the one who called, and nobody else."""
    folder, script = begin(tmp_path, "work"), "study.run(folder, Prints())"
    with in_new_process(script, folder, start_new_session=True) as caller:
        caller.stdout.readline()
        before = samples(folder)
        caller.send_signal(how)
        _, said = caller.communicate()
    wait_for(lambda: not workers_of(folder))
    assert before
    assert before.items() <= samples(folder).items()
    assert ("KeyboardInterrupt" in said) == (how == signal.SIGINT)
    with lock_run(folder):
        pass


def test_what_is_left_of_several_experiments_is_compiled_whatever_else_is_done(tmp_path):
    folder = begin(tmp_path, "operations", "build", structures=("indexed", "half_edge"))
    jobs = {(it.experiment, it.structure): it for it in study.plan(folder)}
    some = ("build", "indexed"), ("operations", "half_edge"), ("build", "half_edge")
    left = [jobs[f"bench_{experiment}", structure] for experiment, structure in some]
    assert set(perform(folder, left, COMPILE)) == set(left)


def test_a_changed_source_is_compiled_anew_in_whichever_language(tmp_path, monkeypatch):
    monkeypatch.setattr(study, "ROOT", tmp_path)
    room = tmp_path / "experiments" / "peers"
    room.mkdir(parents=True)
    for name in ("peer.py", "program.cpp"):
        before = study._sources.__wrapped__()
        (room / name).write_text("another")
        assert study._sources.__wrapped__() != before


DAMAGES = "another number", "joined with a copy", "gone"


@pytest.mark.parametrize("what", waiting_for(DAMAGES[:1], DAMAGES))
def test_a_damaged_run_is_mended_by_the_command_that_its_error_names(run, what):
    (path,) = case_files(run)
    before = samples(run)
    if what == "gone":
        file = CaseFile.at(path)
        file.add(file.measurements[0])  # measured twice
        study.finish(run)
        path.unlink()
    else:
        damage(path, what)
    code, output = hem("study", "--resume", "--run", str(run))
    assert code == 0, output
    assert samples(run) == before
    assert load(run).meta["files"] == {path.name: len(before)}


@pytest.mark.parametrize(
    ("part", "key", "words"),
    [("machine", "cpu", "another machine"), ("versions", "numba", "numba")],
)
def test_a_run_is_not_resumed_where_its_times_do_not_belong(run, part, key, words):
    meta = read_meta(run)
    write_meta(run, {**meta, part: {**meta[part], key: "0.1"}})
    with pytest.raises(ResultsError, match=words):
        go_on(run)
    assert "resumed" not in read_meta(run)


def test_a_run_resumed_with_changes_is_told_to_be_changed(run, monkeypatch):
    write_meta(run, {**read_meta(run), "dirty": False})
    monkeypatch.setattr(study, "describe", lambda preset: {**read_meta(run), "dirty": True})
    go_on(run)
    assert read_meta(run)["dirty"] is True


def test_a_stop_ends_a_worker_before_its_first_case(tmp_path):
    folder, stop = begin(tmp_path, "work"), Event()
    stop.set()
    with pytest.raises(WorkerDiedError):
        list(perform(folder, study.plan(folder), stop=stop))
    assert samples(folder) == {}


def test_once_stopped_no_other_worker_begins(run, monkeypatch):
    begun, stop = [], Event()

    def perform(*given, stop):
        begun.append(given)
        stop.set()
        raise WorkerDiedError("interrupted")
        yield

    monkeypatch.setattr(study, "perform", perform)
    monkeypatch.setattr(Job, "left", lambda job, folder: ["a case"])
    jobs = study.plan(run) * 3
    assert study._measure(run, jobs, study.Observer(), stop) == []
    assert len(begun) == 1
