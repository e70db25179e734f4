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
    assert (found.cases, found.disturbed, found.repeated) == (100, bad, bad)
    assert found.too_busy == too_busy == (found.share > BUSY)
    assert ("too busy to judge by time" in found.words) == too_busy
    assert ("bench_queries on indexed" in found.words) == too_busy


def test_counts_are_not_judged_by_noise(tmp_path):
    counted = noise(run_of(tmp_path, [{**CALM, "off_cpu": 0.5}], "work"))
    assert (counted.cases, counted.too_busy) == (0, False)
    older = noise(run_of(tmp_path / "older", [{}, {}]))
    assert (older.cases, older.words) == (0, "No timed case says how steady the machine was.")
