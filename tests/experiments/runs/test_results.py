"""What a run leaves on disk survives whoever is killed while writing it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from experiments.runs.results import Measurement, ResultFile, ResultsError, latest, load, write_json


def test_cases_come_back_as_they_were(tmp_path):
    write_json(tmp_path / "run.json", {"schema": 1})
    file = ResultFile(tmp_path, "bench_queries", "half_edge")
    file.add(Measurement("a", "time", subject="vertex_faces", samples=[1.5, 2.5], latency=1e-9))
    file.add(Measurement("b", "time", skipped="too slow"))
    run = load(tmp_path)
    assert run.cases["id"].tolist() == ["a"]
    assert run.cases["samples"][0].tolist() == [1.5, 2.5]
    assert (run.cases["experiment"][0], run.cases["structure"][0]) == ("bench_queries", "half_edge")
    assert run.skipped["skipped"].tolist() == ["too slow"]
    assert ResultFile(tmp_path, "bench_queries", "half_edge").finished == {"a", "b"}


def test_a_kill_at_any_moment_leaves_whole_files(tmp_path):
    """A writer is killed many times over; what is on disk is always a prefix of its cases."""
    script = (
        "import sys; from pathlib import Path; from experiments.runs.results import *\n"
        "f = ResultFile(Path(sys.argv[1]), 'bench_x', 'indexed')\n"
        "for i in range(10**6): f.add(Measurement(str(i), 'time', samples=[0.0] * 2000))"
    )
    for delay in np.linspace(0.02, 0.25, 6):
        path = tmp_path / f"{delay:.2f}" / "bench_x.indexed.json"
        child = subprocess.Popen([sys.executable, "-c", script, str(path.parent)])
        while not path.exists():
            time.sleep(0.01)
        time.sleep(delay)
        os.kill(child.pid, signal.SIGKILL)
        child.wait()
        ids = [case["id"] for case in json.loads(path.read_text())["cases"]]
        assert ids == [str(i) for i in range(len(ids))]
        assert ids


def test_the_newest_run_is_found_and_the_newest_unfinished(tmp_path):
    for name, more in (("1", {}), ("2", {"finished": "now"}), ("3", {"finished": "now"})):
        write_json(tmp_path / name / "run.json", {"schema": 1, **more})
    assert latest(tmp_path).name == "3"
    assert latest(tmp_path, unfinished=True).name == "1"


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(ResultsError, match="no run"):
        latest(tmp_path)
    with pytest.raises(ResultsError, match=r"no run\.json"):
        load(tmp_path)
    write_json(tmp_path / "run.json", {"schema": 0})
    with pytest.raises(ResultsError, match="schema 0"):
        load(tmp_path)
    (tmp_path / "run.json").write_text("{")
    with pytest.raises(ResultsError, match=r"run\.json cannot be read"):
        load(tmp_path)
