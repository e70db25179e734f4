"""A run on little memory skips what does not fit, says so, and ends."""

from experiments.harness import PRESETS, memory
from experiments.harness.memory import VARIABLE, estimate, why_too_large
from experiments.runs import experiments, load
from tests.experiments.cli.calls import words
from tests.experiments.small_study import begin, go_on

MEMORY = experiments()["bench_memory"]


def test_a_size_that_is_none_is_refused_in_one_line(monkeypatch, tmp_path):
    monkeypatch.setenv(VARIABLE, "lots")
    code, output = words("study", "--output", str(tmp_path))
    assert (code, output) == (1, "hem: HEM_MEMORY is a size such as 500M or 8G, not 'lots'")
    assert list(tmp_path.iterdir()) == []


def test_a_run_on_little_memory_skips_what_does_not_fit_and_ends(monkeypatch, tmp_path):
    """Of the smoke profile's meshes one fits and another one does not."""
    cases = MEMORY.cases(PRESETS["smoke"], "indexed")
    needed = [estimate(it, MEMORY.copies) for it in cases]
    monkeypatch.setenv(VARIABLE, str(int((min(needed) + max(needed)) / 2 / memory.SHARE)))
    fits = {case.id: not why_too_large(case, MEMORY.copies) for case in cases}
    assert set(fits.values()) == {True, False}
    folder = begin(tmp_path)
    assert go_on(folder) == []
    run = load(folder)
    assert "finished" in run.meta
    assert set(run.cases["id"]) == {case for case, it in fits.items() if it}
    assert set(run.skipped["id"]) == {case for case, it in fits.items() if not it}
    assert run.skipped["skipped"].str.contains("are available, of which a case may take 70%").all()
    assert (run.skipped["kind"] == "bytes").all()
