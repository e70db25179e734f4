"""What the tests of runs share: one small study."""

import shutil
from pathlib import Path

import pytest

from tests.experiments.small_study import begin, go_on


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """A finished run of one experiment on one structure."""
    folder = begin(tmp_path_factory.mktemp("runs"))
    assert go_on(folder) == []
    return folder


@pytest.fixture
def run(finished, tmp_path):
    """That run, a copy for each test."""
    return Path(shutil.copytree(finished, tmp_path / "runs" / finished.name))
