"""A run knows how steady its machine was, and measures again what was disturbed."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from itertools import pairwise

import pytest

from experiments.harness import affinity
from experiments.harness import steadiness as noise_module
from experiments.harness.cases import Case, in_random_order
from experiments.harness.steadiness import BUSY, REPEATS, Watch, badness, disturbed, noise
from experiments.runs.results import Measurement, ResultFile, load, write_sealed

CALM = {"fastest": 1e-4, "before": 1e-4, "after": 1.01e-4, "stray": 0.01, "waited": 0.0}


def run_of(tmp_path, noises, kind="time"):
    write_sealed(tmp_path / "run.json", {"schema": 2})
    file = ResultFile(tmp_path, "bench_queries", "indexed")
    for k, it in enumerate(noises):
        file.add(Measurement(str(k), kind, samples=[1.0], noise=it))
    return load(tmp_path)


def test_a_slow_probe_and_a_long_wait_disturb_a_case():
    assert not disturbed(CALM)
    assert not disturbed({})
    assert disturbed({**CALM, "stray": 0.3})
    assert disturbed({**CALM, "waited": 0.2})
    assert badness(CALM) < badness({**CALM, "waited": 0.2}) < badness({})


def test_a_watch_sees_that_its_process_did_not_run():
    watch = Watch()
    time.sleep(0.3)
    seen = watch.seen()
    assert seen["waited"] > 0.8
    assert disturbed(seen)


def test_a_watch_sees_that_the_same_work_takes_longer(monkeypatch):
    watch = Watch()
    monkeypatch.setattr(noise_module, "probe", lambda: 3 * watch.before)
    assert watch.seen()["stray"] >= 2


def test_a_probe_is_short():
    noise_module.fastest()
    assert min(_seconds_of(noise_module.probe) for _ in range(20)) < 0.01


def _seconds_of(what):
    begin = time.perf_counter()
    what()
    return time.perf_counter() - begin


@pytest.mark.parametrize(("bad", "too_busy"), [(0, False), (10, False), (11, True), (100, True)])
def test_a_run_says_when_its_machine_was_too_busy_to_judge_by_time(tmp_path, bad, too_busy):
    noises = [{**CALM, "waited": 0.5, "measured": 3}] * bad + [CALM] * (100 - bad)
    found = noise(run_of(tmp_path, noises))
    assert (found.cases, found.disturbed, found.repeated) == (100, bad, bad)
    assert found.too_busy == too_busy == (found.share > BUSY)
    assert ("too busy to judge by time" in found.words) == too_busy
    assert ("bench_queries on indexed" in found.words) == too_busy


def test_counts_are_not_judged_by_noise_nor_runs_that_did_not_watch(tmp_path):
    counted = noise(run_of(tmp_path, [{**CALM, "waited": 0.5}], "work"))
    assert (counted.cases, counted.too_busy) == (0, False)
    older = noise(run_of(tmp_path / "older", [{}, {}]))
    assert (older.cases, older.words) == (0, "The run did not watch how steady the machine was.")


@pytest.mark.parametrize(("calm_from", "measured"), [(1, 2), (10**6, 1 + REPEATS)])
def test_a_disturbed_case_is_measured_again_and_no_more_often_than_it_may(
    tmp_path, calm_from, measured
):
    """All cases are disturbed the first time; then none, or all of them always."""
    script = (
        "import sys, pytest; from collections import Counter; from experiments import noise\n"
        "import experiments.conftest as conftest\n"
        "from experiments import results\n"
        "seen, add = Counter(), results.ResultFile.add\n"
        "def counting(self, case):\n"
        "    seen[case.id] += 1; add(self, case)\n"
        "def says(self):\n"
        "    k = says.calls = says.calls + 1\n"
        f"    busy = k <= {calm_from} * 13\n"
        "    return dict(fastest=1, before=1, after=1, stray=0, waited=(0.9 if busy else 0))\n"
        "says.calls = 0\n"
        "noise.Watch.seen = says; results.ResultFile.add = counting\n"
        "clock = iter([0.0, 1e9])\n"
        "conftest.perf_counter = lambda: next(clock, 0.0)\n"
        "code = pytest.main(sys.argv[1:]); print(sorted(set(seen.values()))); sys.exit(code)"
    )
    args = ["experiments/bench_latency.py", "-q", "--profile", "smoke", "--run", str(tmp_path)]
    command = [sys.executable, "-c", script, *args, "-p", "no:cacheprovider", "--benchmark-quiet"]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert f"[{measured}]" in ran.stdout
    cases = json.loads((tmp_path / "bench_latency.machine.json").read_text())["cases"]
    assert len(cases) == 13
    assert {case["noise"]["measured"] for case in cases} == {measured}
    assert {case["noise"]["waited"] for case in cases} == {0 if calm_from == 1 else 0.9}


CELLS = [
    Case("indexed", family, size, query, order)
    for family in ("torus", "grid")
    for size in (100, 400, 1600)
    for query in ("vertex_faces", "face_edges")
    for order in ("random", "consecutive")
]


def test_the_order_of_cases_is_random_and_its_seed_gives_it_again():
    one, again, other = (in_random_order(CELLS, seed) for seed in (1, 1, 2))
    assert one == again != other
    assert sorted(one, key=repr) == sorted(other, key=repr) == sorted(CELLS, key=repr)
    sizes = [case.size for case in one]
    assert sizes not in (sorted(sizes), sorted(sizes)[::-1])


def test_what_is_asked_of_a_mesh_stays_together_so_that_it_is_built_once():
    meshes = [(case.family, case.size) for case in in_random_order(CELLS, 1)]
    changes = sum(a != b for a, b in pairwise(meshes))
    assert changes == len(set(meshes)) - 1


def test_a_process_stays_on_one_core_where_it_may():
    script = (
        "import os; from experiments import cores\n"
        "def refused(*a): raise PermissionError\n"
        "core = cores.pin()\n"
        "assert core is None or os.sched_getaffinity(0) == {core}, core\n"
        "os.sched_setaffinity = refused\n"
        "assert cores.pin() is None"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=60)


def test_the_calmest_core_is_the_one_that_was_idle(monkeypatch):
    ticks = iter([{0: 5, 1: 5, 2: 5}, {0: 6, 1: 14, 2: 7}])
    monkeypatch.setattr(affinity, "idle_ticks", lambda: next(ticks))
    assert affinity.calmest([0, 1, 2], seconds=0) == 1
    monkeypatch.setattr(affinity, "idle_ticks", dict)
    assert affinity.calmest([0, 1, 2], seconds=0) == 2
    assert set(affinity.allowed()) <= set(range(os.cpu_count() or 1))
