"""The baseline: it changes only when somebody says so, who has seen what would change."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from experiments import regression
from experiments.harness import NO_STRUCTURE
from experiments.regression import COUNTERS, RUN, load_baseline, reduce_run, save_baseline
from experiments.runs import ResultsError, read_meta, write_meta
from tests.experiments.cli.calls import hem

COMMITTED = Path(__file__).parents[3] / "results/reference"


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A copy of the committed counters, with nothing to measure for it."""
    measured = load_baseline(COUNTERS, COMMITTED)
    monkeypatch.setattr(regression, "measure_counters", lambda *_: measured)
    shutil.copytree(COMMITTED / COUNTERS, tmp_path / "baseline" / COUNTERS)
    return tmp_path / "baseline"


def update(folder: Path, *arguments: str, said: str | None = None) -> tuple[int, str]:
    return hem("baseline", "update", *arguments, "--baseline", str(folder), said=said)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(it.relative_to(folder)): it.read_bytes() for it in folder.rglob("*.json*")}


def another_count(folder: Path) -> None:
    measured = load_baseline(COUNTERS, folder)
    (row,) = measured.run.cases.query(
        "structure == 'half_edge' and id == 'vertex_faces/torus/100/random'"
    ).index
    measured.run.cases.at[row, "samples"] = [7, 7]
    save_baseline(COUNTERS, measured, folder)


def test_where_nothing_changed_nothing_is_asked_and_nothing_written(folder):
    before = contents(folder)
    code, output = update(folder)
    assert (code, contents(folder)) == (0, before)
    assert "says just this already" in output


def test_a_change_is_shown_and_written_once_one_agrees(folder):
    good = contents(folder)
    another_count(folder)
    code, output = update(folder, said="y\n")
    assert code == 0
    assert "half_edge/vertex_faces/torus/200/random" in output
    assert "7, 7 →" in output
    assert contents(folder) == good


@pytest.mark.parametrize("answer", ["n\n", "\n", ""])
def test_who_does_not_agree_keeps_what_there_is(folder, answer):
    another_count(folder)
    before = contents(folder)
    assert (update(folder, said=answer)[0], contents(folder)) == (1, before)


def test_with_a_run_all_of_it_becomes_the_baseline_a_line_per_case(folder, base_folder, base_run):
    code, output = update(folder, str(base_folder), "--yes")
    assert code == 0
    assert "+ run:" in output
    kept, measured = load_baseline(RUN, folder), reduce_run(base_run)
    assert kept.claims == json.loads(json.dumps(measured.claims))
    assert len(kept.run.cases) == len(measured.run.cases)
    lines = [it for path in (folder / RUN).glob("*.*.jsonl") for it in path.open()]
    assert sum('"id"' in line for line in lines) == len(measured.run.cases)
    assert update(folder, str(base_folder)) == (0, f"{folder} says just this already.\n")


def test_of_times_those_are_kept_that_are_named_and_can_decide(base_run):
    cases, short = base_run.cases, base_run.cases["id"].str.startswith("face_edges/200/")
    rounds = cases["samples"].where(cases["kind"] != "time", [[1e-6] * 9] * len(cases))
    rounds, loops = rounds.where(~short, cases["samples"].str[:8]), [[1e-9] * 9] * len(cases)
    given = replace(base_run, cases=cases.assign(samples=rounds, calibration=loops))
    kept = reduce_run(given).run.cases
    assert not kept[kept["kind"] == "time"]["id"].str.startswith("face_edges/200/").any()
    orders = kept[kept["kind"] == "time"].groupby("experiment")["order"].agg(set)
    assert orders["bench_queries"] == {"consecutive", "random"}
    assert orders["bench_operations"] == {"batched"}


def test_what_times_are_judged_by_is_kept_with_them():
    """Else a page that is opened on the baseline would tell other outcomes than its run."""
    cases = load_baseline(RUN).run.cases
    assert (cases["structure"] == NO_STRUCTURE).sum() > 20  # the latency of the memory
    queries = cases[cases["experiment"] == "bench_queries"]
    assert (queries["edges"] > queries["faces"]).all()
    assert (queries["valence_max"] > 2).all()


def test_a_baseline_that_cannot_be_read_is_replaced(folder):
    good = contents(folder)
    (folder / COUNTERS / "run.json").write_text("{")
    with pytest.raises(ResultsError, match=f"anew: hem baseline update --baseline {folder}$"):
        load_baseline(COUNTERS, folder)
    assert update(folder, "--yes")[0] == 0
    assert contents(folder) == good


def test_what_cannot_be_measured_replaces_nothing(folder, monkeypatch):
    measured = load_baseline(COUNTERS, COMMITTED)
    broken = measured.run.cases[:1].assign(skipped="ValueError: broken")
    run = type(measured.run)(measured.run.folder, {}, measured.run.cases, broken)
    failed = regression.Measured(run, measured.claims)
    monkeypatch.setattr(regression, "measure_counters", lambda *_: failed)
    before = contents(folder)
    code, output = update(folder, "--yes")
    assert (code, contents(folder)) == (1, before)
    assert "could not be measured" in output
    assert "ValueError: broken" in output


def test_a_run_that_is_not_finished_is_no_baseline(folder, base_folder, tmp_path):
    unfinished = Path(shutil.copytree(base_folder, tmp_path / "run"))
    meta = read_meta(unfinished)
    del meta["finished"]
    write_meta(unfinished, meta)
    code, output = update(folder, str(unfinished), "--yes")
    assert code == 1
    assert "hem study --resume" in output


def test_a_run_of_some_is_no_baseline(folder, base_folder, tmp_path):
    part = Path(shutil.copytree(base_folder, tmp_path / "run"))
    write_meta(part, read_meta(part) | {"structures": ["half_edge"]})
    code, output = update(folder, str(part), "--yes")
    assert code == 1
    assert "is of some structures alone, and a baseline is of all" in output


def test_times_that_would_be_lost_are_counted(base_run):
    whole = reduce_run(base_run)
    timed = whole.run.cases["kind"] == "time"
    gone = timed & (whole.run.cases["structure"] == "half_edge")
    assert 0 < gone.sum() < timed.sum()
    without = replace(whole, run=replace(whole.run, cases=whole.run.cases[~gone]))
    told = regression.describe_difference(whole, without)
    assert f"times: 0 of {timed.sum():,} cases anew, {gone.sum():,} lost" in told


def test_what_cannot_be_put_in_place_leaves_the_baseline(folder, monkeypatch):
    before = {it.name: it.read_bytes() for it in (folder / COUNTERS).iterdir()}
    measured, rename = load_baseline(COUNTERS, folder), Path.rename

    def refuse(path, target):
        if path.suffix == ".part":
            raise OSError(28, "No space left on device")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", refuse)
    with pytest.raises(OSError, match="No space"):
        save_baseline(COUNTERS, measured, folder)
    assert {it.name: it.read_bytes() for it in (folder / COUNTERS).iterdir()} == before


def test_a_save_that_was_killed_between_its_renames_loses_no_baseline(folder, monkeypatch):
    before, measured = contents(folder), load_baseline(COUNTERS, folder)

    def fail(*_):
        raise OSError(28, "No space left on device")

    def require_kept():
        assert not (folder / COUNTERS).exists()
        assert load_baseline(COUNTERS, folder).claims == measured.claims

    (folder / COUNTERS).rename(folder / f"{COUNTERS}.old")
    require_kept()
    with monkeypatch.context() as full:
        full.setattr("experiments.regression.baseline.write_whole", fail)
        with pytest.raises(OSError, match="No space"):
            save_baseline(COUNTERS, measured, folder)
    require_kept()
    save_baseline(COUNTERS, measured, folder)
    assert contents(folder) == before
