"""A pytest plugin: tests that hold what a function costs to a growth class.

The body of a marked test is what is measured, of an input as ``make_input`` makes it; without that
of the size itself. Or a test measures by the fixture, which takes from the mark what is not said:

    @pytest.mark.complexity("O(n log n)", make_input=random_floats)
    def test_sorting(complexity_input):
        sorted(complexity_input)

    def test_lookup(complexity):
        complexity(min, random_floats, expected="O(n)", sizes=[100, 1_000, 10_000, 100_000])

All else that `hem.complexity.measure` and `judge` are told by name may be given, too.
"""

import inspect
import json
import os
import subprocess
import warnings
from collections.abc import Iterator
from datetime import UTC, datetime
from math import inf
from pathlib import Path
from typing import Any

import pytest
from numpy.typing import ArrayLike

from hem.complexity.calls import Function, MakeInput
from hem.complexity.judge import Verdict, judge, require_bound
from hem.complexity.measure import BUDGET, measure
from hem.complexity.notation import canonical

POSITIONAL = "expected", "make_input", "sizes"  # of the mark
MEASURING = ("sizes", "budget", "rounds", "fresh", "amortized", "most", "clock")
KNOWN = {*POSITIONAL, *MEASURING, *inspect.signature(judge).parameters} - {"samples"}
DOINGS = "pass", "warn", "fail"
DEFAULTS = {"violated": "fail", "undetermined": "warn"}
UNMEASURED = "a marked test is a function of complexity_input, or one that asks for complexity"
UNCALLED = "it asks for complexity and never calls it"
UNMARKED = "it asks for complexity_input and has no mark complexity"
TOO_MANY = f"a mark complexity takes {', '.join(POSITIONAL)} by position, and all else by name"
PARALLEL = "complexity is not timed beside other tests: run this one without pytest-xdist (-n 0)"
SECONDS = f"Seconds per function; up to thrice that, if need be. Default: {BUDGET:g}."
TOLD = ("expected", "outcome", "answer", "slope", "slope_low", "slope_high")


class ComplexityWarning(UserWarning):
    """It cannot be told whether a test's claim holds, or nobody looked."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """What is done about a verdict, and where runs are kept."""
    group = parser.getgroup("complexity", "growth of costs")
    for outcome, default in DEFAULTS.items():
        words = f"What is done about {outcome} claims: {', '.join(DOINGS)}. Default: {default}."
        group.addoption(f"--complexity-{outcome}", choices=DOINGS, help=words)
        parser.addini(f"complexity_{outcome}", words, default=default)
    group.addoption("--complexity-budget", type=float, help=SECONDS)
    group.addoption(
        "--complexity-history", type=Path, metavar="FILE",
        help="Keep a line per verdict in it, and tell what changed since which commit.",
    )  # fmt: skip


def pytest_configure(config: pytest.Config) -> None:
    """Declare the mark, and begin a list of what is told at the end."""
    mark = 'complexity(expected, make_input=None, sizes=None, …): what it costs grows as "O(n)"'
    config.addinivalue_line("markers", mark)
    for outcome in DEFAULTS:
        _doing(config, f"complexity_{outcome}")
    if (budget := config.getoption("complexity_budget")) is not None and not 0 < budget < inf:
        raise pytest.UsageError(f"--complexity-budget is a number of seconds, not {budget:g}")
    if history := config.getoption("complexity_history"):
        path = config.invocation_params.dir / history
        if path.is_dir():
            raise pytest.UsageError(f"--complexity-history is a file; {history} is a folder")
        found = next(it for it in (path, *path.parents) if it.exists())
        if not os.access(found, os.W_OK) or (found != path and not found.is_dir()):
            raise pytest.UsageError(f"--complexity-history cannot be written: {history}")
        config.stash[COMMIT] = _commit(config.rootpath)  # now, as the history may be tracked
    config.stash[LINES], config.stash[CHANGES] = [], []


LINES = pytest.StashKey[list[str]]()
CHANGES = pytest.StashKey[list[str]]()
COMMIT = pytest.StashKey[str]()


class Complexity:
    """Measures and judges in a test; `verdict` is the last one, of so many `calls`."""

    verdict: Verdict | None = None
    calls = 0

    def __init__(self, item: pytest.Item) -> None:
        self._item = item

    def __call__(
        self, f: Function, make_input: MakeInput | None = None, sizes: ArrayLike | None = None,
        **given: Any,
    ) -> Verdict:  # fmt: skip
        """Measure f(make_input(n)), fail or warn as the verdict asks for -> the verdict.

        given: `expected`, and options of `measure` and `judge`. Fails before it measures where they
        are unknown or `expected` is no growth class.
        """
        config, mark = self._item.config, self._item.get_closest_marker("complexity")
        args, options = (mark.args, dict(mark.kwargs)) if mark else ((), {})
        if len(args) > len(POSITIONAL):
            pytest.fail(f"{self._item.nodeid}: {TOO_MANY}", pytrace=False)
        options |= zip(POSITIONAL, args, strict=False)
        options |= given if sizes is None else given | {"sizes": sizes}
        if mistake := _mistake(options):
            pytest.fail(f"{self._item.nodeid}: {mistake}", pytrace=False)
        marked = options.pop("make_input", None)
        make: MakeInput = make_input or marked or int  # int: the size itself
        if hasattr(config, "workerinput"):
            warnings.warn(ComplexityWarning(f"{self._item.nodeid}: {PARALLEL}"), stacklevel=2)
            pytest.skip(PARALLEL)
        told = {key: options.pop(key) for key in MEASURING if key in options}
        if (budget := config.getoption("complexity_budget")) is not None:
            told["budget"] = budget
        self.verdict = verdict = measure(f, make, **told).judge(**options)
        self.calls += 1
        found = f"it is {verdict.answer}, " if verdict.answer else ""
        claimed = f"{verdict.expected} is claimed; {found}slope {verdict.slope:.2f}"
        words = f"{self._item.nodeid}: {verdict.outcome}: {claimed}. {verdict.reason}"
        config.stash[LINES].append(words)
        if path := config.getoption("complexity_history"):
            _keep(self._item, self.calls, verdict, config.invocation_params.dir / path)
        if verdict.outcome != "consistent":
            doing = _doing(config, f"complexity_{verdict.outcome}")
            if doing == "fail":
                pytest.fail(words, pytrace=False)
            elif doing == "warn":
                warnings.warn(ComplexityWarning(words), stacklevel=2)
        return verdict


@pytest.fixture
def complexity(request: pytest.FixtureRequest) -> Complexity:
    """Measures a function, holds it to a class: ``complexity(f, make_input, expected="O(n)")``."""
    return Complexity(request.node)


@pytest.fixture
def complexity_input(request: pytest.FixtureRequest) -> None:
    """The input of a marked test; each call of its body gets one."""
    if not request.node.get_closest_marker("complexity"):
        pytest.fail(f"{request.node.nodeid} is not measured: {UNMARKED}", pytrace=False)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Measure the body of a marked test; fail one that asks for ``complexity`` and measures not.

    The test is what it was afterwards, or whoever runs it again would measure the measuring.
    """
    if not isinstance(item, pytest.Function):
        return (yield)
    body, names = item.obj, item._fixtureinfo.argnames
    awaited, marked = inspect.iscoroutinefunction(body), item.get_closest_marker("complexity")
    by_fixture = marked and "complexity" in item.fixturenames and "complexity_input" not in names
    asks = ("complexity" in names or by_fixture) and not awaited
    if marked and not asks:
        if "complexity_input" not in names or awaited:
            pytest.fail(f"{item.nodeid} is not measured: {UNMEASURED}", pytrace=False)
        given, measured = {name: item.funcargs[name] for name in names}, Complexity(item)

        def measure_body(**_: Any) -> None:
            measured(lambda it: body(**given | {"complexity_input": it}))

        item.obj = measure_body
    try:
        result = yield
    finally:
        item.obj = body
    asked: Any = item.funcargs["complexity"] if asks else None
    if asked and not asked.calls:
        pytest.fail(f"{item.nodeid} is not measured: {UNCALLED}", pytrace=False)
    return result


def _mistake(options: dict[str, Any]) -> str:
    """What is wrong with a claim and its options; empty if nothing is."""
    if unknown := sorted(options.keys() - KNOWN):
        return f"unknown: {', '.join(unknown)}; known are {', '.join(sorted(KNOWN))}"
    if not options.get("expected"):
        return 'say what is claimed: expected="O(n)"'
    if not isinstance(options["expected"], str):
        return f'expected is a growth class such as "O(n)", not {options["expected"]!r}'
    try:
        canonical(options["expected"], options.get("variable"))
        require_bound(options.get("bound", "tight"))
    except ValueError as error:
        return str(error)
    return ""


def _doing(config: pytest.Config, key: str) -> str:
    """What is done about an outcome; UsageError where the settings say something else."""
    doing: str = config.getoption(key) or config.getini(key)
    if doing not in DOINGS:
        raise pytest.UsageError(f"{key} is {', '.join(DOINGS)}, not {doing!r}")
    return doing


def _keep(item: pytest.Item, call: int, verdict: Verdict, path: Path) -> None:
    """Add a verdict to the history, and what changed since the same call to the end's list."""
    time, stash = datetime.now(UTC).isoformat(timespec="seconds"), item.config.stash
    now: dict[str, Any] = {"test": item.nodeid, "call": call, "time": time, "commit": stash[COMMIT]}
    now |= {key: getattr(verdict, key) for key in TOLD}
    text = path.read_text("utf-8-sig", "replace") if path.exists() else ""
    before, unread = None, list[str]()
    for number, line in enumerate(text.splitlines(), 1):
        try:
            it = {"call": 1} | json.loads(line)
            mine = all(it[key] == now[key] for key in ("test", "call"))
            told = {key: type(now[key])(it[key]) for key in ("commit", *TOLD)}
            before = told if mine else before
        except (ValueError, TypeError, KeyError):
            unread.append(str(number))
    changes = stash[CHANGES]
    if unread and (words := f"{path}: not read: line {', '.join(unread)}") not in changes:
        changes.append(words)
    if before and (change := _change(before, now)):
        changes.append(f"{item.nodeid}: {change}")
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as file:  # after a line that was cut off, on a new one
        cut = "\n" if text and not text.endswith("\n") else ""
        file.write(cut + json.dumps(now, ensure_ascii=False) + "\n")


def _commit(folder: Path) -> str:
    """Ten digits of the commit that is tested, and a star where files differ from it."""
    asked = "describe", "--always", "--exclude=*", "--abbrev=10", "--dirty=*"  # but no tag
    command = ["git", "-C", str(folder), *asked]
    try:
        return subprocess.check_output(command, stderr=subprocess.DEVNULL, text=True).strip()
    except (OSError, subprocess.CalledProcessError):
        return "no commit"


def _change(before: dict[str, Any], now: dict[str, Any]) -> str:
    """What became of a test between two runs; empty if nothing did."""
    apart = now["slope_low"] > before["slope_high"] or before["slope_low"] > now["slope_high"]
    if before["outcome"] == now["outcome"] and (before["answer"] == now["answer"] or not apart):
        return ""
    claims = before["expected"] != now["expected"]
    was, became = (
        f"{claims * (it['expected'] + ' is claimed, ')}{it['outcome']}, "
        f"{it['answer'] or 'no class'}, slope {it['slope']:.2f}"
        for it in (before, now)
    )
    return f"{was} at {before['commit']}; {became} at {now['commit']}"


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Tell the verdicts, and what changed."""
    for title, lines in (("complexity", LINES), ("complexity: changed", CHANGES)):
        if config.stash[lines]:
            terminalreporter.section(title)
            for line in config.stash[lines]:
                terminalreporter.line(line)
