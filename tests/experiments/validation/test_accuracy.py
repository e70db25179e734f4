"""Laws of how far verdicts can be trusted: counts add up, and the kept ones are as asked."""

from dataclasses import replace
from pathlib import Path

import pytest

from experiments.claims import judge_run
from experiments.regression import RUN, load_baseline
from experiments.report.figures import accuracy as accuracy_figures
from experiments.runs import Run, load
from experiments.validation import accuracy
from experiments.validation.synthetic import CONDITIONS, GROWTH, make_curves
from structures import THESIS
from tests.experiments.made_runs import LIKE_THE_THESIS, write_run
from tests.extent import exhaustive

REFERENCE = Path(__file__).parents[3] / "results" / "reference"


def always(answer: str | None):
    return lambda sizes, samples, latency: answer


def test_right_wrong_and_undetermined_are_told_apart() -> None:
    drawn = [curve for growth in GROWTH for curve in make_curves(growth, "steady", 6)]
    judges = {"O(n) to all": always("O(n)"), "silent": always(None)}
    answers = accuracy.count_answers(judges, drawn)
    shares = accuracy.answer_shares(answers)
    assert shares.loc[("O(n) to all", "steady")].tolist() == pytest.approx([1 / 6, 5 / 6, 0])
    assert shares.loc[("silent", "steady")].tolist() == [0, 0, 1]
    per_class = accuracy.confusions(answers, "steady")["O(n) to all"]
    assert (per_class["O(n)"] == 6).all()
    assert per_class.to_numpy().sum() == 36


def test_a_sound_run_is_determined_and_one_without_data_is_not(
    base_run: Run, tmp_path: Path
) -> None:
    claimed = 26 + 8 * len(LIKE_THE_THESIS)
    judged = judge_run(base_run)
    emptied = judge_run(replace(base_run, folder=tmp_path / "empty", cases=base_run.cases.iloc[:0]))
    assert accuracy.determined_shares(judged).loc["Table 1"].tolist() == [claimed, 1, 1]
    assert accuracy.determined_shares(emptied).loc["Table 1"].tolist() == [claimed, 0, 0]


@exhaustive
def test_half_of_the_timed_curves_missing_is_half_of_the_claims_undetermined(
    tmp_path: Path,
) -> None:
    run = load(write_run(tmp_path / "run"))
    timed = run.cases["experiment"].eq("bench_queries")
    lost = timed & (run.cases["subject"] == "vertex_faces")
    claimed = run.cases["structure"].isin([*THESIS, *LIKE_THE_THESIS])
    without = type(run)(tmp_path / "without", run.meta, run.cases[~lost], run.skipped)
    shares = accuracy.determined_shares(judge_run(without)).loc["Table 1"]
    assert shares.work == 1
    without_time = run.cases[lost & claimed]["structure"].nunique()
    assert shares.time == pytest.approx(1 - without_time / shares.claims)


def test_the_baseline_has_as_many_claims_of_table_1_determined_by_work_as_was_asked() -> None:
    # By time the share is the machine's; the chapter shows it beside what was asked.
    baseline = load_baseline(RUN)
    assert baseline.run.meta["preset"] == "standard"
    assert baseline.run.meta["dirty"] is False
    asked = [
        claim["outcome"]
        for name, claim in baseline.claims.items()
        if name.startswith("queries/") and "outcome_time" in claim
    ]
    determined = [outcome != "undetermined" for outcome in asked if outcome != "no claim"]
    assert len(determined) == 42
    assert sum(determined) >= accuracy.DETERMINED["work"] * len(determined)


def test_the_kept_answers_are_as_many_right_and_as_few_wrong_as_asked() -> None:
    kept, answers = accuracy.load_accuracy(REFERENCE / "accuracy.json")
    assert answers.groupby("judge")["count"].sum().eq(kept["curves"]).all()
    shares = accuracy.answer_shares(answers)
    for condition, (right, wrong) in accuracy.ASKED.items():
        assert shares.loc[("hem", condition), "right"] >= right
        assert shares.loc[("hem", condition), "wrong"] <= wrong


def test_the_figures_draw_every_condition_and_judge() -> None:
    kept, answers = accuracy.load_accuracy(REFERENCE / "accuracy.json")
    judges = answers["judge"].unique()
    shares = accuracy_figures.plot_answer_shares(accuracy.answer_shares(answers), CONDITIONS)
    assert [axes.get_title("left") for axes in shares.axes] == list(CONDITIONS.values())
    matrices = accuracy_figures.plot_confusions(accuracy.confusions(answers, "latency known"))
    assert [axes.get_title("left") for axes in matrices.axes] == list(judges)
    assert kept["commit"][:10] in accuracy.describe_origin(kept)
    assert len(accuracy.accuracy_table(answers)) == len(CONDITIONS) * len(judges)


def test_a_judge_that_is_not_installed_has_a_row_that_says_so() -> None:
    _, answers = accuracy.load_accuracy(REFERENCE / "accuracy.json")
    table = accuracy.accuracy_table(answers[answers["judge"] != "bigo"])
    assert table[table["judge"] == "bigo"]["condition"].tolist() == ["not installed"]
