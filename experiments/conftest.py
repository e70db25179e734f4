"""The experiments as pytest-benchmark files: cases come from a preset, results go to a run.

Run one by hand, with all of pytest-benchmark's options::

    python -m pytest experiments/bench_queries.py --structure half_edge -k vertex_faces

``hem study`` runs them all, with ``--run FOLDER``: every finished case is kept there at once, and
is not measured again. Cases come in a random order, the same for the same seed, so that a machine
that slows down does not look like a structure that scales badly.
"""

import gc
from collections.abc import Iterator
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from experiments import harness
from experiments.harness import Case, Experiment, Measurement, memory, own_mesh, steadiness
from experiments.presets import PRESETS, Preset
from experiments.runs import AGAIN, COMPILE, DEFAULT_SEED, MEASURE, CannotWriteError, CaseFile


def pytest_addoption(parser: pytest.Parser) -> None:
    """The extent of an experiment, how it is measured, and where its results go."""
    group = parser.getgroup("hem")
    group.addoption(
        "--preset", "--profile", default="quick", choices=list(PRESETS), help="how much to measure"
    )
    group.addoption("--structure", action="append", help="measure just this one; may be repeated")
    group.addoption("--run", type=Path, help="the folder that keeps the results, case by case")
    group.addoption("--pin", action="store_true", help="stay on one core, where that is allowed")
    group.addoption("--case-seed", type=int, default=DEFAULT_SEED, help="seed of the cases' order")
    words = "measure what the run lacks, what was disturbed, or compile for one case of each kind"
    group.addoption("--action", default=MEASURE, choices=[MEASURE, AGAIN, COMPILE], help=words)


def pytest_configure(config: pytest.Config) -> None:
    """A compiler makes few cycles and many objects: to look for the ones takes a tenth of it."""
    if config.getoption("--action") == COMPILE:
        gc.disable()


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test per case of the experiment that is to be measured."""
    if "case" in metafunc.fixturenames:
        config, experiment = metafunc.config, metafunc.module.EXPERIMENT
        chosen = config.getoption("--structure") or experiment.structures
        structures = (name for name in experiment.structures if name in chosen)
        cases = [case for name in structures for case in _cases(config, experiment, name)]
        metafunc.parametrize("case", cases, ids=[f"{it.structure}/{it.id}" for it in cases])


def _cases(config: pytest.Config, experiment: Experiment, structure: str) -> list[Case]:
    cases = experiment.cases(_extent(config).of(structure), structure)
    action = config.getoption("--action")
    if action == COMPILE:  # the smallest case of each kind
        cases = sorted(cases, key=lambda case: case.size, reverse=True)
        return list({(it.subject, it.order, it.reference_bytes): it for it in cases}.values())
    file = _file(config, experiment.name, structure)
    chosen = file.disturbed if action == AGAIN else {it.id for it in cases} - file.cases.keys()
    seed = f"{config.getoption('--case-seed')} {experiment.name} {structure}"
    return harness.in_random_order([case for case in cases if case.id in chosen], seed)


@cache
def _extent(config: pytest.Config) -> Preset:
    preset, folder = PRESETS[config.getoption("--preset")], config.getoption("--run")
    mesh = own_mesh.of_run(folder) if folder else None
    return preset.on(*mesh) if mesh else preset


@cache
def _file(config: pytest.Config, experiment: str, structure: str) -> CaseFile:
    return CaseFile(config.getoption("--run") or Path("no run"), experiment, structure)


def pytest_collection_modifyitems(items: list[Any]) -> None:
    """pytest-benchmark's statistics are per query or edit, see ``UnitClock``.

    What is only compiled comes structure by structure, each of which is then ready.
    """
    if items and items[0].config.getoption("--action") == COMPILE:
        place = {name: i for i, name in enumerate(items[0].config.getoption("--structure"))}
        cases = {item: item.callspec.params["case"] for item in items}
        items.sort(key=lambda item: place.get(getattr(cases[item], "structure", ""), -1))
    for item in items:
        item.add_marker(pytest.mark.benchmark(timer=harness.CLOCK))


@pytest.fixture
def preset(request: pytest.FixtureRequest, case: Case) -> Preset:
    """How much to measure."""
    return _extent(request.config).of(case.structure)


@pytest.fixture(scope="module")
def core(request: pytest.FixtureRequest) -> int | None:
    """The core that an experiment stays on, the calmest when it begins."""
    return steadiness.pin() if request.config.getoption("--pin") else None


@pytest.fixture
def timer(benchmark: Any) -> Iterator[harness.BenchmarkTimer]:
    """The timer that also feeds pytest-benchmark."""
    timer = harness.BenchmarkTimer(benchmark)
    yield timer
    timer.end()


@pytest.fixture
def keep(request: pytest.FixtureRequest, case: Case, core: int | None) -> harness.Keep:
    """Keep a case's result in the run and for pytest-benchmark; too large a case is skipped."""
    config, experiment = request.config, request.module.EXPERIMENT

    def add(result: Measurement) -> None:
        if config.getoption("--run") and config.getoption("--action") != COMPILE:
            try:
                _file(config, experiment.name, case.structure).add(result)
            except CannotWriteError as error:
                pytest.exit(str(error), returncode=pytest.ExitCode.INTERNAL_ERROR)

    if reason := memory.why_too_large(case, experiment.copies):
        add(case.not_measured(experiment.kind_of(case.order), reason))
        pytest.skip(reason)
    watch = steadiness.Watch()

    def keep_result(result: Measurement) -> None:
        result = replace(result, noise={**watch.seen(), **result.noise, "core": core})
        if "benchmark" in request.fixturenames:
            facts = {key: value for key, value in asdict(result).items() if key != "samples"}
            request.getfixturevalue("benchmark").extra_info.update(facts)
        add(result)

    return keep_result
