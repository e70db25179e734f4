"""The comparisons: what is as before passes, worse fails, and what was not seen never passes."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from experiments.harness import Axis
from experiments.regression import (
    COUNTERS,
    RUN,
    CaseKey,
    Change,
    Finding,
    Kind,
    Measured,
    compare_counters,
    compare_runs,
    exit_code,
    load_baseline,
    measure_counters,
    reduce_run,
)
from experiments.regression.baseline import UPDATE
from experiments.regression.compare import claim_of, compare_classes, compare_values
from experiments.runs import load
from structures import NAMED, NAMES
from tests.experiments.made_runs import LAWS, write_run
from tests.extent import EVERYTHING, OF_EACH_KIND

STRUCTURES = ["half_edge"]
"""A run of one structure is a run, and quickly compared."""
SUBJECTS = "face_edges", "face_faces", "split_face"
CLAIM = "queries/half_edge/face_edges"


@pytest.fixture(scope="module")
def counters() -> Measured:
    return load_baseline(COUNTERS)


@pytest.fixture(scope="module")
def before(base_run) -> Measured:
    """Times of a few subjects, as every curve is compared in every test."""
    measured = reduce_run(base_run).only(STRUCTURES)
    cases = measured.run.cases
    return without(measured, cases["kind"].eq("time") & ~cases["subject"].isin(SUBJECTS))


def changed(measured: Measured, rows, **columns) -> Measured:
    """With other values in some cases; ``None``: without these cases."""
    cases = measured.run.cases.copy()
    for name, value in columns.items():
        cases.loc[rows, name] = cases.loc[rows, name].map(value)
    return replace(measured, run=replace(measured.run, cases=cases))


def without(measured: Measured, rows) -> Measured:
    cases = measured.run.cases
    return replace(measured, run=replace(measured.run, cases=cases[~rows]))


def meta(measured: Measured, **more) -> Measured:
    return replace(measured, run=replace(measured.run, meta={**measured.run.meta, **more}))


def not_same(findings: list[Finding]) -> list[Finding]:
    return [finding for finding in findings if finding.change != Change.SAME]


def test_counters_and_classes_are_those_of_the_baseline(counters):
    chosen = [name for name in NAMED if name in OF_EACH_KIND or name not in NAMES]
    findings = compare_counters(counters.only(chosen), measure_counters(chosen)).findings
    assert not_same(findings) == []
    kinds = [finding.kind for finding in findings]
    # What Python's own objects take is that of its version, and compared with the same one only.
    python = str(counters.run.meta["versions"]["python"]).split(".")[:2]
    same = python == [str(it) for it in sys.version_info[:2]]
    assert set(kinds) == {Kind.WORK, Kind.BYTES, Kind.CLASS}
    assert not EVERYTHING or {kind: kinds.count(kind) for kind in set(kinds)} == {
        Kind.WORK: 1126, Kind.BYTES: 139 if same else 116, Kind.CLASS: 274,
    }  # fmt: skip


@pytest.mark.parametrize(("before", "after", "change"), [
    ([19, 19], [19, 19], "same"),
    ([19, 19], [19, 20], "worse"),
    ([19, 19], [18, 20], "worse"),
    ([19, 19], [18, 19], "better"),
    ([19, 19], [19, 19, 19], "worse"),
    ([10, 20, 40, 80], [10, 60], "worse"),
    ([10, 20, 40], [10, 11, 12, 13, 14, 15], "worse"),
    ([10, 20, 40], [10, 20], "better"),
])  # fmt: skip
def test_counts_are_compared_to_the_last_one(before, after, change):
    found, why = compare_values(before, after)
    assert (found, bool(why)) == (change, len(before) != len(after))


@pytest.mark.parametrize(("before", "after", "change"), [
    (("O(n)", "consistent"), ("O(1)", "violated"), "worse"),
    (("O(1)", "no claim"), ("O(n)", "no claim"), "worse"),
    (("O(n)", "violated"), ("O(1)", "consistent"), "better"),
    (("O(n)", "consistent"), ("O(n)", "undetermined"), "undetermined"),
    (("O(n)", "consistent"), ("O(n)", "consistent"), "same"),
])  # fmt: skip
def test_classes_are_compared_by_what_became_of_the_claim(before, after, change):
    assert compare_classes(before, after)[0] == change


def test_a_higher_count_is_worse_and_names_the_case_and_the_claim(counters):
    rows = counters.run.cases["id"].eq("vertex_faces/torus/100/random")
    rows &= counters.run.cases["structure"] == "half_edge"
    more = changed(counters, rows, samples=lambda samples: samples + 1)
    (found,) = not_same(compare_counters(counters, more).findings)
    assert (found.change, found.case.subject, found.case.size) == ("worse", "vertex_faces", 200)
    assert "Vertex → Faces: O(n_ev)" in found.claim
    assert exit_code([found]) == 1


def test_what_is_not_in_the_baseline_says_which_command_is_next(counters):
    rows = counters.run.cases["structure"] == "plankton"
    found = not_same(compare_counters(without(counters, rows), counters).findings)
    assert {finding.next for finding in found} == {"hem baseline update"}
    assert exit_code(found) == 2


def test_what_could_not_be_measured_is_never_a_pass(counters):
    rows = counters.run.cases["id"].eq("vertex_faces/torus/100/random")
    skipped = counters.run.cases[rows].assign(skipped="ValueError: broken")
    after = without(counters, rows)
    after = replace(after, run=replace(after.run, skipped=skipped))
    found = not_same(compare_counters(counters, after).findings)
    assert {finding.why for finding in found} == {"ValueError: broken"}
    assert exit_code(found) == 2


def test_of_another_python_the_bytes_of_objects_are_not_compared(counters):
    rows = counters.run.cases["structure"].eq("half_edge_objects")
    rows &= counters.run.cases["kind"] == "bytes"
    other = changed(counters, rows, samples=lambda samples: samples + 8)
    assert exit_code(compare_counters(counters, other).findings) == 1
    findings, notes = compare_counters(counters, meta(other, versions={"python": "3.99.1"}))
    assert not_same(findings) == []
    assert "3.99.1" in notes[0]


def test_a_run_is_as_good_as_itself(before):
    assert not_same(compare_runs(before, before).findings) == []


def test_a_query_that_becomes_linear_is_worse_by_work_class_slope_and_time(before, tmp_path):
    def law_of(structure, query, printed):
        linear = (structure, query) == ("half_edge", "face_faces")
        return LAWS["O(n_t)"] if linear else None

    made = write_run(tmp_path, law_of, lambda experiment, structure: structure in STRUCTURES)
    slow = reduce_run(load(made)).only(STRUCTURES)
    worse = [it for it in compare_runs(before, slow).findings if it.change == Change.WORSE]
    assert {finding.kind for finding in worse} == {Kind.WORK, Kind.CLASS, Kind.SLOPE, Kind.TIME}
    assert {finding.case[1:3] for finding in worse} == {("half_edge", "face_faces")}
    assert all("Face → adjacent Faces: O(1)" in finding.claim for finding in worse)


def with_figures(measured: Measured, steeper: float = 0.0, axis: str = "", **more) -> Measured:
    figures = {**measured.claims[CLAIM], **more}
    if axis:
        slopes = figures["slopes"]
        figures["slopes"] = {**slopes, axis: [slope + steeper for slope in slopes[axis]]}
    return replace(measured, claims={**measured.claims, CLAIM: figures})


@pytest.mark.parametrize(("steeper", "change"), [(0.0, "undetermined"), (1.0, "worse")])
def test_by_time_a_claim_is_lost_only_where_a_slope_says_so(before, steeper, change):
    after = with_figures(before, steeper, "time_faces", outcome_time="violated")
    (found,) = [it for it in compare_runs(before, after).findings if it.after == "violated"]
    assert (found.case[1:3], found.change) == (("half_edge", "face_edges"), change)


@pytest.mark.parametrize(("by", "change"), [(1e-9, None), (0.02, "worse"), (-0.02, "better")])
def test_slopes_of_work_may_differ_by_rounding_and_no_more(before, by, change):
    found = not_same(compare_runs(before, with_figures(before, by, "work_faces")).findings)
    assert [finding.change for finding in found] == ([change] if change else [])


@pytest.mark.parametrize(("outcome", "told"), [("consistent", ["worse"]), ("no claim", [])])
def test_slopes_of_time_are_compared_where_something_is_claimed(before, outcome, told):
    old, new = (with_figures(before, it, "time_faces", outcome=outcome) for it in (0.0, 1.0))
    assert [it.change for it in not_same(compare_runs(old, new).findings)] == told


def test_what_no_claim_is_about_bears_on_none():
    assert claim_of(CaseKey("bench_workloads", "half_edge", "impacts")) == ""
    assert "228" in claim_of(CaseKey("bench_memory", "half_edge"))


def test_of_another_preset_no_slopes_are_compared_and_that_is_said(before):
    findings, notes = compare_runs(before, meta(before, preset="full"))
    assert Kind.SLOPE not in {finding.kind for finding in findings}
    assert any("nor are slopes" in note for note in notes)
    assert exit_code(findings) == 0


def test_a_smaller_preset_is_held_against_what_both_have(before):
    gone = ("flip_edge", "add_face", "remove_face")
    cases = before.run.cases
    less = without(before, cases["experiment"].eq("bench_fracture") | cases["subject"].isin(gone))
    claims = {name: it for name, it in before.claims.items() if not name.endswith(gone)}
    assert len(claims) < len(before.claims)
    findings = compare_runs(before, meta(replace(less, claims=claims), preset="full")).findings
    assert exit_code(findings) == 0


def test_a_busy_machine_cannot_judge_by_time(before):
    findings = compare_runs(before, meta(before, too_busy=True)).findings
    timed = [finding for finding in findings if finding.random or finding.kind == Kind.TIME]
    assert [finding.case.experiment for finding in timed] == ["all times"]
    assert exit_code(findings) == 2


def test_times_of_another_machine_are_not_compared_and_that_is_said(before):
    findings, notes = compare_runs(before, meta(before, machine={"cpu": "another"}))
    assert Kind.TIME not in {finding.kind for finding in findings}
    assert any("another machine" in note for note in notes)


def test_an_experiment_that_is_missing_cannot_be_told(before):
    cases = before.run.cases
    rows = cases["experiment"].eq("bench_work") & cases["structure"].eq("half_edge")
    findings = compare_runs(before, without(before, rows)).findings
    (missing,) = not_same(findings)
    assert missing.case[:2] == ("bench_work", "half_edge")
    assert exit_code(findings) == 2


def curve(measured: Measured, count: int | None = None):
    """The rows of one timed curve, or of its largest cases."""
    cases = measured.run.cases
    rows = cases["experiment"].eq("bench_queries") & cases["structure"].eq("half_edge")
    rows &= cases["subject"].eq("face_edges") & cases["order"].eq("random")
    rows &= cases["valence"].isna()
    largest = cases[rows].sort_values("faces").index
    return cases.index.isin(largest if count is None else largest[len(largest) - count :])


def of_curve(before: Measured, after: Measured) -> Finding:
    (found,) = [
        finding
        for finding in compare_runs(before, after).findings
        if finding.kind == Kind.TIME
        and finding.case[:3] == ("bench_queries", "half_edge", "face_edges")
        and finding.case.order == "random"
        and finding.axis == Axis.TIME_FACES.symbol
    ]
    return found


@pytest.mark.parametrize(("slower", "times", "change"), [
    (0, 3, "same"), (1, 3, "same"), (1, 100, "undetermined"), (2, 3, "undetermined"),
    (3, 3, "worse"),
])  # fmt: skip
def test_a_curve_is_slower_where_all_its_largest_cases_are(before, slower, times, change):
    after = changed(before, curve(before, slower), samples=lambda samples: times * samples)
    found = of_curve(before, after)
    assert found.change == change
    assert ("n_t on" in found.why) == (change == "worse")


def test_the_smallest_cases_alone_do_not_make_a_curve_slower(before):
    rows = curve(before) & ~curve(before, sum(curve(before)) // 2 + 1)
    after = changed(before, rows, samples=lambda samples: 3 * samples)
    assert of_curve(before, after).change == "undetermined"


@pytest.mark.parametrize(("times", "change"), [(1.6, "same"), (2.5, "worse"), (0.4, "better")])
def test_from_run_to_run_a_curve_must_be_twice_as_slow(before, times, change):
    after = changed(before, curve(before), samples=lambda samples: times * samples)
    found = of_curve(before, after)
    assert (found.change, found.after.split(" (")[0]) == (change, f"× {times:.2f}")


def test_a_machine_that_slowed_as_much_as_the_curve_is_no_slower_code(before):
    def slower(values):
        return (3 * np.asarray(values)).tolist()

    after = changed(before, curve(before), samples=slower, calibration=slower)
    assert of_curve(before, after).change == "undetermined"


@pytest.mark.parametrize(("count", "said"), [(1, "1 not measured"), (None, "was not measured")])
def test_a_timed_case_that_is_gone_is_missed_and_so_is_a_curve(before, count, said):
    found = of_curve(before, without(before, curve(before, count)))
    assert (found.change, said in found.why) == ("undetermined", True)
    new = of_curve(without(before, curve(before)), before)
    assert (new.change, new.next) == ("undetermined", UPDATE[RUN])


def test_a_baseline_without_calibration_says_which_command_is_next(before):
    old = changed(before, before.run.cases["kind"].eq("time"), calibration=lambda _: [])
    (found,) = [it for it in compare_runs(old, before).findings if it.kind == Kind.TIME]
    assert (found.change, found.next) == ("undetermined", "hem baseline update RUN")
