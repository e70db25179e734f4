"""Two trees timed interleaved: identical code is not slower, and one that cannot run no pass."""

import numpy as np
import pytest

from experiments.regression import HERE, Change, compare_trees, exit_code, interleaved
from experiments.regression.interleaved import PairTimed
from experiments.regression.significance import Comparison
from hem.contract import QUERIES
from tests.extent import exhaustive


def pair(change: str, ratio: float = 1.0) -> PairTimed:
    return PairTimed(Comparison(Change(change), ratio, ratio, ratio), 1e-8, 1e-8 * ratio)


AS_BEFORE, OPEN = pair("same"), pair("undetermined", 1.1)
SLOWER, FASTER = pair("worse", 1.6), pair("better", 0.6)
ENDED = PairTimed(error="it ended")


@pytest.mark.parametrize(("pairs", "change"), [
    ([AS_BEFORE, AS_BEFORE, SLOWER, SLOWER, SLOWER], "same"),  # the last ones are not asked
    ([SLOWER] * 5, "worse"),
    ([FASTER] * 5, "better"),
    ([SLOWER, OPEN, SLOWER, SLOWER, OPEN], "worse"),
    ([SLOWER, OPEN, SLOWER, OPEN, OPEN], "undetermined"),
    ([SLOWER, SLOWER, SLOWER, SLOWER, AS_BEFORE], "undetermined"),
    ([SLOWER, SLOWER, FASTER, SLOWER, SLOWER], "undetermined"),
    ([SLOWER, AS_BEFORE, AS_BEFORE, OPEN, AS_BEFORE], "same"),
    ([SLOWER, AS_BEFORE, AS_BEFORE, SLOWER, AS_BEFORE], "undetermined"),
    ([AS_BEFORE, ENDED, *[AS_BEFORE] * 3], "undetermined"),
])  # fmt: skip
def test_a_tree_is_slower_only_if_no_pair_of_processes_says_otherwise(pairs, change, monkeypatch):
    """A process may be slow by where it lies in memory, and slow code is so in all of them."""
    rest = iter(pairs)

    def time_in_new_processes(before, after, wanted, factor):
        timed = next(rest)
        return [(case, timed) for case in wanted]

    monkeypatch.setattr(interleaved, "time_in_new_processes", time_in_new_processes)
    findings = compare_trees(HERE, HERE, ["indexed"])
    assert {finding.change for finding in findings} == {change}
    assert {it.case.size for it in findings} == {2_000}  # faces of a torus of 1,000 vertices
    if ENDED in pairs:
        assert "could not be timed: it ended" in findings[0].why
    else:
        asked = pairs[:2] if pairs[0] == pairs[1] == AS_BEFORE else pairs
        middle = np.median([it.compared.ratio for it in asked])
        assert findings[0].why.startswith(f"× {middle:.2f}")


@pytest.mark.parametrize(("cost", "noise", "change", "rounds"), [
    (1.0, 0.01, "same", 24),
    (1.05, 0.01, "same", 24),
    (1.3, 0.01, "worse", 24),
    (0.7, 0.01, "better", 24),
    (1.15, 0.02, "undetermined", 96),
])  # fmt: skip
def test_two_processes_are_asked_in_turn_until_they_tell(cost, noise, change, rounds, monkeypatch):
    """Of a machine that slows down: neither is always the first, and what both do cancels out."""
    rng, asked, handles = np.random.default_rng(1), [], 1_000

    def ask(each, **question):
        if times := question.get("times"):
            return handles * times, 4e-6 * each * times
        asked.append(each)
        slow = 1.002 ** len(asked)
        return 2e-3 * each * slow * rng.normal(1, noise), 1e-4 * slow

    monkeypatch.setattr(interleaved, "_ask", ask)
    found = interleaved._time_pair([1.0, cost], "indexed", "vertex_faces", 1.15)
    assert found.compared.change == change
    assert found.compared.ratio == pytest.approx(cost, rel=0.02)
    assert found.after / found.before == pytest.approx(cost, rel=0.03)
    each = 2e-3 / (handles * round(2e-3 / (4e-6 * min(1, cost))))  # the quicker one sets the times
    assert each < found.before < each * 1.002 ** len(asked)
    assert (asked[:4], len(asked)) == ([1, cost, cost, 1], 2 * rounds)


@exhaustive
def test_a_tree_beside_itself_is_timed_and_not_worse(monkeypatch):
    # One pair takes seconds; what several say together has its own test.
    monkeypatch.setattr(interleaved, "PAIRS", 1)
    monkeypatch.setattr(interleaved, "FURTHER", 0)
    findings = compare_trees(HERE, HERE, ["indexed"])
    assert [finding.case.subject for finding in findings] == list(QUERIES)
    assert all(it.before.endswith(" ns") and it.after.endswith(" ns") for it in findings)


def test_what_is_not_compiled_cannot_be_timed_beside_a_tree():
    assert exit_code(compare_trees(HERE, HERE, ["half_edge_objects"])) == 2


def test_a_tree_that_does_not_run_is_no_pass_and_says_why(tmp_path):
    (tmp_path / "hem").mkdir()
    (tmp_path / "hem" / "__init__.py").write_text("raise RuntimeError('this one is broken')")
    findings = compare_trees(tmp_path, HERE, ["indexed"])
    assert exit_code(findings) == 2
    assert "could not be timed: RuntimeError: this one is broken" in findings[0].why


def test_a_query_that_fails_in_a_tree_keeps_no_other_from_being_timed(monkeypatch):
    monkeypatch.setattr(interleaved, "MOST_ROUNDS", interleaved.ROUNDS)
    wanted = [("no_such", "vertex_faces"), ("indexed", "face_vertices")]
    first, second = dict(interleaved.time_in_new_processes(HERE, HERE, wanted, 1.15)).values()
    assert "no_such" in first.error
    assert not second.error
    assert second.before > 0
