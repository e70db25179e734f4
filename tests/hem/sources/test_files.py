"""Files: what is saved comes back, and what is broken is refused by name and reason."""

import base64
import json
import os
import struct
import subprocess
import sys
import tracemalloc
import warnings
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem.sources import meshlab
from hem.sources.ctm import besides

PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
1 1 0
3 0 1 {}
"""
OFF = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 {}\n3 0 1 2\n3 0 2 {}\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 {}\n"
FAITHFUL = ("ply", "obj", "off", "3ds")
FORMATS = (*FAITHFUL, "stl", "wrl", "dae", "x3d", "ctm")


@pytest.fixture
def lumpy() -> hem.TriangleMesh:
    """A closed surface with a vertex without faces, and two vertices of one position."""
    mesh = hem.generate("isosurface", 400)
    points = np.vstack([mesh.points, [[9, 9, 9]], mesh.points[:1]])
    return hem.TriangleMesh(points, mesh.triangles)


def written(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize("extension", FAITHFUL)
def test_a_faithful_format_gives_back_every_bit(
    tmp_path: Path, lumpy: hem.TriangleMesh, extension: str
) -> None:
    file = tmp_path / f"mesh.{extension}"
    hem.save(lumpy, file)
    back = hem.load(file)
    assert np.array_equal(back.points, lumpy.points)
    assert np.array_equal(back.triangles, lumpy.triangles)
    assert os.listdir(tmp_path) == [file.name], "nothing is left beside"


@pytest.mark.parametrize("extension", FORMATS)
def test_every_format_gives_back_the_shape(tmp_path: Path, extension: str) -> None:
    sphere = hem.generate("sphere", 162)
    hem.save(sphere, tmp_path / f"mesh.{extension}")
    back = hem.load(tmp_path / f"mesh.{extension}").welded(1e-5)
    hem.require_manifold(back)
    assert (len(back.points), len(back.triangles)) == (162, 320)
    assert np.allclose(np.linalg.norm(back.points, axis=1), 1, atol=1e-3)


def test_stl_has_one_vertex_per_position_and_none_without_faces(
    tmp_path: Path, lumpy: hem.TriangleMesh
) -> None:
    hem.save(lumpy, tmp_path / "mesh.stl")
    back = hem.load(tmp_path / "mesh.stl")
    assert len(back.points) == len(lumpy.points) - 2
    shape = back.points[back.triangles], lumpy.points[lumpy.triangles]
    assert np.array_equal(*shape)


def test_openctm_keeps_every_bit_and_the_order_of_vertices(
    tmp_path: Path, lumpy: hem.TriangleMesh
) -> None:
    hem.save(lumpy, tmp_path / "mesh.ctm")
    back = hem.load(tmp_path / "mesh.ctm")
    assert np.array_equal(back.points, lumpy.points)
    faces = (sorted(map(from_smallest, it.triangles.tolist())) for it in (back, lumpy))
    assert next(faces) == next(faces)


def from_smallest(face: list[int]) -> list[int]:
    k = face.index(min(face))
    return face[k:] + face[:k]


def test_vertices_that_x3d_makes_one_are_told(tmp_path: Path, lumpy: hem.TriangleMesh) -> None:
    with pytest.warns(hem.MeshWarning, match="one vertex per position"):
        hem.save(lumpy, tmp_path / "mesh.x3d")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hem.save(lumpy.welded(), tmp_path / "mesh.x3d")


@pytest.mark.parametrize("extension", FORMATS)
def test_a_file_cut_anywhere_before_its_last_lines_is_refused(
    tmp_path: Path, extension: str
) -> None:
    whole = tmp_path / f"whole.{extension}"
    hem.save(hem.generate("sphere", 42), whole)
    data = whole.read_bytes()
    last_lines = {"obj": 60, "off": 8, "ctm": 8}.get(extension, 2)
    for end in [*range(8), *np.linspace(8, len(data) - last_lines, 25).astype(int)]:
        cut = written(tmp_path / f"cut.{extension}", data[:end])
        for repair in (False, True):
            with pytest.raises(hem.MeshError, match=f"cut.{extension}"):
                hem.load(cut, repair=repair)


PROMISES = {
    "text.ply": (PLY.format(2).replace("vertex 3", "vertex 2000000000"), "2,000,000,000 of vertex"),
    "binary.ply": (
        PLY.format(2).replace("ascii", "binary_little_endian").replace("face 1", "face -1"),
        "-1 of face",
    ),
    "long list.ply": (
        PLY.format(2).replace("ascii", "binary_little_endian").replace("uchar int", "uint int")
        .replace("vertex 3", "vertex 0"),
        "fewer or other numbers",
    ),
    "large.off": (OFF.replace("4 2 0", "4 3000000000 0"), "4 vertices and 3,000,000,000 faces"),
    "negative.off": (OFF.replace("4 2 0", "-4 -2 0"), "-4 vertices and -2 faces"),
    "long face.off": (
        OFF.format(0, 3).replace("3 0 1 2", "2000000000 0 1 2"), "without all its corners",
    ),
    "vertices.obj": ("# Vertices: 4000000000\n" + OBJ.format(4), "4 of 4,000,000,000 vertices"),
    "facets.stl": (80 * "-" + 4 * "\x7f" + 50 * "-", "134 of 106,953,107,234 bytes"),
    "chunk.3ds": ("MM" + 4 * "\x7f" + 80 * "-", "86 of 2,139,062,143 bytes"),
    "maps.ctm": ("OCTM\5\0\0\0RAW\0" + "\1\0\0\0" * 2 + "\0\0\0\4" + 12 * "\0", "no whole part"),
    "raw.ctm": ("OCTM\5\0\0\0RAW\0" + 8 * "\x7f" + 100 * "\0", r"120 of 51,337,491,\d+ bytes"),
}  # fmt: skip
"""Files whose heads say that there is more than there can be, and what is to be said of it."""


@pytest.mark.parametrize("name", PROMISES)
def test_what_a_head_promises_and_a_file_cannot_hold_is_told_before_room_is_made(
    tmp_path: Path, name: str
) -> None:
    content, words = PROMISES[name]
    file = written(tmp_path / name, content.encode("latin-1"))
    tracemalloc.start()
    try:
        with pytest.raises(hem.MeshError, match=f"cannot load .*{name}: the file is cut .*{words}"):
            hem.load(file)
        assert tracemalloc.get_traced_memory()[1] < 1_000_000
    finally:
        tracemalloc.stop()


def test_a_cut_text_stl_is_refused(tmp_path: Path) -> None:
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 {} 0\nendloop\n"
    body = "".join(facet.format(i) + "endfacet\n" for i in range(1, 30))
    whole = f"solid some\n{body}endsolid some\n"
    assert len(hem.load(written(tmp_path / "whole.stl", whole)).triangles) == 29
    for share in (0.2, 0.5, 0.9):
        cut = written(tmp_path / "cut.stl", whole[: int(share * len(whole))])
        with pytest.raises(hem.MeshError, match="cut short"):
            hem.load(cut)


@pytest.mark.parametrize("name", ["vertex cloud of things", "endfacet", "a solid"])
@pytest.mark.parametrize("parted", ["\n", "\r\n", "\r", " "])
def test_a_text_stl_may_have_any_name_and_blanks_behind(
    tmp_path: Path, name: str, parted: str
) -> None:
    facet = ["facet normal 0 0 1", "outer loop", "vertex 0 0 0", "vertex 1 0 0", "vertex 0 1 0"]
    text = parted.join([f"solid {name}", *facet, "endloop", "endfacet", f"endsolid {name}"])
    assert len(hem.load(written(tmp_path / "a.stl", text + 600 * " ")).triangles) == 1


@pytest.mark.parametrize("parted", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("binary", [False, True])
def test_a_ply_head_ends_at_a_line_of_its_own_whatever_parts_lines(
    tmp_path: Path, parted: str, binary: bool
) -> None:
    remark = "comment before end_header comes\n"
    head, body = PLY.format(2).replace("element v", f"{remark}element v").split("end_header\n")
    content = (head + "end_header\n" + body).replace("\n", parted).encode()
    if binary:
        head = head.replace("ascii", "binary_little_endian") + "end_header\n"
        begin = np.array([10], "<i4").view("<f4").item()  # whose first byte is that of "\n"
        numbers = struct.pack("<9fB3i", begin, 0, 0, 1, 0, 0, 1, 1, 0, 3, 0, 1, 2)
        content = head.replace("\n", parted).encode() + numbers
    mesh = hem.load(written(tmp_path / "a.ply", content))
    assert np.allclose(mesh.points, [(0, 0, 0), (1, 0, 0), (1, 1, 0)])
    assert mesh.triangles.tolist() == [[0, 1, 2]]


def test_a_ply_head_that_names_a_property_twice_is_refused(tmp_path: Path) -> None:
    twice = PLY.format(2).replace("property float y", "property float x")
    for text in (twice, twice.replace("ascii", "binary_little_endian")):
        with pytest.raises(hem.MeshError, match="names a property of vertex twice"):
            hem.load(written(tmp_path / "a.ply", text))


@pytest.mark.parametrize(
    ("was", "now"),
    [
        ("ply", "Ply"), ("format ascii 1.0\n", ""), ("ascii", "roman"), ("end_header", "end"),
        ("float x", "rational x"), ("vertex 3", "vertex three"),
        ("element vertex 3\nproperty float x", "property float x\nelement vertex 3"),
    ],
)  # fmt: skip
def test_what_is_no_head_of_a_ply_file_is_told_as_such(tmp_path: Path, was: str, now: str) -> None:
    with pytest.raises(hem.MeshError, match="its head is not that of a ply file"):
        hem.load(written(tmp_path / "a.ply", PLY.format(2).replace(was, now)))


def test_a_ply_head_without_a_coordinate_is_told_which(tmp_path: Path) -> None:
    with pytest.raises(hem.MeshError, match="its head names no 'z' of vertices"):
        hem.load(written(tmp_path / "a.ply", PLY.format(2).replace("float z", "float w")))


def test_a_text_ply_or_off_that_lacks_any_of_its_last_numbers_is_refused(tmp_path: Path) -> None:
    whole = {"ply": house("ply"), "off": house("off")}
    for extension, text in whole.items():
        begin = text.index("0 0 0\n")
        for end in [begin, *(i for i, it in enumerate(text) if it in " \n" and i > begin)][:-1]:
            with pytest.raises(hem.MeshError, match="the file is cut short"):
                hem.load_polygons(written(tmp_path / f"a.{extension}", text[:end]))
        assert len(hem.load_polygons(written(tmp_path / f"a.{extension}", text[:-1])).faces) == 3


LIST = "property list uchar int vertex_indices"


@pytest.mark.parametrize(
    ("was", "now", "words"),
    [
        ("property float x", "property list uchar float x", "x of vertex a type"),
        (LIST, LIST.replace("uchar", "float"), "vertex_indices of face a type"),
        (LIST, LIST.replace("int ", "float "), "vertex_indices of face a type"),
        (LIST, "property int vertex_indices", "vertex_indices of face a type"),
        (LIST, f"{LIST}\nelement face 1\n{LIST}", "names an element twice"),
    ],
)
@pytest.mark.parametrize("repair", [False, True])
def test_a_ply_head_that_no_mesh_can_have_is_refused(
    tmp_path: Path, was: str, now: str, words: str, repair: bool
) -> None:
    text = PLY.format(2.5).replace(was, now)
    for content in (text, text.replace("ascii", "binary_little_endian")):
        with pytest.raises(hem.MeshError, match=words):
            hem.load(written(tmp_path / "a.ply", content + 99 * "0 "), repair)


def test_a_list_of_less_than_nothing_is_refused_and_takes_no_face_with_it(tmp_path: Path) -> None:
    text = PLY.format(2).replace("face 1", "face 2").replace("uchar", "char") + "-1\n"
    with pytest.raises(hem.MeshError, match="less than nothing"):
        hem.load(written(tmp_path / "a.ply", text), repair=True)


@pytest.mark.parametrize("names", [["vertex_indices"], ["x", "y", "z"]])
def test_what_other_elements_of_a_ply_file_have_is_told_whatever_its_name(
    tmp_path: Path, names: list[str]
) -> None:
    beside = "".join(f"property list uchar int {name}\n" for name in names)
    text = PLY.format(2).replace("element face", f"element tristrips 1\n{beside}element face")
    text = text.replace("3 0 1 2", "3 0 1 2\n" * len(names) + "3 0 1 2")
    file = written(tmp_path / "a.ply", text)
    with pytest.warns(hem.MeshWarning, match="has tristrips, which are dropped"):
        hem.load(file)
    with pytest.raises(hem.MeshError, match="only 3 points and tristrips"):
        hem.load(written(file, text.replace("face 1", "face 0")))


def test_no_letter_of_a_comment_parts_the_lines_of_a_ply_head(tmp_path: Path) -> None:
    text = PLY.format(2).replace("element face", "comment by Å property float w\nelement face")
    assert len(hem.load(written(tmp_path / "a.ply", text)).points) == 3


def test_a_type_that_positions_cannot_have_is_told_before_a_file_is_read(tmp_path: Path) -> None:
    file = written(tmp_path / "a.ply", PLY.format(2))
    for repair, kind in product((False, True), (int, "no type")):
        with pytest.raises(hem.MeshError, match=r"float64, not as \S+( type')?$"):
            hem.load(file, repair, dtype=kind)


@pytest.mark.parametrize("extension", FORMATS)
@pytest.mark.parametrize("junk", [b"this is no mesh at all\n" * 9, bytes(range(256)) * 9])
def test_what_is_no_mesh_is_refused(tmp_path: Path, extension: str, junk: bytes) -> None:
    with pytest.raises(hem.MeshError, match=f"junk.{extension}") as refusal:
        hem.load(written(tmp_path / f"junk.{extension}", junk))
    assert str(refusal.value).count(f"junk.{extension}") == 1


def test_what_cannot_be_opened_is_refused_with_the_reason(tmp_path: Path) -> None:
    with pytest.raises(hem.MeshError, match=r"nowhere\.ply: there is no such file"):
        hem.load(tmp_path / "nowhere.ply")
    with pytest.raises(hem.MeshError, match="it is a folder"):
        hem.load(tmp_path)
    with pytest.raises(hem.MeshError, match="the file is empty"):
        hem.load(written(tmp_path / "blank.obj", " \n"))
    with pytest.raises(hem.MeshError, match=r"Unknown format for load: foo .*ply, obj"):
        hem.load(written(tmp_path / "mesh.foo", PLY))
    with pytest.raises(hem.MeshError, match="no extension"):
        hem.load(written(tmp_path / "mesh", PLY))
    with pytest.raises(hem.MeshError, match="no triangles in it, only 4 points"):
        hem.load(written(tmp_path / "points.obj", OBJ[: OBJ.index("f")]))


def test_what_cannot_be_saved_is_refused_with_the_reason(tmp_path: Path) -> None:
    mesh = hem.TriangleMesh(np.eye(3), [[0, 1, 2]])
    with pytest.raises(hem.MeshError, match="Unknown format for save: foo"):
        hem.save(mesh, tmp_path / "mesh.foo")
    with pytest.raises(hem.MeshError, match="there is no folder"):
        hem.save(mesh, tmp_path / "nowhere" / "mesh.ply")
    with pytest.raises(hem.MeshError, match="no vertices in it; ply, obj and off keep"):
        hem.save(hem.TriangleMesh(np.zeros((0, 3)), []), tmp_path / "mesh.glb")
    assert not list(tmp_path.iterdir())


def test_what_a_format_does_not_keep_replaces_no_file(tmp_path: Path) -> None:
    mesh = hem.TriangleMesh([(0, 0, 0), (0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2), (1, 2, 3)])
    for extension, words in {
        "xyz": "0 of 2 faces", "u3d": "writes no u3d file", "x3d": "1 of 2 faces",
        "json": "Unknown format for load",
    }.items():  # fmt: skip
        file = written(tmp_path / f"mesh.{extension}", "what was there")
        with pytest.raises(hem.MeshError, match=words), warnings.catch_warnings(action="ignore"):
            hem.save(mesh, file)
        assert file.read_text() == "what was there"


@pytest.mark.parametrize("extension", ["dae", "wrl", "x3d", "3mf", "ctm", "3ds"])
def test_half_of_what_pymeshlab_should_have_written_replaces_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, extension: str
) -> None:
    def half(mesh: hem.TriangleMesh, path: Path) -> None:  # as on a full disk
        meshlab.save_file(mesh, path)
        os.truncate(path, path.stat().st_size * 2 // 3)

    monkeypatch.setattr("hem.sources.files.save_file", half)
    file = written(tmp_path / f"mesh.{extension}", "what was there")
    with pytest.raises(hem.MeshError, match=f"cannot save .*mesh.{extension}"):
        hem.save(hem.generate("sphere", 642), file)
    assert file.read_text() == "what was there"


def test_what_the_system_refuses_while_saving_is_a_mesh_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = hem.TriangleMesh(np.eye(3), [[0, 1, 2]])
    with pytest.raises(hem.MeshError, match="too long"):
        hem.save(mesh, tmp_path / (300 * "x") / "mesh.ply")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "nowhere"))
    with pytest.raises(hem.MeshError, match="No such file or directory"):
        hem.save(mesh, tmp_path / "mesh.dae")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("corner out of range.ply", PLY.format(7)),
        ("corner below range.ply", PLY.format(-1)),
        ("corner out of range.off", OFF.format(0, 7)),
        ("corner below range.off", OFF.format(0, -1)),
        ("repeated corner.off", OFF.format(0, 2)),
        ("not finite.off", OFF.format("nan", 3)),
        ("corner out of range.obj", OBJ.format(9)),
        ("repeated corner.obj", OBJ.format(3)),
        ("corner before the first.obj", "f -4 -3 -2\n" + OBJ.format(4)),
        ("no corner.obj", OBJ.format("x")),
        ("short line.off", OFF.format(0, "").replace("3 0 1 2", "3 0 1")),
    ],
)
def test_unusable_elements_are_never_left_out_silently(
    tmp_path: Path, name: str, content: str
) -> None:
    with pytest.raises(hem.MeshError, match=name):
        hem.load(written(tmp_path / name, content))


@pytest.mark.parametrize(
    ("was", "now"), [("2 -1", "2 -1 0 1 1 -1"), ("2 -1", "2 -1 3 4 3 -1"), ("7 7 7", "7 nan 7")]
)
def test_what_pymeshlab_leaves_out_is_left_out_by_repair_alone(
    tmp_path: Path, was: str, now: str
) -> None:
    text = X3D.format("").replace('0 1 0"', '0 1 0 7 7 7 8 8 8"').replace(was, now)
    file = written(tmp_path / "a.x3d", text)
    for read in (hem.load, hem.load_polygons, hem.as_mesh):
        with pytest.raises(hem.MeshError, match=r"1 of its points and triangles .*repair=True"):
            read(file)
    assert hem.load(file, repair=True).triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize(
    ("name", "content", "faces"),
    [
        ("a.off", OFF.format(0, -1), 1), ("b.off", OFF.format(0, 2), 1),
        ("c.obj", OBJ.format(3), 1), ("d.obj", OBJ.format(9), 1), ("e.obj", OBJ.format(4), 2),
        ("f.off", OFF.format(0, 3).replace("3 0 1 2", "2 0 1"), 1),
    ],
)  # fmt: skip
def test_repair_leaves_unusable_elements_out(
    tmp_path: Path, name: str, content: str, faces: int
) -> None:
    assert len(hem.load(written(tmp_path / name, content), repair=True).triangles) == faces


@pytest.mark.parametrize(
    "faces",
    [
        ["1 2 3", "2 1 4", "1 2 5"],  # an edge in three faces
        ["1 2 3", "1 2 4"],  # the same way along an edge
        ["1 2 3", "1 4 5"],  # two fans in one vertex
        ["1 2 3", "2 3 1", "1 2 4"],  # a face twice
    ],
)
def test_repair_makes_a_surface_of_what_is_none(tmp_path: Path, faces: list[str]) -> None:
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n"
    file = written(tmp_path / "mesh.obj", corners + "".join(f"f {face}\n" for face in faces))
    with pytest.raises(hem.NonManifoldError):
        hem.require_manifold(hem.load(file))
    mended = hem.load(file, repair=True)
    hem.require_manifold(mended)
    assert len(mended.triangles) >= 2


@pytest.mark.parametrize("fans", [3, 4])
def test_repair_parts_all_fans_that_meet_in_a_vertex(tmp_path: Path, fans: int) -> None:
    points = "".join(f"v {i} {i * i} {i**3}\n" for i in range(2 * fans + 1))
    faces = "".join(f"f 1 {2 * i + 2} {2 * i + 3}\n" for i in range(fans))
    mended = hem.load(written(tmp_path / "fans.obj", points + faces), repair=True)
    hem.require_manifold(mended)
    assert len(mended.triangles) == fans
    assert len(mended.points) == 3 * fans


def test_a_one_sided_surface_is_beyond_repair(tmp_path: Path) -> None:
    strip = [f"f {i + 1} {(i + 1) % 5 + 1} {(i + 2) % 5 + 1}\n" for i in range(5)]
    moebius = "".join(f"v {np.cos(i)} {np.sin(i)} {i}\n" for i in range(5)) + "".join(strip)
    file = written(tmp_path / "moebius.obj", moebius)
    with pytest.raises(hem.NonManifoldError, match="beyond repair") as refusal:
        hem.load(file, repair=True)
    assert "--repair" not in str(refusal.value), "this was tried"


POLYGONS = [(0, 1, 2, 3), (3, 2, 4), (1, 5, 7, 6, 2)]
"""A quad, a triangle and a pentagon."""

CORNERS = [
    (0, 0, 0),
    (1, 0, 0),
    (1, 1, 0),
    (0, 1, 0),
    (0.5, 2, 0),
    (2, 0, 0),
    (2, 1, 0),
    (3, 0.5, 0),
]


def house(extension: str) -> str:
    rows = [" ".join(map(str, point)) for point in CORNERS]
    faces = [" ".join(map(str, (len(face), *face))) for face in POLYGONS]
    if extension == "off":
        return "\n".join(["OFF", "8 3 0", *rows, *faces, ""])
    if extension == "obj":
        lines = ["f " + " ".join(str(v + 1) for v in face) for face in POLYGONS]
        return "\n".join([*(f"v {row}" for row in rows), *lines, ""])
    head = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
    head += "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header"
    return "\n".join([head, *rows, *faces, ""])


@pytest.mark.parametrize("extension", ["obj", "off", "ply"])
def test_polygons_stay_polygons_unless_triangles_are_asked_for(
    tmp_path: Path, extension: str
) -> None:
    path = written(tmp_path / f"house.{extension}", house(extension))
    mesh = hem.load_polygons(path)
    assert [tuple(face) for face in mesh.faces] == POLYGONS
    assert np.array_equal(mesh.points, np.array(CORNERS, np.float32))
    for repair in (False, True):
        with pytest.raises(hem.MeshError, match=r"load_polygons.*triangulate=True") as refusal:
            hem.load(path, repair=repair)
        assert refusal.value.elements["faces"].tolist() == [0, 2]
    triangles = hem.load(path, triangulate=True)
    fans = [(f[0], f[i], f[i + 1]) for f in POLYGONS for i in range(1, len(f) - 1)]
    assert [tuple(row) for row in triangles.triangles] == fans


@pytest.mark.parametrize("extension", ["ply", "obj", "off"])
def test_polygons_are_saved_and_come_back(tmp_path: Path, extension: str) -> None:
    mesh = hem.PolygonMesh(CORNERS, POLYGONS)
    hem.save(mesh, tmp_path / f"house.{extension}")
    back = hem.load_polygons(tmp_path / f"house.{extension}")
    assert np.array_equal(back.points, mesh.points)
    assert [tuple(face) for face in back.faces] == POLYGONS


def test_a_face_of_more_corners_than_ply_can_count_is_kept_by_obj_and_off(tmp_path: Path) -> None:
    angles = np.arange(256)
    circle = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    for corners, extension in ((255, "ply"), (256, "obj"), (256, "off")):
        mesh = hem.PolygonMesh(circle, [range(corners), (0, 1, 2)])
        hem.save(mesh, tmp_path / f"a.{extension}")
        back = hem.load_polygons(tmp_path / f"a.{extension}")
        assert back.faces.to_list() == mesh.faces.to_list()
    with pytest.raises(hem.MeshError, match="more than 255 corners are kept by obj and off"):
        hem.save(mesh, tmp_path / "a.ply")


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_text_keeps_every_bit_of_numbers_of_any_size(tmp_path: Path, dtype: type) -> None:
    random = np.random.default_rng(0)
    exponents = random.uniform(*np.log10([np.finfo(dtype).tiny, np.finfo(dtype).max]), (3000, 3))
    points = (random.choice([-1, 1], (3000, 3)) * 10**exponents).astype(dtype)
    mesh = hem.TriangleMesh(points, [(0, 1, 2)], dtype)
    for extension in ("obj", "off"):
        hem.save(mesh, tmp_path / f"a.{extension}")
        assert np.array_equal(hem.load(tmp_path / f"a.{extension}", dtype=dtype).points, points)


@pytest.mark.parametrize("extension", ["stl", "3ds"])
def test_polygons_are_refused_where_they_would_be_cut(tmp_path: Path, extension: str) -> None:
    with pytest.raises(hem.MeshError, match="ply, obj and off"):
        hem.save(hem.PolygonMesh(CORNERS, POLYGONS), tmp_path / f"house.{extension}")
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("faces", [[(0, 1, 2), (0, 2, 3)], [(0, 1, 2, 3), (0, 1, 2)]])
def test_a_binary_ply_file_may_hold_more_than_a_mesh(
    tmp_path: Path, order: str, faces: list[tuple[int, ...]]
) -> None:
    name = "little" if order == "<" else "big"
    head = (
        f"ply\nformat binary_{name}_endian 1.0\ncomment element vertex 7\nelement vertex 4\n"
        "property uchar red\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list ushort uint vertex_index\nproperty short part\n"
        "element edge 1\nproperty int vertex1\nend_header\n"
    )
    rows = [struct.pack(f"{order}B3d", 255, *CORNERS[i]) for i in range(4)]
    rows += [struct.pack(f"{order}H{len(f)}Ih", len(f), *f, -1) for f in faces]
    file = written(tmp_path / "more.ply", head.encode() + b"".join(rows) + struct.pack("i", 1))
    with pytest.warns(
        hem.MeshWarning, match=r"more\.ply has colors, part, edge, which are dropped"
    ):
        mesh = hem.load_polygons(file)
    assert np.array_equal(mesh.points, np.array(CORNERS[:4], np.float32))
    assert [tuple(face) for face in mesh.faces] == faces


def test_a_list_in_a_ply_file_may_be_empty(tmp_path: Path) -> None:
    text = PLY.format(2).replace("end_header", "property list uchar float texcoord\nend_header")
    for more in ("0\n", "2 0.5 0.5\n"):
        with pytest.warns(hem.MeshWarning, match=TEXTURE):
            mesh = hem.load(written(tmp_path / "a.ply", text + more))
        assert mesh.triangles.tolist() == [[0, 1, 2]]


def test_the_case_of_an_extension_does_not_matter(tmp_path: Path) -> None:
    hem.save(hem.PolygonMesh(CORNERS, POLYGONS), tmp_path / "HOUSE.OBJ")
    assert [tuple(face) for face in hem.load_polygons(tmp_path / "HOUSE.OBJ").faces] == POLYGONS


@pytest.mark.parametrize("text", [True, False])
def test_an_element_of_a_ply_file_may_have_no_properties(tmp_path: Path, text: bool) -> None:
    content = PLY.format(2).replace("element vertex", "element mark 2\nelement vertex").encode()
    if not text:
        head = content[: content.index(b"0 0 0")].replace(b"ascii", b"binary_big_endian")
        content = head + struct.pack(">9fB3i", *np.ravel(CORNERS[:3]), 3, 0, 1, 2)
    mesh = hem.load(written(tmp_path / "a.ply", content))
    assert mesh.points.tolist() == [list(point) for point in CORNERS[:3]]
    assert mesh.triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("head", ["OFF 3 1 0\n", "COFF\n# colors\n3 1 0\n"])
def test_an_off_file_may_have_colors_and_comments(tmp_path: Path, head: str) -> None:
    text = head + "0 0 0 9 9 9\n1 0 0 9 9 9 # here\n\n0 1 0 9 9 9\n3 0 1 2 255 0 0\n"
    with pytest.warns(hem.MeshWarning, match=r"a\.off has colors"):
        mesh = hem.load(written(tmp_path / "a.off", text))
    assert mesh.triangles.tolist() == [[0, 1, 2]]


def test_a_text_stl_facet_has_three_corners_of_its_own(tmp_path: Path) -> None:
    facet = "facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n"
    corners = [f"vertex {x} {x * x} 0\n" for x in range(6)]
    for cut in (3, 2, 4):
        text = "".join(facet.format("".join(part)) for part in (corners[:cut], corners[cut:]))
        file = written(tmp_path / "a.stl", f"solid\n{text}endsolid\n")
        if cut == 3:
            assert hem.load(file).triangles.tolist() == [[0, 1, 2], [3, 4, 5]]
            continue
        with pytest.raises(hem.MeshError, match="a facet without three vertices"):
            hem.load(file)


def test_faces_of_old_obj_files_are_faces(tmp_path: Path) -> None:
    old = written(tmp_path / "a.obj", OBJ.format(4).replace("f ", "fo "))
    assert hem.load(old).triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_what_an_obj_file_may_say_of_its_corners(tmp_path: Path) -> None:
    points = OBJ[: OBJ.index("f")]
    faces = "f -4 -3 -2 # counted backward\nf 1/1/1 \\\n 3/1/1 4/1/1\n"
    file = written(tmp_path / "fine.obj", points + "vt 0 0\nvn 0 0 1\n" + faces)
    with pytest.warns(hem.MeshWarning, match=r"fine\.obj has texture coordinates, normals, which"):
        mesh = hem.load(file)
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


NORMALS, TEXTURE = "normals", "texture coordinates"
LEFT_OUT = "shapes that pymeshlab leaves out"
LINE = """<Shape><IndexedLineSet coordIndex="0 1 -1">
<Coordinate point="0 0 0 1 0 0"/></IndexedLineSet></Shape>"""
DISK = "<Shape><Appearance><Material/></Appearance><Disk2D/></Shape>"
VERTEX = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
X3D = """<X3D><Scene><Shape><IndexedFaceSet coordIndex="0 1 2 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/>{}</IndexedFaceSet></Shape></Scene></X3D>"""
WRL = """#VRML V2.0 utf8
Shape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [0 0 0, 1 0 0, 0 1 0] }}
coordIndex [0, 1, 2, -1] {} }} }}"""


@pytest.mark.parametrize(
    ("name", "content", "dropped"),
    [
        ("a.obj", OBJ.format(4), []),
        ("a.obj", OBJ.format(4) + "vn 0 0 1\n", [NORMALS]),
        ("a.obj", OBJ.format(4) + "vt 0 1\n", [TEXTURE]),
        ("a.obj", OBJ.format(4).replace("v 1 0 0", "v 1 0 0 .5 .5 .5"), ["colors"]),
        ("a.obj", OBJ.format(4) + "usemtl a\nl 1 2\np 4\n", ["materials", "lines", "points"]),
        ("a.obj", OBJ.format(4) + "curv 0 1 1 2\nsurf 0 1 0 1\n", ["curves", "free-form surfaces"]),
        ("a.ply", PLY.format(2), []),
        (
            "a.ply",
            PLY.format(2).replace(VERTEX, VERTEX + "property float nx\nproperty float s\n")
            .replace(" 0\n", " 0 0 0\n"),
            [NORMALS, TEXTURE],
        ),
        ("a.off", OFF.format(0, 3), []),
        ("a.off", OFF.format(0, 3).replace("OFF", "STNOFF"), [TEXTURE, NORMALS]),
        ("a.off", OFF.format(0, "3 .5 .5 .5"), ["colors"]),
        ("a.off", OFF.format(0, 3).replace("1 1 0", "1 1 0 255 0 0 255"), ["colors"]),
        ("a.off", OFF.format(0, "3 255 0 0").replace("OFF", "CNOFF"), ["colors", NORMALS]),
        ("a.stl", bytes(80) + b"\1\0\0\0" + struct.pack("<12fH", *range(12), 9), ["colors"]),
        ("a.x3d", X3D.format(""), []),
        ("a.x3d", X3D.format('<Normal vector="0 0 1 0 0 1 0 0 1"/>'), [NORMALS]),
        ("a.x3d", X3D.format('<Color color="1 0 0 1 0 0 1 0 0"/>'), ["colors"]),
        ("a.x3d", X3D.format('<TextureCoordinate point="0 0 1 0 0 1"/>'), [TEXTURE]),
        ("a.x3d", X3D.format("").replace("<Scene>", f"<Scene>{LINE}"), [LEFT_OUT]),
        ("a.x3d", X3D.format("").replace("<Scene>", "<Scene><Shape><Box/></Shape>"), [LEFT_OUT]),
        ("a.x3d", X3D.format("").replace("<Scene>", f"<Scene>{DISK}"), ["materials", LEFT_OUT]),
        ("a.wrl", WRL.format(""), []),
        ("a.wrl", WRL.format("") + "Shape { geometry PointSet { } }", [LEFT_OUT]),
        ("a.wrl", WRL.format("normal Normal { vector [0 0 1, 0 0 1, 0 0 1] }"), [NORMALS]),
    ],
)  # fmt: skip
def test_what_a_file_has_and_a_mesh_has_not_is_told(
    tmp_path: Path, name: str, content: str | bytes, dropped: list[str]
) -> None:
    file = written(tmp_path / name, content)
    for read in (hem.load, hem.load_polygons, hem.as_mesh):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            read(file)
        names = ", ".join(dropped)
        sentence = f"{file} has {names}, which are dropped: a mesh is positions and faces"
        assert [str(it.message) for it in told] == [sentence] * bool(dropped)
        assert {it.category for it in told} <= {hem.MeshWarning}


@pytest.mark.parametrize("extension", FORMATS)
def test_nothing_is_written_that_a_mesh_has_not(tmp_path: Path, extension: str) -> None:
    hem.save(hem.generate("sphere", 42), tmp_path / f"mesh.{extension}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hem.load(tmp_path / f"mesh.{extension}")


def gltf(primitive: dict[str, int], node: dict[str, list[float]]) -> str:
    """A scene of a triangle at the axes, or of what else its three corners are to be."""
    data = struct.pack("<9f3H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "translation": [0, 0, 5]}, {"mesh": 0, **node}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, **primitive}]}],
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
    }  # fmt: skip
    return json.dumps(scene)


def test_what_a_scene_has_beside_its_shape_is_told(tmp_path: Path) -> None:
    targets: Any = {"targets": [{"POSITION": 0}]}
    plain, poses = gltf({}, {}), "poses and motions"
    for content, name in (
        (plain.replace("{", '{"materials": [{}], ', 1), "materials"),
        (plain.replace("{", '{"skins": [{"joints": [0], "inverseBindMatrices": 0}], ', 1), poses),
        (gltf(targets, {}), poses),
    ):
        with pytest.warns(hem.MeshWarning, match=f"a.gltf has {name}, which are dropped"):
            hem.load(written(tmp_path / "a.gltf", content))


def test_a_mirrored_part_of_a_scene_is_seen_from_the_same_side(tmp_path: Path) -> None:
    for sides, up in (([2, 2, 1], 1), ([-1, 1, 1], 1), ([1, 1, -1], -1), ([-1, -1, -1], -1)):
        mesh = hem.load(written(tmp_path / "a.gltf", gltf({"mode": 4}, {"scale": sides})))
        assert mesh.points.tolist()[:3] == [[0, 0, 5], [1, 0, 5], [0, 1, 5]]
        assert mesh.face_normals()[:, 2].tolist() == [1, up]


@pytest.mark.parametrize("mode", [0, 1, 2, 3, 5, 6])
def test_what_gltf_has_for_triangles_is_not_taken_for_some(tmp_path: Path, mode: int) -> None:
    with pytest.raises(hem.MeshError, match=f"misreads '\"mode\": {mode}'"):
        hem.load(written(tmp_path / "a.gltf", gltf({"mode": mode}, {})))


def test_a_scene_of_dae_whose_scale_would_get_lost_is_refused(tmp_path: Path) -> None:
    mesh = hem.TriangleMesh(np.eye(3), [[0, 1, 2]])
    hem.save(mesh, tmp_path / "a.dae")
    text = (tmp_path / "a.dae").read_text()
    node = "<instance_geometry"
    assert text.count(node) == 1
    for scale in ("2 2 2", "1 1 -1", " 1.0 1.01 1"):
        file = written(tmp_path / "a.dae", text.replace(node, f"<scale>{scale}</scale>{node}"))
        with pytest.raises(hem.MeshError, match=f"misreads '<scale>{scale}'"):
            hem.load(file)
    written(file, text.replace(node, f'<scale sid="scale"> 1 1.0 1.000\n</scale>{node}'))
    assert np.array_equal(hem.load(file).points, mesh.points)


FRAMES = [[2, 0.5, 1], [-1, 1, 1], [1, -1e-1, 1], [-1, -0.5, 1], [1, 1, -2]]
"""How a triangle in the plane is scaled; as many of them are mirrored as have an odd sign."""


@pytest.mark.parametrize("sides", FRAMES)
def test_a_part_is_seen_from_the_side_it_was_or_refused(tmp_path: Path, sides: list[float]) -> None:
    words, flat = " ".join(map(str, sides)), [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    hem.save(hem.TriangleMesh(flat, [[0, 1, 2]]), tmp_path / "a.dae")
    node, (x, y, z) = "<instance_geometry", sides
    matrix = f"<matrix sid='m'>{x} 0 0 0\n0 {y} 0 0 0 0 {z} 0 0 0 0 1</matrix>"
    shape = X3D.format("").partition("<Scene>")[2].partition("</Scene>")[0]
    files = {
        "dae": (tmp_path / "a.dae").read_text().replace(node, matrix + node),
        "x3d": X3D.format("").replace(shape, f'<Transform scale="{words}">{shape}</Transform>'),
        "wrl": WRL.format("").replace("Shape", f"Transform {{ scale {words} children Shape") + "}",
    }
    for extension, content in files.items():
        file = written(tmp_path / f"a.{extension}", content)
        if x * y * z < 0:
            with pytest.raises(hem.MeshError, match=r"misreads .(<matrix|scale)"):
                hem.load(file)
            continue
        mesh = hem.load(file)
        assert np.allclose(mesh.points[mesh.triangles[0]], np.multiply(flat, sides))


def test_what_pymeshlab_would_read_in_another_place_or_the_wrong_way_is_refused(
    tmp_path: Path,
) -> None:
    hem.save(hem.TriangleMesh(np.eye(3), [[0, 1, 2]]), tmp_path / "a.dae")
    dae, node = (tmp_path / "a.dae").read_text(), "<instance_geometry"
    instances: Any = {"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {}}}}
    strip = X3D.format("").replace("IndexedFaceSet", "IndexedTriangleStripSet")
    for name, content, words in (
        ("a.gltf", gltf({}, instances), "EXT_mesh_gpu_instancing"),
        ("a.dae", dae.replace(node, f"<skew>45 0 1 0 1 0 0</skew>{node}"), "<skew"),
        ("a.dae", dae.replace(node, f"<lookat>0 0 5 0 0 0 0 1 0</lookat>{node}"), "<lookat"),
        ("a.x3d", strip.replace("coordIndex", "index"), "<IndexedTriangleStripSet"),
        ("a.x3d", strip.replace("IndexedTri", "Tri"), "<TriangleStripSet"),
    ):
        with pytest.raises(hem.MeshError, match=f"misreads '\"?{words}"):
            hem.load(written(tmp_path / name, content))


def test_a_part_of_texture_in_a_3ds_file_is_told(tmp_path: Path) -> None:
    hem.save(
        hem.TriangleMesh([(12, 0, 0), (12, 12, 0), (0, 0, 12)], [[0, 1, 2]]), tmp_path / "a.3ds"
    )
    data = (tmp_path / "a.3ds").read_bytes()
    part = struct.pack("<HIH6f", 0x4140, 32, 3, *range(6))
    at = data.index(struct.pack("<H", 0x4120))  # before the faces
    outer = [data.index(struct.pack("<H", it)) for it in (0x4D4D, 0x3D3D, 0x4000, 0x4100)]
    longer = bytearray(data[:at] + part + data[at:])
    for start in outer:
        size = int.from_bytes(data[start + 2 : start + 6], "little") + len(part)
        longer[start + 2 : start + 6] = size.to_bytes(4, "little")
    with pytest.warns(hem.MeshWarning, match=TEXTURE):
        assert len(hem.load(written(tmp_path / "b.3ds", bytes(longer))).triangles) == 1


def test_the_head_of_an_openctm_file_says_what_it_has() -> None:
    head = b"OCTM" + struct.pack("<I4s5I", 5, b"RAW", 3, 1, 2, 0, 1)
    assert besides(head) == [TEXTURE, NORMALS]


def test_an_openctm_file_of_all_parts_is_read_whole_and_refused_without_its_last_byte(
    tmp_path: Path,
) -> None:
    head = struct.pack("<4sI4s6I", b"OCTM", 5, b"RAW", 3, 1, 1, 1, 1, 2) + b"by"
    parts = b"INDX" + struct.pack("<3I", 0, 1, 2) + b"VERT" + np.eye(3, dtype="<f4").tobytes()
    parts += b"NORM" + np.ones((3, 3), "<f4").tobytes()
    parts += b"TEXC" + struct.pack("<I3sI2s6f", 3, b"map", 2, b"it", *range(6))
    parts += b"ATTR" + struct.pack("<I5s12f", 5, b"Color", *12 * [0.5])
    with pytest.warns(hem.MeshWarning, match=f"{TEXTURE}, {NORMALS}"):
        assert np.array_equal(hem.load(written(tmp_path / "a.ctm", head + parts)).points, np.eye(3))
    size = len(head + parts)
    with pytest.raises(hem.MeshError, match=f"{size - 1} of {size} bytes"):
        hem.load(written(tmp_path / "b.ctm", (head + parts)[:-1]))


def test_a_packed_openctm_file_is_read_whole_and_refused_without_its_last_byte(
    tmp_path: Path,
) -> None:
    sphere, file = hem.generate("sphere", 42), tmp_path / "a.CTM"
    meshlab.save_file(sphere, file)  # in capitals pymeshlab packs it
    data = file.read_bytes()
    assert data[8:11] == b"MG2"
    assert len(hem.load(file).triangles) == len(sphere.triangles)
    with pytest.raises(hem.MeshError, match=f"{len(data) - 1} of {len(data)} bytes"):
        hem.load(written(file, data[:-1]))


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("flat.obj", "v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "without three coordinates"),
        ("flat.off", OFF.format(0, 3).replace(" 0\n3", "\n3"), "without three coordinates"),
        ("zero.obj", "v 0 0 0\nf 0 2 3\nv 1 0 0\nv 0 1 0\n", "such as -1"),
        ("other.off", OFF.format(0, 3).replace("OFF", "COFFEE"), "does not begin as off files do"),
        ("cut.obj", OBJ.format(""), "a last line without all its numbers"),
        ("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "only 3 points"),
        (
            "words.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 no\nvertex 1 0 0\n"
            "vertex 0 1 0\nendloop\nendfacet\nendsolid\n", "coordinate that is no number",
        ),
    ],
)  # fmt: skip
def test_what_a_text_file_has_instead_of_points_and_corners_is_told(
    tmp_path: Path, name: str, content: str, words: str
) -> None:
    with pytest.raises(hem.MeshError, match=words):
        hem.load(written(tmp_path / name, content))


def test_off_files_of_other_dimensions_are_refused(tmp_path: Path) -> None:
    for head in ("4OFF", "nOFF", "nÄOFF"):
        text = OFF.format(0, 3).replace("OFF", head).encode("latin-1")
        with pytest.raises(hem.MeshError, match=f"three dimensions: '{head}'"):
            hem.load(written(tmp_path / "a.off", text))


def test_repair_leaves_polygons_with_repeated_corners_out(tmp_path: Path) -> None:
    for extension in ("obj", "off"):
        text = house(extension).replace("1 2 3 4", "1 2 1 4").replace("4 0 1 2 3", "4 0 1 0 3")
        path = written(tmp_path / f"house.{extension}", text)
        with pytest.raises(hem.MeshError, match=r"twice|can be used"):
            hem.load(path, triangulate=True)
        assert len(hem.load(path, repair=True, triangulate=True).triangles) == 4


def test_a_triangle_structure_says_how_to_cut_polygons(tmp_path: Path) -> None:
    path = written(tmp_path / "house.obj", house("obj"))
    for name, mesh in product(structures.NAMES, (path, str(path), hem.load_polygons(path))):
        if structures.REGISTRY[name].holds_polygons:
            assert structures.build(name, mesh).n_faces == 3
            continue
        with pytest.raises(hem.MeshError, match=r"build plankton.*triangulate=True") as refusal:
            structures.build(name, mesh)
        assert refusal.value.elements["faces"].tolist() == [0, 2]


@pytest.mark.parametrize(
    ("faces", "words"),
    [
        ([(0, 1)], "three corners"),
        ([(0, 1, 2), ()], r"three corners or more \(faces: 1\)"),
        ([(0, 1, 2, 9)], "out of the range 0 … 3, such as 9"),
        ([(0, 1, 2), (0, 1, 2, 9), (0, 1, 2)], r"such as 9 \(faces: 1\)"),
        ([(0, 1, 2), (0, -7, 2)], r"such as -7 \(faces: 1\)"),
        ([(0, 1, 2, 1)], "twice"),
        ([[0.5, 1, 2, 3]], "not whole numbers"),
        ([7], "rows"),
        (None, "rows of vertex indices: 'NoneType'"),
        ([[[0, 1], [2]]], "rows of vertex indices: "),
        ([["a", "b", "c"]], "integers, not <U1"),
        ([(0, 1, 2j)], "integers, not complex128"),
        *(
            (hem.Ragged(np.array(offsets), np.array([0, 1, 2, 0, 2, 3])), "offsets of faces")
            for offsets in (np.zeros(0, int), [1, 6], [0, 3], [0, 3, 7], [0.0, 3.0, 6.0], [[0, 6]])
        ),
        (hem.Ragged(np.array([0, 6, 3, 6], np.uint8), np.arange(6) % 4), r"three.* \(faces: 1\)"),
    ],
)
def test_bad_polygons_are_refused(faces: Any, words: str) -> None:
    with pytest.raises(hem.MeshError, match=words):
        hem.PolygonMesh(np.eye(4)[:, :3], faces)


def test_paths_may_be_relative_and_nobody_notices_pymeshlab(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "sub ü").mkdir()
    monkeypatch.chdir(tmp_path)
    mesh = hem.TriangleMesh(np.eye(3), [[0, 1, 2]])
    for extension in ("ply", "dae"):
        hem.save(mesh, f"sub ü/mesh.{extension}")
        assert len(hem.load(f"sub ü/mesh.{extension}").points) == 3
    assert Path.cwd() == tmp_path
    assert capfd.readouterr() == ("", "")


def test_without_pymeshlab_common_files_are_read_and_others_say_what_to_install(
    tmp_path: Path,
) -> None:
    written(tmp_path / "pymeshlab.py", "raise ImportError('No module named pymeshlab')")
    mesh = hem.TriangleMesh(np.eye(3), [[0, 1, 2]])
    for extension in ("ply", "obj", "off", "stl", "dae"):
        hem.save(mesh, tmp_path / f"mesh.{extension}")
    program = (
        "import hem, sys\n"
        "for end in ('ply', 'obj', 'off', 'stl'):\n"
        "    hem.save(hem.load('mesh.' + end), 'again.' + end)\n"
        "try:\n    hem.load('mesh.dae')\nexcept hem.MeshError as error:\n    print(error)"
    )
    path = os.pathsep.join([str(tmp_path), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env={**os.environ, "PYTHONPATH": path},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "mesh.dae: pymeshlab cannot be loaded" in done.stdout
    assert "pip install 'hem-mesh[study]'" in done.stdout


def test_a_file_that_kills_pymeshlab_kills_nothing_else(
    tmp_path: Path,
) -> None:
    hem.save(hem.TriangleMesh(np.eye(3), [[0, 1, 2]]), tmp_path / "mesh.dae")
    process = meshlab._WORKER._process
    process.kill()
    process.wait()
    with pytest.raises(hem.MeshError, match=r"mesh.dae: .*died of this"):
        hem.load(tmp_path / "mesh.dae")
    assert len(hem.load(tmp_path / "mesh.dae").points) == 3


@pytest.mark.parametrize(("name", "content", "words"), [
    ("a.off", OFF.format(0, 3).replace("3 0 1 2", "-1 0 1 2"), "three corners or more.*faces: 0"),
    ("b.off", OFF.format(0, 3).replace("3 0 1 2", "-3 0 1 2 3"), "three corners or more.*faces: 0"),
    ("c.off", OFF.format(0, 10**20), "beyond all numbers"),
    ("d.obj", OBJ.format(10**20), "beyond all numbers"),
    ("e.ply", PLY.format(10**20), ""),
])  # fmt: skip
def test_numbers_that_name_nothing_are_refused_with_the_file(
    tmp_path: Path, name: str, content: str, words: str
) -> None:
    with pytest.raises(hem.MeshError, match=f"{name}.*{words}"):
        hem.load_polygons(written(tmp_path / name, content))


def test_stl_files_are_text_in_any_case_and_binary_whatever_their_first_word(
    tmp_path: Path,
) -> None:
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    text = f"solid some\n{facet}endfacet\nendsolid some\n"
    for content in (text, text.upper(), f"\n {text.title()}"):
        assert len(hem.load(written(tmp_path / "text.stl", content)).triangles) == 1
    file = tmp_path / "binary.stl"
    hem.save(hem.generate("sphere", 42), file)
    data = b"solid" + file.read_bytes()[5:]
    for more in (b"", b"\0\0"):
        assert len(hem.load(written(file, data + more)).triangles) == 80


@pytest.mark.parametrize("head", [b"\xef\xbb\xbf", b"# from C:\\models\\\n", b"v 0 \\\n0 -1\n"])
def test_no_head_of_an_obj_file_takes_a_vertex_with_it(tmp_path: Path, head: bytes) -> None:
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 2, 2)]
    lines = [*(f"v {x} {y} {z}" for x, y, z in points), "f -4 -3 -2", ""]
    (tmp_path / "it.obj").write_bytes(head + "\n".join(lines).encode())
    mesh = hem.load(tmp_path / "it.obj")
    assert mesh.points[-4:].tolist() == [list(map(float, it)) for it in points]
    assert mesh.points[mesh.triangles[0]].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
