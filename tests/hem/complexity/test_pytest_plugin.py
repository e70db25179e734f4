"""Laws of the plugin: a verdict becomes a pass, a failure or a warning, and is kept."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]
PLUGIN = "hem.complexity.pytest_plugin"
GUARD = (Path(__file__).parents[3] / "docs/guard.md").read_text("utf-8")
(SHOWN,) = re.findall(r'"(default::.*?)"', GUARD)
FILTERS = f"{SHOWN.replace('default', 'error')}\n{SHOWN}"  # of warnings: the later goes first

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
    said = "*test_body: consistent: O(n) is claimed; it is O(n), slope 1.00*"
    result.stdout.fnmatch_lines([said])


def test_a_claim_that_is_violated_fails_and_says_why(run) -> None:
    result = run(power=2)
    result.assert_outcomes(failed=3)
    result.stdout.fnmatch_lines(["*test_body: violated: O(n) is claimed; it is O(n²), slope 2.00*"])


@pytest.mark.parametrize(
    ("options", "outcome", "warned"),
    [
        ((), {"passed": 3}, 3),
        (("--complexity-undetermined", "fail"), {"failed": 3}, 0),
        (("-o", "complexity_undetermined=pass"), {"passed": 3}, 0),
        (("-o", f"filterwarnings={FILTERS}"), {"passed": 3}, 3),
    ],
)
def test_what_cannot_be_told_warns_or_does_as_it_is_told(run, options, outcome, warned) -> None:
    result = run(*options, sizes=(10, 100, 1000))
    result.assert_outcomes(**outcome)
    assert result.stdout.str().count(" ComplexityWarning: ") == warned


@pytest.mark.parametrize("filters", ["", FILTERS])
def test_nothing_is_timed_in_parallel(run, filters: str) -> None:
    pytest.importorskip("xdist")
    result = run("-n", "2", "-o", f"filterwarnings={filters}")
    result.assert_outcomes(skipped=3)
    assert result.stdout.str().count("ComplexityWarning: ") == 3
    result.stdout.fnmatch_lines(["*test_body: complexity is not timed beside other tests*"])


def test_history_tells_what_changed(run, pytester: pytest.Pytester) -> None:
    history = "--complexity-history", "kept/history.jsonl"
    for _ in range(2):
        assert "complexity: changed" not in run(*history).stdout.str()
    result = run(*history, power=2)
    result.stdout.fnmatch_lines(
        ["*test_body: consistent, O(n), slope 1.00 at *; violated, O(n²), slope 2.00 at *"]
    )
    kept = (pytester.path / "kept" / "history.jsonl").read_text().splitlines()
    assert [json.loads(line)["outcome"] for line in kept] == ["consistent"] * 6 + ["violated"] * 3


def test_history_names_the_commits_and_whether_files_differ_from_them(
    run, pytester: pytest.Pytester
) -> None:
    def git(*words: str) -> str:
        author = ["-c", "user.name=a", "-c", "user.email=a@b"]
        command = ["git", "-C", str(pytester.path), *author, *words]
        return subprocess.check_output(command, text=True).strip()

    history = ("--complexity-history", "history.jsonl")
    (pytester.path / "kept.txt").write_text("before")
    git("init", "--quiet")
    git("add", "kept.txt")
    git("commit", "--quiet", "-m", "first")
    first = git("rev-parse", "HEAD")[:10]
    git("tag", "-a", "v1.0", "-m", "a release")
    run(*history)
    git("commit", "--quiet", "--allow-empty", "-m", "second")
    (pytester.path / "kept.txt").write_text("after")
    second = git("rev-parse", "HEAD")[:10]
    result = run(*history, power=2)
    result.stdout.fnmatch_lines([f"*slope 1.00 at {first}; violated*slope 2.00 at {second}[*]"])


AMORTIZED_AND_VARIABLES = """
import pytest

def appending(clock, n):  # a store that doubles: one append of n takes n, all of them 3 n
    held = 1
    for count in range(n):
        grows = count == held
        clock.now += 1e-6 * (1 + held * grows)
        held *= 1 + grows

@pytest.mark.complexity("amortized O(1)", sizes=SIZES, amortized=True)
def test_marked(clock, complexity_input):
    appending(clock, complexity_input)

def test_fixture(clock, complexity):
    for amortized, costs in ((True, "O(1)"), (False, "O(n)")):
        told = {"sizes": SIZES, "expected": costs, "amortized": amortized}
        assert complexity(lambda n: appending(clock, n), **told).answer == costs

def product(clock, rows, columns):
    clock.now += 1e-6 * rows * columns**2

@pytest.mark.parametrize(("variable", "answer"), [("r", "O(n)"), ("c", "O(n²)")])
def test_variables(clock, complexity, variable, answer):
    work = lambda n: product(clock, n, 7) if variable == "r" else product(clock, 7, n)
    found = complexity(work, sizes=SIZES, expected="O(r * c^2)", variable=variable)
    assert found.answer == answer

@pytest.mark.complexity("O(r * c^2)", sizes=SIZES)
def test_no_variable_is_said(complexity_input):
    pass
"""


def test_costs_are_amortized_and_one_of_several_variables_is_varied(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    clock = TESTS.partition("@pytest.mark.complexity")[0]
    sizes = str(tuple(2**k for k in range(6, 13)))
    pytester.makepyfile(clock + AMORTIZED_AND_VARIABLES.replace("SIZES", sizes))
    result = pytester.runpytest("-p", PLUGIN)
    result.assert_outcomes(passed=4, failed=1)
    result.stdout.fnmatch_lines(["*test_no_variable_is_said: *names c, r: say which*"])


def test_history_tells_calls_of_one_test_apart_and_leaves_out_what_it_cannot_read(
    pytester: pytest.Pytester,
) -> None:
    pytester.makepyfile("""
        def test_it(complexity):
            for power in (1, 2):
                now = [0.0]
                def work(n):
                    now[0] += 1e-6 * n ** power
                complexity(work, int, [10, 30, 100, 300, 1000], expected=f"O(n^{power})",
                           rounds=2, clock=lambda: now[0])
    """)
    history = pytester.path / "history.jsonl"
    for broken in ("", '3\n{"test"'):
        history.write_text((history.read_text() if history.exists() else "") + broken)
        result = pytester.runpytest("-p", PLUGIN, "--complexity-history", "history.jsonl")
        result.assert_outcomes(passed=1)
        assert result.stdout.str().count("complexity: changed") == bool(broken)
        assert result.stdout.str().count("history.jsonl: not read: line 3, 4") == bool(broken)
        assert "slope 1.00 at" not in result.stdout.str()
    kept = history.read_text().splitlines()
    assert [json.loads(kept[k])["call"] for k in (0, 1, 4, 5)] == [1, 2, 1, 2]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("", 'say what is claimed: expected="O(n)"'),
        ('expected="O(m n)"', "'O(m n)' names m, n: say which"),
        ("expected=3", 'expected is a growth class such as "O(n)", not 3'),
        ("expected=['O(n)']", "expected is a growth class such as *, not [[]'O(n)']"),
        ('expected="fast"', "unknown growth class 'fast'"),
        ('expected="O(n)", bounds="upper"', "unknown: bounds; known are *bound*"),
        ('expected="O(n)", bound="lower"', 'bound must be "tight" or "upper"'),
    ],
)
@pytest.mark.parametrize("marked", [False, True])
def test_a_mistake_is_told_in_a_line_before_anything_is_measured(
    pytester: pytest.Pytester, given: str, message: str, marked: bool
) -> None:
    mark, call = (given, "") if marked else ("", given)
    pytester.makepyfile(f"""
        import pytest

        @pytest.mark.complexity({mark})
        def test_it(complexity):
            complexity(lambda it: print("measured"), list, {call})
    """)
    result = pytester.runpytest("-p", PLUGIN)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines([f"*::test_it: {message}*"])
    assert not {"measured", "Traceback", "test_it.py:"} & {*result.stdout.str().split()}


def test_marked_tests_that_cannot_be_measured_fail(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("""
        import pytest
        import unittest

        pytestmark = pytest.mark.complexity("O(n)", make_input=list)

        class Case(unittest.TestCase):
            def test_method(self):
                pass

        async def test_coroutine(complexity_input):
            pass

        def test_of_nothing():
            pass
    """)
    result = pytester.runpytest("-p", PLUGIN)
    result.assert_outcomes(failed=3)
    names = "Case::test_method", "test_coroutine", "test_of_nothing"
    result.stdout.fnmatch_lines([f"*::{it} is not measured: a marked test is*" for it in names])


def test_what_is_no_function_is_left_alone(pytester: pytest.Pytester) -> None:
    """The plugin comes with the distribution, for whatever else is tested there."""
    pytester.makeconftest("""
        import pytest

        class Item(pytest.Item):
            def runtest(self):
                pass

        class File(pytest.File):
            def collect(self):
                yield Item.from_parent(self, name="it")

        def pytest_collect_file(parent, file_path):
            return File.from_parent(parent, path=file_path) if file_path.suffix == ".txt" else None
    """)
    pytester.maketxtfile(test_words="words")
    pytester.runpytest("-p", PLUGIN).assert_outcomes(passed=1)


def test_an_input_without_a_mark_and_a_mark_of_too_much_fail(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("""
        import pytest

        def test_unmarked(complexity_input):
            pass

        @pytest.mark.complexity("O(n)", list, [1, 2], 3)
        def test_too_much(complexity_input):
            pass
    """)
    result = pytester.runpytest("-p", PLUGIN)
    result.assert_outcomes(errors=1, failed=1)
    result.stdout.fnmatch_lines([
        "*::test_unmarked is not measured: it asks for complexity_input and has no mark*",
        "*::test_too_much: a mark complexity takes expected, make_input, sizes by position*",
    ])  # fmt: skip


def test_a_test_that_is_run_again_is_measured_again_and_kept_where_it_began(
    pytester: pytest.Pytester,
) -> None:
    pytester.makeconftest("""
        import os
        import pytest
        from _pytest.runner import runtestprotocol

        @pytest.hookimpl(tryfirst=True)
        def pytest_runtest_protocol(item, nextitem):
            for _ in range(2):
                runtestprotocol(item, nextitem=nextitem, log=False)
            return True
    """)
    pytester.makepyfile("""
        import pytest

        class Clock:
            now = 0.0
            def __call__(self):
                return self.now

        clock, calls = Clock(), []

        @pytest.mark.complexity("O(n)", sizes=[10, 30, 100, 300, 1000], rounds=2, clock=clock)
        def test_it(complexity_input, monkeypatch, tmp_path):
            monkeypatch.chdir(tmp_path)
            clock.now += 1e-6 * complexity_input
    """)
    pytester.runpytest("-p", PLUGIN, "--complexity-history", "history.jsonl")
    kept = (pytester.path / "history.jsonl").read_text().splitlines()
    assert [json.loads(line)["outcome"] for line in kept] == ["consistent"] * 2


def test_a_test_that_never_calls_what_it_asks_for_fails(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("""
        import pytest

        @pytest.mark.complexity("O(n)")
        @pytest.mark.parametrize("given", [1, 2])
        def test_marked(complexity, given):
            pass

        def test_plain(complexity):
            pass

        @pytest.fixture
        def helper(complexity):
            return complexity

        @pytest.mark.complexity("O(n)")
        def test_helped(helper):
            pass

        def test_other_reasons_come_first(complexity):
            assert False, "of its own"
    """)
    result = pytester.runpytest("-p", PLUGIN)
    result.assert_outcomes(failed=5)
    names = "test_marked?1?", "test_marked?2?", "test_plain", "test_helped"
    words = [f"*::{it} is not measured: it asks for complexity and never calls it" for it in names]
    result.stdout.fnmatch_lines([*words, "*AssertionError: of its own*"])


def test_a_fixture_that_asks_for_complexity_keeps_no_body_from_being_measured(
    run, pytester: pytest.Pytester
) -> None:
    pytester.makeconftest("""
        import pytest

        @pytest.fixture(autouse=True)
        def keep(complexity):
            yield
    """)
    pytester.makepyfile(test_plain="def test_body_of_nothing(): pass")
    result = run("-k", "test_body", power=2)
    result.assert_outcomes(passed=1, failed=1, deselected=2)
    result.stdout.fnmatch_lines(["*test_body: violated: O(n) is claimed*"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "complexity_violated=nope"), "complexity_violated is pass, warn, fail, not 'nope'"),
        (("--complexity-budget", "0"), "--complexity-budget is a number of seconds, not 0"),
        (("--complexity-budget", "inf"), "--complexity-budget is a number of seconds, not inf"),
        (("--complexity-history", "."), "--complexity-history is a file; * is a folder"),
        (("--complexity-history", "/dev/null/a/b"), "--complexity-history cannot be written: *"),
    ],
)
def test_settings_that_are_none_are_told_before_any_test(run, options, message: str) -> None:
    result = run(*options)
    result.stderr.fnmatch_lines([f"*{message}*"])
    assert "test_body" not in result.stdout.str()


def test_a_budget_of_the_command_line_goes_before_one_of_a_test(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("""
        def test_it(complexity):
            now = [0.0]
            def work(n):
                now[0] += 1e-6 * n
            complexity(work, int, expected="O(n)", budget=1e9, clock=lambda: now[0])
            assert 0.1 < now[0] < 1
    """)
    result = pytester.runpytest("-p", PLUGIN, "--complexity-budget", "0.2")
    result.assert_outcomes(passed=1)


def test_help_says_what_is_done_about_claims(run) -> None:
    words = " ".join(run("--help").stdout.str().split())
    for outcome in ("violated", "undetermined"):
        assert f"What is done about {outcome} claims: pass, warn, fail." in words


def test_history_tells_that_the_claim_is_another_and_passes_over_what_is_no_verdict(
    run, pytester: pytest.Pytester
) -> None:
    history, kept = ("-k", "test_body", "--complexity-history", "it.jsonl"), Path("it.jsonl")
    run(*history)
    before = kept.read_text()
    kept.write_text("\ufeff" + before.replace('"O(n)", "outcome"', '"O(1)", "outcome"').replace(
        "consistent", "violated"), "utf-8")  # fmt: skip
    result = run(*history)
    result.stdout.fnmatch_lines(
        ["*: O(1) is claimed, violated, O(n), *; O(n) is claimed, consistent, O(n), *"]
    )
    line = json.loads(before)
    answer = {"answer": "O(n²)"}
    up, down = ({"slope": it, "slope_low": it - 0.1, "slope_high": it + 0.1} for it in (2, 0.2))
    for other, changed in ((answer, 0), (up, 0), (answer | up, 1), (answer | down, 1)):
        kept.write_text(json.dumps(line | other) + "\n")
        assert ("complexity: changed" in run(*history).stdout.str()) == changed
    kept.write_text(json.dumps(line | {"slope_low": None}) + "\n")
    result = run(*history)
    result.assert_outcomes(passed=1, deselected=2)
    result.stdout.fnmatch_lines(["*it.jsonl: not read: line 1"])


def test_a_mark_takes_its_first_options_by_place(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("""
        import pytest

        @pytest.mark.complexity("O(n)", lambda n: "x" * n, [10, 20, 30], rounds=1)
        def test_it(complexity_input):
            assert isinstance(complexity_input, str)
    """)
    result = pytester.runpytest("-p", PLUGIN)
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*Too few sizes: 3*"])


def test_pytest_benchmark_works_beside(pytester: pytest.Pytester) -> None:
    pytest.importorskip("pytest_benchmark")
    pytester.makepyfile("""
        def test_it(benchmark, complexity):
            benchmark.pedantic(len, ([],))
            complexity(len, lambda n: [0] * n, [10, 20, 40, 80], expected="O(1)", rounds=1)
    """)
    judged = pytester.runpytest("-p", PLUGIN, "--complexity-violated=pass")  # on a busy machine
    judged.assert_outcomes(passed=1)
