"""The experiments as pytest-benchmark files: cases come from a profile, results go to a run.

Run one by hand, with all of pytest-benchmark's options::

    python -m pytest experiments/bench_queries.py --structure half_edge -k vertex_faces

``hem study`` runs them all, with ``--run FOLDER``: every finished case is kept there at once, and
cases that are there already are not measured again. Cases are measured in a random order, the same
for the same seed, so that a machine that slows down does not look like a structure that scales
badly; those that were disturbed are measured again at the end.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from time import perf_counter
from typing import Any, cast

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
    badness,
    disturbed,
    in_random_order,
    memory,
)
from experiments.harness.steadiness import REPEATS
from experiments.runs.results import CannotWriteError, ResultFile
from experiments.runs.worker import CANNOT_WRITE, DEFAULT_SEED, end_with

CORE = pytest.StashKey[int | None]()
FILES = pytest.StashKey[dict[tuple[str, str], ResultFile]]()
DISTURBED = pytest.StashKey[bool]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """The extent of an experiment, how it is measured, and where its results go."""
    group = parser.getgroup("hem")
    group.addoption("--profile", default="quick", choices=list(PRESETS), help="how much to measure")
    group.addoption("--structure", action="append", help="measure just this one; may be repeated")
    group.addoption("--study", type=int, help="end when the process of this number has ended")
    group.addoption("--run", type=Path, help="the folder that keeps the results, case by case")
    group.addoption("--pin", action="store_true", help="stay on one core, where that is allowed")
    group.addoption(
        "--case-seed", type=int, default=DEFAULT_SEED, help="seed of the order of the cases"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Tie this process to its study and to a core."""
    config.stash[FILES] = {}
    study = config.getoption("--study")
    if study:
        end_with(study)
    config.stash[CORE] = affinity.pin() if config.getoption("--pin") else None


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test per case of the experiment that the run does not have yet."""
    if "case" in metafunc.fixturenames:
        config, module = metafunc.config, metafunc.module
        chosen = config.getoption("--structure") or module.EXPERIMENT.structures
        profile = PRESETS[config.getoption("--profile")]
        seed = config.getoption("--case-seed")
        cases = [
            case
            for name in chosen
            for case in in_random_order(
                module.cases(profile.of(name), name), f"{seed} {module.__name__} {name}"
            )
            if case.id not in _file(config, module.__name__, name).finished
        ]
        ids = [f"{case.structure}/{case.id}" for case in cases]
        metafunc.parametrize("case", cases, ids=ids)


@pytest.hookimpl(wrapper=True)
def pytest_runtestloop(session: pytest.Session) -> Iterator[None]:
    """After all cases, measure again those that were disturbed, for as long as all took at most."""
    begin = perf_counter()
    result = yield
    until = 2 * perf_counter() - begin
    for _ in range(REPEATS):
        again = [item for item in session.items if item.stash.get(DISTURBED, False)]
        if again and session.config.getoption("--pin"):
            session.config.stash[CORE] = affinity.pin()  # another one may be calmer by now
        for item in again:
            if perf_counter() < until:
                cast(Any, item)._initrequest()  # what pytest knows of its fixtures is used up
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
    return result


@pytest.fixture
def preset(request: pytest.FixtureRequest, case: Case) -> Preset:
    """How much to measure."""
    return PRESETS[request.config.getoption("--profile")].of(case.structure)


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
    kept = bool(request.config.getoption("--run"))
    file = _file(request.config, request.module.__name__, case.structure)
    declared = request.module.EXPERIMENT
    reason = memory.why_too_large(case, declared.copies)
    if reason:
        if kept:
            _add(file, case.not_measured(declared.kind_of(case), reason))
        pytest.skip(reason)
    watch = Watch()

    def keeping(result: Measurement) -> None:
        result = _calmest(file, replace(result, noise=watch.seen()))
        timed = result.kind == "time" and not result.skipped
        if "benchmark" in request.fixturenames:
            facts = {key: value for key, value in asdict(result).items() if key != "samples"}
            request.getfixturevalue("benchmark").extra_info.update(facts)
        if kept:
            request.node.stash[DISTURBED] = timed and disturbed(result.noise)
            _add(file, result)

    return keeping


def _calmest(file: ResultFile, result: Measurement) -> Measurement:
    """The result, or an earlier one of its case that was less disturbed."""
    earlier = file.get(result.id)
    before = Measurement(**earlier) if earlier else result
    chosen = min(result, before, key=lambda it: badness(it.noise))
    times = 1 + before.noise.get("measured", 0)
    return replace(chosen, noise={**chosen.noise, "measured": times})


def _add(file: ResultFile, result: Measurement) -> None:
    try:
        file.add(result)
    except CannotWriteError as error:
        pytest.exit(str(error), returncode=CANNOT_WRITE)


def _file(config: pytest.Config, module: str, structure: str) -> ResultFile:
    files = config.stash[FILES]
    if (module, structure) not in files:
        folder = config.getoption("--run") or Path("no run")
        file = ResultFile(folder, module.rpartition(".")[2], structure)
        files[module, structure] = file
    files[module, structure].head["core"] = config.stash[CORE]
    return files[module, structure]
