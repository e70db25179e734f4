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

import json
import subprocess
import warnings
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from hem.complexity.judge import Verdict
from hem.complexity.measure import BUDGET, Function, MakeInput, measure

MEASURING = ("sizes", "budget", "rounds", "fresh", "amortized", "most", "clock")
DOINGS = "pass", "warn", "fail"
PARALLEL = "complexity is not timed beside other tests: run this one without pytest-xdist (-n 0)"
SECONDS = f"Seconds per function, and once more where they leave it open. Default: {BUDGET:g}."
TOLD = ("expected", "outcome", "answer", "slope", "slope_low", "slope_high")


class ComplexityWarning(UserWarning):
    """It cannot be told whether a test's claim holds."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """What is done about a verdict, and where runs are kept."""
    group = parser.getgroup("complexity", "growth of costs")
    for outcome, default in (("violated", "fail"), ("undetermined", "warn")):
        words = f"What an {outcome} claim does: {', '.join(DOINGS)}. Default: {default}."
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
    config.stash[LINES], config.stash[CHANGES] = [], []


LINES = pytest.StashKey[list[str]]()
CHANGES = pytest.StashKey[list[str]]()


class Complexity:
    """Measures and judges in a test; `verdict` is the last one."""

    verdict: Verdict | None = None

    def __init__(self, item: pytest.Item) -> None:
        self._item = item

    def __call__(self, f: Function, make_input: MakeInput | None = None, **given: Any) -> Verdict:
        """Measure f(make_input(n)), fail or warn as the verdict asks for -> the verdict.

        given: `expected`, and options of `measure` and `judge`.
        """
        config, mark = self._item.config, self._item.get_closest_marker("complexity")
        options = dict(mark.kwargs) if mark else {}
        options |= {"expected": mark.args[0]} if mark and mark.args else {}
        options |= given
        marked = options.pop("make_input", None)
        make: MakeInput = make_input or marked or int  # int: the size itself
        if not options.get("expected"):
            raise pytest.UsageError(f'{self._item.nodeid}: say what is claimed: expected="O(n)"')
        if hasattr(config, "workerinput"):
            pytest.skip(PARALLEL)
        told = {key: options.pop(key) for key in MEASURING if key in options}
        if budget := config.getoption("complexity_budget"):
            told["budget"] = budget
        self.verdict = verdict = measure(f, make, **told).judge(**options)
        found = f"it is {verdict.answer}, " if verdict.answer else ""
        claimed = f"{verdict.expected} is claimed; {found}slope {verdict.slope:.2f}"
        words = f"{self._item.nodeid}: {verdict.outcome}: {claimed}. {verdict.reason}"
        config.stash[LINES].append(words)
        if path := config.getoption("complexity_history"):
            _keep(self._item, verdict, path)
        if verdict.outcome != "consistent":
            _settle(config, words, f"complexity_{verdict.outcome}")
        return verdict


@pytest.fixture
def complexity(request: pytest.FixtureRequest) -> Complexity:
    """Measures a function, holds it to a class: ``complexity(f, make_input, expected="O(n)")``."""
    return Complexity(request.node)


@pytest.fixture
def complexity_input() -> None:
    """The input of a marked test; each call of its body gets one."""


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Iterator[None]:
    """Measure the body of a marked test that does not measure by itself."""
    marked = pyfuncitem.get_closest_marker("complexity")
    if marked and "complexity" not in pyfuncitem.fixturenames:
        body, names = pyfuncitem.obj, pyfuncitem._fixtureinfo.argnames
        given = {name: pyfuncitem.funcargs[name] for name in names}
        measured = Complexity(pyfuncitem)

        def measure_body(**_: Any) -> None:
            measured(lambda it: body(**given | {"complexity_input": it}))

        pyfuncitem.obj = measure_body
    return (yield)


def _settle(config: pytest.Config, words: str, key: str) -> None:
    doing = config.getoption(key) or config.getini(key)
    if doing == "fail":
        pytest.fail(words, pytrace=False)
    elif doing == "warn":
        warnings.warn(ComplexityWarning(words), stacklevel=3)
    elif doing != "pass":
        raise pytest.UsageError(f"{key} is {', '.join(DOINGS)}, not {doing!r}")


def _keep(item: pytest.Item, verdict: Verdict, path: Path) -> None:
    """Add a verdict to the history, and what changed to what is told at the end."""
    asked = ["git", "-C", str(item.config.rootpath), "describe"]
    asked += ["--always", "--abbrev=40", "--dirty=*"]
    try:
        commit = subprocess.check_output(asked, stderr=subprocess.DEVNULL, text=True).strip()
    except (OSError, subprocess.CalledProcessError):
        commit = "no commit"
    time = datetime.now(UTC).isoformat(timespec="seconds")
    now = {"test": item.nodeid, "commit": commit, "time": time}
    now |= {key: getattr(verdict, key) for key in TOLD}
    lines = path.read_text("utf-8").splitlines() if path.exists() else []
    earlier = [it for it in map(json.loads, lines) if it["test"] == item.nodeid]
    if earlier and (change := _change(earlier[-1], now)):
        item.config.stash[CHANGES].append(f"{item.nodeid}: {change}")
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(now, ensure_ascii=False) + "\n")


def _change(before: dict[str, Any], now: dict[str, Any]) -> str:
    """What became of a test between two runs; empty if nothing did."""
    apart = now["slope_low"] > before["slope_high"] or before["slope_low"] > now["slope_high"]
    if before["outcome"] == now["outcome"] and (before["answer"] == now["answer"] or not apart):
        return ""
    was, became = (
        f"{it['outcome']}, {it['answer'] or 'no class'}, slope {it['slope']:.2f}"
        for it in (before, now)
    )
    return f"{was} at {before['commit'][:10]}; {became} at {now['commit'][:10]}"


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Tell the verdicts, and what changed."""
    for title, lines in (("complexity", LINES), ("complexity: changed", CHANGES)):
        if config.stash[lines]:
            terminalreporter.section(title)
            for line in config.stash[lines]:
                terminalreporter.line(line)
