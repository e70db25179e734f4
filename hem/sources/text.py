"""Reading and writing obj, off and stl: points, and faces of any number of corners.

Readers are strict. What is cut short or no number is a MeshError; corners that are out of range are
handed on, for the mesh to refuse by their rows.
"""

import re
from collections.abc import Iterable
from itertools import chain
from typing import NamedTuple

import numpy as np

from hem.arrays import Array, Floats, Points
from hem.errors import MeshError
from hem.meshes import clusters
from hem.ragged import Ragged

_OBJ_BESIDE = {
    b"vt": "texture coordinates", b"vn": "normals", b"usemtl": "materials", b"p": "points",
    b"l": "lines", b"curv": "curves", b"surf": "free-form surfaces",
}  # fmt: skip
_OFF_BESIDE = {b"ST": "texture coordinates", b"C": "colors", b"N": "normals"}
_LOOP = rb"\bloop" + 3 * rb"\s+vertex\s+(\S+)\s+(\S+)\s+(\S+)" + rb"\s+endloop"
_NAMED = re.compile(rb"\b(end)?solid\b.*?(?=[\r\n]|\bfacet\s+normal|\Z)")  # its name is any words


class Parts(NamedTuple):
    """What a file holds: (n, 3) points, a row of corners per face, and names for all else."""

    points: Array
    faces: Ragged
    dropped: Iterable[str] = ()


def as_ragged(rows: list[list[int]]) -> Ragged:
    """Rows of corners in two arrays."""
    offsets = np.cumsum([0, *map(len, rows)], dtype=np.int64)
    try:
        corners = np.fromiter(chain.from_iterable(rows), np.int64, offsets[-1])
    except OverflowError as error:
        raise MeshError("a face names a vertex beyond all numbers; get the file anew") from error
    return Ragged(offsets, corners)


def uniform(triangles: Array) -> Ragged:
    """Faces (m, k) as rows."""
    m, k = triangles.shape
    return Ragged(np.arange(m + 1, dtype=np.int64) * k, triangles.ravel())


def cut_short(holds: str) -> MeshError:
    """What to raise for a file that is not all there."""
    return MeshError(f"the file is cut short or broken: it has {holds}; get it anew")


def read_obj(data: bytes) -> Parts:
    """Points and faces of an obj file; corners may count backward, lines go on behind a backslash.

    MeshLab, and `write_obj`, say at the head how many there are: the only way to know of an obj
    file that it is whole.
    """
    points: list[list[float]] = []
    faces: list[list[int]] = []
    dropped: dict[str, None] = {}
    for line in re.sub(rb"(?m)^([^#\n]*)\\\r?\n", rb"\1 ", data).splitlines():
        kind, *words = line.partition(b"#")[0].split() or [b""]
        try:
            if kind == b"v":
                points.append([float(word) for word in words[:3]])
                if len(words) >= 6:
                    dropped["colors"] = None
            elif kind in (b"f", b"fo"):  # fo: of old files
                corners = [int(word.partition(b"/")[0]) for word in words]
                faces.append([v - 1 if v >= 0 else max(len(points) + v, -1) for v in corners])
            elif kind in _OBJ_BESIDE:
                dropped[_OBJ_BESIDE[kind]] = None
        except ValueError as error:
            raise MeshError(f"a line is no {kind.decode()} line: {line[:60]!r}") from error
    for name, found in ((b"Vertices", points), (b"Faces", faces)):
        said = re.search(rb"(?m)^# " + name + rb": (\d+)", data[:2000])
        if said and len(found) < int(said[1]):
            raise cut_short(f"{len(found):,} of {int(said[1]):,} {name.decode().lower()}")
    if faces and len(faces[-1]) < 3:
        raise cut_short("a last line without all its numbers")
    return Parts(_rows_of_three(points), as_ragged(faces), dropped)


def read_off(data: bytes) -> Parts:
    """Points and faces of an off file."""
    lines = [line.split() for raw in data.splitlines() if (line := raw.partition(b"#")[0].strip())]
    if len(lines) < 2 or not lines[0][0].endswith(b"OFF"):
        raise MeshError("it does not begin as off files do, with OFF and how much it holds")
    kind = lines[0][0].removesuffix(b"OFF")
    if re.search(rb"[4n]", kind):
        named = lines[0][0].decode("latin-1")
        raise MeshError(f"its points are not of three dimensions: {named!r}")
    dropped = [words for letter, words in _OFF_BESIDE.items() if letter in kind]
    counts, *elements = lines[1:] if len(lines[0]) == 1 else [lines[0][1:], *lines[1:]]
    try:
        n, m = int(counts[0]), int(counts[1])
        if not (0 <= n <= len(data) and 0 <= m <= len(data)):
            raise cut_short(f"{len(data):,} bytes, and promises {n:,} vertices and {m:,} faces")
        points = [[float(word) for word in line[:3]] for line in elements[:n]]
        faces = [(line, max(int(line[0]), 0)) for line in elements[n : n + m]]
        rows = [[int(word) for word in line[: corners + 1]] for line, corners in faces]
        if any(len(line) > len(row) for line, row in zip(elements[n:], rows, strict=False)) or (
            not kind and any(len(line) > 3 for line in elements[:n])
        ):
            dropped.append("colors")
    except MeshError:
        raise
    except (ValueError, IndexError) as error:
        raise MeshError(f"it has something else where a number belongs: {error}") from error
    if len(rows) < m:
        raise cut_short(f"{len(points) + len(rows):,} of {n + m:,} lines")
    if any(len(row) <= row[0] for row in rows):
        raise cut_short("a face without all its corners")
    return Parts(_rows_of_three(points), as_ragged([row[1:] for row in rows]), dropped)


def read_stl(data: bytes) -> Parts:
    """Points, one per position, and triangles of an stl file, binary or text.

    Its normals are those of the triangles, so that nothing is lost with them; what a binary file
    has beside, two bytes a triangle, are colors where they are not zero.
    """
    dropped: list[str] = []
    count = int.from_bytes(data[80:84], "little")
    binary = len(data) >= 84 + 50 * count
    if data[:80].lstrip()[:5].lower() == b"solid" and not binary:
        text = _NAMED.sub(rb"\1solid", data.lower())
        numbers = re.findall(_LOOP, text)
        if b"endsolid" not in text.rstrip()[-500:] or len(numbers) != text.count(b"endfacet"):
            raise cut_short("no 'endsolid' at its end, or a facet without three vertices")
        try:
            corners = np.array(numbers, np.bytes_).reshape(-1, 3).astype(np.float64)
        except ValueError as error:
            raise MeshError(f"a vertex has a coordinate that is no number: {error}") from error
    elif binary:
        facets = np.frombuffer(data, _FACET, count, offset=84)
        corners = facets["corners"].reshape(-1, 3)
        dropped += ["colors"] * bool(facets["attribute"].any())
    else:
        raise cut_short(f"{len(data):,} of {84 + 50 * count:,} bytes")
    first, cluster = clusters(corners, 0.0)
    return Parts(corners[first], uniform(cluster.reshape(-1, 3)), dropped)


def write_obj(points: Points, faces: Ragged) -> bytes:
    """Text with the counts at its head, every digit and all corners of every face."""
    head = f"# Vertices: {len(points)}\n# Faces: {len(faces)}\n"
    counted = Ragged(faces.offsets, faces.values + 1)
    rows = ["f " + " ".join(map(str, row)) for row in counted.to_list()]
    return "\n".join([head, *_positions("v ", points), *rows, ""]).encode()


def write_off(points: Points, faces: Ragged) -> bytes:
    """Text with every digit and all corners of every face."""
    head = f"OFF\n{len(points)} {len(faces)} 0"
    rows = [" ".join(map(str, (len(row), *row))) for row in faces.to_list()]
    return "\n".join([head, *_positions("", points), *rows, ""]).encode()


def write_stl(points: Points, faces: Ragged) -> bytes:
    """Binary. Raises MeshError for faces of more than three corners."""
    if (faces.counts != 3).any():
        raise MeshError("polygons are kept by ply, obj and off; or take mesh.triangulated()")
    facets = np.zeros(len(faces), _FACET)
    facets["corners"] = points[faces.values.reshape(-1, 3)]
    return bytes(80) + len(faces).to_bytes(4, "little") + facets.tobytes()


_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def _rows_of_three(points: list[list[float]]) -> Floats:
    if any(len(point) != 3 for point in points):
        raise cut_short("a vertex without three coordinates")
    return np.array(points, np.float64).reshape(-1, 3)


def _positions(before: str, points: Points) -> list[str]:
    digits = 17 if points.dtype == np.float64 else 9
    row = before + " ".join([f"%.{digits}g"] * 3)
    return [row % tuple(point) for point in points.tolist()]
