"""One name for a mesh everywhere: a file, a sample, or a family and a size."""

import numpy as np
import pytest

import hem


def same(one: hem.TriangleMesh, other: hem.TriangleMesh) -> bool:
    return np.array_equal(one.points, other.points) and np.array_equal(
        one.triangles, other.triangles
    )


@pytest.mark.parametrize(("name", "made"), [
    ("torus:100", lambda: hem.generate("torus", 100)),
    ("sphere", lambda: hem.generate("sphere", 2_000)),
    ("grid:1_000", lambda: hem.generate("grid", 1_000)),
    ("teapot", lambda: hem.sample("teapot")),
])  # fmt: skip
def test_a_name_gives_what_its_source_gives(name, made):
    assert same(hem.find_mesh(name), made())


def test_a_file_comes_before_a_sample_of_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = hem.generate("grid", 100)
    hem.save(mesh, "cow.ply")
    (tmp_path / "cow.ply").rename("torus:7.ply")
    assert same(hem.find_mesh("torus:7.ply"), mesh)


def test_polygons_are_kept_unless_they_are_to_be_cut(tmp_path):
    file = tmp_path / "quad.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    for path in (file, str(file)):
        assert len(hem.find_mesh(path).faces) == 1
    assert len(hem.find_mesh(str(file), triangulate=True).triangles) == 2


@pytest.mark.parametrize(("name", "said"), [
    ("cube:3", "there is no model 'cube:3': name a file, or one of bunny"),
    ("sphere:many", "after the colon stands a number of vertices"),
    ("sphere:1__000", "after the colon stands a number of vertices"),
    ("sphere:" + 5_000 * "9", "after the colon stands a number of vertices"),
    ("sphere:_5", "after the colon stands a number of vertices"),
    ("sphere:٣", "after the colon stands a number of vertices"),
    ("torus:5", "reachable are"),
    ("no.obj", "there is no such file"),
    (300 * "x", "there is no model 'xxx"),
    (300 * "x" + ".obj", "it cannot be read: File name too long"),
])  # fmt: skip
def test_a_name_that_nothing_has_is_refused_with_those_that_there_are(name, said):
    with pytest.raises(hem.MeshError, match=said.replace("(", r"\(")):
        hem.find_mesh(name)


def test_a_folder_does_not_hide_a_family_or_sample_of_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("teapot", "torus", "neither"):
        (tmp_path / name).mkdir()
    assert same(hem.find_mesh("teapot"), hem.sample("teapot"))
    assert same(hem.find_mesh("torus"), hem.generate("torus", 2_000))
    with pytest.raises(hem.MeshError, match="it is a folder"):
        hem.find_mesh("neither")


def test_every_sample_may_be_repaired():
    assert same(hem.find_mesh("teapot", repair=True), hem.sample("teapot"))
    assert hem.find_mesh("bunny", repair=True).summary().components >= 1
