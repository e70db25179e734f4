"""Laws of the figures on speed: every program's work is there, and the least of it stands."""

import json
from importlib.metadata import distributions, version
from pathlib import Path

import pytest
from typer import BadParameter

from experiments.peers import OURS
from experiments.report.peers import LIKE, beside_ours
from experiments.validation import speed
from structures import REGISTRY
from tests.extent import exhaustive

ROOT = Path(__file__).parents[3]
WORKS = {work for works in speed.WORKS.values() for work in works}


def test_the_least_of_several_turns_stands(tmp_path) -> None:
    rows = [("build", 100, "one", LIKE, it) for it in (3.0, 2.0, 4.0)]
    (tmp_path / "kept").write_text(json.dumps({"columns": speed.COLUMNS, "rows": rows}))
    _, found = speed.load_speed(tmp_path / "kept")
    assert found.loc[("build", 100, "one"), LIKE] == 2


def test_a_table_has_half_edges_as_measured_and_how_many_times_that_others_take(tmp_path) -> None:
    rows = [
        ("build", 100, "all", LIKE, 0.002),
        ("build", 100, "all", "openmesh", 0.006),
        ("rms", 100, "one", LIKE, 0.01),
        ("simplify", 100, "one", "winged_edge", 9),
    ]
    (tmp_path / "kept").write_text(json.dumps({"columns": speed.COLUMNS, "rows": rows}))
    _, found = speed.load_speed(tmp_path / "kept")
    works = {"build": "Build", "rms": "Error"}
    assert beside_ours(found, works, speed.ERRORS) == [
        ["", "vertices", "Half-Edge", "OpenMesh"],
        ["Build, all cores", "100", "2.0 ms", "3.0 ×"],
        ["Error", "100", "1.0 %", "N/A"],
    ]


def test_the_kept_run_has_every_work_of_each_of_our_structures() -> None:
    kept, found = speed.load_speed(ROOT / speed.RESULT)
    assert not kept["dirty"]
    ours = found.dropna(subset=[LIKE])
    assert {work for work, *_ in ours.index} == WORKS
    assert not ours[list(speed.STRUCTURES)].isna().any(axis=None)
    assert set(speed.COMPILED) | set(speed.BUILT) | set(speed.ASKED_SINGLY) <= {*found.columns}
    assert {size for _, size, _ in found.index} == {*speed.SIZES}


def test_every_library_of_the_kept_run_will_have_its_version_kept() -> None:
    pytest.importorskip("fast_simplification")
    _, found = speed.load_speed(ROOT / speed.RESULT)
    libraries = {*found.columns} - {*REGISTRY}
    told = speed.describe("")["versions"] | speed.versions()
    assert libraries - {*told} == set()
    assert told["fast-simplification"] == version("fast-simplification")
    assert told["openmesh"] in {"", *(it.version for it in distributions(name="openmesh"))}


def test_a_folder_that_is_not_there_is_told_before_anything_is_measured(tmp_path) -> None:
    with pytest.raises(BadParameter, match="there is no folder"):
        speed.main(tmp_path / "missing" / "speed.json")


@exhaustive
def test_all_works_are_measured_of_one_structure(monkeypatch) -> None:
    pytest.importorskip("pymeshlab")
    monkeypatch.setattr(speed, "STRUCTURES", [LIKE])
    for libraries in ("COMPILED", "BUILT", "ASKED_SINGLY"):
        monkeypatch.setattr(speed, libraries, ())
    made = {OURS: speed.simplifiers()[LIKE]}
    monkeypatch.setattr(speed, "simplifiers", lambda: made)
    rows = speed.measured(speed.ALL, 400, 200) + speed.measured(speed.ONE, 400, 200)
    assert {work for work, *_ in rows} == WORKS
    assert all(value > 0 for *_, value in rows)
