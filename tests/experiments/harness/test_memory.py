"""A case that would not fit into memory is skipped beforehand and says so."""

import tracemalloc

import pytest

import hem
import structures
from experiments import bench_memory, bench_printed, harness
from experiments.harness import PRESETS, memory, time_rounds
from experiments.harness.cases import Case
from experiments.harness.memory import VARIABLE, available, estimate, size_of
from experiments.runs.catalog import experiments
from structures import NAMES

COPIES = {name: experiment.copies for name, experiment in experiments().items()}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("reference_bytes", [4, 8])
def test_what_building_takes_is_foreseen_and_not_by_far_too_much(name, reference_bytes):
    n = 4_000
    case = Case(name, "torus", n, reference_bytes=reference_bytes)
    foreseen = estimate(case, COPIES["bench_build"])
    structures.build(name, hem.generate("torus", n), reference_bytes)  # compiles
    tracemalloc.start()
    mesh = hem.generate("torus", n)
    built = [structures.build(name, mesh, reference_bytes)]
    built.append(structures.build(name, mesh, reference_bytes))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak <= foreseen <= 8 * peak


def test_what_a_case_takes_grows_with_its_mesh_and_with_its_structure():
    def of(name, size):
        return estimate(Case(name, "torus", size), COPIES["bench_operations"])

    assert of("indexed", 10**6) > 9 * of("indexed", 10**5)
    assert of("half_edge_objects", 10**5) > of("half_edge", 10**5) > of("indexed", 10**5)
    hubs = estimate(Case("indexed", "hubs", 2_000, valence=8), COPIES["bench_queries"])
    assert hubs == estimate(Case("indexed", "torus", 1_000), COPIES["bench_queries"])
    assert estimate(Case("machine", "chase", 1 << 30), COPIES["bench_latency"]) > 1 << 30


def test_what_is_available_is_the_least_that_anybody_allows(monkeypatch, tmp_path):
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(memory, "CGROUPS", ())
    free = available()
    assert free > 1 << 20
    limit, used = tmp_path / "max", tmp_path / "current"
    monkeypatch.setattr(memory, "CGROUPS", ((str(limit), str(used)),))
    used.write_text("1000\n")
    limit.write_text("max\n")
    assert available() > free / 2
    limit.write_text("5000\n")
    assert available() == 4000
    monkeypatch.setenv(VARIABLE, "2K")
    assert available() == 2048


@pytest.mark.parametrize(
    ("text", "size"), [("12", 12), ("500M", 500 << 20), ("1.5 GiB", 3 << 29), ("8gb", 8 << 30)]
)
def test_sizes_are_read_as_people_write_them(text, size):
    assert size_of(text) == size


@pytest.mark.parametrize("structure", ["triangle_neighbor", "half_edge"])
def test_addresses_that_were_never_written_are_not_weighed(structure: str) -> None:
    case = Case(structure, "torus", 270_000, reference_bytes=8)  # so that arrays have addresses
    found = bench_memory.measure(case, PRESETS["smoke"], time_rounds)
    (model,) = found.samples
    assert model <= found.detail["traced"] < 1.01 * model
    assert model < found.detail["peak"] < 2 * model


@pytest.mark.parametrize("structure", bench_printed.EXPERIMENT.structures)
@pytest.mark.parametrize("size", [100, 800])
def test_the_latency_beside_a_listing_is_that_of_what_its_mesh_takes(monkeypatch, structure, size):
    beside: list[int] = []
    monkeypatch.setattr(harness, "latency_now", lambda it: beside.append(it) or 1e-9)
    case = Case(structure, "torus", size, "split_face", bench_printed.TIMED)
    found = bench_printed.measure(case, PRESETS["smoke"], time_rounds)
    mesh = case.mesh()
    tracemalloc.start()
    built = bench_printed._build(structure, mesh)
    if structure == "as_printed":
        built.generate_render_mesh()
    traced = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert beside == [found.working_set]
    assert 0.75 < found.working_set / traced < 1.25
