"""Laws of trying judges on real functions: each can be called, and answers are counted once."""

from pathlib import Path

import pandas as pd
import pytest

from experiments.validation import real_functions
from experiments.validation.functions import CACHE_BOUND, HELD_OUT
from hem.complexity import canonical

ROOT = Path(__file__).parents[3]


def test_there_are_enough_functions_of_known_cost_with_their_source() -> None:
    assert len(HELD_OUT) >= 60
    assert len({it.name for it in HELD_OUT}) == len(HELD_OUT)
    assert all(it.source and canonical(it.growth) == it.growth for it in HELD_OUT)
    assert sum(it.most == CACHE_BOUND for it in HELD_OUT) >= 6


@pytest.mark.parametrize("it", HELD_OUT, ids=lambda it: it.name)
def test_every_function_can_be_called_at_small_sizes(it) -> None:
    for n in (5, 8, 64) if it.growth != "O(2^n)" else (5, 8):
        it.call(it.make(n))


@pytest.mark.parametrize(
    ("answer", "kind"),
    [
        ("O(n)", "right"),
        ("O(n) or O(n log n)", "one of two"),
        ("O(1) or O(log n)", "wrong"),
        ("O(n²)", "wrong"),
        ("O(n^1.2)", "wrong"),
        ("undetermined", "undetermined"),
    ],
)
def test_answers_are_of_one_kind(answer: str, kind: str) -> None:
    assert real_functions.kind_of(answer, "O(n)") == kind


def test_every_judge_is_counted_on_every_function_once() -> None:
    _, answers = real_functions.load_answers(ROOT / real_functions.RESULT)
    for _, rows in answers.groupby(["neighbor", "judge"]):
        assert sorted(rows["function"]) == sorted(it.name for it in HELD_OUT)
    assert set(answers["neighbor"]) == set(real_functions.NEIGHBORS)
    assert (real_functions.shares(answers).sum(axis=1) == len(HELD_OUT)).all()


def test_what_is_measured_anew_leaves_the_other_answers_as_they_were(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in real_functions.ONE_THREAD.items():
        monkeypatch.setenv(name, value)
    who, output = ("f", "O(n)", "a book"), tmp_path / "answers.json"
    for answer, busy in (("O(1)", False), ("O(1)", True), ("O(n)", True)):
        rows = [[*who, real_functions.NEIGHBORS[busy], "hem", answer]]
        monkeypatch.setattr(real_functions, "_rows", lambda *_, rows=rows: iter(rows))
        real_functions.main(output, busy=busy)
    told = real_functions.load_answers(output)[1].set_index("neighbor")["answer"]
    assert told.to_dict() == {"shared": "O(1)", "busy": "O(n)"}


def test_the_readme_shows_the_kept_answers() -> None:
    _, answers = real_functions.load_answers(ROOT / real_functions.RESULT)
    page = (ROOT / "hem" / "complexity" / "README.md").read_text("utf-8")
    table = real_functions.by_judge(answers).astype(str)
    lines = [[*table], ["---"] * 5, *table.to_numpy().tolist()]
    assert "\n".join(f"| {' | '.join(line)} |" for line in lines) in page


def test_ours_is_wrong_least_often_of_all_judges() -> None:
    _, answers = real_functions.load_answers(ROOT / real_functions.RESULT)
    wrong = real_functions.shares(answers)["wrong"].unstack("judge")
    ours = wrong.pop("hem")
    rivals: pd.DataFrame = wrong.drop(columns="hem, memory unknown")
    assert all((rivals.sub(ours, axis=0) > 0).all(axis=1))


def test_the_first_page_tells_the_figures_of_the_shared_machine() -> None:
    _, answers = real_functions.load_answers(ROOT / real_functions.RESULT)
    found = real_functions.shares(answers).loc["shared"]
    ours, others = found.loc["hem"], found.drop(index=["hem", "hem, memory unknown"])
    span = [f"{others[kind].min()} to {others[kind].max()}" for kind in ("right", "wrong")]
    open_ones = f"{ours['one of two']} as one of two, and {ours['undetermined']} it leaves open"
    told = (
        f"it names {ours['right']} right, {ours['wrong']} wrong, {open_ones}; "
        f"the others name {span[0]} right and {span[1]} wrong."
    )
    page = " ".join((ROOT / "README.md").read_text("utf-8").split())
    assert f"Of {len(HELD_OUT)} functions" in page
    assert told in page
