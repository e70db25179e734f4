"""A browser for the tests of pages."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from experiments.report.pdf import BROWSER_VARIABLE, find_browser
from tests.experiments.chromium import Browser, started


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    """One browser for all tests of a file."""
    if find_browser() is None:
        pytest.skip(f"no Chromium or Chrome is installed; {BROWSER_VARIABLE} names one elsewhere")
    with started() as browser:
        yield browser
