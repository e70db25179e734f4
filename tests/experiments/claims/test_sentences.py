"""Sentences and break-even: judged on runs whose costs are known."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import hem
import structures
from experiments.claims import (
    CLAIMED,
    Between,
    Kind,
    Outcome,
    break_even,
    curves,
    in_digits,
    judge_sentences,
    sentence_claims,
)
from experiments.claims import demonstrations as shown
from experiments.claims.beside import OCTAHEDRON, sound
from experiments.claims.demonstrations import code_facts, come_round_tests
from experiments.claims.quantities import QUANTITIES, TIMED
from experiments.harness import Measurement
from experiments.report.pages import sentences_markdown
from experiments.runs import CaseFile, load
from hem.authoring import kernel
from tests.experiments.made_runs import BUILD, SIZES, rewrite, write_run

FIRST_WORDS = {
    Kind.PRINTED: {"thesis", "draft", "article"}, Kind.FOLLOWS: {"follows"}, Kind.EXPECTED: {"we"},
}  # fmt: skip
"""How the source of a sentence begins: with a document, or with why it is said."""


def outcome(run, quantity: str) -> str:
    claims = [it for it in sentence_claims() if it.expects.quantity == quantity]
    return judge_sentences(run, claims)[0].outcome


def test_every_sentence_has_a_quantity_of_its_own_and_a_source_that_fits_its_kind():
    every = sentence_claims()
    assert [it.expects.quantity for it in every] == list(QUANTITIES)
    for it in every:
        assert it.source.replace(",", " ").split()[0] in FIRST_WORDS[it.kind]
    assert {it.kind for it in every} == set(CLAIMED)
    assert all(it.expects.low > -np.inf or it.expects.high < np.inf for it in every)


def test_no_kind_of_claim_has_a_mark_or_a_list_of_another(base_run):
    marks = [{kind.marks([it]) for it in Outcome if it != "no claim"} for kind in CLAIMED]
    assert len(set.union(*marks)) == sum(map(len, marks))
    every = judge_sentences(base_run)
    tables = {kind: sentences_markdown(every, kind) for kind in CLAIMED}
    for it in every:
        listed = [kind for kind, text in tables.items() if it.claim.text in text]
        assert listed == [it.claim.kind]
    own = next(it for it in every if it.claim.expects.quantity == "directed_queries")
    assert (own.outcome, own.mark, own.words) == ("consistent", "○", "as expected")


def test_what_the_article_says_is_run(base_run):
    of_article = "books_built", "polygon_corners", "article_invariants", "outgoing_kept"
    for quantity in (*of_article, "cube_vertices"):
        assert outcome(base_run, quantity) == "consistent"
    assert outcome(base_run, "coincident") == "violated"


WHERE_ALL_HOLDS = (
    "soup", "winged_half_time", "published_splits", "corrected_splits", "published_collapse",
    "outlook", "corrected_collapse", "collapse_by_valence", "local_update", "almost_free",
    "stored_previous", "reduction_time",
)  # fmt: skip
ALSO_CONSISTENT = (
    "bytes_ratio", "winged_half", "dynamic", "static", "edits_after_building", "answers",
    "more_bytes", "subdivision", "reduction",
)  # fmt: skip


@pytest.mark.parametrize("quantity", [*WHERE_ALL_HOLDS, *ALSO_CONSISTENT])
def test_what_holds_where_every_cell_does_is_consistent(base_run, quantity):
    assert outcome(base_run, quantity) == "consistent"


@pytest.mark.parametrize("quantity", ["edges_both_ways", "larger_meshes_repay"])
def test_what_a_run_in_which_table_1_holds_refutes_is_violated(base_run, quantity):
    """Table 1 gives O(n_ev) from a vertex to its edges."""
    assert outcome(base_run, quantity) == "violated"


def slow(case) -> dict:
    return {"samples": [1e6 * it for it in case.samples]}


def to_the_contrary(structure: str, subject: str, printed: str):
    """Laws of a run in which sentences come out the other way round."""
    if structure in ("as_printed", "plankton"):
        return lambda n_t, n_ev: 10.0 + 3.0 * n_t
    cost = {"indexed": 300.0, "triangle_neighbor": 200.0, "half_edge": 100.0, "winged_edge": 30.0}
    if subject in ("split_face", "collapse_edge"):
        cost = {"indexed": 1.0, "half_edge": 100.0}
    return lambda n_t, n_ev: cost.get(structure, 50.0)


@pytest.fixture(scope="module")
def contrary(tmp_path_factory: pytest.TempPathFactory):
    folder = write_run(tmp_path_factory.mktemp("contrary"), to_the_contrary)
    rewrite(folder, "bench_workloads", "half_edge", slow)
    rewrite(folder, "bench_memory", "indexed", slow)
    in_step = {"rendered", "in a transaction"}
    rewrite(
        folder, "bench_operations", "half_edge", lambda it: slow(it) if it.order in in_step else {}
    )
    rewrite(folder, "bench_build", "half_edge", lambda it: {"samples": [1e-9 * it.faces**2]})
    return load(folder)


@pytest.mark.parametrize(
    "quantity",
    [
        *(it for it in WHERE_ALL_HOLDS if it != "published_collapse"),
        "subdivision_time",
        "dynamic",
    ],
)
def test_what_holds_in_one_run_is_violated_in_the_contrary_one(contrary, quantity):
    assert outcome(contrary, quantity) == "violated"


@pytest.mark.parametrize("quantity", ["edges_both_ways", "larger_meshes_repay"])
def test_what_is_violated_in_one_run_holds_in_the_contrary_one(contrary, quantity):
    assert outcome(contrary, quantity) == "consistent"


@pytest.mark.parametrize(
    ("indexed", "said", "also"),
    [(1e3, "consistent", "consistent"), (1e-3, "violated", "undetermined")],
)
def test_what_the_draft_says_of_faces_is_judged_by_time(tmp_path, indexed, said, also):
    law = {"indexed": lambda n_t, n_ev: indexed}
    timed = "bench_queries", "bench_operations", "bench_workloads"
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s), lambda it, _: it in timed))
    assert outcome(run, "draft_faces") == said
    assert outcome(run, "subdivision_time") == also  # all faces take as long to split on both


def test_more_bytes_that_quicken_no_query_refute_the_thesis(tmp_path):
    run = load(write_run(tmp_path, lambda s, q, p: lambda n_t, n_ev: 100.0))
    assert outcome(run, "more_bytes") == "violated"


def test_operations_that_grow_with_the_mesh_suit_no_change_of_detail(tmp_path):
    law = {"half_edge": lambda n_t, n_ev: 3.0 * n_t}
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s)))
    assert outcome(run, "subdivision") == outcome(run, "reduction") == "violated"


@pytest.mark.parametrize(("growth", "said"), [(100, "consistent"), (1, "violated")])
def test_bytes_beyond_an_indexed_mesh_are_told_at_both_ends(tmp_path, growth, said):
    folder = write_run(tmp_path, only=lambda experiment, structure: False)
    for structure, each in (("half_edge", 228.0), ("indexed", 36.0)):
        for n, size in ((1_000, each), (100_000, growth * each)):
            more = {"vertices": n, "family": "torus", "reference_bytes": 8, "samples": [size]}
            CaseFile(folder, "bench_memory", structure).add(Measurement(f"{n}", "bytes", **more))
    assert outcome(load(folder), "larger_meshes") == said


def test_a_real_model_counts_in_the_sentence_on_bytes(tmp_path):
    folder = write_run(tmp_path, only=lambda experiment, structure: experiment == "bench_memory")
    for structure, size in (("half_edge", 599.0), ("indexed", 100.0)):
        case = Measurement("bone/0/8", "bytes", family="bone", reference_bytes=8, samples=[size])
        CaseFile(folder, "bench_memory", structure).add(case)
    run = load(folder)
    assert sorted(QUANTITIES["bytes_ratio"](curves(run))) == pytest.approx([5.99, 228 / 36])
    assert outcome(run, "bytes_ratio") == "undetermined"


def test_of_structures_that_were_not_weighed_the_sentence_on_bytes_tells_nothing(tmp_path):
    folder = write_run(tmp_path, only=lambda *it: it == ("bench_memory", "winged_edge"))
    case = Measurement("bone/0/8", "bytes", family="bone", reference_bytes=8, samples=[599.0])
    CaseFile(folder, "bench_memory", "winged_edge").add(case)
    assert outcome(load(folder), "bytes_ratio") == "undetermined"


def test_a_split_as_published_is_not_conforming_and_a_corrected_one_is(base_run):
    assert outcome(base_run, "conforming") == "violated"
    s = sound()
    s.split_edge(s.half_edges[0].edge, (0.25, 0.25, 0.5))
    assert set(shown.half_edges_per_face(s)) == {3}


def test_welded_points_do_not_coincide():
    assert list(shown.coincident_vertices()) == [1]
    assert list(shown.coincident_vertices(OCTAHEDRON)) == [0]


def test_the_previous_half_edge_is_two_steps_away_in_triangles_only(base_run):
    assert outcome(base_run, "previous") == "consistent"
    quad = hem.PolygonMesh(np.eye(4)[:, :3], [[0, 1, 2, 3]])
    (share,) = shown.two_steps_back(quad)
    assert share == 0


@kernel
def _scan(m, v, out):
    i = 0
    while i < 3:
        if m.face[0, i] == v:
            out[0] = i
        i += 1
    return 1


@kernel
def _walk(m, v, out):
    start = m.vertex[v]
    it = m.next[start]
    while it != start:
        it = m.next[it]
    return _scan(m, v, out)


def test_tests_of_direction_and_of_coming_round_are_counted_in_the_code():
    assert code_facts([_scan]) == (1, 2, 6)
    assert code_facts([_walk]) == (1, 3, 11)  # with what it calls
    assert code_facts([_scan, _walk]) == (2, 3, 11)
    assert come_round_tests([_scan]) == 0
    assert come_round_tests([_walk]) == 1


def test_walks_are_told_apart_by_whether_they_test_for_having_come_round(base_run, monkeypatch):
    assert outcome(base_run, "come_round") == "violated"
    for it in structures.REGISTRY.values():
        monkeypatch.setitem(it.kernels, "vertex_faces", _scan)
    assert outcome(base_run, "come_round") == "consistent"


def test_the_code_of_a_winged_edge_mesh_tests_directions_and_is_no_longer(base_run):
    assert outcome(base_run, "directions") == "consistent"
    assert outcome(base_run, "handling") == "violated"
    same = shown.handling("direction_tests", "branches", "lines", mine="winged_edge")
    assert list(same) == [1, 1, 1]


@pytest.mark.parametrize(("power", "constant"), [(1, 0), (1, 500), (2, 500), (0, 500)])
def test_a_slope_in_the_valence_is_that_of_the_growth_and_not_of_what_is_constant(power, constant):
    sizes = np.array([4, 16, 64, 256])
    curve = SimpleNamespace(sizes=sizes, centers=constant + 9.0 * sizes**power)
    found = QUANTITIES["collapse_by_valence"](SimpleNamespace(curve=lambda *_: curve))
    assert list(found) == pytest.approx([power] * 3)


def test_what_lies_outside_its_bounds_is_violated(tmp_path):
    law = {"winged_edge": lambda n_t, n_ev: 1e6}
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s)))
    assert outcome(run, "winged_half") == "violated"


@pytest.mark.parametrize(
    ("values", "of_every", "of_another", "found"),
    [
        ([0.5], "consistent", "consistent", "0.5"),
        ([0.5, 1.0, 0.7], "consistent", "consistent", "0.5 … 1"),
        ([0.5, 2.0], "violated", "undetermined", "0.5 … 2"),
        ([2.0, 3.0], "violated", "violated", "2 … 3"),
        ([0.5, np.nan], "undetermined", "undetermined", "0.5"),
        ([2.0, np.nan], "violated", "undetermined", "2"),
        ([], "undetermined", "undetermined", "–"),
    ],
)
def test_one_value_refutes_a_sentence_of_every_one_and_no_busy_machine_refutes_any(
    monkeypatch, values, of_every, of_another, found
):
    monkeypatch.setitem(QUANTITIES, "dynamic", lambda _: values)
    for busy, every in itertools.product((False, True), repeat=2):
        of_run = SimpleNamespace(too_busy=busy, of_machines=False)
        monkeypatch.setattr("experiments.claims.quantities.curves", lambda _, it=of_run: it)
        claim = replace(sentence_claims()[0], expects=Between("dynamic", "it", 0, 1, every))
        (judged,) = judge_sentences(None, [claim])
        said = of_every if every else of_another
        said = "undetermined" if busy and said == "violated" else said
        assert (judged.outcome, judged.found) == (said, found)


def test_of_an_empty_run_only_what_no_run_has_to_measure_is_told(base_run, tmp_path):
    empty = judge_sentences(load(write_run(tmp_path, only=lambda *_: False)))
    for one, other in zip(empty, judge_sentences(base_run), strict=True):
        assert one.outcome == "undetermined" or np.array_equal(one.values, other.values)


def test_where_nothing_was_measured_nothing_is_told(tmp_path):
    folder = write_run(tmp_path)
    for path in folder.glob("bench_workloads.*"):
        path.unlink()
    run = load(folder)
    assert outcome(run, "dynamic") == "undetermined"
    assert [it.found for it in judge_sentences(run) if it.claim.key == "sentence/dynamic"] == ["–"]


@pytest.mark.parametrize(
    ("quantity", "experiment", "structure"),
    [
        *(
            (it, "bench_operation_work", "plankton")
            for it in ("corrected_splits", "corrected_collapse")
        ),
        ("collapse_by_valence", "bench_operation_work", "half_edge_objects"),
        *((it, "bench_workloads", "half_edge") for it in ("static", "reduction_time")),
        ("subdivision_time", "bench_operations", "indexed"),
    ],
)
def test_a_sentence_of_which_a_part_was_not_measured_passes_for_no_lack_of_it(
    base_run, quantity, experiment, structure
):
    mine = base_run.cases["experiment"].eq(experiment) & base_run.cases["structure"].eq(structure)
    run = replace(base_run, cases=base_run.cases[~mine].reset_index(drop=True))
    (judged,) = (it for it in judge_sentences(run) if it.claim.expects.quantity == quantity)
    assert judged.outcome == "undetermined"
    assert "not measured" in judged.reason


def test_building_that_is_never_repaid_on_a_large_mesh_is_not_repaid_as_soon_as_on_a_small_one(
    tmp_path,
):
    folder = write_run(tmp_path)
    rewrite(
        folder, "bench_queries", "half_edge",
        lambda it: {"samples": [1.0]} if it.faces == SIZES[-1] else {},
    )  # fmt: skip
    assert outcome(load(folder), "larger_meshes_repay") == "undetermined"


def test_what_refutes_a_sentence_of_every_one_refutes_it_though_others_were_not_measured(contrary):
    less = contrary.cases[contrary.cases["structure"] != "half_edge_objects"].reset_index(drop=True)
    assert outcome(replace(contrary, cases=less), "corrected_splits") == "violated"


def slow_on_large_meshes(case) -> dict:
    return {"samples": [1.0]} if case.vertices > 10_000 else {}


def test_a_sentence_that_holds_in_part_is_undetermined(tmp_path):
    folder = write_run(tmp_path)
    rewrite(folder, "bench_workloads", "half_edge", slow_on_large_meshes)
    assert outcome(load(folder), "dynamic") == "undetermined"


def test_bounds_and_spans_are_given_in_words(base_run):
    told = {it.claim.expects.quantity: it for it in judge_sentences(base_run)}
    assert (told["bytes_ratio"].claim.expects.words, told["bytes_ratio"].found) == (
        "at least 6", "6.33",
    )  # fmt: skip
    assert told["bytes_winged_half"].claim.expects.words == "1"
    assert told["winged_half"].claim.expects.words == "0.5 to 2"
    assert told["dynamic"].claim.expects.words == "at most 1"


@pytest.mark.parametrize(
    ("value", "told"),
    [(5e-6, "0.000005"), (0.0765, "0.0765"), (1e3, "1,000"), (46_412.0, "46,400"), (0.0, "0")],
)
def test_what_was_found_is_told_without_powers(value, told):
    assert in_digits(value, 3) == told
    assert float(told.replace(",", "")) == pytest.approx(value, rel=5e-3)


def test_break_even_is_where_building_and_asking_cost_the_same(base_run):
    table = break_even(curves(base_run))
    asked = table[(table["subject"] == "vertex_faces") & (table["structure"] == "half_edge")]
    assert asked["vertices"].tolist() == [n // 2 for n in SIZES]
    for n_t, times in zip(SIZES, asked["times"], strict=True):
        mine = BUILD["half_edge"] * n_t + times * 1e-9 * (2 + 3 * 6)
        base = BUILD["indexed"] * n_t + times * 1e-9 * (10 + 3 * n_t)
        assert mine == pytest.approx(base, rel=0.15)


def test_who_never_catches_up_does_so_after_infinitely_many(tmp_path):
    law = {"half_edge": lambda n_t, n_ev: 1e9}
    run = load(write_run(tmp_path, lambda s, q, p: law.get(s)))
    table = break_even(curves(run))
    assert np.isinf(table[table["structure"] == "half_edge"]["times"]).all()
    assert np.isfinite(table[table["structure"] == "winged_edge"]["times"]).all()


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_times_that_cannot_be_trusted_accuse_nothing_and_counts_do(contrary, quantity):
    (claim,) = (it for it in sentence_claims() if it.expects.quantity == quantity)
    before = judge_sentences(contrary, [claim])[0].outcome
    busy = [{"fastest": 1.0, "before": 9.0, "after": 9.0, "off_cpu": 0.0}] * len(contrary.cases)
    too_busy = replace(contrary, cases=contrary.cases.assign(noise=busy))
    several = {**contrary.meta, "machine": {"cpu": "2 machines", "machines": ["a", "b"]}}
    for run in (too_busy, replace(contrary, meta=several)):
        after = judge_sentences(run, [claim])[0].outcome
        assert after == before or quantity in TIMED
        assert not (quantity in TIMED and after == "violated")


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_the_sentences_on_times_are_those_that_other_times_change(base_run, quantity):
    (claim,) = (it for it in sentence_claims() if it.expects.quantity == quantity)
    factors = np.random.default_rng(0).uniform(1, 9, len(base_run.cases))
    timed = base_run.cases["kind"] == "time"
    scaled = base_run.cases["samples"].map(np.array) * np.where(timed, factors, 1.0)
    other = replace(base_run, cases=base_run.cases.assign(samples=scaled.map(list)))
    before, after = (judge_sentences(it, [claim])[0].values for it in (base_run, other))
    assert np.array_equal(before, after) == (quantity not in TIMED)
