"""Laws of the plugin: a verdict becomes a pass, a failure or a warning, and is kept."""

import json
import sys

import pytest

pytest_plugins = ["pytester"]
PLUGIN = "hem.complexity.pytest_plugin"

TESTS = """
import pytest
import sys
import hem.complexity
measuring = sys.modules["hem.complexity.measure"]

@pytest.fixture(autouse=True)
def clock(monkeypatch):  # runs as the function says, so that no neighbor can disturb a verdict
    class Clock:
        now = 0.0
        def __call__(self):
            self.now += 1e-9
            return self.now
    made = Clock()
    defaults = measuring.measure.__kwdefaults__ | {"clock": made}
    monkeypatch.setattr(measuring.measure, "__kwdefaults__", defaults)
    return made

@pytest.mark.complexity("O(n)", sizes=SIZES)
def test_body(clock, complexity_input):
    clock.now += 1e-6 * complexity_input ** POWER

@pytest.mark.complexity("O(n)", sizes=SIZES)
def test_marked_fixture(clock, complexity):
    def work(text):
        clock.now += 1e-6 * len(text) ** POWER
    assert complexity(work, lambda n: "x" * n).expected == "O(n)"

def test_fixture(clock, complexity):
    def work(n):
        clock.now += 1e-6 * n ** POWER
    complexity(work, expected="linear", sizes=SIZES)
"""


@pytest.fixture
def run(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch):
    # What was compiled of a file as long, written in the same second, would be taken for it.
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def run_tests(*options: str, power: int = 1, sizes: tuple[int, ...] = (10, 30, 100, 300, 1000)):
        text = TESTS.replace("POWER", str(power)).replace("SIZES", str(sizes))
        pytester.makepyfile(text)
        return pytester.runpytest("-p", PLUGIN, *options)

    return run_tests


def test_a_claim_that_holds_passes(run) -> None:
    result = run()
    result.assert_outcomes(passed=3)
    result.stdout.fnmatch_lines(
        ["*test_body: consistent: O(n) is claimed; it is O(n), slope 1.00*"]
    )


def test_a_claim_that_is_violated_fails_and_says_why(run) -> None:
    result = run(power=2)
    result.assert_outcomes(failed=3)
    result.stdout.fnmatch_lines(["*test_body: violated: O(n) is claimed; it is O(n²), slope 2.00*"])


@pytest.mark.parametrize(
    ("options", "outcome"),
    [
        ((), {"passed": 3, "warnings": 3}),
        (("--complexity-undetermined", "fail"), {"failed": 3}),
        (("-o", "complexity_undetermined=pass"), {"passed": 3}),
    ],
)
def test_what_cannot_be_told_warns_or_does_as_it_is_told(run, options, outcome) -> None:
    run(*options, sizes=(10, 100, 1000)).assert_outcomes(**outcome)


def test_nothing_is_timed_in_parallel(run) -> None:
    pytest.importorskip("xdist")
    result = run("-n", "2", "-rs")
    result.assert_outcomes(skipped=3)
    result.stdout.fnmatch_lines(["*not timed beside other tests*"])


def test_history_tells_what_changed(run, pytester: pytest.Pytester) -> None:
    assert (
        "complexity: changed" not in run("--complexity-history", "kept/history.jsonl").stdout.str()
    )
    assert (
        "complexity: changed" not in run("--complexity-history", "kept/history.jsonl").stdout.str()
    )
    result = run("--complexity-history", "kept/history.jsonl", power=2)
    result.stdout.fnmatch_lines(
        ["*test_body: consistent, O(n), slope 1.00 at *; violated, O(n²), slope 2.00 at *"]
    )
    kept = (pytester.path / "kept" / "history.jsonl").read_text().splitlines()
    assert [json.loads(line)["outcome"] for line in kept] == ["consistent"] * 6 + ["violated"] * 3


def test_a_missing_claim_is_a_mistake(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("def test_it(complexity):\n    complexity(len, list)")
    pytester.runpytest("-p", PLUGIN).stdout.fnmatch_lines(
        ['*say what is claimed: expected="O(n)"*']
    )


def test_pytest_benchmark_works_beside(pytester: pytest.Pytester) -> None:
    pytest.importorskip("pytest_benchmark")
    pytester.makepyfile("def test_it(benchmark, complexity):\n    benchmark.pedantic(len, ([],))")
    pytester.runpytest("-p", PLUGIN).assert_outcomes(passed=1)
