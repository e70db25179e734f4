"""Laws of reading costs: what other tools wrote is told as they measured it."""

import json
from pathlib import Path
from typing import Any

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
    ("content", "name"),
    [(PYTEST_BENCHMARK, "test_sort"), (GOOGLE, "BM_Sort"), (HYPERFINE, "sort {n}"), (CSV, "sort")],
    ids=["pytest-benchmark", "Google Benchmark", "hyperfine", "CSV"],
)
def test_samples_are_told_by_size(tmp_path: Path, content: Any, name: str) -> None:
    file = tmp_path / "costs"
    file.write_text(content if isinstance(content, str) else json.dumps(content))
    (curve,) = read_curves(file)
    assert (curve.name, curve.parameter) == (name, "n")
    assert curve.sizes.tolist() == [10, 20]
    assert [row.tolist() for row in curve.samples] == [[3, 4], [7]]


def test_parameters_that_are_not_asked_for_are_held_fixed(tmp_path: Path) -> None:
    runs = [
        {"name": f"BM/n:{n}/m:{m}/real_time", "real_time": n * m, "cpu_time": 1}
        for n in (1, 2)
        for m in (5, 6)
    ]
    file = tmp_path / "costs.json"
    file.write_text(json.dumps({"benchmarks": runs}))
    assert [it.name for it in read_curves(file, "n")] == ["BM/real_time, m=5", "BM/real_time, m=6"]
    assert [row.tolist() for row in read_curves(file, "n")[1].samples] == [[6], [12]]
    with pytest.raises(ValueError, match="varies n, m: say which"):
        read_curves(file)
    with pytest.raises(ValueError, match="no parameter 'k'"):
        read_curves(file, "k")


def test_runs_that_failed_are_skipped_and_named(tmp_path: Path) -> None:
    failed = {"name": "BM_Sort/30", "error_occurred": True, "error_message": "no room"}
    (tmp_path / "file").write_text(json.dumps({"benchmarks": [*GOOGLE["benchmarks"], failed]}))
    with pytest.warns(UserWarning, match="BM_Sort/30 failed and is skipped"):
        (curve,) = read_curves(tmp_path / "file")
    assert curve.sizes.tolist() == [10, 20]


def test_cells_may_be_empty_and_a_file_that_is_no_text_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("n,a,b\n1,2,\n2, ,4\n3,5,6\n")
    assert [it.sizes.tolist() for it in read_curves(tmp_path / "file")] == [[1, 3], [2, 3]]
    (tmp_path / "binary").write_bytes(b"\x7fELF\xff")
    with pytest.raises(ValueError, match="binary is no text"):
        read_curves(tmp_path / "binary")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("words", "no CSV of costs"),
        ("n,a\n1,2\nx,3\n", "row 3"),
        ("n,a\n1,2\n2,3 s\n", "row 3, a: '3 s' is no number"),
        ("n,a\n1,2\n1,3\n", "nothing varies"),
        ("{}", "no JSON of"),
        ("{", "no JSON of"),
    ],
)
def test_what_is_wrong_with_a_file_is_named(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "file").write_text(text)
    with pytest.raises(ValueError, match=message):
        read_curves(tmp_path / "file")
