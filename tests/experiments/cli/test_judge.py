"""Laws of `hem judge`: the exit code is the verdict, and a mistake gets one clear line."""

import json
from functools import partial
from pathlib import Path

import pytest

from tests.experiments.cli import calls

SIZES = [100 * 4**k for k in range(6)]


hem = partial(calls.hem, "judge")


@pytest.fixture
def costs(tmp_path: Path) -> Path:
    """A quadratic function and a linear one."""
    rows = [f"{n},{1e-9 * n**2 * k},{1e-8 * n * k}" for n in SIZES for k in (0.99, 1, 1.01, 1.02)]
    file = tmp_path / "costs.csv"
    file.write_text("\n".join(["n,pairs,scan", *rows]))
    return file


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ((), 0),
        (("--expected", "O(n)"), 1),
        (("--expected", "O(n^2)", "--upper"), 0),
        (("--expected", "n log n", "--upper"), 1),
        (("--expected", "O(n²·m)", "--upper", "--parameter", "n"), 0),
        (("--expected", "O(n·m²)", "--upper"), 1),
    ],
)
def test_the_exit_code_is_the_worst_verdict(costs: Path, arguments: tuple[str], code: int) -> None:
    told, words = hem(str(costs), *arguments)
    assert told == code
    assert "O(n²)" in words


def test_too_little_data_cannot_be_told(tmp_path: Path) -> None:
    file = tmp_path / "few.csv"
    file.write_text("n,a\n1,1\n2,2\n3,3\n")
    code, words = hem(str(file), "--expected", "O(n)")
    assert code == 2
    assert "Too few sizes" in words
    assert "Too few sizes" in hem(str(file))[1]  # without a claim, too


def test_a_reason_answers_no_claim_that_nobody_made(tmp_path: Path) -> None:
    file = tmp_path / "open.csv"
    rows = [f"{n},{n * k}" for n in (1_000, 4_000, 16_000, 64_000) for k in (0.99, 1, 1.01)]
    file.write_text("\n".join(["n,a", *rows]))
    words = " ".join(hem(str(file))[1].split())
    assert "O(√n) and O(n log n) are not ruled out" in words
    assert "O(1)" not in words


def test_a_bound_needs_a_claim(costs: Path) -> None:
    code, words = hem(str(costs), "--upper")
    assert code == 2
    assert "--upper is of a claim" in words


@pytest.mark.parametrize("head", ["rows", "nv", "n_v", "n", "O"])
def test_the_variable_of_a_claim_is_named_as_the_sizes_are(
    costs: Path, tmp_path: Path, head: str
) -> None:
    file = tmp_path / "named.csv"
    file.write_text(costs.read_text().replace("n,pairs,scan", f"{head},pairs,scan [/ms]"))
    _, words = hem(str(file), "--json", "--expected", f"O({head}·m log m)")
    assert [it["outcome"] for it in json.loads(words)] == ["violated", "consistent"]
    assert "scan [/ms]" in hem(str(file), "--expected", f"O({head})")[1]
    _, words = hem(str(file), "--json", "--expected", "O(k)")  # any letter of one, as ever
    assert [it["outcome"] for it in json.loads(words)] == ["violated", "consistent"]


def test_a_claim_on_what_is_held_fixed_is_no_claim_on_the_sizes(tmp_path: Path) -> None:
    runs = [
        {"name": f"BM/n:{n}/m:{m}", "cpu_time": n * m} for n in (8, 64, 512, 4096) for m in (3, 30)
    ]
    file = tmp_path / "two.json"
    file.write_text(json.dumps({"benchmarks": runs}))
    asked = str(file), "--exact", "--parameter", "n", "--expected"
    assert [hem(*asked, claim)[0] for claim in ("O(n)", "O(m)", "O(n·m)")] == [0, 1, 0]
    assert "names k, n_held: say which" in hem(*asked, "O(k·m)")[1]  # k may be meant for n
    for name in ("Log", "O"):  # a claim is written with them
        file.write_text(json.dumps({"benchmarks": runs}).replace("m:", f"{name}:"))
        assert [hem(*asked, it)[0] for it in ("O(n)", "O(log n)", "O(log(n))")] == [0, 1, 1]


@pytest.mark.parametrize(("varied", "held"), ["Nn", "nN"])
def test_parameters_that_differ_in_case_alone_are_told_apart(
    tmp_path: Path, varied: str, held: str
) -> None:
    runs = [
        {"name": f"BM/{varied}:{x}/{held}:{y}", "cpu_time": x * y}
        for x in (8, 64, 512, 4096)
        for y in (3, 30)
    ]
    file = tmp_path / "two.json"
    file.write_text(json.dumps({"benchmarks": runs}))
    asked = str(file), "--exact", "--parameter", varied, "--expected"
    assert [hem(*asked, f"O({it})")[0] for it in (varied, held)] == [0, 1]


def test_sizes_without_a_name_are_judged(costs: Path) -> None:
    costs.write_text(costs.read_text().replace("n,pairs", ",pairs"))
    assert hem(str(costs), "--expected", "O(n)")[0] == 1
    assert "say which of them is varied" in hem(str(costs), "--expected", "O(n·m)")[1]


def test_json_says_what_the_table_says(costs: Path) -> None:
    _, words = hem(str(costs), "--json", "--expected", "linear")
    pairs, scan = json.loads(words)
    assert (pairs["function"], pairs["answer"], pairs["outcome"]) == ("pairs", "O(n²)", "violated")
    assert (scan["function"], scan["answer"], scan["outcome"]) == ("scan", "O(n)", "consistent")
    assert "outcome" not in json.loads(hem(str(costs), "--json")[1])[0]


def test_costs_are_drawn_into_a_file(costs: Path, tmp_path: Path) -> None:
    hem(str(costs), "--expected", "O(n)", "--plot", str(tmp_path / "costs.svg"))
    assert "scan" in (tmp_path / "costs.svg").read_text()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("none.csv",), "none.csv"),
        (("{costs}", "--expected", "fast"), "unknown growth class 'fast'"),
        (("{costs}", "--parameter", "m"), "no parameter 'm'; there are: n"),
        (("{costs}", "--expected", ""), "unknown growth class ''"),
    ],
)
def test_a_mistake_gets_one_clear_line(costs: Path, arguments: list[str], message: str) -> None:
    code, words = hem(*(it.format(costs=costs) for it in arguments))
    assert code == 2
    assert message in words
    assert words.count("\n") == 1
