"""What the tests of the experiments share."""

import os
from pathlib import Path

import pytest
from filelock import FileLock

from experiments.claims import judge_run
from experiments.regression import record_run
from experiments.runs import Run, load
from tests.experiments.made_runs import write_run


@pytest.fixture(scope="session")
def base_folder(tmp_path_factory) -> Path:
    """A run in which every claim holds, judged: written once for all processes that test."""
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "base" / "run"
    folder.parent.mkdir(exist_ok=True)
    with FileLock(folder.with_name("lock")):
        if not folder.exists():
            judge_run(load(write_run(folder)))
    return folder


@pytest.fixture(scope="session")
def base_run(base_folder) -> Run:
    """That run, read once by each process; nobody changes it."""
    return load(base_folder)


@pytest.fixture(scope="session")
def base(tmp_path_factory):
    """The line of such a run of some structures."""
    folder, some = tmp_path_factory.mktemp("some"), ("indexed", "half_edge", "plankton")
    return record_run(load(write_run(folder, only=lambda _, it: it in some)))
