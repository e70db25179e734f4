"""Meshes from files and into files: ply, obj, off and stl read here, all else by pymeshlab."""

import codecs
import os
import re
import struct
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from hem.arrays import Array, Points
from hem.errors import MeshError, MeshWarning
from hem.meshes import (
    PolygonMesh,
    TriangleMesh,
    clusters,
    from_any,
    position_type,
    repeats_a_corner,
    require_triangles,
    simplest,
)
from hem.ragged import Ragged
from hem.sources import text
from hem.sources.ctm import besides, promised_bytes
from hem.sources.meshlab import MeshlabError, load_file, save_file
from hem.sources.ply import read_ply, write_ply
from hem.sources.repair import repaired
from hem.sources.text import Parts, cut_short, uniform
from hem.whole_files import write_whole

FilePath = str | os.PathLike[str]
_COMMON = "ply, obj, off, stl, 3ds, dae, wrl, x3d, ctm"
_READERS: dict[str, Callable[[bytes], Parts]] = {
    "ply": read_ply, "obj": text.read_obj, "off": text.read_off, "stl": text.read_stl,
}  # fmt: skip
_WRITERS: dict[str, Callable[[Points, Ragged], bytes]] = {
    "ply": write_ply, "obj": text.write_obj, "off": text.write_off, "stl": text.write_stl,
}  # fmt: skip
_BESIDE = {
    "texture coordinates": rb'"TEXCOORD|\bTextureCoordinate\b',
    "normals": rb'"NORMAL"|<Normal\b|\bNormal\s*\{',
    "colors": rb'"COLOR|<Color|\bColor(RGBA)?\s*\{',
    "materials": rb'"materials"\s*:|<[Mm]aterial\b',
    "poses and motions": rb'"(skins|targets|animations)"\s*:|<(skin|morph|animation)\b',
    "shapes that pymeshlab leaves out": rb"<(tri(strips|fans)|line(s|strips)|polygons)\b"
    rb"|(<|\bgeometry\s+)(Indexed)?(LineSet|PointSet|Box|Cone|Extrusion|Text|Nurbs\w+"
    rb"|(Arc|Circ|Disk|Poly|Rect|Tri)\w*2D)\b",
}
"""What text that pymeshlab reads has beside; it does not tell, and makes normals of its own."""

_MISREAD = (
    rb'"mode"\s*:\s*[0-356]|"sparse"\s*:\s*\{'  # strips, fans, lines; numbers that replace some
    rb'|"EXT_mesh_gpu_instancing"\s*:\s*\{|<(Indexed)?TriangleStripSet\b|<(skew|lookat)\b'
    rb"|<scale\b[^>]*>(?!(\s*1(\.0*)?){3}\s*<)[^<]*"
)
"""What gltf, glb, dae and x3d may have, and pymeshlab reads the triangles as if it were not there;
and strips, of which it turns every other triangle around."""

_NUMBER = rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_FRAME = rb"(?:<matrix\b[^>]*>|\bscale\b\s*(?:=\s*[\"'])?)((?:[\s,]*%b){3}(?:(?:[\s,]+%b){13})?)"
"""The matrix of a part in dae, or its scale in x3d and wrl, by which it may be mirrored."""

_SAYS_ONLY_WHERE = ("Unable to open file", "Error encountered while loading file", "File:", '"')


def load(
    path: FilePath, repair: bool = False, triangulate: bool = False, dtype: DTypeLike = np.float32
) -> TriangleMesh:
    """The triangles of a file: ply, obj, off, stl, and of any other format that pymeshlab reads.

    >>> hem.save(hem.valence_mesh(6, 12), "model.ply")
    >>> hem.load("model.ply")
    TriangleMesh(8 vertices, 12 faces)

    Faces of more than three corners are a MeshError: `load_polygons` keeps them, and with
    `triangulate` they are cut, as pymeshlab does with those of all formats but ply, obj and off.

    Vertices keep their order, also those without faces and those of one position, but for STL,
    which has no shared vertices: there the ones of one position become one. Several meshes in one
    file become one mesh. With `repair`, elements that cannot be used (corners out of range or
    repeated, coordinates that are not finite) are left out, and pymeshlab's repair filters make
    the mesh a surface (hem.sources.repair). `dtype` is that of the positions, see `TriangleMesh`.

    O(bytes). A MeshWarning names normals, texture coordinates and whatever else the file has and a
    mesh does not. Raises MeshError, naming the file and what is wrong, for one that is missing, a
    folder, empty, cut short, of an unknown format, no mesh, or without faces, and without `repair`
    for one with elements that cannot be used; and where pymeshlab is needed, but missing.
    """
    with _about("load", path) as file:
        mesh = _read_mesh(file, repair, dtype)
        if triangulate and isinstance(mesh, PolygonMesh):
            mesh = mesh.triangulated()
        triangles = require_triangles(mesh, "keep them with hem.load_polygons(path)")
        return repaired(triangles) if repair else triangles


def load_polygons(path: FilePath, dtype: DTypeLike = np.float32) -> PolygonMesh:
    """The faces of a file, of any number of corners where it is ply, obj or off; else see `load`.

    Only some structures hold such a mesh; `triangulated()` cuts it.
    """
    with _about("load", path) as file:
        mesh = _read_mesh(file, False, dtype)
        return PolygonMesh(mesh.points, mesh.face_rows(), dtype)


def as_mesh(given: Any) -> TriangleMesh | PolygonMesh:
    """The mesh of a path, a structure, a pair of arrays, or whatever has vertices and faces.

    >>> hem.as_mesh(([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    TriangleMesh(3 vertices, 1 faces)

    Of triangles if it has no other faces; with positions as float32, but for a mesh that keeps them
    otherwise. O(n + m). Raises MeshError that names what was given, and what is taken.
    """
    if isinstance(given, str | os.PathLike):
        return simplest(load_polygons(given))
    return from_any(given)


def save(mesh: Any, path: FilePath) -> None:
    """Write a mesh, or what `as_mesh` takes, in the format that the path's extension names.

    Replaces what is there. ply, off and obj keep every bit, every vertex and every polygon; the
    others round to float32. 3ds keeps no polygons, and stl (binary) only triangles and vertices
    that have faces; text formats such as wrl, dae and x3d keep six digits of a coordinate, 3mf six
    decimals, and ctm has the faces in another order. x3d has one vertex per position: a
    MeshWarning tells where some become one. A broken run never leaves half a file. Raises MeshError
    where the format is none that `load` reads, or keeps no polygons or not all faces, or the folder
    cannot be written.
    """
    with _about("save", path) as file:
        try:
            if not file.parent.is_dir():
                raise MeshError(f"there is no folder {file.parent}")
            write_whole(file, encoded(as_mesh(mesh), _extension(file)))
        except OSError as error:
            raise MeshError(error.strerror or str(error)) from error


def encoded(mesh: TriangleMesh | PolygonMesh, extension: str) -> bytes:
    """The content of a file of this extension (lower case, no dot) that holds the mesh."""
    if extension not in ("ply", "obj", "off"):
        mesh = mesh.astype(np.float32)
    if extension in _WRITERS:
        return _WRITERS[extension](mesh.points, mesh.face_rows())
    if isinstance(mesh, PolygonMesh):
        raise MeshError("polygons are kept by ply, obj and off; or take mesh.triangulated()")
    if not len(mesh.points):
        raise MeshError("there are no vertices in it; ply, obj and off keep a mesh without any")
    if extension == "x3d" and len(clusters(mesh.points, 0.0)[0]) < len(mesh.points):
        message = "x3d has one vertex per position: those that coincide become one"
        warnings.warn(message, MeshWarning, stacklevel=3)
    with tempfile.TemporaryDirectory(prefix="hem-") as folder:
        beside = Path(folder) / f"mesh.{extension}"
        try:
            save_file(mesh, beside)
        except MeshlabError as error:
            raise MeshError(_words(error)) from error
        if not beside.exists():
            raise MeshError(f"pymeshlab writes no {extension} file")
        kept = len(_read(beside, repair=True).faces)  # of what it could not write, it tells nothing
        if kept < len(mesh.triangles):
            raise MeshError(f"pymeshlab writes {kept:,} of {len(mesh.triangles):,} faces into it")
        return beside.read_bytes()


def _extension(file: Path) -> str:
    return file.suffix.lower().removeprefix(".")


def _read(file: Path, repair: bool = False) -> Parts:
    data, extension = _bytes(file), _extension(file)
    if extension in _READERS:
        return _READERS[extension](data)
    promised = _promised(data, extension)
    if len(data) < promised:  # pymeshlab would read the half of it
        raise cut_short(f"{len(data):,} of {promised:,} bytes")
    frames = re.finditer(_FRAME % (_NUMBER, _NUMBER), data)
    if misread := re.search(_MISREAD, data) or next(filter(_mirrors, frames), None):
        words = misread[0].decode("latin-1")
        raise MeshError(f"pymeshlab misreads {words!r}; write plain triangles into it")
    try:
        points, triangles, left_out = load_file(file)
    except MeshlabError as error:
        raise MeshError(_words(error, "; is it whole, and of the format of its name?")) from error
    if left_out and not repair:
        raise MeshError(
            f"{left_out:,} of its points and triangles are not finite or use a vertex twice; "
            "leave them out with hem.load(path, repair=True)"
        )
    return Parts(points, uniform(triangles), _besides(data, extension))


def _mirrors(frame: re.Match[bytes]) -> bool:
    """Whether faces would have to be turned around, which pymeshlab leaves as they are."""
    numbers = np.array([float(it) for it in re.findall(_NUMBER, frame[1])])
    matrix = np.diag(numbers) if len(numbers) == 3 else numbers.reshape(4, 4)[:3, :3]
    return bool(np.linalg.det(matrix) < 0)


def _besides(data: bytes, extension: str) -> list[str]:
    """What a file has beside points and faces, by what its format writes for that."""
    if extension == "ctm":
        return besides(data)
    if extension == "3ds":  # a part's number, its bytes, and how many coordinates it has
        parts = re.findall(rb"(?s)\x40\x41(.{4})(..)", data)
        sizes = [[int.from_bytes(number, "little") for number in part] for part in parts]
        return ["texture coordinates"] * any(size == 8 + 8 * count for size, count in sizes)
    return [name for name, words in _BESIDE.items() if re.search(words, data)]


def _promised(data: bytes, extension: str) -> int:
    """How many bytes a file says that it has, where it does."""
    if extension == "3ds":
        return max(int.from_bytes(data[2:6], "little"), 6)
    if extension == "ctm":
        try:
            return promised_bytes(data)
        except (struct.error, KeyError) as error:
            raise cut_short(f"{len(data):,} bytes, and no whole part at its end") from error
    return 0


def _bytes(file: Path) -> bytes:
    try:
        if file.is_dir():
            raise MeshError("it is a folder; name a file in it")
        if not file.exists():
            raise MeshError(f"there is no such file; the current folder is {Path.cwd()}")
        if not file.suffix:
            raise MeshError(f"its name has no extension to tell the format (usual: {_COMMON})")
        data = file.read_bytes()
    except OSError as error:  # a name that is too long for a file, as well
        raise MeshError(f"it cannot be read: {error.strerror}") from error
    data = data.removeprefix(codecs.BOM_UTF8)
    if not data.strip():
        raise MeshError("the file is empty; get it anew")
    return data


def _read_mesh(file: Path, repair: bool, dtype: DTypeLike) -> TriangleMesh | PolygonMesh:
    kind = position_type(dtype)
    points, faces, dropped = _read(file, repair)
    if repair:
        points, faces = _usable(points, faces, kind)
    names = ", ".join(dict.fromkeys(dropped))
    if not len(faces):
        beside = f" and {names}" if names else ""
        raise MeshError(f"there are no triangles in it, only {len(points):,} points{beside}")
    if names:
        message = f"{file} has {names}, which are dropped: a mesh is positions and faces"
        warnings.warn(message, MeshWarning, stacklevel=3)
    try:
        if (faces.counts == 3).all():
            return TriangleMesh(points, faces.values.reshape(-1, 3), dtype)
        return PolygonMesh(points, faces, dtype)
    except MeshError as error:
        hint = f"{error.reason}; or leave them out with hem.load(path, repair=True)"
        raise MeshError(hint, **error.elements) from error


@contextmanager
def _about(task: str, path: FilePath) -> Iterator[Path]:
    """The file; every MeshError names it, and what could not be done with it."""
    file = Path(path).absolute()
    try:
        yield file
    except MeshError as error:
        raise type(error)(f"cannot {task} {file}: {error.reason}", **error.elements) from error


def _usable(points: Array, faces: Ragged, dtype: DTypeLike) -> tuple[Array, Ragged]:
    """Without points that are not finite, and faces that have such corners or are no polygons."""
    with np.errstate(over="ignore"):
        finite = np.all(np.isfinite(np.asarray(points, dtype)), axis=1)
    corners, counts = faces.values, faces.counts
    inside = (corners >= 0) & (corners < len(points))
    inside[inside] = finite[corners[inside]]
    face = np.repeat(np.arange(len(counts)), counts)
    strays = np.bincount(face[~inside], minlength=len(counts)) > 0
    good = ~strays & (counts >= 3) & ~repeats_a_corner(faces)
    renumbered = np.cumsum(finite) - 1
    offsets = np.concatenate([[0], np.cumsum(counts[good])])
    return points[finite], Ragged(offsets, renumbered[corners[good[face]]])


def _words(error: MeshlabError, hint: str = "") -> str:
    """The message of pymeshlab in one line, without the path, which the caller has named."""
    lines = [line.strip() for line in error.reason.splitlines() if line.strip()]
    said = [line for line in lines if not line.startswith(_SAYS_ONLY_WHERE)]
    message = " ".join(said or lines).replace("Error details: ", "")
    if "Unknown format" in message:
        return f"{message} (usual: {_COMMON})"
    return f"pymeshlab says {message!r}{hint}"
