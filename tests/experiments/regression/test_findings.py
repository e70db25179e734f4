"""Laws of findings: what fails, what cannot be told, and what more than half say."""

import pytest

from experiments.regression import CaseKey, Change, Finding, Kind, exit_code
from experiments.regression.findings import vote
from experiments.report.findings import as_json, as_markdown, summary

WORSE, OPEN, BETTER, SAME = Change.WORSE, Change.UNDETERMINED, Change.BETTER, Change.SAME
CASE = CaseKey("bench_work", "half_edge", "vertex_faces", "torus", 200, order="random")


def test_a_case_is_named_by_what_it_has():
    assert str(CASE) == "bench_work/half_edge/vertex_faces/torus/200/random"
    weighed = CaseKey("bytes", "indexed", "faces", size=9, valence=8, reference_bytes=8)
    assert str(weighed) == "bytes/indexed/faces/9/valence 8/8-byte references"
    assert str(weighed._replace(reference_bytes=4)) == "bytes/indexed/faces/9/valence 8"


def counted(change: Change) -> Finding:
    return Finding(change, Kind.WORK, CASE, "19", "20")


def timed(change: Change) -> Finding:
    return Finding(change, Kind.TIME, CASE, "", "× 1.2", random=True)


def test_worse_outweighs_what_cannot_be_told_and_that_outweighs_better():
    findings = [counted(change) for change in (BETTER, OPEN, WORSE)]
    assert exit_code(findings[:1]) == 0
    assert exit_code(findings[:2]) == 2
    assert exit_code(findings) == 1
    assert exit_code([]) == 0


def test_chance_may_leave_a_tenth_open_and_nothing_else_may_be():
    closed, left_open = [timed(SAME)] * 18, [timed(OPEN)]
    assert exit_code(closed + 2 * left_open) == 0
    assert exit_code(closed + 3 * left_open) == 2
    assert exit_code([*closed, Finding(OPEN, Kind.TIME, CASE, why="was not measured")]) == 2
    assert exit_code(closed[:8] + left_open) == 0
    assert exit_code(closed[:8] + 2 * left_open) == 2
    assert exit_code(closed[:1] + left_open) == 0
    assert exit_code(left_open) == 2


@pytest.mark.parametrize(("changes", "unanimous", "said"), [
    ([WORSE, WORSE, SAME], False, WORSE),
    ([WORSE, WORSE, SAME], True, OPEN),
    ([WORSE, WORSE, OPEN], True, WORSE),
    ([WORSE, WORSE, OPEN, OPEN], True, OPEN),
    ([BETTER] * 5, True, BETTER),
    ([WORSE, SAME, SAME, OPEN, SAME], True, SAME),
    ([WORSE, SAME, SAME, WORSE, SAME], True, OPEN),
    ([WORSE, SAME, SAME, WORSE, SAME], False, OPEN),
])  # fmt: skip
def test_a_vote_needs_more_than_half_and_few_who_say_otherwise(changes, unanimous, said):
    assert vote(changes, unanimous=unanimous)[0] == said


def test_json_and_markdown_say_what_is_worse():
    content = as_json([counted(WORSE)], ["a note"])
    (found,) = content["findings"]
    assert (content["code"], found["where"], found["outcome"]) == (1, str(CASE), "worse")
    assert found["case"]["structure"] == "half_edge"
    text = as_markdown([counted(WORSE)], ["a note"])
    assert f"| work | `{CASE}` | 19 | 20 |" in text
    assert "- a note" in text


def test_a_pass_says_that_some_of_it_is_open():
    assert summary([timed(SAME)] * 18) == "Nothing got worse."
    assert (
        summary([timed(SAME)] * 18 + [timed(OPEN)]) == "Nothing got worse, as far as can be told."
    )
    assert summary([timed(SAME), counted(WORSE)]) == "Something got worse."
