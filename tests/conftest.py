"""What all tests share."""

import signal
from pathlib import Path

import pytest

STRUCTURES = Path(__file__).parent / "structures"

# In the background of a shell Ctrl-C is ignored, and would be by all that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The many short files come last, and the cores end at the same time."""
    items.sort(key=lambda item: item.path.is_relative_to(STRUCTURES))
