"""A run knows how steady its machine was."""

import pytest

from experiments.harness import Measurement
from experiments.harness.steadiness import BUSY
from experiments.runs import CaseFile, load, noise, write_meta

CALM = {"fastest": 1e-9, "before": 1e-9, "after": 1.01e-9, "off_cpu": 0.0}


def run_of(tmp_path, noises, kind="time"):
    write_meta(tmp_path, {"schema": 3})
    file = CaseFile(tmp_path, "bench_queries", "indexed")
    for k, it in enumerate(noises):
        times = 3 if it.get("off_cpu") else 1
        file.add(*[Measurement(str(k), kind, samples=[1.0], noise=it)] * times)
    return load(tmp_path)


@pytest.mark.parametrize(("bad", "too_busy"), [(0, False), (10, False), (11, True), (100, True)])
def test_a_run_says_when_its_machine_was_too_busy_to_judge_by_time(tmp_path, bad, too_busy):
    noises = [{**CALM, "off_cpu": 0.5}] * bad + [CALM] * (100 - bad)
    found = noise(run_of(tmp_path, noises))
    counted = f"{bad} of 100 timed cases ({bad}%) were disturbed, {bad} were repeated"
    assert counted in found.words
    assert found.too_busy == too_busy == (bad / 100 > BUSY)
    assert ("too busy to judge by time" in found.words) == too_busy
    assert ("bench_queries on indexed" in found.words) == too_busy


def test_counts_are_not_judged_by_noise(tmp_path):
    counted = noise(run_of(tmp_path, [{**CALM, "off_cpu": 0.5}], "work"))
    older = noise(run_of(tmp_path / "older", [{}, {}]))
    assert counted == older == (False, "No timed case says how steady the machine was.")


@pytest.mark.parametrize(("inside", "others"), [(20e-9, False), (49e-9, False), (51e-9, True)])
@pytest.mark.parametrize("largest", [1 << 24, 1 << 30])
def test_a_run_says_when_the_last_cache_was_not_its_own(tmp_path, inside, others, largest):
    run = run_of(tmp_path, [CALM])
    write_meta(tmp_path, {**run.meta, "machine": {"caches": {"L2": "1024K", "L3": "32768K"}}})
    file = CaseFile(tmp_path, "bench_latency", "machine")
    for size in (1 << k for k in range(14, 31)):
        seconds = 4e-9 if size <= 1 << 20 else inside if size <= 1 << 23 else 100e-9
        if size <= largest:
            file.add(Measurement(str(size), "time", samples=[seconds], working_set=size))
    told = "Others used the L3 cache of 32768K" in noise(load(tmp_path)).words
    assert told == (others and largest > 1 << 25)  # what reaches no memory cannot tell
