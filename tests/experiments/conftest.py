"""What the tests of the experiments share."""

from __future__ import annotations

import pytest

from experiments.regression import record_run
from experiments.runs import load
from tests.experiments.made_runs import write_run


@pytest.fixture(scope="session")
def base_folder(tmp_path_factory):
    """A run in which every claim holds."""
    return write_run(tmp_path_factory.mktemp("base"))


@pytest.fixture(scope="session")
def base(base_folder):
    """The line of that run."""
    return record_run(load(base_folder))
