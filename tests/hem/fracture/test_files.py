"""Pieces as files, and the numbers that are told of them."""

from __future__ import annotations

import itertools
import json
import os
import sys
from dataclasses import replace

import numpy as np
import pytest

import hem
import structures
from hem.fracture import MATERIALS, shatter
from hem.fracture.blow import Blow, motion
from hem.fracture.bodies.voronoi import voronoi
from hem.fracture.files import describe, names, require_writable, save_pieces, whole


@pytest.fixture(scope="module")
def broken():
    mesh = hem.generate("torus", 200)
    return voronoi(mesh, mesh.points[0], MATERIALS["glass"], 1.0)


@pytest.fixture(scope="module")
def sheet():
    return shatter(structures.build("half_edge", hem.generate("grid", 64)), (0.4, 0.4, 0), "stone")


def corners(mesh) -> np.ndarray:
    return mesh.points[mesh.triangles]


@pytest.mark.parametrize("package", ["manifold3d", "trimesh"])
def test_without_a_package_the_error_names_what_brings_it(sheet, tmp_path, monkeypatch, package):
    make = {
        "manifold3d": lambda: voronoi(hem.generate("sphere", 162), (0, 0, 1), "glass"),
        "trimesh": lambda: save_pieces(sheet, tmp_path, "glb"),
    }
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(hem.NotInstalledError, match=rf"{package}.*'hem-mesh\[fracture\]'"):
        make[package]()
    assert not list(tmp_path.iterdir())


def test_glb_holds_a_node_for_every_piece_turned_so_that_up_is_y(broken, tmp_path):
    import trimesh

    (path,) = save_pieces(broken, tmp_path, "glb", up=(0, 0, 1))
    scene = trimesh.load(path)
    assert set(scene.graph.nodes_geometry) == set(names(broken))
    for name, piece in zip(names(broken), broken.pieces, strict=True):
        turn, geometry = scene.graph[name]
        np.testing.assert_array_equal(scene.geometry[geometry].triangles, corners(piece))
        np.testing.assert_allclose(turn[:3, :3] @ (0, 0, 1), (0, 1, 0), atol=1e-12)


def test_obj_holds_a_group_for_every_piece_to_the_last_bit(broken, tmp_path):
    (path,) = save_pieces(broken, tmp_path, "obj")
    text = path.read_text()
    assert [line[2:] for line in text.splitlines() if line.startswith("o ")] == names(broken)
    whole_mesh = hem.load(path)
    every = np.concatenate([corners(piece) for piece in broken.pieces])
    np.testing.assert_array_equal(corners(whole_mesh), every)


def test_a_material_of_any_name_can_be_saved(broken, tmp_path):
    named = replace(broken, material=replace(broken.material, name="Größe 石\nv 1 2 3"))
    for format in ("glb", "obj"):
        (path,) = save_pieces(named, tmp_path, format)
        every = np.concatenate([it.points for it in broken.pieces])
        assert np.array_equal(np.sort(hem.load(path).points, axis=0), np.sort(every, axis=0))


def test_ply_holds_a_file_for_every_piece_and_none_of_a_fracture_before(broken, sheet, tmp_path):
    (tmp_path / "pieces").mkdir()
    for name in ("notes.txt", "mine.ply", "shard_999.ply", "island_7.ply"):
        (tmp_path / "pieces" / name).write_text("before")
    paths = save_pieces(broken, tmp_path, "ply")
    assert [path.stem for path in paths] == names(broken)
    kept = {path.name for path in (tmp_path / "pieces").iterdir()}
    assert kept == {"notes.txt", "mine.ply", *(path.name for path in paths)}
    for path, piece in zip(paths, broken.pieces, strict=True):
        np.testing.assert_array_equal(corners(hem.load(path)), corners(piece))
    save_pieces(broken, tmp_path, "obj")
    assert kept == {path.name for path in (tmp_path / "pieces").iterdir()}


def test_the_rest_and_its_islands_have_names_of_their_own(sheet):
    given = names(sheet)
    assert len(given) == len(set(given)) == len(sheet.pieces)
    assert given[len(sheet.shards)] == "rest"
    assert given[0] == "shard_000"
    assert names(replace(sheet, rest=[])) == given[: len(sheet.shards)]
    assert names(replace(sheet, shards=[])) == given[len(sheet.shards) :]
    parts = replace(sheet, shards=sheet.shards[:1], rest=[sheet.rest[0]] * 3)
    assert names(parts) == ["shard_000", "rest", "island_0", "island_1"]
    for n, last in ((1000, "shard_999"), (1001, "shard_1000")):
        assert names(replace(sheet, shards=[*sheet.shards][:1] * n, rest=[]))[-1] == last


@pytest.mark.parametrize("kind", ["broken", "sheet"])
def test_the_numbers_are_those_of_the_fracture_and_json_can_hold_them(kind, request):
    found = request.getfixturevalue(kind)
    blow = Blow(found.impact, found.direction, 3.0)
    moving = motion(found, blow)
    told = json.loads(json.dumps(describe(found, blow, moving, "it"), allow_nan=False))
    assert told["schema"] == 1
    assert told["model"] == "it"
    assert told["material"]["name"] == found.material.name
    assert told["break_points"] == dict(found.counts)
    pieces, totals = told["pieces"], told["totals"]
    assert [it["name"] for it in pieces] == names(found)
    assert sum(it["mass_kg"] for it in pieces) == pytest.approx(totals["mass_kg"])
    assert sum(it["kinetic_energy_J"] for it in pieces) == pytest.approx(totals["kinetic_energy_J"])
    assert totals["kinetic_energy_J"] <= 3.0 * totals["mass_kg"]
    momentum = sum(np.array(it["velocity_m_s"]) * it["mass_kg"] for it in pieces)
    np.testing.assert_allclose(momentum, totals["momentum_kg_m_s"], atol=1e-9 * totals["mass_kg"])
    pairs = {(i, j) for i, it in enumerate(pieces) for j in it["neighbors"]}
    assert pairs == {pair for a, b in found.neighbors.tolist() for pair in ((a, b), (b, a))}
    assert all(it["neighbors"] == sorted(it["neighbors"]) for it in pieces)
    if not found.closed:
        each = pieces[0]
        assert each["area_m2"] == pytest.approx(found.pieces[0].area())
        assert each["area_m2"] * told["thickness_m"] == pytest.approx(each["volume_m3"])


def test_another_format_or_no_direction_is_refused_and_nothing_is_made(broken, tmp_path):
    for format in ("stl", ["stl"]):
        with pytest.raises(hem.MeshError, match=r"'stl'.*glb, obj, ply"):
            save_pieces(broken, tmp_path / "new", format)
    for format, up in itertools.product(("glb", "obj", "ply"), ((0, 0, 0), (np.nan, 0, 0), "y")):
        with pytest.raises(hem.MeshError, match="a direction"):
            save_pieces(broken, tmp_path / "new", format, up)
    assert not (tmp_path / "new").exists()


def stop_midway(folder):
    with whole(folder) as beside:
        (beside / "pieces.obj").write_text("half")
        raise KeyboardInterrupt


def write_two(folder):
    with whole(folder) as beside:
        (beside / "a.txt").write_text("")
        (beside / "pieces.glb").write_text("")


def test_a_broken_run_leaves_what_was_there(broken, tmp_path, monkeypatch):
    save_pieces(broken, tmp_path, "obj")
    before = (tmp_path / "pieces.obj").read_bytes()
    with pytest.raises(KeyboardInterrupt):
        stop_midway(tmp_path)
    assert (tmp_path / "pieces.obj").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["pieces.obj"]
    with pytest.raises(KeyboardInterrupt):
        stop_midway(tmp_path / "a" / "b")
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
@pytest.mark.parametrize("moves", [0, 1, 9, 40])
def test_what_ends_while_files_are_moved_leaves_those_that_were_there(
    broken, sheet, tmp_path, monkeypatch, moves, error
):
    def found():
        return {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}

    steps, move = iter([*[None] * moves, error]), os.replace

    def move_or_end(*given):
        if ends := next(steps, None):
            raise ends
        move(*given)

    save_pieces(sheet, tmp_path, "ply")
    before = found()
    monkeypatch.setattr(os, "replace", move_or_end)
    with pytest.raises((KeyboardInterrupt, hem.MeshError)):
        save_pieces(broken, tmp_path, "ply")
    assert found() == before


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    for place in (tmp_path / "file", tmp_path / "file" / "inner"):
        with pytest.raises(hem.MeshError, match="is a file, not a folder"):
            require_writable(place)
    (tmp_path / "locked").mkdir()
    (tmp_path / "locked").chmod(0o500)
    if os.access(tmp_path / "locked", os.W_OK):
        pytest.skip("this user may write everywhere")
    with pytest.raises(hem.MeshError, match="read-only"):
        require_writable(tmp_path / "locked" / "new")


def test_a_folder_where_a_file_shall_be_is_told_and_nothing_is_moved(broken, tmp_path):
    (tmp_path / "pieces.glb").mkdir()
    with pytest.raises(hem.MeshError, match="something else has this name"):
        write_two(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["pieces.glb"]
