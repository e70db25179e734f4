"""What all tests share."""

import gc
import signal
from pathlib import Path
from typing import Any

import pytest

from structures import NAMES
from tests.extent import EVERYTHING

STRUCTURES = Path(__file__).parent / "structures"

# In the background of a shell Ctrl-C is ignored, and would be by all that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is exhaustive. What is about one structure is long and comes first.

    The many short files come last, so the cores end together.
    """
    more = set() if EVERYTHING else {it for it in items if it.get_closest_marker("exhaustive")}
    config.hook.pytest_deselected(items=[it for it in items if it in more])
    items[:] = [it for it in items if it not in more]
    items.sort(key=lambda item: (not about(item.nodeid), item.path.is_relative_to(STRUCTURES)))


COMPILE = "tests/hem/", "tests/structures/", "tests/experiments/harness/"
"""Where tests compile kernels; elsewhere a structure's name picks from a run that all share."""


def about(test: str) -> str:
    """The structure that a test compiles for, by its parameters; empty where it is not one."""
    if not test.startswith(COMPILE):
        return ""
    parameters = test.partition("[")[2].rstrip("]").split("-")
    return next((it for it in parameters if it in NAMES), "")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """One process does what is about a structure, so its kernels are compiled or loaded once."""
    from xdist.scheduler import LoadFileScheduling

    class ByStructureOrFile(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return about(nodeid) or super()._split_scope(nodeid)

    return ByStructureOrFile(config, log) if config.getvalue("dist") == "loadfile" else None


def pytest_collection_finish() -> None:
    """What was imported stays: to look for garbage in it took a twentieth of the time.

    Most of what is compiled later stays, too: it is looked at less often, for three hundredths.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(100_000, 20, 100)


def pytest_unconfigure() -> None:
    """At the end all of it is garbage; what was written in C++ tells of what is left."""
    gc.unfreeze()
