"""What a run leaves on disk survives whoever is killed, and nothing broken is read as good."""

import shutil

import pytest

from experiments.harness import Measurement
from experiments.harness.steadiness import REPEATS
from experiments.runs import CaseFile, ResultsError, latest, load, resume_command, write_meta
from experiments.runs.store import DamagedError
from tests.experiments.small_study import damage, in_new_process

DAMAGES = (
    "truncated", "emptied", "overwritten", "another number", "without its checksum", "a line less",
    "a list", "joined with a copy",
)  # fmt: skip
CALM = {"fastest": 1e-4, "before": 1e-4, "after": 1e-4, "off_cpu": 0.0}
BUSY = {**CALM, "off_cpu": 0.9}


def measurement(name: str, *samples: float, **more) -> Measurement:
    return Measurement(name, "time", samples=list(samples), **more)


@pytest.fixture
def made_up(tmp_path):
    """The one file of a finished run."""
    write_meta(tmp_path, {"schema": 3, "preset": "smoke", "files": {"bench_x.indexed.jsonl": 2}})
    file = CaseFile(tmp_path, "bench_x", "indexed")
    file.add(measurement("a", 1.5, 2.5))
    file.add(measurement("b", 0.5))
    return file.path


def test_cases_come_back_as_they_were(tmp_path):
    write_meta(tmp_path, {"schema": 3})
    file = CaseFile(tmp_path, "bench_queries", "half_edge")
    kept = measurement("a", 1.5, 0.1 + 0.2, subject="vertex_faces", latency=1e-9, noise=CALM)
    file.add(kept)
    file.add(measurement("b", skipped="too slow"))
    assert CaseFile(tmp_path, "bench_queries", "half_edge").measurements[0] == kept
    run = load(tmp_path)
    assert run.cases["id"].tolist() == ["a"]
    assert run.cases["samples"][0].tolist() == [1.5, 0.1 + 0.2]
    assert (run.cases["experiment"][0], run.cases["structure"][0]) == ("bench_queries", "half_edge")
    assert run.skipped["skipped"].tolist() == ["too slow"]


@pytest.mark.parametrize("unfinished", ["", "machine-a", "machine-c"])
def test_a_job_that_one_machine_left_unfinished_counts_where_it_is_whole(tmp_path, unfinished):
    write_meta(tmp_path, {"schema": 3})
    CaseFile(tmp_path / unfinished, "bench_x", "indexed").add(measurement("a", 1.0))
    CaseFile(tmp_path / "machine-b", "bench_x", "indexed").add(*map(measurement, "ab"))
    CaseFile(tmp_path / "machine-a", "bench_y", "indexed").add(measurement("a", 2.0))
    cases = load(tmp_path).cases
    found = cases[["experiment", "machine", "id"]].agg("/".join, axis=1).tolist()
    assert found == ["bench_x/machine-b/a", "bench_x/machine-b/b", "bench_y/machine-a/a"]


def test_what_one_of_several_machines_measured_is_resumed_as_the_run_that_it_is_of(tmp_path):
    assert resume_command(tmp_path / "machine-a") == resume_command(tmp_path)


def test_of_several_measurements_of_a_case_the_calmest_counts(tmp_path):
    file = CaseFile(tmp_path, "bench_x", "indexed")
    file.add(measurement("a", 1.0, noise=BUSY), measurement("b", 1.0, noise=BUSY))
    assert file.disturbed == {"a", "b"}
    file.add(measurement("a", 2.0, noise=CALM), measurement("b", 2.0, noise=BUSY))
    again = CaseFile(tmp_path, "bench_x", "indexed")
    assert again.cases["a"].samples == [2.0]
    assert again.cases["a"].noise["measured"] == 2
    assert again.disturbed == {"b"}
    again.add(*[measurement("b", 3.0, noise=BUSY)] * (REPEATS - 1))
    assert again.disturbed == set()


def test_a_process_that_never_saw_its_core_alone_is_found_out_by_one_that_did(tmp_path):
    slow = {**CALM, "fastest": 1.8e-4, "before": 1.8e-4, "after": 1.8e-4}
    file = CaseFile(tmp_path, "bench_x", "indexed")
    file.add(measurement("a", 2.0, noise=slow))
    assert file.disturbed == set()
    file.add(measurement("b", 1.0, noise=CALM))
    assert file.disturbed == {"a"}


def test_a_kill_at_any_moment_leaves_whole_lines(tmp_path):
    """A writer is killed many times over; what is on disk is always a prefix of its cases."""
    script = (
        "f = CaseFile(folder, 'bench_x', 'indexed')\n"
        "for i in range(len(f.measurements), 10**6):\n"
        "    f.add(Measurement(str(i), 'time', samples=[0.0] * 2000)); print(i, flush=True)"
    )
    for repetition in range(2):
        with in_new_process(script, tmp_path) as writer:
            told = [writer.stdout.readline() for _ in range(3 + repetition)]
            writer.kill()
        ids = [it.id for it in CaseFile(tmp_path, "bench_x", "indexed").measurements]
        assert ids == [str(i) for i in range(len(ids))]
        assert len(ids) > int(told[-1])


def test_a_torn_last_line_is_a_case_to_measure_again(made_up):
    whole = made_up.read_bytes()
    made_up.write_bytes(whole[:-20])
    file = CaseFile.at(made_up)
    assert [it.id for it in file.measurements] == ["a"]
    file.add(measurement("b", 0.5))
    assert made_up.read_bytes() == whole


@pytest.mark.parametrize("how", DAMAGES)
def test_a_damaged_file_is_named_with_what_to_do_and_never_read(made_up, how):
    damage(made_up, how)
    with pytest.raises(DamagedError, match=r"bench_x\.indexed\.jsonl.*hem study --resume"):
        load(made_up.parent)


def test_no_flipped_bit_changes_what_is_read(made_up):
    good = made_up.read_bytes()
    for bit in range(0, 8 * len(good), 7):
        flipped = bytearray(good)
        flipped[bit // 8] ^= 1 << bit % 8
        made_up.write_bytes(bytes(flipped))
        with pytest.raises(ResultsError):
            load(made_up.parent)


def test_the_newest_run_is_found_and_the_newest_unfinished(tmp_path):
    runs = ("c", {}), ("b", {"finished": "now"}), ("a", {"finished": 1})
    for day, (name, more) in enumerate(runs, 1):
        write_meta(tmp_path / name, {"schema": 3, "started": f"2020-01-0{day}", **more})
    assert latest(tmp_path).name == "a"  # whatever its folder is called
    assert latest(tmp_path, unfinished=True).name == "c"
    for name in ("a", "c"):  # what cannot be read is told, and keeps nobody from the others
        text = (tmp_path / name / "run.json").read_text()
        (tmp_path / name / "run.json").write_text(text.replace("2020", "2021"))
    with pytest.warns(UserWarning, match=r"run\.json.*checksum.*move.*passed over"):
        assert latest(tmp_path).name == "b"
    with pytest.warns(match="passed over"), pytest.raises(ResultsError, match="no unfinished run"):
        latest(tmp_path, unfinished=True)


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(ResultsError, match="no run"):
        latest(tmp_path)
    with pytest.raises(ResultsError, match=r"no run\.json"):
        load(tmp_path)
    write_meta(tmp_path, {"schema": 2})
    with pytest.raises(ResultsError, match=r"schema 2.*hem study"):
        load(tmp_path)
    (tmp_path / "run.json").write_text("{")
    with pytest.raises(DamagedError, match=r"run\.json is damaged"):
        load(tmp_path)


def test_a_copy_of_a_file_is_not_read_and_a_renamed_one_is_refused(made_up):
    shutil.copy(made_up, made_up.with_name("bench_x.indexed.backup.jsonl"))
    assert len(load(made_up.parent).cases) == 2
    shutil.copy(made_up, made_up.with_name("bench_x.half_edge.jsonl"))
    with pytest.raises(ResultsError, match="head of another file"):
        load(made_up.parent)


def test_a_file_that_cannot_be_written_stays_as_it_was(tmp_path):
    """As a full disk, where none can be mounted: files may not grow past a limit."""
    script = (
        "import resource, signal\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "f = CaseFile(folder, 'bench_x', 'indexed'); f.add(Measurement('a', 'time'))\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))\n"
        "f.add(Measurement('b', 'time', samples=[0.5] * 9000))"
    )
    _, said = in_new_process(script, tmp_path).communicate()
    assert "bench_x.indexed.jsonl cannot be written" in said
    (path,) = tmp_path.iterdir()
    assert path.stat().st_size < 4000
    assert CaseFile.at(path).cases.keys() == {"a"}
