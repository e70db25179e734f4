"""Meshes from files and into files: ply, obj, off and stl read here, all else by pymeshlab."""

import os
import struct
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Literal, overload

import numpy as np

from hem.arrays import Array, Points
from hem.errors import MeshError
from hem.meshes import PolygonMesh, TriangleMesh, repeats_a_corner
from hem.ragged import Ragged
from hem.sources.ctm import promised_bytes
from hem.sources.meshlab import MeshlabError, load_file, save_file
from hem.sources.ply import read_ply, write_ply
from hem.sources.repair import repaired
from hem.sources.text import (
    Parts,
    cut_short,
    read_obj,
    read_off,
    read_stl,
    uniform,
    write_obj,
    write_off,
    write_stl,
)
from hem.whole_files import write_whole

_COMMON = "ply, obj, off, stl, 3ds, dae, wrl, x3d, ctm"
_READERS: dict[str, Callable[[bytes], Parts]] = {
    "ply": read_ply, "obj": read_obj, "off": read_off, "stl": read_stl,
}  # fmt: skip
_WRITERS: dict[str, Callable[[Points, Ragged], bytes]] = {
    "ply": write_ply, "obj": write_obj, "off": write_off, "stl": write_stl,
}  # fmt: skip
_SAYS_ONLY_WHERE = ("Unable to open file", "Error encountered while loading file", "File:", '"')


@overload
def load(
    path: str | os.PathLike[str], repair: bool = False, *, triangulate: Literal[True]
) -> TriangleMesh: ...


@overload
def load(
    path: str | os.PathLike[str], repair: bool = False, triangulate: bool = False
) -> TriangleMesh | PolygonMesh: ...


def load(
    path: str | os.PathLike[str], repair: bool = False, triangulate: bool = False
) -> TriangleMesh | PolygonMesh:
    """The mesh of a file: ply, obj, off, stl, and of any other format that pymeshlab reads.

    A `PolygonMesh` if it has faces of more than three corners (ply, obj and off), which only some
    structures hold; with `triangulate`, or in other formats, these are cut into triangles.

    Vertices keep their order, also those without faces and those of one position, but for STL,
    which has no shared vertices: there the ones of one position become one. Several meshes in one
    file become one mesh. With `repair`, elements that cannot be used (corners out of range or
    repeated, coordinates that are not finite) are left out, and pymeshlab's repair filters make
    the mesh a surface (hem.sources.repair).

    O(bytes). Raises MeshError, naming the file and what is wrong, for one that is missing, a
    folder, empty, cut short, of an unknown format, no mesh, or without faces, and without
    `repair` for one with elements that cannot be used; and where pymeshlab is needed, but missing.
    """
    file = Path(path).absolute()
    try:
        points, faces = _read(file)
        if repair:
            points, faces = _usable(points, faces)
        mesh = _mesh(points, faces)
        if isinstance(mesh, PolygonMesh) and not (triangulate or repair):
            return mesh
        triangles = mesh.triangulated() if isinstance(mesh, PolygonMesh) else mesh
        if not len(triangles.triangles):
            raise MeshError(f"there are no triangles in it, only {len(points):,} points")
        return repaired(triangles) if repair else triangles
    except MeshError as error:
        raise type(error)(f"cannot load {file}: {error.reason}", **error.elements) from error


def save(mesh: TriangleMesh | PolygonMesh, path: str | os.PathLike[str]) -> None:
    """Write the mesh in the format that the path's extension names; replaces what is there.

    ply, off and obj keep every float32, every vertex and every polygon; 3ds keeps no polygons, and
    stl (binary) only triangles and vertices that have faces; text formats such as wrl, dae and x3d
    round the coordinates. A broken run never leaves half a file. Raises MeshError where the format
    is unknown, or keeps no polygons, or the folder cannot be written.
    """
    file = Path(path).absolute()
    if not file.parent.is_dir():
        raise MeshError(f"cannot save {file}: there is no folder {file.parent}")
    try:
        write_whole(file, encoded(mesh, _extension(file)))
    except MeshError as error:
        raise MeshError(f"cannot save {file}: {error.reason}") from error
    except OSError as error:
        raise MeshError(f"cannot save {file}: {error.strerror or error}") from error


def encoded(mesh: TriangleMesh | PolygonMesh, extension: str) -> bytes:
    """The content of a file of this extension (lower case, no dot) that holds the mesh."""
    if extension in _WRITERS:
        faces = mesh.faces if isinstance(mesh, PolygonMesh) else uniform(mesh.triangles)
        return _WRITERS[extension](mesh.points, faces)
    if isinstance(mesh, PolygonMesh):
        raise MeshError("polygons are kept by ply, obj and off; or take mesh.triangulated()")
    with tempfile.TemporaryDirectory(prefix="hem-") as folder:
        beside = Path(folder) / f"mesh.{extension}"
        try:
            save_file(mesh, beside)
        except MeshlabError as error:
            raise MeshError(_words(error)) from error
        return beside.read_bytes()


def _extension(file: Path) -> str:
    return file.suffix.lower().removeprefix(".")


def _read(file: Path) -> Parts:
    data, extension = _bytes(file), _extension(file)
    if extension in _READERS:
        return _READERS[extension](data)
    promised = _promised(data, extension)
    if len(data) < promised:  # pymeshlab would read the half of it
        raise cut_short(f"{len(data):,} of {promised:,} bytes")
    try:
        points, triangles = load_file(file)
    except MeshlabError as error:
        raise MeshError(_words(error)) from error
    return points, uniform(triangles)


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
    if file.is_dir():
        raise MeshError("it is a folder; name a file in it")
    if not file.exists():
        raise MeshError(f"there is no such file; the current folder is {Path.cwd()}")
    if not file.suffix:
        raise MeshError(f"its name has no extension to tell the format (usual: {_COMMON})")
    try:
        data = file.read_bytes()
    except OSError as error:
        raise MeshError(f"it cannot be read: {error.strerror}") from error
    if not data.strip():
        raise MeshError("the file is empty; get it anew")
    return data


def _mesh(points: Array, faces: Ragged) -> TriangleMesh | PolygonMesh:
    try:
        if (faces.counts == 3).all():
            return TriangleMesh(points, faces.values.reshape(-1, 3))
        return PolygonMesh(points, faces)
    except MeshError as error:
        hint = f"{error.reason}; or leave them out with repair=True"
        raise MeshError(hint, **error.elements) from error


def _usable(points: Array, faces: Ragged) -> Parts:
    """Without points that are not finite, and faces that have such corners or are no polygons."""
    with np.errstate(over="ignore"):
        finite = np.all(np.isfinite(np.asarray(points, np.float32)), axis=1)
    corners, counts = faces.values, faces.counts
    inside = (corners >= 0) & (corners < len(points))
    inside[inside] = finite[corners[inside]]
    face = np.repeat(np.arange(len(counts)), counts)
    strays = np.bincount(face[~inside], minlength=len(counts)) > 0
    good = ~strays & (counts >= 3) & ~repeats_a_corner(faces)
    renumbered = np.cumsum(finite) - 1
    offsets = np.concatenate([[0], np.cumsum(counts[good])])
    return points[finite], Ragged(offsets, renumbered[corners[good[face]]])


def _words(error: MeshlabError) -> str:
    """The message of pymeshlab in one line, without the path, which the caller has named."""
    lines = [line.strip() for line in error.reason.splitlines() if line.strip()]
    said = [line for line in lines if not line.startswith(_SAYS_ONLY_WHERE)]
    message = " ".join(said or lines).replace("Error details: ", "")
    if "Unknown format" in message:
        return f"{message} (usual: {_COMMON})"
    return f"pymeshlab says {message!r}; is it whole, and of the format of its name?"
