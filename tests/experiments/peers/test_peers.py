"""Laws of measuring other libraries: each answer is checked first, and nobody stops the others."""

import os
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from time import sleep

import numpy as np
import pytest

import hem
import structures
from experiments import bench_peers
from experiments.harness import PRESETS, Measurement, time_rounds
from experiments.harness.oracle import CheckFailedError
from experiments.peers import (
    BAD_INPUT,
    BULK,
    BYTES,
    LOOPED,
    OURS,
    PEERS,
    SINGLE,
    installed,
    missing,
    trials,
)
from experiments.runs import experiments, study
from experiments.runs.worker import EXPERIMENTS, PYTEST
from hem.contract import OPERATIONS, QUERIES
from tests.experiments.peers.slow_library import ABSENT, LIAR, LIBRARY
from tests.extent import exhaustive

HERE = [
    pytest.param(name, marks=exhaustive if PEERS[name].loops and name != OURS else ())
    for name in installed()
]
"""The libraries that are here; those in C++, which are compiled first, where all is tested."""
PRESET = replace(PRESETS["smoke"], case_seconds=60, round_seconds=0.001)


@pytest.fixture
def library(monkeypatch):
    monkeypatch.setitem(PEERS, "slow", LIBRARY)
    return "slow"


def measured(name: str, **wanted) -> list[Measurement]:
    """What is measured of a library on the smallest meshes."""
    return [
        bench_peers.measure(it, PRESET, time_rounds)
        for it in bench_peers.cases(PRESET, name)
        if all(getattr(it, key) == value for key, value in wanted.items())
    ]


@pytest.mark.parametrize("name", HERE)
def test_every_library_that_is_here_answers_as_the_triangle_list_says(name):
    found = measured(name, size=PRESET.sizes[0])
    asked = {(it.subject, it.order) for it in found if it.checked}
    assert asked >= {(it, SINGLE) for it in PEERS[name].single}
    assert asked >= {(it, BULK) for it in PEERS[name].bulk}
    assert all(np.all(np.array(it.samples) > 0) for it in found)


@pytest.mark.parametrize("name", HERE)
def test_every_operation_and_algorithm_leaves_the_faces_it_should(name):
    peer = PEERS[name]
    for subject in {*peer.operations, *peer.batches, *peer.algorithms}:
        assert all(it.samples for it in measured(name, subject=subject))


@pytest.mark.parametrize("name", [it for it in installed() if not PEERS[it].told_version])
def test_an_operation_that_a_library_calls_as_we_do_is_measured(name):
    module = import_module(PEERS[name].module or PEERS[name].distribution)
    assert {it for it in OPERATIONS if hasattr(module, it)} <= {*PEERS[name].operations}


def test_a_library_is_asked_at_hubs_where_the_valence_varies(library):
    found = [it for it in measured(library, subject="vertex_faces") if it.valence]
    assert [it.valence for it in found] == list(PRESET.valences)


def test_objects_are_measured_on_meshes_that_are_no_larger_than_for_ours(library):
    large = replace(PRESETS["quick"], sizes=(100, 3_000, 100_000))
    sizes = {it.size for it in bench_peers.cases(large, library) if it.subject in QUERIES}
    assert 100_000 not in sizes
    assert {100, 3_000} <= sizes


@pytest.mark.parametrize("order", [SINGLE, BULK])
def test_a_wrong_answer_is_told_with_both_answers_and_not_timed(monkeypatch, order):
    monkeypatch.setitem(PEERS, "liar", LIAR)
    with pytest.raises(CheckFailedError, match=r"vertex_faces\(\d+\) gives .*the triangle list"):
        measured("liar", subject="vertex_faces", order=order)


def test_a_library_in_python_whose_answer_takes_too_long_is_stopped_and_skipped(monkeypatch):
    def forever(handle):
        while True:
            pass

    endless = replace(LIBRARY, single={"vertex_faces": lambda m: forever}, bulk={})
    monkeypatch.setitem(PEERS, "endless", endless)
    monkeypatch.setattr(
        "tests.experiments.peers.test_peers.PRESET", replace(PRESET, case_seconds=1)
    )
    found = measured("endless", subject="vertex_faces", family="torus")
    assert found
    assert all("takes longer than the 1 s" in it.skipped and not it.samples for it in found)


def test_a_library_that_is_not_installed_is_named_and_has_no_cases(monkeypatch):
    monkeypatch.setitem(PEERS, "absent", ABSENT)
    assert missing()["Absent"] == "pip install no-such-distribution"
    assert bench_peers.cases(PRESET, "absent") == []


def test_libraries_in_cpp_are_one_program_and_take_what_the_system_has_of_both(
    monkeypatch, tmp_path
):
    monkeypatch.setattr("experiments.peers.program.HEADERS", tmp_path)
    (tmp_path / "CGAL").mkdir()
    for text in ("", "#define CGAL_VERSION 5.5.1"):  # without either, and with one of them
        (tmp_path / "CGAL/version.h").write_text(text)
        found = missing(["cgal", "openmesh_cpp"]).values()
        assert list(found) == ["apt-get install g++ libcgal-dev libopenmesh-dev"] * 2


def test_what_is_measured_of_nobody_is_an_error_that_names_it():
    with pytest.raises(ValueError, match="'vertex_colors' is none of vertex_vertices"):
        replace(LIBRARY, bulk={"vertex_colors": None})


def test_every_other_library_says_where_its_manual_is():
    assert [name for name, it in PEERS.items() if not it.site.startswith("https://")] == [OURS]


def test_ours_refuses_every_bad_input():
    assert {trials.give(PEERS[OURS], bad)[0] for bad in BAD_INPUT.values()} == {"refused"}


def test_what_a_library_accepts_drops_or_cannot_do_is_told_apart(library):
    found = {name: trials.give(LIBRARY, bad) for name, bad in BAD_INPUT.items()}
    assert found["moebius"] == ("accepted", "all faces are there")
    assert found["tetrahedron"][0] == "N/A"
    fewer = replace(LIBRARY, faces=lambda m: 1)
    assert trials.give(fewer, BAD_INPUT["two_fans"]) == ("changed", "1 of 2 faces are there")


def test_the_bad_strip_has_one_side_and_is_manifold_but_for_that():
    strip = np.array(BAD_INPUT["moebius"].triangles)
    directed = strip[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, uses = np.unique(np.sort(directed), axis=0, return_counts=True)
    assert uses.max() == 2
    assert len(np.unique(directed, axis=0)) < len(directed)  # some edge runs the same way twice


def test_a_process_that_ends_is_told_and_what_is_left_is_tried_in_another(monkeypatch):
    monkeypatch.setattr(trials, "BAD_INPUT", ["two_fans"])
    told = trials.told_by_child("no such library", "torus", 100)
    assert told.pop(BYTES) is None
    assert told == {"two_fans": ("ended", "exit code 1")}


def test_a_process_grows_by_what_ours_takes():
    told = trials.told_by_child(OURS, "torus", 100_000)
    s = structures.build("half_edge", hem.generate("torus", 100_000))
    assert 0.95 < told[BYTES] / sum(s.memory(room=True).values()) < 1.15
    assert {it[0] for name, it in told.items() if name != BYTES} == {"refused"}


def test_a_study_measures_other_libraries_only_where_it_is_asked_to(tmp_path):
    by_name = {name for name, it in experiments().items() if it.by_name}
    assert by_name == {"bench_peers"}
    folder = study.begin("smoke", tmp_path)
    assert not by_name & {it.experiment for it in study.plan(folder)}
    folder = study.begin("smoke", tmp_path, experiments=["peers"])
    assert {it.structure for it in study.plan(folder)} == set(installed())


def test_other_libraries_decide_no_claim_and_enter_no_baseline():
    declared = experiments()["bench_peers"]
    assert declared.table is None
    assert not declared.axes
    assert not declared.baseline_orders


def test_libraries_that_are_named_are_measured_alone(tmp_path):
    begun = study.begin("smoke", tmp_path, experiments=["peers"], structures=[OURS])
    assert {job.structure for job in study.plan(begun)} == {OURS}
    with pytest.raises(ValueError, match="no structure is called 'ours'"):
        study.begin("smoke", tmp_path, experiments=["latency"], structures=[OURS])


@pytest.mark.parametrize("weighed", [1_000_000, None])
def test_a_case_works_on_what_its_mesh_weighs_whatever_was_built_before(
    library, monkeypatch, weighed
):
    monkeypatch.setattr(bench_peers.peers, "told_by_child", lambda *_: {BYTES: weighed})
    largest = bench_peers.sizes(PRESET, LIBRARY)[-1]
    of_arrays = {n: 3 * 8 * n + 3 * 4 * 2 * n for n in PRESET.sizes}  # of a torus of n vertices
    for size in (*PRESET.sizes, *PRESET.sizes):
        found = measured(library, size=size, order=SINGLE)
        expected = of_arrays[size] if weighed is None else weighed * size / largest
        assert {it.working_set for it in found if it.subject in QUERIES} == {round(expected)}


def test_cases_that_one_program_tells_of_are_all_as_disturbed_as_it_was(library, monkeypatch):
    def looped(*_: object) -> dict:
        sleep(0.1)  # off its core, however idle the machine is
        return {"times": times, "answers": {}, "operated": {}, "bytes": 640}

    times = {"vertex_faces": [1e-9], "face_faces": [1e-9]}
    monkeypatch.setitem(PEERS, library, replace(LIBRARY, looped=looped, loops=tuple(times)))
    found = measured(library, size=PRESET.sizes[0], order=LOOPED)
    assert [it.subject for it in found] == [*times]
    assert all(it.noise["off_cpu"] > 0.5 for it in found)


def test_a_run_keeps_the_noise_that_a_program_saw_with_every_case_of_it(tmp_path):
    begun = study.begin("smoke", tmp_path, experiments=["peers"], structures=[OURS])
    (job,) = study.plan(begun)
    words = "loop and torus and 100 and (edge_vertices or face_faces or vertex_edges)"
    command = [sys.executable, "-m", "pytest", str(EXPERIMENTS / "bench_peers.py"), *PYTEST]
    options = ["--preset", "smoke", "--structure", OURS, "--run", str(begun), "-k", words]
    alone = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    subprocess.run([*command, *options], check=True, capture_output=True, env=alone)
    seen = [it.noise["before"] for it in job.file(begun).measurements]
    assert len(seen) == 3
    assert len(set(seen)) == 1
