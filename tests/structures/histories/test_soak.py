"""The soak finds what is wrong, at the step where it went wrong."""

from __future__ import annotations

import pytest
from llvmlite.binding.executionengine import ExecutionEngine
from numba import njit

from tests.structures.histories.world import World
from tests.structures.soak import History, Meshes, histories


@pytest.mark.parametrize("of_polygons", [False, True])
def test_a_fault_is_narrowed_to_its_step(monkeypatch: pytest.MonkeyPatch, of_polygons: bool):
    check = World.check

    def find(world: World, thorough: bool = True) -> None:
        check(world, thorough)
        assert world.turn < 8, "something is wrong"

    monkeypatch.setattr(World, "check", find)
    with pytest.raises(AssertionError, match=r"step 7, .*something is wrong"):
        History(0, 1, of_polygons, 30).narrowed(20)


def test_the_same_history_is_run_again():
    history = History(5, 2, True, 60)
    assert history.run(20) == history.run(60)


@pytest.mark.parametrize("of_polygons", [False, True])
def test_what_was_done_before_loads_no_machine_code(monkeypatch, of_polygons: bool):
    """Else a process ends some day: code that is loaded stays, and its pages are limited."""
    history, loaded, add = History(0, 0, of_polygons, 60), [], ExecutionEngine.add_module
    history.run(20)

    def watched(engine: ExecutionEngine, module: object) -> None:
        loaded.append(module)
        add(engine, module)

    monkeypatch.setattr(ExecutionEngine, "add_module", watched)
    history.run(20)
    assert not loaded
    njit(lambda x: x + 1)(1)
    assert loaded  # a change in Numba would go unseen otherwise


@pytest.mark.parametrize("meshes", Meshes)
def test_histories_are_as_many_operations_as_asked_for(meshes: Meshes):
    some = list(histories(meshes, 1234, 0))
    assert sum(it.length for it in some) == 1234
    assert {it.of_polygons for it in some} == {
        Meshes.BOTH: {False, True},
        Meshes.TRIANGLES: {False},
        Meshes.POLYGONS: {True},
    }[meshes]
