"""The experiments as pytest-benchmark files: cells come from a profile, results go to a run.

Run one by hand, with all of pytest-benchmark's options::

    python -m pytest experiments/bench_queries.py --structure half_edge -k vertex_faces

``hem study`` runs them all, with ``--run FOLDER``: every finished cell is kept there at once, and
cells that are there already are not measured again.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import pytest

from experiments.profiles import PROFILES, Profile
from experiments.results import CellResult, ResultFile
from experiments.subjects import Cell

Keep = Callable[[CellResult], None]


def pytest_addoption(parser: pytest.Parser) -> None:
    """The extent of an experiment, and where its results go."""
    group = parser.getgroup("hem")
    group.addoption(
        "--profile", default="quick", choices=list(PROFILES), help="how much to measure"
    )
    group.addoption("--structure", action="append", help="measure just this one; may be repeated")
    group.addoption("--study", type=int, help="end when the process of this number has ended")
    group.addoption("--run", type=Path, help="the folder that keeps the results, cell by cell")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test per cell of the experiment that the run does not have yet."""
    if "cell" in metafunc.fixturenames:
        config = metafunc.config
        chosen = config.getoption("--structure") or metafunc.module.STRUCTURES
        profile = PROFILES[config.getoption("--profile")]
        cells = [
            cell
            for name in chosen
            for cell in metafunc.module.cells(profile.of(name), name)
            if cell.id not in _file(config, metafunc.module.__name__, name).finished
        ]
        ids = [f"{cell.structure}/{cell.id}" for cell in cells]
        metafunc.parametrize("cell", cells, ids=ids)


@pytest.fixture
def profile(request: pytest.FixtureRequest, cell: Cell) -> Profile:
    """How much to measure."""
    return PROFILES[request.config.getoption("--profile")].of(cell.structure)


@pytest.fixture
def keep(request: pytest.FixtureRequest, cell: Cell) -> Keep:
    """Keep a cell's result in the run, and what it is about in pytest-benchmark's own JSON."""
    file = _file(request.config, request.module.__name__, cell.structure)

    def keeping(result: CellResult) -> None:
        study = request.config.getoption("--study")
        if study and os.getppid() != study:
            # Whoever resumes it writes to the same file.
            pytest.exit("the study that began this was killed", returncode=1)
        if "benchmark" in request.fixturenames:
            facts = {key: value for key, value in asdict(result).items() if key != "samples"}
            request.getfixturevalue("benchmark").extra_info.update(facts)
        if request.config.getoption("--run"):
            file.add(result)

    return keeping


def _file(config: pytest.Config, module: str, structure: str) -> ResultFile:
    folder = config.getoption("--run") or Path("no run")
    return ResultFile(folder, module.rpartition(".")[2], structure)
