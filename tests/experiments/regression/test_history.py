"""The history keeps what was added, whole, once, and in spite of crashes and company."""

import errno
import json
import multiprocessing
import os
from dataclasses import replace

import numpy as np
import pytest

from experiments.claims import Outcome
from experiments.regression import Trends, append_run, read_history, record_run
from experiments.regression.history import commit_date
from experiments.runs import ResultsError, load, machine, machine_id, read_meta, write_meta
from tests.experiments.histories import CLAIM, line, lines
from tests.experiments.made_runs import STEADY, write_run


def test_a_line_has_the_verdicts_and_figures_of_its_run(base):
    claim = base["claims"][CLAIM]  # 2 + 3 n_ev accesses and nanoseconds, latency 2 ns
    assert (claim["outcome"], claim["outcome_time"]) == ("consistent", "consistent")

    assert (claim["work"], claim["work_faces"]) == (20, 200_000)
    assert claim["seconds"] == pytest.approx(20e-9, rel=0.03)
    assert claim["relative"] == pytest.approx(10, rel=0.03)
    assert (claim["time_faces"], claim["time_sizes"]) == (200_000, 7)
    assert claim["slopes"]["work_faces"] == [0, 0, 0]
    slope, low, high = claim["slopes"]["time_valence"]
    assert low <= slope <= high
    of_bytes = {"kind": "printed", "outcome": "consistent", "bytes": 36}
    assert base["claims"]["queries/indexed/memory"] == of_bytes
    assert len(json.dumps(base)) < 500 * len(base["claims"])


@pytest.mark.parametrize(("kind", "missing"), [("work", "outcome_time"), ("time", "outcome")])
def test_a_run_says_nothing_of_what_it_has_not_measured(base_run, kind, missing, tmp_path):
    kept = base_run.cases[base_run.cases["kind"] == kind]
    claims = record_run(replace(base_run, folder=tmp_path, cases=kept))["claims"]
    known = [it for it in claims.values() if "slopes" in it]
    judged = [it for it in known if Outcome.NO_CLAIM not in it.values()]
    assert judged
    assert not any(missing in it for it in judged)


@pytest.mark.parametrize("busy", [False, True])
def test_a_line_says_whether_the_machine_was_too_busy_to_judge_by_time(base_run, busy, tmp_path):
    slow = {**STEADY, "after": 9 * STEADY["fastest"]} if busy else STEADY
    cases = base_run.cases[base_run.cases["structure"] == "half_edge"]
    cases = cases.assign(noise=cases["noise"].map(lambda it: it and slow))
    kept = record_run(replace(base_run, folder=tmp_path, cases=cases))
    assert json.loads(json.dumps(kept))["too_busy"] is busy


def test_a_run_without_latencies_has_times_and_none_relative_to_them(base_run, tmp_path):
    cases = base_run.cases[base_run.cases["structure"] == "half_edge"].assign(latency=np.nan)
    claim = record_run(replace(base_run, folder=tmp_path, cases=cases))["claims"][CLAIM]
    assert "seconds" in claim
    assert "relative" not in claim


def test_a_run_that_is_not_finished_is_refused(tmp_path):
    folder = write_run(tmp_path / "run")
    meta = read_meta(folder)
    del meta["finished"]
    write_meta(folder, meta)
    with pytest.raises(ResultsError, match="not finished; go on with: hem study --resume"):
        record_run(load(folder))


def test_what_is_added_is_read_again_in_the_order_of_the_commits(base, tmp_path):
    path = tmp_path / "deep" / "deeper" / "history.jsonl"
    for k in (4, 1, 3):
        assert append_run(line(base, k), path)
    kept = read_history(path)
    assert kept.runs == [line(base, k) for k in (1, 3, 4)]
    assert kept.faults == []
    assert [it["commit"] for it in lines(path)] == [line(base, k)["commit"] for k in (4, 1, 3)]


def test_a_run_of_a_commit_without_a_date_stands_where_it_was_measured(base, tmp_path):
    undated = line(base, 2) | {"committed": None, "started": line(base, 3)["started"]}
    for it in (line(base, 4), undated, line(base, 1)):
        append_run(it, tmp_path / "history.jsonl")
    assert read_history(tmp_path / "history.jsonl").runs == [line(base, 1), undated, line(base, 4)]


def test_without_a_file_the_history_is_empty(tmp_path):
    assert read_history(tmp_path / "none.jsonl").runs == []
    assert list(tmp_path.iterdir()) == []


def test_the_same_run_is_kept_once(base, tmp_path):
    path = tmp_path / "a folder" / "not yet there" / "history.jsonl"
    assert append_run(line(base, 1), path)
    before = path.read_bytes()
    assert not append_run(line(base, 1), path)
    assert path.read_bytes() == before
    assert append_run(line(base, 1, "another"), path)


def _add(base, path, numbers):
    for k in numbers:
        append_run(line(base, k), path)


def test_who_writes_at_the_same_time_loses_nothing_and_adds_nothing_twice(base, tmp_path):
    path = tmp_path / "history.jsonl"
    context = multiprocessing.get_context("fork")
    shares = [range(10), range(5, 15), range(10, 25), range(25)]
    writers = [context.Process(target=_add, args=(base, path, share)) for share in shares]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
        assert writer.exitcode == 0
    kept = read_history(path)
    assert kept.faults == []
    assert kept.runs == [line(base, k) for k in range(25)]
    assert len(lines(path)) == 25


@pytest.mark.parametrize("share", [0.0001, 0.1, 0.5, 0.9, 0.9999])
def test_a_line_that_a_crash_cut_short_is_named_and_hides_nothing_else(base, tmp_path, share):
    path = tmp_path / "history.jsonl"
    append_run(line(base, 1), path)
    whole = path.read_bytes()
    append_run(line(base, 2), path)
    second = path.read_bytes()[len(whole) :]
    path.write_bytes(whole + second[: max(int(share * len(second)), 1)])

    kept = read_history(path)
    assert kept.runs == [line(base, 1)]
    assert kept.faults == [f"{path}, line 2 is cut short or damaged; it is skipped"]

    assert append_run(line(base, 2), path)
    assert path.read_bytes().startswith(whole)
    kept = read_history(path)
    assert kept.runs == [line(base, 1), line(base, 2)]
    assert len(kept.faults) == 1


def test_a_line_that_lacks_nothing_but_its_end_is_whole(base, tmp_path):
    path = tmp_path / "history.jsonl"
    append_run(line(base, 1), path)
    path.write_bytes(path.read_bytes().removesuffix(b"\n"))
    assert len(read_history(path).runs) == 1
    append_run(line(base, 2), path)
    assert [len(read_history(path).runs), read_history(path).faults] == [2, []]


def test_where_there_is_no_room_the_file_stays_as_it_was(base, tmp_path, monkeypatch):
    path = tmp_path / "history.jsonl"
    append_run(line(base, 1), path)
    before = path.read_bytes()

    def full(file):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        append_run(line(base, 2), path)
    assert path.read_bytes() == before


@pytest.mark.parametrize(("text", "said"), [
    ("[1, 2]", "is no run: it has no schema"),
    ('{"commit": "c"}', "is no run: it has no schema"),
    ('{"schema": 3}', "has schema 3, this version knows 2"),
    ('{"schema": 2}', "is no run: its commit is None"),
    ('{"schema": 1}', "has schema 1, this version knows 2"),
    ('{"schema": [1]}', "has schema [1], this version knows 2"),
    ('{"schema": 2, "work": NaN}', "is cut short or damaged"),
    ("\x00\x00\x00", "is cut short or damaged"),
    ("[" * 100_000, "is cut short or damaged"),
])  # fmt: skip
def test_a_line_that_is_no_run_is_named_and_skipped(base, tmp_path, text, said):
    path = tmp_path / "history.jsonl"
    append_run(line(base, 1), path)
    with path.open("a") as file:
        file.write(text + "\n")
    append_run(line(base, 2), path)
    kept = read_history(path)
    assert len(kept.runs) == 2
    assert len(kept.faults) == 1
    assert f"line 2 {said}" in kept.faults[0]


@pytest.mark.parametrize("odd", [
    {"slopes": None}, {"slopes": {"work_faces": 3}}, {"slopes": {"work_faces": [1, 2]}},
    {"slopes": {"work_faces": [0, 0, "1"]}},
    {"outcome": None}, {"outcome_time": 3}, {"work": None}, {"work": [1]}, {"relative": "12"},
])  # fmt: skip
def test_a_line_whose_figures_are_none_is_named_and_skipped(base, tmp_path, odd):
    path, made = tmp_path / "history.jsonl", line(base, 1)
    made["claims"][CLAIM] |= odd
    append_run(line(base, 2), path)
    with path.open("a") as file:
        file.write(json.dumps(made) + "\n")
    kept = read_history(path)
    assert kept.runs == [line(base, 2)]
    (fault,) = kept.faults
    assert f"line 2 is no run: {next(iter(odd))} of {CLAIM} is " in fault


@pytest.mark.parametrize("name", ["half_edge", "queries/half_edge/vertex_faces/more"])
def test_a_line_with_a_claim_of_another_name_is_named_and_skipped(base, tmp_path, name):
    path, made = tmp_path / "history.jsonl", line(base, 1)
    made["claims"][name] = made["claims"][CLAIM]
    path.write_text(json.dumps(made) + "\n")
    append_run(line(base, 2), path)
    kept = read_history(path)
    assert kept.runs == [line(base, 2)]
    assert len(kept.faults) == 1
    with pytest.raises(ValueError, match="no claim 'nothing'; say one of"):
        Trends(kept).claims("nothing")


@pytest.mark.parametrize("odd", [
    {"machine": {"id": ["a list"]}}, {"claims": {CLAIM: 3}}, {"committed": "yesterday"},
    {"committed": 3}, {"started": "today"},
])  # fmt: skip
def test_a_line_without_a_machine_s_name_figures_or_dates_is_named_and_skipped(base, tmp_path, odd):
    (tmp_path / "history.jsonl").write_text(json.dumps(line(base, 1) | odd) + "\n")
    kept = read_history(tmp_path / "history.jsonl")
    assert (kept.runs, len(kept.faults)) == ([], 1)


def test_a_machine_is_the_same_after_an_update_and_another_with_another_processor():
    here = {
        "cpu": "AMD EPYC",
        "cores": 2,
        "memory_bytes": 25276514304,
        "caches": {"L1": "32K", "L2": "1024K", "L3": "32768K"},
        "platform": "Linux 6.18.44 x86_64",
        "python": "cpython",
    }
    updated = here | {"platform": "Linux 7.1.2-other x86_64", "python": "other"}
    updated["memory_bytes"] -= 2**20
    assert machine_id(here) == machine_id(updated)
    assert machine_id(machine()) == machine_id(machine())
    assert len(machine_id(here)) == 8
    for key, other in (("cpu", "another"), ("cores", 99), ("caches", {}), ("memory_bytes", 2**40)):
        assert machine_id(here | {key: other}) != machine_id(here)


def test_a_commit_that_is_not_here_has_no_date():
    assert commit_date("unknown") is None
    assert commit_date("--help") is None
    assert commit_date(40 * "0") is None
