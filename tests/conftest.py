"""What all tests share."""

import gc
import signal
from pathlib import Path

import pytest

from tests.extent import EVERYTHING

STRUCTURES = Path(__file__).parent / "structures"

# In the background of a shell Ctrl-C is ignored, and would be by all that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is exhaustive; the many short files come last, so the cores end together."""
    more = [] if EVERYTHING else [it for it in items if it.get_closest_marker("exhaustive")]
    config.hook.pytest_deselected(items=more)
    items[:] = [it for it in items if it not in more] if more else items
    items.sort(key=lambda item: item.path.is_relative_to(STRUCTURES))


def pytest_collection_finish() -> None:
    """What was imported stays: to look for garbage in it took a twentieth of the time."""
    gc.collect()
    gc.freeze()


def pytest_unconfigure() -> None:
    """At the end all of it is garbage; what was written in C++ tells of what is left."""
    gc.unfreeze()
