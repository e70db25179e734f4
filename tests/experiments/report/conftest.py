"""A browser for the tests of pages."""

from collections.abc import Iterator

import pytest

from experiments.claims import judge_run
from experiments.report.pdf import BROWSER_VARIABLE, find_browser
from experiments.report.session import Session, share
from experiments.runs import Run
from tests.experiments.chromium import Browser, started


@pytest.fixture(scope="module")
def run(base_run: Run) -> Run:
    """A run in which every claim holds."""
    return base_run


@pytest.fixture(scope="module")
def session(base_run: Run) -> Iterator[Session]:
    """It is the run of all chapters while a file is tested."""
    session = Session(base_run, judge_run(base_run))
    share(session)
    yield session
    share(None)


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    """One browser for all tests of a file."""
    if find_browser() is None:
        pytest.skip(f"no Chromium or Chrome is installed; {BROWSER_VARIABLE} names one elsewhere")
    with started() as browser:
        yield browser
