"""The experiments as pytest-benchmark files: cases come from a preset, results go to a run.

Run one by hand, with all of pytest-benchmark's options::

    python -m pytest experiments/bench_queries.py --structure half_edge -k vertex_faces

``hem study`` runs them all, with ``--run FOLDER``: every finished case is kept there at once, and
cases that are there already are not measured again, unless ``--action again`` asks for those that
were disturbed. Cases are measured in a random order, the same for the same seed, so that a machine
that slows down does not look like a structure that scales badly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest

from experiments.harness import (
    CLOCK,
    PRESETS,
    BenchmarkTimer,
    Case,
    Keep,
    Measurement,
    Preset,
    Watch,
    affinity,
    in_random_order,
    memory,
)
from experiments.runs.store import CannotWriteError, CaseFile
from experiments.runs.worker import AGAIN, COMPILE, DEFAULT_SEED, MEASURE

CORE = pytest.StashKey[int | None]()
FILES = pytest.StashKey[dict[tuple[str, str], CaseFile]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """The extent of an experiment, how it is measured, and where its results go."""
    group = parser.getgroup("hem")
    group.addoption(
        "--preset", "--profile", default="quick", choices=list(PRESETS), help="how much to measure"
    )
    group.addoption("--structure", action="append", help="measure just this one; may be repeated")
    group.addoption("--run", type=Path, help="the folder that keeps the results, case by case")
    group.addoption("--pin", action="store_true", help="stay on one core, where that is allowed")
    group.addoption(
        "--case-seed", type=int, default=DEFAULT_SEED, help="seed of the order of the cases"
    )
    group.addoption(
        "--action",
        default=MEASURE,
        choices=[MEASURE, AGAIN, COMPILE],
        help="measure what the run lacks, what was disturbed, or compile for one case of each kind",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Tie this process to a core."""
    config.stash[FILES] = {}
    config.stash[CORE] = affinity.pin() if config.getoption("--pin") else None


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test per case of the experiment that is to be measured."""
    if "case" in metafunc.fixturenames:
        config, module = metafunc.config, metafunc.module
        chosen = config.getoption("--structure") or module.EXPERIMENT.structures
        cases = [case for name in chosen for case in _cases(config, module, name)]
        ids = [f"{case.structure}/{case.id}" for case in cases]
        metafunc.parametrize("case", cases, ids=ids)


def _cases(config: pytest.Config, module: Any, structure: str) -> list[Case]:
    preset = PRESETS[config.getoption("--preset")].of(structure)
    cases = module.EXPERIMENT.cases(preset, structure)
    action, file = config.getoption("--action"), _file(config, module.__name__, structure)
    if action == COMPILE:
        kinds = {(it.subject, it.order, it.reference_bytes): it for it in _largest_first(cases)}
        return list(kinds.values())
    chosen = file.disturbed if action == AGAIN else {it.id for it in cases} - file.cases.keys()
    seed = f"{config.getoption('--case-seed')} {module.__name__} {structure}"
    return in_random_order([case for case in cases if case.id in chosen], seed)


def _largest_first(cases: list[Case]) -> list[Case]:
    return sorted(cases, key=lambda case: case.size, reverse=True)


@pytest.fixture
def preset(request: pytest.FixtureRequest, case: Case) -> Preset:
    """How much to measure."""
    return PRESETS[request.config.getoption("--preset")].of(case.structure)


@pytest.fixture
def timer(benchmark: Any) -> Iterator[BenchmarkTimer]:
    """The timer that also feeds pytest-benchmark."""
    timer = BenchmarkTimer(benchmark)
    yield timer
    timer.end()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """pytest-benchmark's statistics are per query or edit, see ``UnitClock``."""
    for item in items:
        item.add_marker(pytest.mark.benchmark(timer=CLOCK))


@pytest.fixture
def keep(request: pytest.FixtureRequest, case: Case) -> Keep:
    """Keep a case's result in the run, and what it is about in pytest-benchmark's own JSON.

    Skips the test, and keeps the reason, where there is not enough memory for the case.
    """
    config, declared = request.config, request.module.EXPERIMENT
    file = _file(config, request.module.__name__, case.structure)
    reason = memory.why_too_large(case, declared.copies)
    if reason:
        _add(config, file, case.not_measured(declared.kind_of(case), reason))
        pytest.skip(reason)
    watch = Watch()

    def keep_result(result: Measurement) -> None:
        result = replace(result, noise={**watch.seen(), "core": config.stash[CORE]})
        if "benchmark" in request.fixturenames:
            facts = {key: value for key, value in asdict(result).items() if key != "samples"}
            request.getfixturevalue("benchmark").extra_info.update(facts)
        _add(config, file, result)

    return keep_result


def _add(config: pytest.Config, file: CaseFile, result: Measurement) -> None:
    if config.getoption("--run"):
        try:
            file.add(result)
        except CannotWriteError as error:
            pytest.exit(str(error), returncode=pytest.ExitCode.INTERNAL_ERROR)


def _file(config: pytest.Config, module: str, structure: str) -> CaseFile:
    files = config.stash[FILES]
    if (module, structure) not in files:
        folder = config.getoption("--run") or Path("no run")
        files[module, structure] = CaseFile(folder, module.rpartition(".")[2], structure)
    return files[module, structure]
