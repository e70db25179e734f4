"""Laws of how far verdicts can be trusted: counts add up, and the kept ones are as asked."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from experiments.claims.judged import judged
from experiments.regression.baseline import load_measured, measured
from experiments.report import accuracy_figures
from experiments.runs.results import load, read_json
from experiments.validation import aa, accuracy
from experiments.validation.a_against_a import (
    LARGEST_SHARE,
    Rounds,
    Timed,
    cases,
    compared,
    joined,
    measure,
)
from experiments.validation.synthetic import CURVES, PARTS, curves
from tests.experiments.made_runs import LAWS, write_run

REFERENCE = Path(__file__).parents[3] / "results" / "reference"


def readme() -> str:
    """The README with single spaces."""
    return " ".join((Path(__file__).parents[3] / "README.md").read_text().split())


def always(answer: str | None):
    return lambda sizes, samples, latency: answer


def test_right_wrong_and_undetermined_are_told_apart() -> None:
    drawn = [it for name in CURVES for it in curves(name, "none", 6)]
    judges = {"O(n) to all": always("O(n)"), "silent": always(None)}
    table = accuracy.named(judges, drawn)
    found = accuracy.shares(table)
    assert found.loc[("O(n) to all", "none")].tolist() == pytest.approx([1 / 6, 5 / 6, 0])
    assert found.loc[("silent", "none")].tolist() == [0, 0, 1]
    per_class = accuracy.confusion(table, "O(n) to all", "none")
    assert (per_class["O(n)"] == 6).all()
    assert per_class.to_numpy().sum() == 36


def test_a_sound_run_is_determined_and_one_without_data_is_not(tmp_path: Path) -> None:
    run = load(write_run(tmp_path / "sound"))
    found = accuracy.determined(judged(run))
    assert found["queries"] == accuracy.Shares(42, 1.0, 1.0)
    emptied = type(run)(run.folder, run.meta, run.cases.iloc[:0], run.skipped)
    assert accuracy.determined(judged(emptied))["queries"] == accuracy.Shares(42, 0.0, 0.0)
    shown = accuracy.determined_table(run)
    assert shown["determined by time"].iloc[0] == "100%"


def test_half_of_the_timed_curves_missing_is_half_of_the_claims_undetermined(
    tmp_path: Path,
) -> None:
    run = load(write_run(tmp_path / "run"))
    timed = run.cases["experiment"].isin(["bench_queries", "bench_valence"])
    kept = run.cases[~(timed & (run.cases["subject"] == "vertex_faces"))]
    without = type(run)(run.folder, run.meta, kept, run.skipped)
    found = accuracy.determined(judged(without))["queries"]
    lost = run.cases[timed & (run.cases["subject"] == "vertex_faces")]["structure"].nunique()
    assert found.work == 1
    assert found.time == pytest.approx(1 - lost / found.claims)


def test_the_reference_has_as_many_cases_of_table_1_determined_as_was_asked() -> None:
    kept = load_measured(REFERENCE)
    found = accuracy.determined(pd.DataFrame(kept.verdicts.values()))["queries"]
    assert kept.head["profile"] == "standard"
    assert kept.head["dirty"] is False
    assert found.work >= accuracy.DETERMINED["work"]
    assert found.time >= accuracy.DETERMINED["time"]


def test_the_kept_corpus_gives_what_was_asked() -> None:
    kept, table = accuracy.saved(REFERENCE / "rigour.json")
    assert table.groupby("judge")["count"].sum().eq(kept["curves"]).all()
    found = accuracy.shares(table)
    for part, (right, wrong) in accuracy.ASKED.items():
        assert found.loc[("hem", part), "right"] >= right
        assert found.loc[("hem", part), "wrong"] <= wrong


def test_the_kept_pairs_of_the_same_code_raised_few_alarms() -> None:
    kept = read_json(REFERENCE / "a_against_a.json")
    assert len(kept["pairs"]) >= 20
    assert kept["comparisons"] == sum(row["comparisons"] for row in kept["pairs"]) >= 1000
    assert kept["alarms"] <= LARGEST_SHARE * kept["comparisons"]
    left_open = sum(row["undetermined"] for row in kept["pairs"])
    said = f"{kept['alarms']} false alarms in {kept['comparisons']:,} comparisons"
    assert f"{said}, {left_open} left open" in readme()
    assert kept["dirty"] is False


def test_the_kept_check_of_the_same_code_raised_few_alarms() -> None:
    kept = read_json(REFERENCE / "same_code.json")
    pairs, turns = aa.totals(kept["pairs"]), aa.totals(kept["turns"])
    assert kept["dirty"] is False
    assert len(kept["pairs"]) >= 20
    assert len(kept["turns"]) >= 20
    assert pairs["comparisons"] >= 1000
    assert kept["comparisons"] == pairs["comparisons"] + turns["comparisons"]
    assert kept["alarms"] == pairs["alarms"] + turns["alarms"]
    assert kept["alarms"] <= LARGEST_SHARE * kept["comparisons"]
    for found in pairs, turns:
        said = f"{found['alarms']} false alarms in {found['comparisons']:,} comparisons"
        assert said in aa.words(kept)
        assert f"{said}, {found['undetermined']} left open" in readme()


def test_a_run_of_slower_code_is_an_alarm_and_exact_counts_are_left_out(tmp_path: Path) -> None:
    def law_of(structure, query, printed):
        return LAWS["O(n_t)"] if (structure, query) == ("half_edge", "face_faces") else None

    sound = measured(load(write_run(tmp_path / "sound")))
    slow = measured(load(write_run(tmp_path / "slow", law_of)))
    assert aa.compared(sound, sound)["alarms"] == []
    found = aa.compared(sound, slow)
    assert len(found["alarms"]) >= 3
    assert all("half_edge/face_faces" in it and " by work" not in it for it in found["alarms"])
    assert aa.totals([found])["alarms"] == len(found["alarms"])


def test_a_case_is_timed_with_a_probe_before_every_round() -> None:
    first = next(iter(cases()))
    found = joined([measure([first]), measure([first])])
    ((name, timed),) = found.items()
    assert name.startswith(first.structure)
    assert len(timed.samples) == 10
    assert len(timed.probe) >= 10
    assert all(seconds > 0 for seconds in timed.samples + timed.probe)
    assert set(compared(found, found)) == {name}


def test_rounds_hand_over_what_was_set_up() -> None:
    asked = []
    rounds = Rounds(lambda: 1.0)
    rounds.pedantic(asked.append, setup=lambda: ((7,), {}), rounds=3, warmup_rounds=1)
    assert asked == [7] * 4
    assert rounds.readings == [1.0] * 4
    assert len(rounds.stats.stats.data) == 3
    rounds.pedantic(asked.append, (8,), rounds=1)
    assert asked[-1] == 8


def test_code_twice_as_slow_would_be_an_alarm() -> None:
    times = [1 + 0.01 * (i * 7 % 5) for i in range(15)]
    before = {"case": Timed(times, [1.0] * 15)}
    after = {"case": Timed([2 * it for it in times], [1.0] * 15)}
    assert compared(before, after)["case"].outcome == "worse"


def test_the_figures_draw() -> None:
    kept, table = accuracy.saved(REFERENCE / "rigour.json")
    pairs = {"pairs": [{"ratios": [1.0, 1.3], "alarms": {"case": 1.3}}]}
    pairs |= {"factor": 1.15, "comparisons": 2, "alarms": 1}
    for figure in (
        accuracy_figures.who_names_what(table),
        accuracy_figures.confusions(table, "measured"),
        accuracy_figures.same_code(pairs),
    ):
        assert figure.axes
    assert kept["commit"][:10] in accuracy.provenance(kept)
    shown = accuracy.table(table)
    assert isinstance(shown, pd.DataFrame)
    assert len(shown) == len(PARTS) * table["judge"].nunique()
