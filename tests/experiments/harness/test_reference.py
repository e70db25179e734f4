"""Laws of the reference loop: the work of a small mesh at every size, in the memory of the case."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from experiments.harness import PRESETS, Case, time_query, time_rounds
from experiments.harness.reference import Reference, copies
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
    assert sum(counts[2]) == pytest.approx(sum(counts[0]), rel=0.1)  # some structures hash
    for count in counts:
        assert sum(count) <= 1.1 * sum(counts[0])
        assert max(count) <= max(counts[0]) + 10


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

    def ask(sweep: Sweep) -> float:
        asked.append(sweep.handles)
        return 1e-6 * len(sweep.handles)

    monkeypatch.setattr(reference, "ask", ask)
    assert reference.seconds(2e-3) == 3 * [1e-6]
    reference.seconds(2e-3)
    assert [len(it) for it in asked] == 2 * [1000, 2000, 2000, 2000]
    assert np.array_equal(np.concatenate(asked), np.resize(handles, 14_000))


@pytest.mark.parametrize(("family", "measured"), [("torus", True), ("sphere", False)])
def test_a_case_of_the_judged_family_has_a_reference_beside_it(family: str, measured: bool) -> None:
    case = Case("half_edge", family, 400, "face_faces", "random")
    result = time_query(case, PRESETS["smoke"], time_rounds)
    assert (result.reference is not None) == measured
    assert not measured or 0 < result.reference < 1e-5
