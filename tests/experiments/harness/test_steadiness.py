"""The machine is watched while a case is measured; cases come in a random order."""

import os
import subprocess
import sys
import time
from itertools import pairwise

from experiments.harness import Case, badness, disturbed, steadiness
from experiments.harness.cases import in_random_order
from experiments.harness.steadiness import Watch

CALM = {"fastest": 1e-4, "before": 1e-4, "after": 1.01e-4, "off_cpu": 0.0}


def test_a_slow_loop_and_a_long_wait_disturb_a_case():
    assert not disturbed(CALM)
    assert not disturbed({})
    assert disturbed({**CALM, "after": 1.3e-4})
    assert disturbed({**CALM, "off_cpu": 0.2})
    assert badness(CALM) < badness({**CALM, "off_cpu": 0.2}) < badness({})


def test_a_watch_sees_that_its_process_did_not_run():
    watch = Watch()
    time.sleep(0.3)
    seen = watch.seen()
    assert seen["off_cpu"] > 0.8
    assert disturbed(seen)


BURNING = """
from time import process_time
while process_time() < 0.5: pass
print(process_time())
"""


def test_while_a_program_runs_that_a_case_waits_for_the_case_runs():
    watch, begin = Watch(), time.perf_counter()
    done = subprocess.run([sys.executable, "-c", BURNING], capture_output=True, check=True)
    most = 1 - float(done.stdout) / (time.perf_counter() - begin)
    assert watch.seen()["off_cpu"] <= most + 0.02


def test_a_wait_that_spoils_one_round_at_most_is_none(monkeypatch):
    monkeypatch.setattr(steadiness, "reading", lambda: 1e-9)
    for waited, off_cpu in ((5e-4, 0.0), (1e-2, 1.0)):
        monkeypatch.setattr(steadiness, "process_time", lambda: 0.0)
        monkeypatch.setattr(steadiness, "perf_counter", iter([0.0, waited]).__next__)
        assert Watch().seen()["off_cpu"] == off_cpu


def test_a_watch_sees_that_the_same_work_takes_longer(monkeypatch):
    watch = Watch()
    monkeypatch.setattr(steadiness, "reading", lambda: 3 * watch.before)
    assert watch.seen()["after"] >= 2.9 * watch.fastest


CASES = [
    Case("indexed", family, size, query, order)
    for family in ("torus", "grid")
    for size in (100, 400, 1600)
    for query in ("vertex_faces", "face_edges")
    for order in ("random", "consecutive")
]


def test_the_order_of_cases_is_random_and_its_seed_gives_it_again():
    one, again, other = (in_random_order(CASES, seed) for seed in (1, 1, 2))
    assert one == again != other
    assert sorted(one, key=repr) == sorted(other, key=repr) == sorted(CASES, key=repr)
    sizes = [case.size for case in one]
    assert sizes not in (sorted(sizes), sorted(sizes)[::-1])


def test_what_is_asked_of_a_mesh_stays_together_so_that_it_is_built_once():
    meshes = [(case.family, case.size) for case in in_random_order(CASES, 1)]
    changes = sum(a != b for a, b in pairwise(meshes))
    assert changes == len(set(meshes)) - 1


def test_a_process_stays_on_one_core_where_it_may():
    script = (
        "import os; from experiments.harness import steadiness\n"
        "def refused(*a): raise PermissionError\n"
        "core = steadiness.pin()\n"
        "assert core is None or os.sched_getaffinity(0) == {core}, core\n"
        "os.sched_setaffinity = refused\n"
        "assert steadiness.pin() is None"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=300)


def test_the_calmest_core_is_the_one_that_was_idle(monkeypatch):
    monkeypatch.setattr("psutil.cpu_percent", lambda seconds, percpu: [90.0, 10.0, 80.0])
    assert steadiness.calmest([0, 1, 2], seconds=0) == 1
    monkeypatch.setattr("psutil.cpu_percent", lambda seconds, percpu: [])
    assert steadiness.calmest([0, 1, 2], seconds=0) == 2
    assert set(steadiness.allowed_cores()) <= set(range(os.cpu_count() or 1))
