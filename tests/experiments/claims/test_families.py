"""Laws of the families: each is judged by its own times, and what denies another is named."""

from pathlib import Path

import pytest

from experiments.claims import BY_TIME, Outcome, judge_families, judge_run
from experiments.harness import Axis
from experiments.report import comparisons
from experiments.runs import CaseFile, Run, load
from tests.experiments.made_runs import SIZES, write_run

DENIED = "half_edge", "face_faces"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Two more families: one like the judged one, one on which a constant query is linear."""
    folder = write_run(tmp_path_factory.mktemp("families"), only=lambda _, it: it == DENIED[0])
    for path in list(folder.glob("bench_queries.*.jsonl")):
        file = CaseFile.at(path)
        for family in ("like", "unlike"):
            given = [it for it in file.measurements if it.faces in SIZES[::2]]
            file.add(*(of_family(it, family, file.structure) for it in given))
    return load(folder)


def of_family(case, family: str, structure: str):
    linear = family == "unlike" and (structure, case.subject) == DENIED
    factor = case.faces if linear and case.order == "consecutive" else 1
    changed = {"family": family, "id": f"{family}/{case.id}", "edges": 3 * case.vertices}
    changed |= {"samples": [factor * it for it in case.samples], "reference": None}
    return type(case)(**{**vars(case), **changed})


def test_the_judged_family_comes_first_and_is_judged_by_no_more_than_others(run: Run) -> None:
    first, like, unlike = judge_families(run, judge_run(run))
    assert (first.name, like.name, unlike.name) == ("torus", "like", "unlike")
    for axis in BY_TIME:
        assert first.outcomes(axis) == like.outcomes(axis)
        for mine, others in zip(first.claims, like.claims, strict=True):
            one, other = (it.verdicts.get(axis) for it in (mine, others))
            assert (one is None and other is None) or vars(one) == vars(other)


def test_what_another_family_denies_is_named_and_nothing_else(run: Run) -> None:
    first, like, unlike = judge_families(run, judge_run(run))
    assert not [it for axis in BY_TIME for it in like.against(first, axis)]
    (denied,) = unlike.against(first, Axis.TIME_FACES)
    assert (denied.claim.structure, denied.claim.subject) == DENIED
    assert unlike.outcomes(Axis.TIME_FACES)[denied.claim.key] is Outcome.VIOLATED
    assert first.outcomes(Axis.TIME_FACES)[denied.claim.key] is Outcome.CONSISTENT
    assert not list(unlike.against(first, Axis.RANDOM_FACES))


def test_the_page_tells_which_family_it_is_and_of_what(run: Run) -> None:
    families = judge_families(run, judge_run(run))
    text = comparisons.by_family(families)
    assert text.count("Half-Edge, Face → adjacent Faces</a>: violated by time in order") == 1
    assert "unlike (1)." in comparisons.families_in_words(families)
    assert "none of them" in comparisons.families_in_words(families[:2])
    assert "one family alone" in comparisons.families_in_words(families[:1])


def test_a_run_without_queries_has_no_family(tmp_path: Path) -> None:
    run = load(write_run(tmp_path, only=lambda experiment, _: experiment == "bench_memory"))
    assert judge_families(run, judge_run(run)) == []
