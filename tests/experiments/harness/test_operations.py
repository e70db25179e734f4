"""How operations are measured: on what, on how many copies, and that all did the same."""

import gc
import weakref
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import pytest

import hem
import structures
from experiments.bench_workloads import KEPT, UNITS, WORKLOADS, _check, without_call
from experiments.harness import BASE, HUBS, OPERATIONS, PRESETS, Case, disturbed, time_rounds
from experiments.harness.operations import OperationBatch, constant_work, time_operations
from experiments.harness.operations import operation_arguments as arguments
from experiments.harness.operations import operation_faces as faces_of
from experiments.harness.reference import copies, copies_of
from experiments.harness.timer import Timed
from experiments.runs import experiments
from structures import REGISTRY
from tests.extent import OF_EACH_KIND, QUICK_TO_COMPILE, waiting_for


def case(structure: str, family: str = "torus", valence: int | None = None) -> Case:
    return Case(structure, family, 900 if family != HUBS else 2048, "split_face", valence=valence)


@pytest.mark.parametrize("family", ["torus", "grid"])
def test_chosen_elements_have_no_neighbor_in_common(family):
    it = case("half_edge", family)
    s, faces = it.build(), faces_of(it)
    rings = [set(s.vertex_vertices(s.face_vertices(int(f))).values.tolist()) for f in faces]
    assert len(faces) > 10
    assert sum(map(len, rings)) == len(set().union(*rings))


def test_where_the_valence_varies_each_element_is_at_a_hub_of_its_own():
    it = case("half_edge", HUBS, valence=16)
    faces, hubs = faces_of(it), hem.valence_hubs(16, 2048)
    first = it.mesh().triangles[faces, 0]
    assert set(first) == set(hubs[::2])


@pytest.mark.parametrize("valence", [4, 8, 16])
def test_a_reference_operates_on_no_element_twice(valence):
    it = replace(case("half_edge", HUBS, valence), subject="remove_face")
    batch = constant_work(it, replace(PRESETS["standard"], valences=(4,)), len(faces_of(it)))
    before = batch.mesh.n_faces
    batch.operate()
    assert 0 < batch.operations == before - batch.mesh.n_faces


@pytest.mark.parametrize("operation", OPERATIONS)
@pytest.mark.parametrize("name", waiting_for(["half_edge", "half_edge_objects"], structures.NAMES))
def test_a_batch_is_operated_on_and_restored(name, operation):
    it = case(name)
    batch = OperationBatch(it.build(), operation, faces_of(it))
    batch.restore()  # what was found when it was asked is forgotten
    before = [array.copy() for array in batch.mesh.arrays]
    count, each = batch.mesh.n_faces, {"split_edge": 2, "split_face": 2, "collapse_edge": -2}
    each |= {"flip_edge": 0, "add_face": 1, "remove_face": -1}
    _, growth = batch.mesh.operations[operation].growth  # of one that others add
    for _ in range(2):
        batch.operate_all()
        assert batch.operations > 10
        assert batch.mesh.n_faces == count + each.get(operation, growth) * batch.operations
        batch.mesh.validate()
        batch.restore()
        now = batch.mesh.arrays
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(now, before, strict=True))
    assert it.build().n_faces == 1800  # the mesh it was copied from is left alone


def test_an_idle_call_takes_no_time_to_speak_of_and_does_nothing():
    it = case("half_edge")
    batch = OperationBatch(it.build(), "split_face", faces_of(it))
    before = batch.mesh.n_faces
    assert 0 < batch.idle_seconds() < 1e-3
    assert batch.mesh.n_faces == before
    batch.operate_all()


def test_all_structures_are_asked_for_the_same(monkeypatch):
    rows = []
    for name in structures.NAMES:
        it = case(name)
        s = it.build().copy()
        args = arguments(s, "split_edge", faces_of(it))
        rows.append(s.edge_vertices(args[:, 0]).values.tolist())
    assert all(row == rows[0] for row in rows)


@pytest.mark.parametrize("order", ["compiled", "from Python"])
@pytest.mark.parametrize("workload", WORKLOADS)
def test_a_workload_makes_of_every_structure_the_same_mesh(workload, order):
    made = []
    for name in QUICK_TO_COMPILE:
        s = structures.build(name, hem.generate("sphere", 162))
        before = s.copy()
        WORKLOADS[workload].run(order)(s)
        units = UNITS[WORKLOADS[workload].unit](before, s)
        s.validate()
        corners = np.sort(s.face_vertices(s.faces()).values.reshape(-1, 3), axis=1)
        made.append((units, corners.tolist()))
    assert all(it == made[0] for it in made)


@pytest.mark.parametrize("workload", ["vertex_normals", "impacts"])
def test_a_workload_that_tells_otherwise_than_on_the_base_structure_is_not_timed(workload):
    given = WORKLOADS[workload]

    def tells_otherwise(s, *faces):
        told = given.compiled(s, *faces)
        return told if s.name == BASE else 1.01 * told

    case = Case("half_edge", "sphere", 162, workload, "compiled")
    _check(case, given.compiled)
    with pytest.raises(AssertionError, match=f"{workload} on half_edge"):
        _check(case, tells_otherwise)


@pytest.mark.parametrize("workload", WORKLOADS)
def test_positions_held_by_objects_are_gathered_once_or_twice_and_not_per_edit(
    monkeypatch, workload
):
    kind, gathered = structures.REGISTRY["half_edge_objects"], []
    points = kind.points.fget
    monkeypatch.setattr(kind, "points", property(lambda s: gathered.append(1) or points(s)))
    WORKLOADS[workload].from_python(kind.build(hem.generate("sphere", 162)))
    assert len(gathered) <= 2


@pytest.mark.parametrize("order", ["compiled", "from Python"])
def test_a_simplification_leaves_a_tenth_and_a_closed_surface(order):
    s = structures.build("half_edge", hem.generate("sphere", 642))
    WORKLOADS["simplification"].run(order)(s)
    assert s.n_vertices == int(KEPT * 642)
    hem.require_sound(s.to_triangles(), euler=2)


@pytest.mark.parametrize("order", ["compiled", "from Python"])
def test_smoothing_moves_every_vertex_to_the_mean_of_its_neighbors(order):
    mesh = hem.generate("torus", 100)
    s = structures.build("half_edge", mesh)
    WORKLOADS["smoothing"].run(order)(s)
    for v in (0, 50, 99):
        near = np.unique(mesh.triangles[(mesh.triangles == v).any(axis=1)])
        expected = mesh.points[near[near != v]].mean(axis=0)
        assert np.allclose(s.points[v], expected, atol=1e-5)


@pytest.mark.parametrize("order", ["compiled", "from Python"])
@pytest.mark.parametrize("family", ["torus", "grid"])
def test_smoothing_leaves_vertices_that_no_face_has_where_they_are(family, order):
    mesh, alone = hem.generate(family, 100), [0, 51, 101, 102]
    numbers = np.setdiff1d(np.arange(len(mesh.points) + len(alone)), alone)
    points = np.full((len(mesh.points) + len(alone), 3), 9, np.float32)
    points[numbers] = mesh.points
    s = structures.build("half_edge", mesh)
    other = structures.build("half_edge", hem.TriangleMesh(points, numbers[mesh.triangles]))
    for it in (s, other):
        WORKLOADS["smoothing"].run(order)(it)
    assert np.allclose(other.points[numbers], s.points, atol=1e-6)
    assert np.all(other.points[alone] == 9)


def counted(name: str, operation: str, size: int) -> list[int]:
    """Elements that an operation reads and writes in some of the copies that make up a mesh."""
    small = Case(name, "torus", 100)
    s, _ = copies(small, size)
    faces = copies_of([faces_of(replace(small, subject=operation))], small, s)[[0, 1, -1]]
    s = s.copy()
    return [s.operation_work(operation, *row) for row in arguments(s, operation, faces).tolist()]


WITH_A_REFERENCE = [
    (name, operation)
    for name, operation in product(structures.NAMES, OPERATIONS)
    if structures.REGISTRY[name].compiled and not Case(name, "torus", 100, operation).searches
]
FEW = [it for it in WITH_A_REFERENCE if it[0] in OF_EACH_KIND]


@pytest.mark.parametrize(("name", "operation"), waiting_for(FEW, WITH_A_REFERENCE))
def test_on_more_copies_an_operation_does_no_more_where_it_has_a_reference(name, operation):
    few, many = (counted(name, operation, size) for size in (400, 6400))
    assert max(many) <= 1.1 * max(few)


def test_what_cannot_be_is_left_out_and_told():
    batch = OperationBatch(case("half_edge").build(), "split_face", faces_of(case("half_edge")))
    idle, cycle = 2e-6, 2e-10
    samples = np.array([idle + 4e-6, idle - 1e-6, idle + 0.5 * cycle, idle + 5e-6])
    timed, impossible = batch.each(Timed(samples, np.arange(4.0), 2), idle)
    assert impossible == 0.5
    assert np.allclose(timed.samples * batch.operations, [4e-6, 5e-6])
    assert timed.calibration.tolist() == [0, 3]
    assert timed.per == 2 * batch.operations


def test_operations_that_take_no_longer_than_idle_calls_are_skipped_and_measured_again(monkeypatch):
    it = replace(case("half_edge"), order="batched")
    kept = time_operations(it, PRESETS["smoke"], time_rounds)
    assert "skipped" not in kept
    assert kept["reference"] > 1e-9 < min(kept["samples"])
    monkeypatch.setattr(OperationBatch, "idle_seconds", lambda batch: 1.0)
    nothing = time_operations(it, PRESETS["smoke"], time_rounds)
    assert "samples" not in nothing
    assert "no longer than a call that does none" in nothing["skipped"]
    calm = {"fastest": 1e-9, "before": 1e-9, "after": 1e-9, "off_cpu": 0.0}
    assert not disturbed(calm)
    assert disturbed({**calm, **nothing["noise"]})


@pytest.mark.parametrize("units", [100, 1_000])
def test_what_the_call_itself_takes_is_taken_off_and_a_round_that_tells_nothing_goes(units):
    call, each = 180e-6, np.array([0.5e-6, 0.7e-6, -0.1e-6])
    whole = call + units * each  # the first of them is in ``one``, with the call
    timed = Timed(whole / units, np.array([1.0, 2.0, 3.0]), units)
    found = without_call(timed, call + 0.5e-6)
    assert found.samples == pytest.approx([0.5e-6, (0.7e-6 * units - 0.5e-6) / (units - 1)])
    assert found.calibration.tolist() == [1.0, 2.0]


@pytest.mark.parametrize("name", QUICK_TO_COMPILE)
def test_as_many_impacts_are_counted_as_were_made(name):
    workload = WORKLOADS["impacts"]
    s = structures.build(name, hem.generate("torus", 1_000))
    for _ in range(3):  # also where the mesh has grown by the one before
        workload.one(s)
        before = s.copy()
        workload.compiled(s)
        assert UNITS[workload.unit](before, s) == (s.n_vertices - before.n_vertices) / 2


@pytest.mark.parametrize(
    ("experiment", "subject", "order"),
    [
        *(("operations", "split_face", it) for it in ("one by one", "rendered")),
        *(
            ("operations", "split_face", it)
            for it in ("in a transaction", "render mesh built anew")
        ),
        ("naming", "split_by_index", "timed"),
        ("real_time", "compact", None),
    ],
)
def test_what_breaks_a_mesh_is_never_timed(monkeypatch, experiment, subject, order):
    kind = REGISTRY[BASE]
    method = "compact" if subject == "compact" else "split_face"
    sound = getattr(kind, method)

    def broken(s, *given):
        told = sound(s, *given)
        s.records.triangle[0] = s.records.triangle[0, 0]  # a corner thrice
        return told

    monkeypatch.setattr(kind, method, broken)
    its = experiments()[f"bench_{experiment}"]
    every = its.cases(PRESETS["smoke"], BASE)
    case = next(it for it in every if (it.subject, it.order) == (subject, order))
    with pytest.raises(hem.MeshError):
        its.measure(case, PRESETS["smoke"], time_rounds)


@pytest.mark.parametrize("name", ["indexed", "triangle_soup"])
def test_what_is_counted_of_a_search_by_corners_is_what_is_asked_for_it(name):
    its, small = experiments()["bench_naming"], PRESETS["smoke"]
    every = {it.subject: it for it in its.cases(small, name) if it.order == "counted"}
    by_index, by_corners = (every[f"split_by_{it}"] for it in ("index", "corners"))
    counted = [its.measure(it, small, time_rounds).samples[0] for it in (by_index, by_corners)]
    s, asked = by_corners.build().copy(), []

    def spy(query, ask, handles):
        asked.append((query, np.atleast_1d(handles)))
        return ask(handles)

    for query in ("vertex_faces", "face_vertices"):
        vars(s)[query] = partial(spy, query, getattr(s, query))
    face = faces_of(by_corners, 10)[0]
    corners = s.face_vertices(face).tolist()
    asked.clear()
    assert s.find_face(*corners) == face
    assert sum(s.work(*it).sum() for it in asked) == counted[1] - counted[0]


@pytest.mark.parametrize(
    ("experiment", "order"),
    [
        ("operations", "rendered"),
        ("operations", "in a transaction"),
        ("operations", "render mesh built anew"),
        ("workloads", "compiled"),
    ],
)
def test_a_copy_that_was_operated_on_is_freed_before_another_round(monkeypatch, experiment, order):
    kind, copies, most = REGISTRY[BASE], weakref.WeakSet(), 0
    sound = kind.copy

    def copy(s):
        nonlocal most
        copies.add(made := sound(s))
        most = max(most, len(copies))
        return made

    monkeypatch.setattr(kind, "copy", copy)
    its, small = experiments()[f"bench_{experiment}"], replace(PRESETS["smoke"], rounds=12)
    timed = next(it for it in its.cases(small, BASE) if it.order == order)
    gc.disable()  # as while a study times
    try:
        its.measure(timed, small, time_rounds)
    finally:
        gc.enable()
    assert most <= 3  # of the round before, of this one, and one to spare
