"""Laws of the reference loop: the work of a small mesh at every size, in the memory of the case."""

from dataclasses import replace

import numpy as np
import pytest

from experiments.harness import PRESETS, Case, time_query, time_rounds
from experiments.harness.reference import FEWEST_HANDLES, ROUNDS, Reference, copies
from hem.contract import QUERIES, Sweep
from structures import REGISTRY

COMPILED = [name for name, kind in REGISTRY.items() if kind.compiled]
SMALL = 64
PRESET = replace(PRESETS["smoke"], sizes=(SMALL,))


def work(reference: Reference, begin: int, many: int) -> np.ndarray:
    """Elements read for some of the handles, counted in the interpreted source."""
    sweep = reference.sweep.successive(begin, many)
    uses = sweep.state.declared.queries
    name = next(it for it in QUERIES if uses[it].sweep is sweep.loop)
    return uses[name].work(sweep.handles, sweep.out, reference.records)


@pytest.mark.parametrize("query", QUERIES)
@pytest.mark.parametrize("name", COMPILED)
def test_no_size_makes_the_reference_work_more(name: str, query: str) -> None:
    counts = []
    for size in (SMALL, 4 * SMALL, 32 * SMALL):
        reference = Reference(Case(name, "torus", size, query, "consecutive"), PRESET)
        of_one = len(reference.sweep.handles) * SMALL // size
        counts += [work(reference, begin, of_one) for begin in (0, -of_one)]
    assert sum(counts[2]) == pytest.approx(sum(counts[0]), rel=0.2)  # it depends on the numbers
    for count in counts:
        assert sum(count) <= 1.25 * sum(counts[0])
        more = max(counts[0]) // 10 if name == "triangle_soup" else 10  # coordinates may be alike
        assert max(count) <= max(counts[0]) + more


@pytest.mark.parametrize("name", COMPILED)
def test_copies_take_the_memory_of_one_mesh_of_their_size(name: str) -> None:
    large = Case(name, "torus", 16 * SMALL)
    s, _ = copies(Case(name, "torus", SMALL), large.vertices)
    there = sum(large.build().memory().values())
    assert sum(s.memory().values()) == pytest.approx(there, rel=0.1)
    s.validate()


@pytest.mark.parametrize("order", ["random", "consecutive"])
def test_the_reference_asks_every_handle_in_turn(
    order: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = Case("half_edge", "torus", 4 * SMALL, "face_faces", order)
    reference = Reference(case, PRESET)
    handles = reference.sweep.handles
    assert np.array_equal(np.sort(handles), reference.structure.handles("face"))
    assert np.array_equal(handles, np.sort(handles)) == (order == "consecutive")
    asked: list[np.ndarray] = []

    def ask(sweep: Sweep) -> None:
        asked.append(sweep.handles)

    monkeypatch.setattr(reference, "ask", ask)
    assert len(reference.seconds(1500) + reference.seconds(10)) == 2 * ROUNDS
    assert [len(it) for it in asked] == (1 + ROUNDS) * [1500] + ROUNDS * [FEWEST_HANDLES]
    assert np.array_equal(np.concatenate(asked), np.resize(handles, sum(map(len, asked))))


def test_neighbors_in_copies_are_numbered_as_far_apart_as_in_one_mesh_of_their_size() -> None:
    def far_apart(triangles: np.ndarray) -> np.ndarray:
        return np.quantile(abs(triangles - np.roll(triangles, 1, axis=1)), [0.25, 0.6, 0.9])

    large = Case("half_edge", "torus", 1024 * SMALL)
    s, _ = copies(Case("half_edge", "torus", SMALL), large.vertices)
    copied, one = far_apart(s.triangles()), far_apart(large.mesh().triangles)
    assert (copied < 3 * one + 1).all()
    assert (one < 3 * copied + 1).all()


@pytest.mark.parametrize(("family", "measured"), [("torus", True), ("sphere", False)])
def test_a_case_of_the_judged_family_has_a_reference_beside_it(family: str, measured: bool) -> None:
    case = Case("half_edge", family, 400, "face_faces", "random")
    result = time_query(case, PRESETS["smoke"], time_rounds)
    assert (result.reference is not None) == measured
    assert not measured or 0 < result.reference < 1e-5
