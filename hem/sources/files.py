"""Meshes from files and into files, in the formats that pymeshlab knows."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, overload

import numpy as np

from hem.errors import MeshError
from hem.meshes.polygons import PolygonMesh
from hem.meshes.triangles import TriangleMesh, repeated_corners
from hem.sources.contents import Contents, contents, off_polygons, without_stray_corners

_PLAIN = {"save_vertex_normal": False, "save_vertex_color": False}
_SAVE_OPTIONS: dict[str, dict[str, bool]] = {
    "ply": {**_PLAIN, "save_vertex_quality": False},
    "obj": _PLAIN,
}
_SAYS_ONLY_WHERE = ("Unable to open file", "Error encountered while loading file", "File:", '"')
_COMMON = "ply, obj, off, stl, 3ds, dae, wrl, x3d, ctm"


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
    """The mesh of a file, of any format that pymeshlab reads.

    A `PolygonMesh` if it has faces of more than three corners (ply, obj and off), which only some
    structures hold; with `triangulate`, or in other formats, these are cut into triangles.

    Vertices keep their order, also those without faces and those of one position, but for STL,
    which has no shared vertices: there the ones of one position become one. Several meshes in one
    file become one mesh. With `repair`, elements that cannot be used (corners out of range or
    repeated, coordinates that are not finite) are left out, and pymeshlab's repair filters make
    the mesh a surface (hem.meshes.repair).

    O(bytes). Raises MeshError, naming the file and what is wrong, for one that is missing, a
    folder, empty, cut short, of an unknown format, no mesh, or without faces, and without
    `repair` for one with elements that cannot be used.
    """
    file = Path(path).absolute()
    try:
        data = _bytes(file)
        held = contents(data, _extension(file))
        sound, stray = without_stray_corners(data, _extension(file))
        if stray and not repair:
            raise MeshError(
                f"{stray:,} of {held.faces or stray:,} faces have corners out of range; "
                "repair=True leaves those out"
            )
        with _written(file, None if sound is data else sound) as readable:
            found = _read(readable, sound, contents(sound, _extension(file)), repair)
        if not repair:
            _require_all(found, held)
        if isinstance(found, PolygonMesh) and not (triangulate or repair):
            return found
        mesh = found.triangulated() if isinstance(found, PolygonMesh) else found
        if not len(mesh.triangles):
            raise MeshError(f"there are no triangles in it, only {len(mesh.points):,} points")
        return _repaired(mesh) if repair else mesh
    except MeshError as error:
        raise type(error)(f"cannot load {file}: {error.reason}", **error.elements) from error


def save(mesh: TriangleMesh | PolygonMesh, path: str | os.PathLike[str]) -> None:
    """Write the mesh in the format that the path's extension names; replaces what is there.

    ply, off, obj and 3ds keep every float32 and every vertex; stl (binary) keeps only vertices
    that have faces; text formats such as wrl, dae and x3d round the coordinates. Polygons are kept
    by obj alone, where a face may begin with another corner. Written beside and renamed, so that
    a broken run never leaves half a file. Raises MeshError where the format is unknown, or keeps
    no polygons, or the folder cannot be written.
    """
    from hem.sources.meshlab import mesh_set, meshlab, undisturbed

    file = Path(path).absolute()
    if not file.parent.is_dir():
        raise MeshError(f"cannot save {file}: there is no folder {file.parent}")
    options = _SAVE_OPTIONS.get(_extension(file), {})
    if isinstance(mesh, PolygonMesh):
        if _extension(file) != "obj":  # pymeshlab 2025.7 cuts them in ply, and turns faces in off
            raise MeshError(
                f"cannot save {file}: polygons are kept in obj files only; save it as one, or "
                "mesh.triangulated()"
            )
        options = {**_PLAIN, "save_polygonal": True}
    try:
        with tempfile.TemporaryDirectory(dir=file.parent, prefix=".hem-") as folder, undisturbed():
            beside = Path(folder) / file.name
            mesh_set(mesh).save_current_mesh(str(beside), **options)
            os.replace(beside, file)
    except (OSError, meshlab().PyMeshLabException) as error:
        raise MeshError(f"cannot save {file}: {_words(error)}") from error


@contextmanager
def _written(file: Path, data: bytes | None) -> Iterator[Path]:
    """The file itself, or for a while one with this content instead."""
    if data is None:
        yield file
        return
    with tempfile.TemporaryDirectory(prefix="hem-") as folder:
        other = Path(folder) / file.name
        other.write_bytes(data)
        yield other


def _extension(file: Path) -> str:
    return file.suffix.lower().removeprefix(".")


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


def _read(
    file: Path, data: bytes, held: Contents, drop_unusable: bool
) -> TriangleMesh | PolygonMesh:
    from hem.sources.meshlab import mesh_set, meshlab, undisturbed

    meshes = mesh_set()
    try:
        with undisturbed():
            meshes.load_new_mesh(str(file))
            several = meshes.mesh_number() > 1
            if several:
                meshes.generate_by_merging_visible_meshes(
                    mergevertices=False, alsounreferenced=True
                )
    except meshlab().PyMeshLabException as error:
        raise MeshError(f"{_words(error)}") from error
    cut = held.faces is not None and meshes.current_mesh().face_number() > held.faces
    if cut and not several:
        return _polygons(meshes.current_mesh(), _extension(file), data, drop_unusable)
    return _current(meshes, drop_unusable)


def _polygons(current: Any, extension: str, data: bytes, drop_unusable: bool) -> PolygonMesh:
    """The faces as they stand in the file; pymeshlab has cut them, and puts them together again."""
    points: Any = current.transformed_vertex_matrix()
    if extension == "off":  # of faces with five corners or more pymeshlab 2025.7 makes other ones
        points, faces = off_polygons(data)
    else:  # a polygon comes turned by one corner, a triangle does not
        listed = current.polygonal_face_list()
        faces = [np.roll(face, len(face) > 3).tolist() for face in listed]
    if drop_unusable:
        faces = [face for face in faces if len(set(face)) == len(face) > 2]
    return PolygonMesh(points, faces)


def _current(meshes: Any, drop_unusable: bool) -> TriangleMesh:
    current = meshes.current_mesh()
    points, triangles = current.transformed_vertex_matrix(), current.face_matrix()
    if drop_unusable:
        outside = ((triangles < 0) | (triangles >= len(points))).any(axis=1)
        triangles = triangles[~outside & ~repeated_corners(triangles)]
    return TriangleMesh(points, triangles)


def _require_all(mesh: TriangleMesh | PolygonMesh, held: Contents) -> None:
    """Hold the mesh against the file: pymeshlab silently leaves out what it cannot use."""
    faces = len(mesh.faces) if isinstance(mesh, PolygonMesh) else len(mesh.triangles)
    fewer_vertices = held.vertices is not None and len(mesh.points) < held.vertices
    fewer_faces = held.faces is not None and faces < held.faces
    if fewer_vertices or fewer_faces:
        raise MeshError(
            f"it holds {_counted(held)}, of which only {len(mesh.points):,} vertices and "
            f"{faces:,} faces can be used: others have coordinates that are not "
            "finite, or corners that are repeated or out of range; repair=True leaves those out"
        )


def _counted(held: Contents) -> str:
    pairs = ((held.vertices, "vertices"), (held.faces, "faces"))
    return " and ".join(f"{number:,} {kind}" for number, kind in pairs if number is not None)


def _repaired(mesh: TriangleMesh) -> TriangleMesh:
    from hem.meshes.repair import repaired

    return repaired(mesh)


def _words(error: Exception) -> str:
    """The message of pymeshlab in one line, without the path, which the caller has named."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    said = [line for line in lines if not line.startswith(_SAYS_ONLY_WHERE)]
    message = " ".join(said or lines).replace("Error details: ", "")
    if "Unknown format" in message:
        return f"{message} (usual: {_COMMON})"
    return f"pymeshlab says {message!r}; is it whole, and of the format of its name?"
