"""What the tests of the experiments share."""

from __future__ import annotations

import os

import pytest
from filelock import FileLock

from experiments.claims import judge_run
from experiments.regression import record_run
from experiments.runs import load
from tests.experiments.made_runs import write_run


@pytest.fixture(scope="session")
def base_folder(tmp_path_factory):
    """A run in which every claim holds, judged: written once for all processes that test."""
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "base" / "run"
    folder.parent.mkdir(exist_ok=True)
    with FileLock(folder.with_name("lock")):
        if not folder.exists():
            judge_run(load(write_run(folder)))
    return folder


@pytest.fixture(scope="session")
def base(base_folder):
    """The line of that run."""
    return record_run(load(base_folder))
