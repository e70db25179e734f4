from __future__ import annotations

from pathlib import Path

import pytest

from experiments.claims import shards
from experiments.report.fracture_figures import face_finding, shards_per_second
from experiments.runs import results
from tests.experiments.made_runs import write_run


@pytest.fixture
def run(tmp_path: Path) -> results.Run:
    return results.load(write_run(tmp_path / "run"))


def test_walks_and_scans_are_told_apart_by_their_growth(run):
    found = shards.found(run).set_index("way")
    slopes = {way: float(case.split()[0]) for way, case in found["visited"].items()}
    assert slopes["walk"] == pytest.approx(0.5, abs=0.03)
    assert slopes["jump and walk"] == pytest.approx(1 / 3, abs=0.05)
    assert slopes["scan"] == pytest.approx(1, abs=0.01)
    assert found["visited"]["walk"].endswith("O(√n)")


def test_structures_are_compared_with_the_indexed_mesh_at_its_size(run):
    table = shards.shattered(run).set_index("structure")
    assert table["faster"]["Indexed"] == 1
    assert table["faster"]["Half-Edge"] == pytest.approx(200_000)
    assert (table["vertices"] == 100_000).all()


def test_a_run_of_before_there_was_destruction_gives_empty_tables(run):
    older = run.cases[run.cases["experiment"] != "bench_fracture"]
    before = results.Run(run.folder, run.meta, older, run.skipped)
    assert shards.shattered(before).empty
    assert shards.found(before).empty
    assert shards.styled(shards.found(before), shards.FOUND)
    shards_per_second(before).draw_without_rendering()
    face_finding(before).draw_without_rendering()
