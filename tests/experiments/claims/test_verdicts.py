"""Verdicts on runs that follow a known law: what holds is consistent, what does not is violated."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from experiments.claims import (
    MEMORY,
    NO_CLAIM,
    SENTENCES,
    JudgedClaim,
    Outcome,
    curves,
    judge_cells,
    judge_run,
    load_claims,
)
from experiments.harness import NO_STRUCTURE, Axis, Measurement
from experiments.runs import CaseFile, Run, load
from structures import NAMES, REGISTRY, THESIS
from tests.experiments import made_runs
from tests.experiments.made_runs import LAWS, LIKE_THE_THESIS, SIZES, rewrite, write_run
from tests.extent import OF_EACH_KIND, waiting_for

TABLES = "queries", "operations"


@pytest.fixture(scope="module")
def every(base_run: Run) -> list[JudgedClaim]:
    """All its cells, judged."""
    return [it for it in judge_run(base_run) if it.claim.table != SENTENCES]


def cells(run: Run, **fields: str) -> list[JudgedClaim]:
    """The judged cells of a run whose claims have these fields."""
    claims = [c for c in load_claims() if all(getattr(c, k) == v for k, v in fields.items())]
    return judge_cells(run, claims)


def measured_cells(tmp_path: Path, law_of: Callable, **fields: str) -> list[JudgedClaim]:
    """The same of a run of a structure of each kind, as far as it was measured."""
    run = load(write_run(tmp_path, law_of, lambda _, structure: structure in OF_EACH_KIND))
    return [it for it in cells(run, **fields) if it.was_measured]


def claimed(judged: list[JudgedClaim]) -> list[JudgedClaim]:
    return [it for it in judged if it.claim.claims_something and it.claim.subject != MEMORY]


def test_what_grows_as_claimed_is_consistent_by_work_and_by_time(every):
    more = len(LIKE_THE_THESIS)
    counts = {"queries": 26 + 8 * more, "operations": 16 + 4 * more, "listings": 14, "naming": 2}
    for table, count in counts.items():
        of_table = [it for it in claimed(every) if it.claim.table == table]
        assert len(of_table) == count
        assert {it.outcome for it in of_table} == {Outcome.CONSISTENT}
        assert {it.outcome_time for it in of_table} == {Outcome.CONSISTENT}
    memory = [it.outcome for it in every if it.claim.subject == MEMORY]
    others = len(memory) - len(THESIS)
    assert memory == len(THESIS) * [Outcome.CONSISTENT] + others * [Outcome.NO_CLAIM]
    assert {it.outcome for it in every if it.claim.printed == NO_CLAIM} == {Outcome.NO_CLAIM}


@pytest.mark.parametrize("printed", waiting_for(["O(1)"], ["O(1)", "O(n_ev)", "O(n_t)"]))
@pytest.mark.parametrize("really", ["O(1)", "O(n_ev)", "O(n_t)", "O(n_t n_ev)"])
def test_what_grows_otherwise_is_violated(tmp_path, printed, really):
    laws = {**LAWS, "O(n_t n_ev)": lambda n_t, n_ev: 1.0 * n_t * n_ev**2}
    laws_of = {printed: laws[really]}
    rows = measured_cells(tmp_path, lambda s, q, p: laws_of.get(p), printed=printed)
    expected = Outcome.CONSISTENT if printed == really else Outcome.VIOLATED
    assert {it.outcome for it in rows if it.claim.table in TABLES} == {expected}


@pytest.mark.parametrize("fastest", [1e-4, 1e-5])
def test_times_of_a_machine_that_was_too_busy_accuse_nothing_and_counts_do(
    tmp_path, monkeypatch, fastest
):
    monkeypatch.setitem(made_runs.STEADY, "fastest", fastest)
    rows = measured_cells(tmp_path, lambda *_: LAWS["O(n_t)"], printed="O(1)", table="queries")
    busy = fastest < 1e-4
    by_time = Outcome.UNDETERMINED if busy else Outcome.VIOLATED
    assert {it.outcome for it in rows} == {Outcome.VIOLATED}
    assert {it.outcome_time for it in rows} == {by_time}


@pytest.mark.parametrize(
    ("table", "said"), [("queries", Outcome.VIOLATED), ("operations", Outcome.UNDETERMINED)]
)
def test_a_slowdown_beyond_the_latency_is_held_against_queries_and_not_against_batches(
    tmp_path, table, said
):
    """Whose mesh was written just before: no chase of it tells what they wait for."""
    slowed = dict(zip(SIZES, [5, 5, 5, 5, 5.5, 12, 30], strict=True))
    rows = measured_cells(
        tmp_path, lambda *_: lambda n_t, n_ev: slowed.get(n_t, 5.0), printed="O(1)", table=table
    )
    assert {it.outcome_time for it in rows} == {said}


def test_a_byte_too_many_is_a_violation(tmp_path):
    folder = write_run(tmp_path, only=lambda experiment, structure: experiment == "bench_memory")
    rewrite(folder, "bench_memory", "half_edge", lambda it: {"samples": [228_001.0]})
    next(folder.glob("bench_memory.indexed.*")).unlink()
    judged = {it.claim.structure: it.outcome for it in cells(load(folder), subject=MEMORY)}
    assert judged["half_edge"] == Outcome.VIOLATED
    assert judged["winged_edge"] == Outcome.CONSISTENT
    assert judged["indexed"] == Outcome.UNDETERMINED


@pytest.mark.parametrize(
    ("size", "outcome"), [(227_700.0, Outcome.CONSISTENT), (227_400.0, Outcome.UNDETERMINED)]
)
def test_bytes_of_other_than_two_faces_per_vertex_accuse_nothing(tmp_path, size, outcome):
    write_run(tmp_path, only=lambda *it: it == ("bench_memory", "half_edge"))
    rewrite(tmp_path, "bench_memory", "half_edge", lambda _: {"samples": [size], "faces": 1_996})
    (judged,) = cells(load(tmp_path), subject=MEMORY, structure="half_edge")
    assert judged.outcome == outcome


def test_a_query_that_was_not_measured_is_undetermined_never_a_pass(tmp_path):
    folder = of_two(tmp_path)
    for path in folder.glob("bench_*work.half_edge.*"):
        path.unlink()
    rows = claimed(cells(load(folder), structure="half_edge"))
    of_tables = [it for it in rows if it.claim.table in TABLES]
    assert {it.outcome for it in of_tables} == {Outcome.UNDETERMINED}


def test_the_class_found_names_its_variables(every):
    for it in every:
        if it.claim.subject != MEMORY:
            expected = it.claim.printed if it.claim.claims_something else "O(1)"
            if it.claim.table in ("listings", "naming"):  # whose valence is not varied
                expected = expected.replace("n_ev", "1")
            assert it.found == expected


@pytest.mark.parametrize(
    ("law", "found"),
    [
        (lambda n_t, n_ev: 10.0 + 3.0 * n_t + 60.0 * n_ev, "O(n_t)"),
        (lambda n_t, n_ev: 1.0 * n_t * n_ev, "O(n_t · n_ev)"),
        (lambda n_t, n_ev: 9.0 + 0.01 * n_ev, "O(n_ev)"),
    ],
)
def test_beside_a_scan_of_all_faces_the_few_of_a_vertex_are_not_named(tmp_path, law, found):
    made = write_run(tmp_path, lambda *_: law, lambda _, structure: structure == "indexed")
    (judged,) = cells(load(made), structure="indexed", subject="vertex_faces")
    assert judged.found == found


def test_a_case_may_wait_as_long_as_a_quarter_or_a_sixteenth_of_its_working_set(tmp_path):
    folder = write_run(tmp_path, only=lambda *it: it == ("bench_queries", "half_edge"))
    for size in (1e2, 1e9):
        chase = {"family": "chase", "working_set": int(size), "samples": [1e-15 * size]}
        CaseFile(folder, "bench_latency", NO_STRUCTURE).add(Measurement(f"{size}", "time", **chase))
    of_run, sets = curves(load(folder)), 60 * np.array(SIZES)  # bytes, as such runs have them
    found = of_run.latencies(of_run.curve(Axis.TIME_FACES, "half_edge", "face_edges"))
    assert found == pytest.approx(np.stack([0 * sets + 2e-9, 1e-15 * sets / 4, 1e-15 * sets / 16]))


def of_two(folder: Path) -> Path:
    """A run of two structures, which is quickly judged."""
    return write_run(folder, only=lambda _, structure: structure in ("half_edge", "winged_edge"))


def test_a_run_is_judged_once_and_what_was_kept_is_the_same(tmp_path, monkeypatch):
    run = load(of_two(tmp_path))
    judged = judge_run(run)
    assert judge_run(run) is judged
    monkeypatch.setattr(
        "experiments.claims.verdicts.judge_cells", lambda run: pytest.fail("judged again")
    )
    again = judge_run(load(run.folder))
    assert [it.claim for it in again] == [it.claim for it in judged]
    assert [it.outcome for it in again] == [it.outcome for it in judged]
    assert [it.verdicts for it in again] == [it.verdicts for it in judged]
    for kept, first in zip(again, judged, strict=True):
        assert np.array_equal(kept.values, first.values)


def test_what_was_kept_of_other_measurements_is_not_read(tmp_path):
    folder = of_two(tmp_path)
    before = {it.claim.key: it.outcome for it in judge_run(load(folder))}
    rewrite(folder, "bench_memory", "half_edge", lambda it: {"samples": [228_001.0]})
    after = {it.claim.key: it.outcome for it in judge_run(load(folder))}
    changed = {key for key in before if before[key] != after[key]}
    assert changed == {"half_edge/memory", "sentence/bytes_winged_half"}


def test_what_was_kept_of_other_measurements_of_one_of_several_machines_is_not_read(tmp_path):
    folder = write_run(tmp_path, only=lambda *it: it == ("bench_memory", "half_edge"))
    there = folder / "machine-b"
    there.mkdir()
    for path in folder.glob("*.jsonl"):
        path.rename(there / path.name)
    before = {it.claim.key: it.outcome for it in judge_run(load(folder))}
    rewrite(there, "bench_memory", "half_edge", lambda it: {"samples": [228_001.0]})
    after = {it.claim.key: it.outcome for it in judge_run(load(folder))}
    assert {key for key in before if before[key] != after[key]} == {"half_edge/memory"}


def test_what_was_kept_of_other_claims_is_not_read(tmp_path, monkeypatch):
    """Claims stand in the files of structures, too."""
    folder, kind = of_two(tmp_path), REGISTRY["directed_edge"]
    before = {it.claim.key: it.outcome for it in judge_run(load(folder))}
    claims = replace(kind.claims, costs={"vertex_faces": "O(1)"})
    monkeypatch.setattr(kind, "claims", claims)
    after = {it.claim.key: it.outcome for it in judge_run(load(folder))}
    changed = {key for key in after if before[key] != after[key]}
    assert "directed_edge/vertex_faces" in changed
    assert {before[key] for key in changed} == {Outcome.NO_CLAIM}


def test_one_entry_adds_a_claim(base_run):
    text = """
        [classes]
        "O(1)" = { faces = "O(1)", valence = "O(1)" }
        [[claim]]
        kind = "printed"
        source = "another document"
        queries.vertex_vertices = { half_edge = "O(1)" }
    """
    claim = next(it for it in load_claims(text) if it.printed == "O(1)")
    (judged,) = judge_cells(base_run, [claim])
    assert judged.outcome == Outcome.CONSISTENT
    assert np.isfinite(judged.work)
    assert len(load_claims(text)) == len(NAMES)
