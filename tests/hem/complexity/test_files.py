"""Laws of reading costs: what other tools wrote is told as they measured it."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hem.complexity import read_curves

PYTEST_BENCHMARK: dict[str, Any] = {
    "machine_info": {},
    "benchmarks": [
        {"name": "test_sort[10]", "params": {"n": 10}, "stats": {"data": [3, 4], "median": 3.5}},
        {"name": "test_sort[20]", "params": {"n": 20}, "stats": {"median": 7.0}},
    ],
}
GOOGLE: dict[str, Any] = {
    "context": {},
    "benchmarks": [
        {"name": "BM_Sort/10", "run_name": "BM_Sort/10", "run_type": "iteration", "cpu_time": 3},
        {"name": "BM_Sort/10", "run_name": "BM_Sort/10", "run_type": "iteration", "cpu_time": 4},
        {"name": "BM_Sort/20", "run_name": "BM_Sort/20", "run_type": "iteration", "cpu_time": 7},
        {"name": "BM_Sort_BigO", "run_type": "aggregate", "aggregate_name": "BigO", "cpu_time": 1},
    ],
}
HYPERFINE: dict[str, Any] = {
    "results": [
        {"command": "sort 10", "parameters": {"n": "10"}, "times": [3, 4]},
        {"command": "sort 20", "parameters": {"n": "20"}, "mean": 7.0},
    ]
}
CSV = "n,sort\n10,3\n20,7\n10,4\n"


@pytest.mark.parametrize(
    ("content", "name", "unit"),
    [
        (PYTEST_BENCHMARK, "test_sort", 1),
        (GOOGLE, "BM_Sort", 1e-9),
        (HYPERFINE, "sort {n}", 1),
        (CSV, "sort", 1),
    ],
    ids=["pytest-benchmark", "Google Benchmark", "hyperfine", "CSV"],
)
def test_samples_are_told_by_size(tmp_path: Path, content: Any, name: str, unit: float) -> None:
    file = tmp_path / "costs"
    file.write_text(content if isinstance(content, str) else json.dumps(content))
    for path in (file, str(file)):
        (curve,) = read_curves(path)
        assert (curve.name, curve.parameter) == (name, "n")
    assert curve.sizes.tolist() == [10, 20]
    for row, told in zip(curve.samples, ([3, 4], [7]), strict=True):
        assert row / unit == pytest.approx(told)


def test_times_of_several_units_are_one_curve_of_seconds(tmp_path: Path) -> None:
    units = {10: ("ns", 1e9), 20: ("us", 1e6), 30: ("ms", 1e3), 40: ("s", 1)}
    runs = [
        {"name": f"BM/{n}", "cpu_time": n * per, "time_unit": unit}
        for n, (unit, per) in units.items()
    ]
    (tmp_path / "file").write_text(json.dumps({"benchmarks": runs}))
    (curve,) = read_curves(tmp_path / "file")
    assert [it[0] for it in curve.samples] == pytest.approx([*units])


def test_parameters_that_are_not_asked_for_are_held_fixed(tmp_path: Path) -> None:
    runs = [
        {"name": f"BM/n:{n}/m:{m}/real_time", "real_time": n * m, "cpu_time": 1}
        for n in (1, 2)
        for m in (5, 6)
    ]
    file = tmp_path / "costs.json"
    file.write_text(json.dumps({"benchmarks": runs}))
    assert [it.name for it in read_curves(file, "n")] == ["BM/real_time, m=5", "BM/real_time, m=6"]
    six = read_curves(file, "n")[1]
    assert [row[0] / 1e-9 for row in six.samples] == pytest.approx([6, 12])
    assert six.fixed == ("m",)
    with pytest.raises(ValueError, match="varies n, m: say which"):
        read_curves(file)
    with pytest.raises(ValueError, match="no parameter 'k'"):
        read_curves(file, "k")


def curves_of(path: Path, content: dict[str, Any], parameter: str | None = None) -> dict[str, Any]:
    """By the name of a curve its sizes."""
    path.write_text(json.dumps(content))
    return {it.name: it.sizes.tolist() for it in read_curves(path, parameter)}


def written_of(*rows: tuple[str, dict[str, Any] | None, dict[str, Any]]) -> dict[str, Any]:
    """What pytest-benchmark writes of tests: by full name, parameters and extra information."""
    return {
        "machine_info": {},
        "benchmarks": [
            {
                "name": full.rpartition("::")[2], "fullname": full, "params": parameters,
                "extra_info": extra, "stats": {"median": 1.0},
            }
            for full, parameters, extra in rows
        ],
    }  # fmt: skip


def test_tests_of_one_name_are_two_curves(tmp_path: Path) -> None:
    rows = [
        (f"a.py::{it}::test_append[{n}]", {"n": n}, {}) for it in ("List", "Deque") for n in (1, 2)
    ]
    assert curves_of(tmp_path / "file", written_of(*rows)) == {
        "a.py::List::test_append": [1, 2],
        "a.py::Deque::test_append": [1, 2],
    }


def test_extra_information_is_a_parameter_where_a_test_has_none(tmp_path: Path) -> None:
    rows = [(f"a.py::test[{n}]", {"n": n}, {"comparisons": n * n}) for n in (1, 2)]
    assert curves_of(tmp_path / "file", written_of(*rows)) == {"test": [1, 2]}
    rows = [("a.py::test[x]", {"kind": "x"}, {"size": n}) for n in (1, 2)]
    assert curves_of(tmp_path / "file", written_of(*rows)) == {"test, x": [1, 2]}


@pytest.mark.parametrize(
    "command", ["sort data_{n}.txt", "head -c{n} f", "sha1sum -n {n}", "sort -k2 {n}"]
)
def test_a_command_is_one_curve_wherever_its_parameter_stands(tmp_path: Path, command: str) -> None:
    runs = [
        {"command": command.format(n=n), "parameters": {"n": str(n)}, "mean": 1.0}
        for n in (1, 2, 10)
    ]
    assert curves_of(tmp_path / "file", {"results": runs}) == {command: [1, 2, 10]}


def test_two_parameters_of_a_command_may_have_one_value(tmp_path: Path) -> None:
    runs = [
        {"command": f"x {n} {m}", "parameters": {"n": str(n), "m": str(m)}, "mean": 1.0}
        for n in (10, 100) for m in (10, 100)
    ]  # fmt: skip
    found = curves_of(tmp_path / "file", {"results": runs}, "n")
    assert found == {"x {n} {m}, m=10": [10, 100], "x {n} {m}, m=100": [10, 100]}


def test_each_number_of_threads_is_a_curve(tmp_path: Path) -> None:
    runs = [
        {"name": f"BM/{n}/min_time:{t}/min_warmup_time:1/threads:{t}", "cpu_time": n * t}
        for n in (1, 2) for t in (1, 8)
    ]  # fmt: skip
    runs += [{"name": f"BI/{n}/iterations:{9 - n}/repeats:{n}", "cpu_time": n} for n in (3, 4)]
    found = curves_of(tmp_path / "file", {"benchmarks": runs}, "n")
    assert found == {"BM, threads=1": [1, 2], "BM, threads=8": [1, 2], "BI": [3, 4]}


def test_arguments_without_names_are_told_by_their_places(tmp_path: Path) -> None:
    runs = [{"name": f"BM/{n}/{m}", "cpu_time": n} for n in (1, 2) for m in (7, 8)]
    runs += [{"name": f"BK/k:3/{n}", "cpu_time": n} for n in (5, 6)]
    runs += [{"name": "BM_of_nothing", "cpu_time": 9}]
    found = curves_of(tmp_path / "file", {"benchmarks": runs}, "argument 1")
    assert found == {"BM, argument 2=7": [1, 2], "BM, argument 2=8": [1, 2], "BK, k=3": [5, 6]}


def test_runs_that_failed_are_skipped_and_named(tmp_path: Path) -> None:
    failed = [{"name": "BM_Sort/30", key: True} for key in ("error_occurred", "skipped")]
    (tmp_path / "file").write_text(json.dumps({"benchmarks": [*GOOGLE["benchmarks"], *failed]}))
    with pytest.warns(UserWarning, match="BM_Sort/30 failed and is skipped"):
        (curve,) = read_curves(tmp_path / "file")
    assert curve.sizes.tolist() == [10, 20]


def test_commands_that_failed_cost_nothing(tmp_path: Path) -> None:
    runs = [
        {"command": f"sort {n}", "parameters": {"n": str(n)}, "times": [n, 1, n], "exit_codes": it}
        for n, it in ((30, [127, 127, 127]), (10, [0, 127, 0]), (20, [0, 0, 0]))
    ]
    (tmp_path / "file").write_text(json.dumps({"results": runs}))
    with pytest.warns(UserWarning, match="sort 10: 1 of 3 runs failed and are skipped"):
        (curve,) = read_curves(tmp_path / "file")
    assert [it.tolist() for it in curve.samples] == [[10, 10], [20, 1, 20]]


def test_commands_without_times_may_have_exit_codes(tmp_path: Path) -> None:
    runs = [
        {"command": f"x {n}", "parameters": {"n": str(n)}, "mean": n, "exit_codes": [0, 0]}
        for n in (1, 2)
    ]
    assert curves_of(tmp_path / "file", {"results": runs}) == {"x {n}": [1, 2]}


@pytest.mark.parametrize("command", ["sort {n}", "sort {n} --as={kind}"])
def test_each_program_that_a_command_was_given_is_a_curve(tmp_path: Path, command: str) -> None:
    runs = [
        {"command": command.format(n=n, kind=it), "parameters": {"n": n, "kind": it}, "mean": 1.0}
        for n in ("1", "2") for it in ("s", "sorted", "*")
    ]  # fmt: skip
    named = command if "kind" in command else "sort {n}, {kind}"
    assert curves_of(tmp_path / "file", {"results": runs}) == {
        named.replace("{kind}", it): [1, 2] for it in ("s", "sorted", "*")
    }


def test_of_each_benchmark_the_runs_are_read_or_else_the_median(tmp_path: Path) -> None:
    def aggregate(name: str, n: int, of: str) -> dict[str, Any]:
        run = {"name": f"{name}/{n}_{of}", "run_name": f"{name}/{n}", "cpu_time": len(of)}
        return run | {"run_type": "aggregate", "aggregate_name": of}

    runs = [{"name": f"BM_T/{n}", "run_type": "iteration", "cpu_time": n} for n in (1, 2)]
    failed = {"name": "BM_F/1", "run_type": "iteration", "error_occurred": True}
    told = [
        aggregate(name, n, of) for name in ("BM_S", "BM_T", "BM_F") for n in (1, 2)
        for of in ("mean", "median", "stddev")
    ]  # fmt: skip
    content = {"benchmarks": [*told, *runs, failed]}
    (tmp_path / "file").write_text(json.dumps(content))
    with pytest.warns(UserWarning, match="BM_F/1 failed"):
        found = {it.name: it for it in read_curves(tmp_path / "file")}
    assert {name: it.sizes.tolist() for name, it in found.items()} == {
        name: [1, 2] for name in ("BM_S", "BM_F", "BM_T")
    }
    assert [row[0] / 1e-9 for row in found["BM_T"].samples] == pytest.approx([1, 2])
    assert np.array(found["BM_S"].samples) / 1e-9 == pytest.approx(np.full((2, 1), len("median")))


def test_objects_and_what_is_no_number_split_no_curve(tmp_path: Path) -> None:
    rows = [
        ("a.py::t[g]", {"n": n, "g": f"UNSERIALIZABLE[<t.G object at {n:#x}>]", "m": "nan"}, {})
        for n in (1, 2)
    ]
    assert curves_of(tmp_path / "file", written_of(*rows)) == {"t, nan": [1, 2]}
    given = {"t, up": "up", "t, True": True, "t, None": None, "t, [1, 2]": [1, 2]}
    rows = [(f"a.py::t[{k}]", {"n": n, "k": k}, {}) for n, k in enumerate(given.values(), 1)]
    rows += [("a.py::plain", None, {})]
    found = curves_of(tmp_path / "file", written_of(*rows))
    assert found == {name: [n] for n, name in enumerate(given, 1)}


def test_each_function_and_object_that_a_test_was_given_is_a_curve(tmp_path: Path) -> None:
    given = ["<class 'list'>", "<function f at 0x1a>", "<t.A object at 0x2>", "<t.A object at 0x3>"]
    rows = [
        (f"a.py::t[{n}-{k}]", {"n": n, "f": f"UNSERIALIZABLE[{it}]"}, {})
        for n in (1, 2) for k, it in enumerate(given)
    ]  # fmt: skip
    found = curves_of(tmp_path / "file", written_of(*rows))
    assert [*found.values()] == [[1, 2]] * 4
    assert [*found][:2] == ["t, <class 'list'>", "t, <function f>"]
    assert all(it in name for it, name in zip(given[2:], [*found][2:], strict=True))


def test_spaces_around_names_of_columns_are_none_of_theirs(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("n , f\n1,2\n2,3\n")
    (curve,) = read_curves(tmp_path / "file", "n")
    assert (curve.name, curve.parameter) == ("f", "n")


def test_values_that_differ_in_the_last_digit_are_two_curves(tmp_path: Path) -> None:
    rows = [(f"a.py::t[{n}-{k}]", {"n": n, "k": k}, {}) for n in (1, 2) for k in (2**20, 2**20 + 1)]
    (tmp_path / "file").write_text(json.dumps(written_of(*rows)))
    names = [it.name for it in read_curves(tmp_path / "file", "n")]
    assert names == ["t, k=1048576", "t, k=1048577"]


def test_cells_may_be_empty_and_a_file_that_is_no_text_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("n,a,b\n1,2,\n2, ,4\n,,\n3,5,6\n4,7\n")
    assert [it.sizes.tolist() for it in read_curves(tmp_path / "file")] == [[1, 3, 4], [2, 3]]
    (tmp_path / "file").write_text("1,,5\n2,3,4\n")
    found = [(it.name, it.parameter, it.sizes.tolist()) for it in read_curves(tmp_path / "file")]
    assert found == [("column 3", "n", [1, 2]), ("column 2", "n", [2])]
    (tmp_path / "binary").write_bytes(b"\x7fELF\xff")
    with pytest.raises(ValueError, match="binary is no text"):
        read_curves(tmp_path / "binary")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("words", "no CSV of costs"),
        ("n;a\n1;2\n2;3\n", "commas between"),
        ("n,a\n1,2\nx,3\n", "row 3"),
        ("n,a\n\n1,2\nx,3\n", "row 4"),
        ("n,a\n1,2\n2,3,4\n", "row 3: a size and a number"),
        ("-1,2\n2,3\n", "column 2: n is -1, and sizes are at least 1"),
        ("n,a\n1,2\n2,3 s\n", "row 3, a: '3 s' is no number"),
        ("n,a\n1,2\n1,3\n", "nothing varies"),
        ("n,a,a\n1,2,3\n2,3,4\n", "two columns 'a'"),
        ("n,fast\n1,0\n2,3\n", "fast, n=1: a cost is positive, not 0"),
        ("n,a\n1,nan\n2,3\n", "row 2, a: 'nan' is no number"),
        ("n,a\n0,2\n1,3\n", "a: n is 0, and sizes are at least 1"),
        ("n,a\nnan,2\n1,3\n", "row 2: a size and a number"),
        ("1O00,1\n2000,2\n", "row 1: a size and a number"),
        ("n,a\n1," + "9" * 200_000, "no CSV of costs: field larger"),
        ("{}", "no JSON of .*: it has no benchmarks and no results"),
        ("[1, 2]", "no JSON of"),
        ('{"results": [{"command": "f", "mean": 1}]}', "nothing varies"),
        ('{"benchmarks": [{"name": "f/1"}]}', "no JSON of"),
        ('{"benchmarks": ["f/1"]}', "no JSON of"),
        ("{", "no JSON of"),
        ("[" * 100_000, "no JSON of"),
        ('{"results": [{"command": "f 1", "mean": null}]}', "no JSON of"),
        ('{"results": [{"command": "f 1", "times": ["1 s"]}]}', "no JSON of"),
        ('{"machine_info": 0, "benchmarks": [{"name": "f", "stats": {"median": null}}]}', "JSON"),
        (f'{{"results": [{{"command": "f 1", "mean": 1{"0" * 400}}}]}}', "no JSON of"),
        ("", "no CSV of costs"),
    ],
)
def test_what_is_wrong_with_a_file_is_named(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "file").write_text(text)
    with pytest.raises(ValueError, match=message):
        read_curves(tmp_path / "file")
