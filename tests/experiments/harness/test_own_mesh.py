"""A study of one's own mesh: versions are surfaces of its kind, and cases are about them."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import hem
import structures
from experiments.claims import beside
from experiments.harness import PRESETS, Case, own_mesh, time_rounds
from experiments.presets import COARSER, FINE_ENOUGH, LARGEST, SMALLEST
from experiments.report import comparisons
from experiments.runs import experiments, load, read_meta, study
from hem.meshes import non_manifold_edges
from tests.experiments.cli.calls import hem as command
from tests.experiments.small_study import begin, go_on
from tests.extent import EVERYTHING, exhaustive, waiting_for

ON_ONE_MESH = "memory", *(("queries", "operations", "operation_work", "real_time") * EVERYTHING)


def versions(folder: Path) -> list[hem.TriangleMesh]:
    name, sizes = own_mesh.of_run(folder) or ("", ())
    return [own_mesh.version(name, size) for size in sizes]


@pytest.mark.parametrize(
    "name", waiting_for(["grid:1600"], ["torus:1600", "grid:1600", *hem.SAMPLES])
)
def test_versions_are_of_the_same_topology_and_four_times_apart(tmp_path, name):
    own_mesh.keep_versions(tmp_path, name, repair=True)  # a face is no surface before
    given, kept = hem.find_mesh(name, repair=True), versions(tmp_path)
    own_one = next(it for it in kept if len(it.points) == len(given.points))
    assert np.array_equal(own_one.points, given.points)
    assert np.array_equal(own_one.triangles, given.triangles)
    own = given.summary()
    for coarser, finer in pairwise(kept):
        assert 3 < len(finer.triangles) / len(coarser.triangles) < 6
    sizes = [len(it.points) for it in kept]
    own_size = len(own_one.points)
    assert len([it for it in sizes if it < own_size]) <= COARSER
    assert sizes[0] == own_size or sizes[0] > SMALLEST / 2
    assert max(sizes) <= max(own_size, LARGEST)
    assert len([it for it in sizes if it > max(own_size, FINE_ENOUGH)]) <= 1
    for mesh in kept:
        hem.require_sound(mesh)
        summary = mesh.summary()
        assert (summary.euler, summary.components) == (own.euler, own.components)
        assert summary.unreferenced == (own.unreferenced if mesh is own_one else 0)


def test_a_sample_stays_the_sample_after_versions_of_it_were_measured(tmp_path):
    own_mesh.keep_versions(tmp_path, "teapot")
    name, sizes = own_mesh.of_run(tmp_path) or ("", ())
    assert name == "teapot"
    assert len(Case("indexed", name, sizes[0]).mesh().points) == sizes[0]
    sample = Case("indexed", name, 0).mesh()
    assert np.array_equal(sample.triangles, hem.sample("teapot").triangles)


def test_a_small_mesh_gets_finer_versions_only(tmp_path):
    tetrahedron = tmp_path / "tetrahedron.off"
    hem.save(beside.TETRAHEDRON, tetrahedron)
    own_mesh.keep_versions(tmp_path, str(tetrahedron))
    sizes = [len(it.points) for it in versions(tmp_path)]
    assert sizes[0] == 4
    assert sizes[-1] > FINE_ENOUGH / 4


def test_no_finer_version_takes_the_place_of_a_mesh_with_unused_vertices(tmp_path):
    file = tmp_path / "mostly_unused.ply"
    hem.save(hem.TriangleMesh(np.eye(6, 3), [(0, 1, 2)]), file)  # halving makes 6 vertices, too
    own_mesh.keep_versions(tmp_path, str(file))
    name, _ = own_mesh.of_run(tmp_path) or ("", ())
    assert len(own_mesh.version(name, 6).triangles) == 1


def test_that_faces_of_more_corners_are_cut_is_told(tmp_path):
    square = tmp_path / "square.obj"
    square.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    with pytest.warns(hem.MeshWarning, match=r"faces of .*square\.obj are cut into triangles"):
        own_mesh.keep_versions(tmp_path, str(square))
    assert len(versions(tmp_path)[0].triangles) == 2


def test_a_run_keeps_its_mesh_and_is_called_by_it(tmp_path):
    file = tmp_path / "model.ply"
    hem.save(hem.generate("torus", 500), file)
    folder = begin(tmp_path, "memory", "work", mesh=str(file), structures=["triangle_neighbor"])
    file.unlink()
    go_on(folder)
    assert read_meta(folder)["preset"] == "smoke on model.ply"
    cases = load(folder).cases
    of_mesh = cases[cases["family"] == "model.ply"]
    assert set(of_mesh["experiment"]) == {"bench_memory", "bench_work"}
    assert 500 in set(of_mesh["vertices"])
    assert set(cases["family"]) == {"model.ply", "hubs"}  # and no real models
    for asked in (["check"], ["baseline", "update", "--yes"]):
        code, printed = command(*asked, str(folder))
        assert code in (1, 2)
        assert "is on model.ply, and the baseline is not" in printed


def test_a_mesh_is_weighed_at_its_own_size_and_that_is_told(tmp_path):
    file = tmp_path / "tetrahedron.off"
    hem.save(beside.TETRAHEDRON, file)
    holders = ["half_edge", "half_edge_objects"]
    folder = begin(tmp_path, "memory", mesh=str(file), structures=holders)
    go_on(folder)
    every = [len(it.points) for it in versions(folder)]
    heads, own, *finer = comparisons.bytes_by_mesh(load(folder)).rows
    assert [int(row[1].replace(",", "")) for row in (own, *finer)] == every
    told = dict(zip(heads, own, strict=True))
    for name in holders:
        expected = sum(structures.build(name, beside.TETRAHEDRON, 8).memory().values()) / 4
        title = structures.REGISTRY[name].title
        assert float(told[title].replace(",", "")) == pytest.approx(expected, abs=0.05)


@pytest.mark.parametrize(
    ("experiment", "mesh"),
    [
        ("bench_queries", "grid:400"),
        ("bench_operations", "grid:400"),
        # None of its versions is as small as a torus can be.
        pytest.param("bench_workloads", "sphere:642", marks=exhaustive),
    ],
)
def test_everything_is_timed_on_the_versions_of_a_mesh(tmp_path, experiment, mesh):
    own_mesh.keep_versions(tmp_path, mesh)
    name, sizes = own_mesh.of_run(tmp_path)
    preset = PRESETS["smoke"].on(name, sizes)
    its = experiments()[experiment]
    cases = [it for it in its.cases(preset, "half_edge") if it.family == name]
    assert {it.size for it in cases} == set(sizes)
    for case in {it.subject: it for it in reversed(cases)}.values():  # at the smallest size
        measured = its.measure(case, preset, time_rounds)
        assert measured.vertices == sizes[0]
        assert measured.samples or measured.skipped


@pytest.fixture
def finned(tmp_path) -> str:
    """A file of a torus with a third face at an edge."""
    torus = hem.generate("torus", 200)
    fin = [*torus.triangles[0, :2], len(torus.points)]
    points = np.concatenate([torus.points, torus.points[:1] + 1])
    file = tmp_path / "finned.off"
    hem.save(hem.TriangleMesh(points, np.concatenate([torus.triangles, [fin]])), file)
    return str(file)


def test_what_is_not_manifold_is_measured_on_the_structures_that_hold_it(tmp_path, finned):
    with pytest.warns(hem.MeshWarning, match=r"held by Triangle-Neighbor, .*skipped.*--repair"):
        folder = begin(tmp_path, *ON_ONE_MESH, structures=(), mesh=finned)
    go_on(folder)
    run = load(folder)
    measured = set(run.cases["structure"]) & set(structures.NAMES)
    for name in structures.NAMES:
        try:
            structures.build(name, finned)
        except hem.NonManifoldError:
            assert name not in measured
        else:
            assert name in measured
    assert all(len(non_manifold_edges(it.triangles)) for it in versions(folder))


def test_what_the_chosen_structures_cannot_hold_is_refused_and_leaves_no_run(tmp_path):
    with pytest.raises(hem.MeshError, match=r"held by Half-Edge: .*--repair"):
        study.begin("smoke", tmp_path, ["half_edge"], mesh="face")
    with pytest.raises(hem.MeshError, match="there is no model"):
        study.begin("smoke", tmp_path, mesh="nothing")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("options", "said"), [
    (["--repair"], "say --mesh as well"),
    (["--mesh", "cow", "--workers", "tcp://a:1"], "leave out --workers"),
    (["--mesh", "cow", "--resume"], "leave out --mesh"),
    (["--mesh", "cow", "--peers"], "leave out --mesh"),
])  # fmt: skip
def test_options_that_do_not_go_together_are_told(options, said):
    code, printed = command("study", *options)
    assert code == 1
    assert said in printed


def test_every_size_of_a_preset_is_one_of_the_mesh():
    preset = PRESETS["quick"].on("mine", (100, 400_000))
    assert preset.families == ("mine",)
    for sizes in (preset.sizes, preset.build_sizes, preset.operation_sizes, preset.workload_sizes):
        assert sizes == (100, 400_000)
    assert preset.work_sizes == (100,)  # Python counts


ON_A_TRIANGLE = "operations", "operation_work", "workloads", "real_time", "picking"


@pytest.mark.parametrize("name", ON_A_TRIANGLE)
def test_what_a_triangle_does_not_allow_is_skipped_and_the_rest_measured(tmp_path, name):
    file = tmp_path / "triangle.off"
    hem.save(hem.TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), file)
    own_mesh.keep_versions(tmp_path, str(file))
    called, sizes = own_mesh.of_run(tmp_path)
    preset = PRESETS["smoke"].on(called, sizes[:4])
    its = experiments()[f"bench_{name}"]
    cases = [it for it in its.cases(preset, "indexed") if it.family == called]
    found = [its.measured(it, preset, time_rounds) for it in cases]
    assert all(bool(it.samples) != bool(it.skipped) for it in found)
    assert name != "picking" or not any(it.skipped for it in found)  # nothing of it is an edit
    if name == "operation_work":
        skipped = {it.subject for it in found if it.skipped and it.vertices == 3}
        assert skipped == {"collapse_edge", "flip_edge"}
