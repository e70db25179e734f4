"""pytest-benchmark's own storage and comparison, as the README tells to use them."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tests.extent import exhaustive

ROOT = Path(__file__).parents[3]
COMMAND = (
    "experiments/bench_queries.py --profile smoke --structure half_edge "
    "-k vertex_faces -q -p no:cacheprovider"
)


def bench(storage: Path, *more: str) -> tuple[int, str]:
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *COMMAND.split(), f"--benchmark-storage={storage}", *more],
        cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """The storage after ``--benchmark-save before``."""
    storage = tmp_path_factory.mktemp("storage")
    code, output = bench(storage, "--benchmark-save=before", "--benchmark-save-data")
    assert code == 0, output
    return storage


def content(storage: Path) -> tuple[Path, dict]:
    (path,) = storage.glob("*/0001_before.json")
    return path, json.loads(path.read_text())


def test_what_is_saved_is_per_query_and_says_what_it_is_of(saved):
    _, found = content(saved)
    assert len(found["benchmarks"]) == 6  # of two sizes, each in two orders; of two valences
    assert found["commit_info"]["id"]
    assert found["machine_info"]["cpu"]
    for benchmark in found["benchmarks"]:
        about, stats = benchmark["extra_info"], benchmark["stats"]
        assert benchmark["name"] == f"test_query[half_edge/{about['id']}]"
        assert about["handles"] > 10
        assert about["checked"]
        assert stats["median"] < 1e-4  # one query; a round of them lasts 0.2 ms


@pytest.mark.parametrize(
    ("factor", "code"), [pytest.param(1000.0, 0, marks=exhaustive), (0.001, 1)]
)
def test_a_comparison_fails_if_and_only_if_it_got_slower(saved, tmp_path, factor, code):
    """As if it had been a thousand times as slow, and as fast, before."""
    path, found = content(saved)
    for benchmark in found["benchmarks"]:
        for figure in ("min", "max", "mean", "median", "stddev", "iqr", "q1", "q3"):
            benchmark["stats"][figure] *= factor
    before = tmp_path / path.parent.name / path.name
    before.parent.mkdir()
    before.write_text(json.dumps(found))
    returned, output = bench(
        tmp_path, "--benchmark-compare=0001", "--benchmark-compare-fail=median:99%"
    )
    assert returned == code, output
    assert "Comparing against benchmarks from:" in output
    assert bool(re.search("Performance has regressed", output)) == bool(code)


@pytest.fixture
def below():
    """A storage below the working directory, where pytest-benchmark can name it in a warning."""
    (ROOT / ".benchmarks").mkdir(exist_ok=True)
    with TemporaryDirectory(dir=ROOT / ".benchmarks", prefix="test-") as folder:
        yield Path(folder)


@exhaustive
def test_another_machine_is_not_compared_silently(saved, below):
    path, found = content(saved)
    found["machine_info"]["cpu"]["brand_raw"] = "another"
    found["machine_info"]["node"] = "elsewhere"
    before = below / path.parent.name / path.name
    before.parent.mkdir()
    before.write_text(json.dumps(found))
    code, output = bench(below, "--benchmark-compare=0001")
    assert code == 0, output
    assert "machine_info is different" in output
