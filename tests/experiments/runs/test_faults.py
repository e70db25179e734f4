"""Whatever happens to a study, nothing finished is lost and nothing broken is read as good."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from experiments.runs import locks, study, worker
from experiments.runs.results import (
    CannotWriteError,
    DamagedError,
    Measurement,
    ResultFile,
    ResultsError,
    load,
    write_json,
    write_sealed,
)
from tests.experiments.cli.test_cli import hem
from tests.experiments.small_study import begin, children_of, damage, go_on, samples, wait_for

DAMAGES = (
    "truncated", "emptied", "overwritten", "another number", "without its checksum", "a list",
)  # fmt: skip


@pytest.fixture(autouse=True)
def one_experiment(monkeypatch):
    monkeypatch.setattr(study, "EXPERIMENTS", ("bench_memory",))
    monkeypatch.setattr(worker, "POLL_SECONDS", 0.01)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "EXPERIMENTS", ("bench_memory",))
        folder = begin(tmp_path_factory.mktemp("runs"))
        assert go_on(folder) == []
    return folder


@pytest.fixture
def run(finished, tmp_path):
    """A finished run of one file, a copy for each test."""
    return Path(shutil.copytree(finished, tmp_path / "runs" / finished.name))


@pytest.fixture
def made_up(tmp_path):
    write_sealed(tmp_path / "run.json", {"schema": 2, "profile": "smoke"})
    file = ResultFile(tmp_path, "bench_x", "indexed")
    file.add(Measurement("a", "time", samples=[1.5, 2.5]))
    return file.path


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


def fill(disk: Path) -> Path:
    """Leave not a byte of a file system."""
    filler = disk / "filler"
    with filler.open("wb", buffering=0) as file:
        for size in (1 << 16, 1 << 12, 1):
            try:
                while True:
                    file.write(bytes(size))
            except OSError:
                continue
    return filler


@pytest.mark.parametrize("how", DAMAGES)
def test_a_damaged_file_is_named_with_what_to_do_and_never_read(made_up, how):
    damage(made_up, how)
    named = r"bench_x\.indexed\.json.*hem study --resume"
    with pytest.raises(DamagedError, match=named):
        load(made_up.parent)
    with pytest.raises(DamagedError, match=named):
        ResultFile(made_up.parent, "bench_x", "indexed")


def test_no_flipped_bit_changes_what_is_read(made_up):
    good = made_up.read_bytes()
    before = load(made_up.parent).cases.to_dict("records")
    for bit in range(0, 8 * len(good), 7):
        flipped = bytearray(good)
        flipped[bit // 8] ^= 1 << bit % 8
        made_up.write_bytes(bytes(flipped))
        try:
            content = study.read_json(made_up)
            ResultFile(made_up.parent, "bench_x", "indexed")
        except ResultsError:
            continue
        assert content["cases"][0]["samples"] == before[0]["samples"].tolist()
        assert [content[key] for key in ("experiment", "structure")] == ["bench_x", "indexed"]


def test_a_damaged_head_of_a_run_is_not_taken_for_another_run(made_up, tmp_path):
    run = tmp_path / "runs" / "2"
    for name in ("1", "2"):
        write_sealed(tmp_path / "runs" / name / "run.json", {"schema": 2, "profile": "smoke"})
    text = (run / "run.json").read_text()
    (run / "run.json").write_text(text.replace("smoke", "quick"))
    with pytest.raises(DamagedError, match=r"2/run\.json.*checksum.*Move"):
        study.resume(tmp_path / "runs")


def test_resuming_sets_a_damaged_file_aside_and_measures_its_cases_again(run):
    (path,) = study.result_files(run)
    before = samples(run)
    damage(path, "truncated")
    broken = path.read_bytes()
    assert "was damaged and is set aside" in go_on(run)[0]
    assert samples(run) == before  # bytes are the same each time
    assert path.with_name(f"{path.name}.damaged").read_bytes() == broken
    assert len(load(run).meta["resumed"]) == 1


def test_a_file_that_is_gone_from_a_finished_run_is_missed(run):
    (path,) = study.result_files(run)
    path.unlink()
    with pytest.raises(DamagedError, match=r"bench_memory\.indexed\.json is missing"):
        load(run)
    code, output = hem("table", str(run))
    assert (code, output.count("hem study --resume --run")) == (1, 1)


def test_runs_of_the_schema_before_are_still_read(tmp_path):
    write_json(tmp_path / "run.json", {"schema": 1})
    case = {"id": "a", "kind": "time", "samples": [1.0], "skipped": ""}
    head = {"schema": 1, "experiment": "bench_x", "structure": "indexed"}
    write_json(tmp_path / "bench_x.indexed.json", {**head, "cases": [case]})
    (row,) = load(tmp_path).cases.to_dict("records")
    assert (row["samples"].tolist(), row["noise"], row["machine"]) == ([1.0], {}, "")


def test_a_full_disk_stops_the_study_and_loses_nothing(small_disk):
    """The disk fills up after some cases; there is room again; the run goes on and ends."""
    folder = begin(small_disk)
    kept: dict[str, list[float]] = {}
    filler = small_disk / "filler"

    def fills_up(process: study.Process, done: int) -> None:
        if done and not filler.exists():
            fill(small_disk)
            kept.update(samples(folder))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "EXPERIMENTS", ("bench_work",))
        with pytest.raises(CannotWriteError, match=r"No space left on device.*make room"):
            go_on(folder, fills_up)
        assert kept
        assert kept.items() <= samples(folder).items()
        with pytest.raises(CannotWriteError, match="make room"):
            go_on(folder)
        filler.unlink()
        assert go_on(folder) == []
    assert kept.items() <= samples(folder).items()
    assert "finished" in load(folder).meta


def test_a_file_that_cannot_be_written_stays_as_it_was(tmp_path):
    """As a full disk, where none can be mounted: files may not grow past a limit."""
    script = (
        "import resource, signal, sys; from pathlib import Path\n"
        "from experiments.runs.results import *\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "f = ResultFile(Path(sys.argv[1]), 'bench_x', 'indexed'); f.add(Measurement('a', 'time'))\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))\n"
        "f.add(Measurement('b', 'time', samples=[0.5] * 9000))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True, check=False
    )
    assert "bench_x.indexed.json cannot be written" in ran.stderr
    assert ResultFile(tmp_path, "bench_x", "indexed").finished == {"a"}
    assert [path.name for path in tmp_path.iterdir()] == ["bench_x.indexed.json"]


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
    code, output = hem("study", "--profile", "smoke", "--output", str(place))
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


def test_a_run_that_cannot_be_written_to_can_be_read(small_disk):
    folder = begin(small_disk)
    assert go_on(folder) == []
    subprocess.run(["mount", "-o", "remount,ro", str(small_disk)], check=True)
    code, output = hem("table", str(folder))
    assert (code, "Bytes per vertex" in output) == (0, True), output


def test_a_run_is_not_gone_on_with_by_other_code(run):
    meta = study.read_json(run / "run.json")
    write_sealed(run / "run.json", {**meta, "commit": "0123456789abcdef"})
    with pytest.raises(ResultsError, match=r"was begun at commit 0123456789ab.*check that commit"):
        go_on(run)


def test_a_copy_of_a_file_beside_it_is_not_read(made_up):
    before = len(load(made_up.parent).cases)
    shutil.copy(made_up, made_up.with_name("bench_x.indexed.backup.json"))
    assert len(load(made_up.parent).cases) == before


def test_a_folder_without_a_run_cannot_be_resumed(tmp_path):
    code, output = hem("study", "--resume", "--run", str(tmp_path))
    assert (code, "holds no run" in output) == (1, True)


def test_of_two_studies_in_one_folder_the_second_is_told_who_has_it(run):
    holder = _holder_of(run)
    try:
        with pytest.raises(locks.InUseError, match=rf"process {holder.pid} on .*wait"):
            go_on(run)
        code, output = hem("study", "--resume", "--run", str(run))
        assert (code, f"process {holder.pid}" in output) == (1, True)
    finally:
        holder.kill()
        holder.wait()
    assert f"process {holder.pid}" in (run / locks.LOCK).read_text()  # stale, and nobody's
    assert go_on(run) == []


def _holder_of(folder: Path) -> subprocess.Popen[str]:
    script = (
        "import sys, time; from pathlib import Path; from experiments.runs.locks import held\n"
        "with held(Path(sys.argv[1])): print('held', flush=True); time.sleep(60)"
    )
    command = [sys.executable, "-c", script, str(folder)]
    holder = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    return holder


def test_two_studies_begun_in_the_same_second_have_folders_of_their_own(tmp_path):
    assert len({begin(tmp_path) for _ in range(3)}) == 3


def test_a_process_that_is_killed_costs_no_finished_case(tmp_path):
    folder = begin(tmp_path)
    kept: dict[str, list[float]] = {}
    child: list[int] = []

    def kill(process: study.Process, done: int) -> None:
        if not child:
            child.extend(children_of(folder))  # which takes longer than some cases
        elif done and not kept:
            os.kill(child[0], signal.SIGKILL)
            kept.update(samples(folder))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "EXPERIMENTS", ("bench_work",))
        with pytest.raises(study.StudyFailedError, match="bench_work on indexed"):
            go_on(folder, kill)
    assert kept.items() <= samples(folder).items()
    assert len(samples(folder)) < 36


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_whoever_stops_a_study_leaves_no_process_behind(tmp_path, how):
    """As an interrupt in a notebook: the signal reaches the one who called, and nobody else."""
    script = (
        "import sys; from pathlib import Path; from experiments import study\n"
        "study.EXPERIMENTS = ('bench_work',)\n"
        "study.run(Path(sys.argv[1]), 'smoke', lambda p, n: None, ['indexed'])"
    )
    folder = begin(tmp_path)
    caller = subprocess.Popen(
        [sys.executable, "-c", script, str(folder)], start_new_session=True, stderr=subprocess.PIPE
    )
    wait_for(lambda: samples(folder))
    before = samples(folder)
    caller.send_signal(how)
    _, said = caller.communicate(timeout=20)
    wait_for(lambda: not children_of(folder), 2)
    time.sleep(0.2)
    assert before.items() <= samples(folder).items()
    assert (b"KeyboardInterrupt" in said) == (how == signal.SIGINT)
    with locks.held(folder):
        pass
