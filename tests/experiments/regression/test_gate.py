"""The gate: what is as before passes, what is worse fails, and what was not seen never passes."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from experiments import cli
from experiments.claims.judged import judged, save
from experiments.regression import interleaved
from experiments.regression.baseline import SCHEMA, load_exact, measured, save_exact, save_measured
from experiments.regression.compare_runs import compare_runs
from experiments.regression.counters import Exact, measure
from experiments.regression.findings import Finding, claim_of, code, compare_cases, compare_exact
from experiments.regression.findings_shown import as_json, as_markdown
from experiments.regression.significance import Comparison
from experiments.runs.results import load
from hem.contract import QUERIES
from tests.experiments.made_runs import LAWS, write_run

HERE = Path(__file__).parents[3]
REFERENCE = HERE / "results/reference"
KEY = "work/half_edge/vertex_faces/torus/100/random"


def hem(*arguments: str) -> tuple[int, str]:
    cli.console.width = cli.errors.width = 400
    result = CliRunner().invoke(cli.app, arguments)
    return result.exit_code, " ".join((result.stdout + result.stderr).split())


def outcomes(findings) -> set[str]:
    return {it.outcome for it in findings}


def test_work_and_bytes_are_those_of_the_reference():
    findings = compare_exact(load_exact(REFERENCE), measure())
    assert [str(it) for it in findings if it.outcome != "same"] == []


@pytest.mark.parametrize(
    ("before", "after", "outcome"),
    [
        ([19, 19], [19, 19], "same"),
        ([19, 19], [19, 20], "worse"),
        ([19, 19], [18, 20], "worse"),
        ([19, 19], [18, 19], "better"),
        ([19, 19], [19, 19, 19], "worse"),
        ([10, 20, 40, 80], [10, 60], "worse"),
        ([10, 20, 40], [10, 11, 12, 13, 14, 15], "worse"),
        ([10, 20, 40], [10, 20], "better"),
        ([19, 19], None, "undetermined"),
        (None, [19, 19], "undetermined"),
        ("O(n), consistent", "O(1), violated", "worse"),
        ("O(1), no claim", "O(n), no claim", "worse"),
        ("O(n), violated", "O(1), consistent", "better"),
        ("O(n), consistent", "O(n), undetermined", "undetermined"),
    ],
)
def test_an_exact_value_is_compared_to_the_last_count(before, after, outcome):
    sides = ({KEY: it} if it is not None else {} for it in (before, after))
    (found,) = compare_cases(*sides)
    assert found.outcome == outcome
    assert "Vertex → Faces: O(n_ev)" in found.claim
    assert code([found]) == {"worse": 1, "undetermined": 2}.get(outcome, 0)


def test_worse_outweighs_what_cannot_be_told_and_that_outweighs_better():
    found = [Finding(it, "work", "", "", "") for it in ("better", "undetermined", "worse")]
    assert code(found[:1]) == 0
    assert code(found[:2]) == 2
    assert code(found) == 1
    assert code([]) == 0


def test_what_could_not_be_measured_is_never_a_pass():
    before = Exact({KEY: [19]})
    (found,) = compare_exact(before, Exact({}, {KEY: "ValueError: broken"}))
    assert (found.outcome, found.why) == ("undetermined", "ValueError: broken")


def test_a_finding_names_the_claim_it_touches():
    assert claim_of("bytes/half_edge/torus/1000").startswith("Table 1, Bytes per vertex: 228")
    assert "Split face" in claim_of("work/half_edge/split_face/torus/100/counted")
    assert claim_of("work/as_printed/listing/build/torus/50/counted").startswith("The listings")


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory):
    return load(write_run(tmp_path_factory.mktemp("sound")))


@pytest.fixture(scope="module")
def before(sound):
    return measured(sound)


def test_a_run_is_as_good_as_itself(before):
    assert outcomes(compare_runs(before, before).findings) == {"same"}


def test_a_query_that_becomes_linear_is_worse_by_work_class_slope_and_time(before, tmp_path):
    def law_of(structure, query, printed):
        changed = (structure, query) == ("half_edge", "face_faces")
        return LAWS["O(n_t)"] if changed else None

    slow = load(write_run(tmp_path, law_of))
    worse = [it for it in compare_runs(before, measured(slow)).findings if it.outcome == "worse"]
    assert {it.kind for it in worse} == {"work", "class", "slope", "time"}
    assert all("half_edge/face_faces" in it.where for it in worse)
    assert all("Face → adjacent Faces: O(1)" in it.claim for it in worse)


@pytest.mark.parametrize(("steeper", "outcome"), [(0.0, "undetermined"), (1.0, "worse")])
def test_by_time_a_claim_is_lost_only_where_a_slope_says_so(before, steeper, outcome):
    key = "queries", "half_edge", "face_edges"
    row = dict(before.verdicts[key], outcome_time="violated")
    row["time_faces"] = row["time_faces"] | {it: row["time_faces"][it] + steeper for it in SLOPES}
    after = replace(before, verdicts={**before.verdicts, key: row})
    (found,) = [it for it in compare_runs(before, after).findings if it.after == "violated"]
    assert (found.where, found.outcome) == ("half_edge/face_edges by time", outcome)


SLOPES = ("slope", "slope_low", "slope_high")


@pytest.mark.parametrize(("by", "outcome"), [(1e-9, "same"), (0.02, "worse")])
def test_slopes_of_work_may_differ_by_rounding_and_no_more(before, by, outcome):
    key = "queries", "half_edge", "face_edges"
    row = dict(before.verdicts[key])
    row["work_faces"] = row["work_faces"] | {it: row["work_faces"][it] + by for it in SLOPES}
    after = replace(before, verdicts={**before.verdicts, key: row})
    where = "half_edge/face_edges by work and faces"
    (found,) = [it for it in compare_runs(before, after).findings if it.where == where]
    assert found.outcome == outcome


def test_of_another_profile_no_slopes_are_compared_and_that_is_said(before):
    other = replace(before, head={**before.head, "profile": "full"})
    compared = compare_runs(before, other)
    assert not [it for it in compared.findings if it.kind == "slope"]
    assert any("slopes are not compared" in note for note in compared.notes)
    assert code(compared.findings) == 0


def test_a_busy_machine_cannot_judge_by_time(before):
    busy = replace(before, head={**before.head, "too_busy": True})
    findings = compare_runs(before, busy).findings
    timed = [it.where for it in findings if it.by_chance or it.kind == "time"]
    assert timed == ["all that is timed"]
    assert code(findings) == 2


CURVE = "bench_queries/half_edge/face_edges/"


def random_cases(before) -> list[str]:
    keys = [it for it in before.times if it.startswith(CURVE) and it.endswith("/random")]
    return sorted(keys, key=lambda key: before.times[key]["samples"])


def of_curve(before, times) -> Finding:
    findings = compare_runs(before, replace(before, times=times)).findings
    (found,) = [it for it in findings if it.kind == "time" and it.where == f"{CURVE}random"]
    return found


@pytest.mark.parametrize("slower", [0, 1, 2])
def test_a_curve_is_not_as_before_where_some_of_it_is_slower(before, slower):
    keys = random_cases(before)
    times = dict(before.times)
    for key in keys[len(keys) - slower :]:
        times[key] = {**times[key], "samples": [3 * it for it in times[key]["samples"]]}
    assert of_curve(before, times).outcome == ("undetermined" if slower == 2 else "same")


@pytest.mark.parametrize(("times", "said"), [(1.6, "same"), (2.5, "worse"), (0.4, "better")])
def test_from_run_to_run_a_curve_must_be_twice_as_slow(before, times, said):
    keys = random_cases(before)
    scaled = {
        key: {**it, "samples": [times * sample for sample in it["samples"]]} if key in keys else it
        for key, it in before.times.items()
    }
    assert of_curve(before, scaled).outcome == said


def test_a_timed_case_that_is_gone_is_missed(before):
    lost = random_cases(before)[0]
    found = of_curve(before, {key: it for key, it in before.times.items() if key != lost})
    assert (found.outcome, "1 not measured" in found.why) == ("undetermined", True)


def test_chance_may_leave_a_tenth_open_and_nothing_else_may_be():
    closed = [Finding("same", "time", "a curve", "", "× 1.0")] * 18
    left_open = [Finding("undetermined", "time", "a curve", "", "× 1.2")]
    missing = [Finding("undetermined", "time", "a curve", "", "", "was not measured")]
    assert code(closed + 2 * left_open) == 0
    assert code(closed + 3 * left_open) == 2
    assert code(closed + missing) == 2
    assert code(closed[:8] + left_open) == 0
    assert code(closed[:8] + 2 * left_open) == 2
    assert code(left_open) == 2


def test_of_another_python_the_bytes_of_objects_are_left_out_in_runs_as_well():
    cases = {"bench_memory/half_edge_objects/torus/100/8-byte references": [7]}
    assert compare_cases(cases, {}, other_python=True) == []


def test_what_is_not_compiled_cannot_be_timed_beside_a_tree():
    assert code(interleaved.compare_trees(HERE, HERE, ["half_edge_objects"])) == 2


def test_times_of_another_machine_are_left_out_and_that_is_said(before):
    other = replace(before, head={**before.head, "machine": {"cpu": "another"}})
    compared = compare_runs(before, other)
    assert not [it for it in compared.findings if it.kind == "time"]
    assert any("another machine" in note for note in compared.notes)


def test_an_experiment_that_is_missing_cannot_be_told(before):
    kept = {k: v for k, v in before.exact.items() if not k.startswith("bench_work/half_edge/")}
    findings = compare_runs(before, replace(before, exact=kept)).findings
    missing = [it for it in findings if it.outcome != "same"]
    assert [it.where for it in missing] == ["bench_work/half_edge"]
    assert code(findings) == 2


def test_json_and_markdown_say_what_is_worse():
    before, after = {KEY: [19]}, {KEY: [20]}
    found = compare_cases(before, after)
    content = as_json(found, ["a note"])
    assert (content["code"], content["findings"][0]["where"]) == (1, KEY)
    text = as_markdown(found, ["a note"])
    assert f"| work | `{KEY}` | 19 | 20 |" in text
    assert "- a note" in text


@pytest.fixture
def reference(tmp_path: Path) -> Path:
    folder = tmp_path / "reference"
    shutil.copytree(REFERENCE, folder)
    return folder


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere"], "nowhere holds no run"),
        (["--factor", "0.5"], "--factor is more than 1"),
        (["--structure", "halfedge"], "no structure is called 'halfedge'"),
        (["--reference", "nowhere"], "nowhere/exact.json is not there"),
        (["--beside", "nowhere", "--structure", "indexed"], "nowhere is no checkout"),
    ],
)
def test_a_mistake_is_one_line_and_never_a_pass(arguments, said, reference):
    options = [] if "--reference" in arguments else ["--reference", str(reference)]
    exit_code, output = hem("check", *arguments, *options)
    assert exit_code == 2
    assert output.startswith("hem:")
    assert said in output


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "exact.json cannot be read"),
        ("[]", "exact.json holds no cases"),
        ('{"schema": 99, "cases": {}}', f"has schema 99, this version reads {SCHEMA}"),
    ],
)
def test_a_broken_reference_is_named_with_the_way_out(text, said, reference):
    (reference / "exact.json").write_text(text)
    exit_code, output = hem("check", "--reference", str(reference))
    assert exit_code == 2
    assert said in output
    assert "hem reference update" in output


def test_an_empty_run_is_refused(reference, tmp_path):
    (tmp_path / "run.json").write_text('{"schema": 1, "profile": "quick"}')
    exit_code, output = hem("check", str(tmp_path), "--reference", str(reference))
    assert exit_code == 2
    assert "holds no case" in output


def test_a_worse_structure_fails_the_command_and_shows_the_numbers(reference, tmp_path):
    exact = load_exact(reference)
    exact.cases["work/indexed/face_vertices/torus/100/random"] = [2, 2, 2]
    save_exact(exact, reference)
    page = tmp_path / "summary.md"
    options = "--structure", "indexed", "--reference", str(reference), "--markdown", str(page)
    exit_code, output = hem("check", *options)
    assert exit_code == 1
    assert "2, 2, 2 → 3, 3, 3 (Table 1, Face → Vertices: O(1)" in output
    assert "Something got worse" in page.read_text()


def test_a_tree_beside_itself_is_timed_and_not_worse(monkeypatch):
    monkeypatch.setattr(
        interleaved, "PAIRS", 1
    )  # so that it takes seconds; what they say has its own test
    monkeypatch.setattr(interleaved, "FURTHER", 0)
    found = interleaved.compare_trees(HERE, HERE, ["indexed"])
    assert [it.where.split("/")[2] for it in found] == list(QUERIES)
    assert outcomes(found) <= {"same", "undetermined"}
    assert all(it.before.endswith(" ns") and it.after.endswith(" ns") for it in found)


def pair(outcome: str, ratio: float = 1.0) -> interleaved.Pair:
    return interleaved.Pair(Comparison(outcome, ratio, ratio, ratio, 0.0), 1e-8, 1e-8 * ratio)


AS_BEFORE, OPEN = pair("same"), pair("undetermined", 1.1)
SLOWER, FASTER = pair("worse", 1.6), pair("better", 0.6)


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        ([AS_BEFORE, AS_BEFORE, SLOWER, SLOWER, SLOWER], "same"),  # the last ones are not asked
        ([SLOWER] * 5, "worse"),
        ([FASTER] * 5, "better"),
        ([SLOWER, OPEN, SLOWER, SLOWER, OPEN], "worse"),
        ([SLOWER, OPEN, SLOWER, OPEN, OPEN], "undetermined"),
        ([SLOWER, SLOWER, SLOWER, SLOWER, AS_BEFORE], "undetermined"),
        ([SLOWER, SLOWER, FASTER, SLOWER, SLOWER], "undetermined"),
        ([SLOWER, AS_BEFORE, AS_BEFORE, OPEN, AS_BEFORE], "same"),
        ([SLOWER, AS_BEFORE, AS_BEFORE, SLOWER, AS_BEFORE], "undetermined"),
        ([AS_BEFORE, "it ended", *[AS_BEFORE] * 3], "undetermined"),
    ],
)
def test_a_tree_is_slower_only_if_no_pair_of_processes_says_otherwise(pairs, said, monkeypatch):
    """A process may be slow by where it lies in memory, and slow code is so in all of them."""
    rest = iter(pairs)

    def in_new_processes(before, after, wanted, factor):
        found = next(rest)
        return [(it, found) for it in wanted]

    monkeypatch.setattr(interleaved, "_in_new_processes", in_new_processes)
    found = interleaved.compare_trees(HERE, HERE, ["indexed"])
    assert outcomes(found) == {said}
    assert "it ended" not in pairs or "could not be timed: it ended" in found[0].why


def test_a_tree_that_cannot_be_timed_is_no_pass(reference, tmp_path):
    other = tmp_path / "other"
    (other / "hem").mkdir(parents=True)
    (other / "hem" / "__init__.py").write_text("raise RuntimeError('this one is broken')")
    options = "--structure", "indexed", "--reference", str(reference)
    exit_code, output = hem("check", "--beside", str(other), *options)
    assert exit_code == 2
    assert "could not be timed: RuntimeError: this one is broken" in output


def test_a_saved_reference_reads_as_it_was_one_line_per_case(sound, before, tmp_path):
    from experiments.regression.baseline import load_measured

    save_measured(before, tmp_path)
    save(sound, judged(sound), tmp_path)
    assert load_measured(tmp_path) == before
    lines = (tmp_path / "times.json").read_text().splitlines()
    assert len([it for it in lines if it.startswith('"bench_')]) == len(before.times)
    assert json.loads((tmp_path / "run.json").read_text())["schema"] == SCHEMA
