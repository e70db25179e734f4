"""The example workflow runs commands that there are, with options that they have."""

import re
import shlex
from pathlib import Path

import pytest
import yaml
from typer.main import get_command

from experiments.cli import app

ROOT = Path(__file__).parents[3]
JOBS = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text())["jobs"]
STEPS = [step for job in JOBS.values() for step in job["steps"]]


def commands(program: str) -> list[list[str]]:
    """The arguments of every call of ``program`` in the workflow."""
    scripts = "\n".join(step.get("run", "") for step in STEPS)
    found = re.findall(rf"(?:^|[\s;|&])(?:\.venv/bin/)?{program} ([^\n;|&>]+)", scripts)
    return [shlex.split(arguments) for arguments in found]


def test_it_checks_tests_measures_judges_and_keeps_the_report():
    assert commands("make") == [["check"], ["test-all"], ["study"]]
    assert {tuple(it[:2]) for it in commands("hem")} >= {("check", "results/runs/*-quick")}
    kept = [it["with"]["path"] for it in STEPS if "upload-artifact" in it.get("uses", "")]
    assert "report/html" in kept[0].split()


def test_every_step_either_runs_something_or_uses_a_version_of_something():
    for step in STEPS:
        assert ("run" in step) != ("uses" in step)
        assert "run" in step or re.fullmatch(r"actions/[\w-]+@v\d+", step["uses"])


@pytest.mark.parametrize("arguments", commands("make"), ids=" ".join)
def test_make_has_the_target(arguments):
    targets = re.findall(r"^([\w-]+):.*##", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert set(arguments) <= set(targets)


@pytest.mark.parametrize("arguments", commands("hem"), ids=" ".join)
def test_hem_has_the_command_and_its_options_parse(arguments):
    command, context = get_command(app), None
    while hasattr(command, "commands"):
        name, *arguments = arguments
        assert name in command.commands, f"hem has no command {name!r}"
        command = command.commands[name]
    context = command.make_context("hem", list(arguments), resilient_parsing=False)
    assert not context.args


def test_it_tests_every_python_that_is_promised():
    classifiers = re.findall(r"Python :: (3\.\d+)", (ROOT / "pyproject.toml").read_text())
    assert JOBS["test"]["strategy"]["matrix"]["python-version"] == classifiers


def test_the_workflow_that_a_page_shows_runs_pytest_on_three_systems():
    page = (ROOT / "docs/guard.md").read_text()
    (text,) = re.findall(r"(?ms)^```yaml\n(.*?)^```", page)
    (job,) = yaml.safe_load(text)["jobs"].values()
    assert job["runs-on"] == "${{ matrix.os }}"
    systems = [it.partition("-")[0] for it in job["strategy"]["matrix"]["os"]]
    assert sorted(systems) == ["macos", "ubuntu", "windows"]
    assert [it["run"].split()[0] for it in job["steps"] if "run" in it] == ["pip", "pytest"]


def test_it_judges_and_tests_the_core_on_the_other_systems():
    systems = JOBS["elsewhere"]["strategy"]["matrix"]["os"]
    assert systems == ["macos-latest", "windows-latest"]
    (tests,) = commands("python -m pytest")
    assert all((ROOT / it).exists() for it in tests)
    assert ["judge", "costs.csv", "--expected", "O(n)", "--exact"] in commands("hem")


def test_what_is_cached_and_installed_is_there():
    caches = [it["with"] for it in STEPS if "setup-python" in it.get("uses", "")]
    assert caches
    for it in caches:
        assert all((ROOT / name).exists() for name in it["cache-dependency-path"].split())
