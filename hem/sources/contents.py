"""How many vertices and faces a file holds, counted without pymeshlab.

pymeshlab silently loads the first half of many truncated files, and silently leaves out what it
cannot use. These counts, from the file's own words, are what its result is held against.
"""

import re
import struct
from bisect import bisect
from collections.abc import Callable
from itertools import compress
from typing import NamedTuple

from hem.errors import MeshError


class Contents(NamedTuple):
    """What a file holds; a face may be a polygon. None where the format does not tell."""

    vertices: int | None
    faces: int | None


_UNKNOWN = Contents(None, None)


def contents(data: bytes, extension: str) -> Contents:
    """The counts in a file of this extension (lower case, no dot). O(bytes).

    Raises MeshError when the file says itself that it is longer than it is. A text file that is
    cut between two lines, or within its last number, cannot always be told from a whole one.
    """
    return _COUNTERS.get(extension, _not_counted)(data)


def _not_counted(data: bytes) -> Contents:
    return _UNKNOWN


def _ply(data: bytes) -> Contents:
    header = data[: data.find(b"end_header") + 1]
    declared = dict(re.findall(rb"(?m)^element (vertex|face) (\d+)", header))
    return Contents(*(int(declared.get(kind, 0)) for kind in (b"vertex", b"face")))


def _off(data: bytes) -> Contents:
    lines = [line for line in data.splitlines() if line.strip() and not line.startswith(b"#")]
    header = re.match(rb"\s*\w*OFF\s*(\d+)\s+(\d+)", b"\n".join(lines[:2]))
    if header is None:
        return _UNKNOWN
    vertices, faces = map(int, header.groups())
    first = 1 if len(lines[0].split()) > 1 else 2
    elements = lines[first : first + vertices + faces]
    _require(len(elements) == vertices + faces, f"{len(elements):,} of {vertices + faces:,} lines")
    if faces:
        last = elements[-1].split()
        whole = last[0].isdigit() and len(last) > int(last[0])
        _require(whole, "a last face without all its corners")
    return Contents(vertices, faces)


def off_polygons(data: bytes) -> tuple[list[list[float]], list[list[int]]]:
    """The positions and the faces of an OFF file that ``contents`` has found whole. O(bytes)."""
    _, vertices, faces = _off_parts(data)
    points = [[float(it) for it in line.split()[:3]] for line in vertices]
    return points, [_off_corners(line) for line in faces]


def without_stray_corners(data: bytes, extension: str) -> tuple[bytes, int]:
    """The file without faces whose corners are out of range -> it, and how many. O(bytes).

    pymeshlab checks the corners of a ply file, but not those of off and obj: to these it computes
    normals in memory that is not its own, so that the process dies of it sooner or later. Comments
    behind a face of an obj file, which keep it busy for ever, are left out, too.
    """
    sift = {"off": _sifted_off, "obj": _sifted_obj}.get(extension)
    return sift(data) if sift else (data, 0)


def _off_parts(data: bytes) -> tuple[bytes, list[bytes], list[bytes]]:
    """The word at the head, the lines of vertices and those of faces."""
    lines = [line for line in data.splitlines() if line.strip() and not line.startswith(b"#")]
    head = lines[0].split()
    counts, first = (head[1:], 1) if len(head) > 1 else (lines[1].split(), 2)
    faces = first + int(counts[0])
    return head[0], lines[first:faces], lines[faces : faces + int(counts[1])]


def _off_corners(line: bytes) -> list[int]:
    sides, *rest = line.split()
    return [int(it) for it in rest[: int(sides)]]


def _sifted_off(data: bytes) -> tuple[bytes, int]:
    if _off(data) == _UNKNOWN:
        return data, 0
    head, vertices, faces = _off_parts(data)
    try:
        corners = [_off_corners(line) for line in faces]
        whole = all(
            len(it) == int(line.split()[0]) for it, line in zip(corners, faces, strict=True)
        )
    except ValueError as error:
        raise MeshError(f"a face has a corner that is no number: {error}") from error
    _require(whole, "a face without all its corners")
    n = len(vertices)
    within = [all(0 <= v < n for v in it) for it in corners]
    if all(within):
        return data, 0
    kept = list(compress(faces, within))
    counts = f"{n} {len(kept)} 0".encode()
    return b"\n".join([head, counts, *vertices, *kept, b""]), len(faces) - len(kept)


def _sifted_obj(data: bytes) -> tuple[bytes, int]:
    vertices = [line.start() for line in re.finditer(rb"(?m)^[ \t]*v[ \t]", data)]
    stray = 0

    def keep(line: re.Match[bytes]) -> bytes:
        nonlocal stray
        said, comment, _ = line[0].partition(b"#")
        words = said.replace(b"\\", b" ").split()[1:]
        try:
            corners = [int(word.partition(b"/")[0]) for word in words]
        except ValueError:
            corners = [0]
        before = bisect(vertices, line.start()) if min(corners, default=0) < 0 else 0
        if all(1 <= v <= len(vertices) or -before <= v < 0 for v in corners):
            return said if comment else line[0]
        stray += 1
        return b""

    # A line may go on behind a backslash.
    sifted = re.sub(rb"(?m)^[ \t]*f[ \t]+((?:[^\n\\]|\\\r?\n|\\)*)$", keep, data)
    return (data, 0) if sifted == data else (sifted, stray)


def _obj(data: bytes) -> Contents:
    found = len(re.findall(rb"(?m)^v\s", data)), len(re.findall(rb"(?m)^f\s", data))
    for kind, number in zip((b"Vertices", b"Faces"), found, strict=True):
        promised = re.search(rb"(?m)^# " + kind + rb": (\d+)", data[:2000])
        if promised:
            words = f"{number:,} of {int(promised[1]):,} {kind.decode().lower()}"
            _require(number >= int(promised[1]), words)
    last = data[data.rstrip().rfind(b"\n") + 1 :].split()
    if last and last[0] in (b"v", b"f"):
        _require(len(last) > 3, "a last line without all its numbers")
    return Contents(*found)


def _stl(data: bytes) -> Contents:
    faces: int = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
    if data[:80].lstrip().startswith(b"solid") and len(data) != 84 + 50 * faces:
        _require(b"endsolid" in data[-500:], "no 'endsolid' at its end")
        return Contents(None, len(re.findall(rb"(?m)^\s*endfacet", data)))
    _require(len(data) >= 84 + 50 * faces, f"{len(data):,} of {84 + 50 * faces:,} bytes")
    return Contents(None, faces)


def _3ds(data: bytes) -> Contents:
    promised: int = struct.unpack_from("<I", data, 2)[0] if len(data) >= 6 else 6
    _require(len(data) >= promised, f"{len(data):,} of {promised:,} bytes")
    return _UNKNOWN


def _ctm(data: bytes) -> Contents:
    """The counts of the header; of a compressed file every part must be there to its end."""
    if len(data) < 36 or data[:4] != b"OCTM":
        return _UNKNOWN
    method, vertices, faces = struct.unpack_from("<4sII", data, 8)
    place = 36 + int(struct.unpack_from("<I", data, 32)[0])
    if method not in (b"MG1\0", b"MG2\0"):
        return Contents(vertices, faces)
    tags = set()
    while place < len(data):
        tags.add(data[place : place + 4])
        place = _ctm_part_end(data, place, method)
        _require(place <= len(data), f"{len(data):,} bytes, fewer than its parts take")
    _require(tags >= {b"VERT", b"INDX"}, "no part for the vertices or the faces")
    return Contents(vertices, faces)


def _ctm_part_end(data: bytes, place: int, method: bytes) -> int:
    """Where the part ends that begins here: a tag, names, a size, five bytes, and as many more."""
    tag, beyond = data[place : place + 4], len(data) + 1
    if tag == b"MG2H":
        return place + 48
    place += 4
    names = {b"TEXC": 2, b"ATTR": 1}.get(tag, 0)
    for _ in range(names):
        if place + 4 > len(data):
            return beyond
        place += 4 + int(struct.unpack_from("<I", data, place)[0])
    if names and method == b"MG2\0":
        place += 4  # the precision
    if place + 4 > len(data):
        return beyond
    return place + 9 + int(struct.unpack_from("<I", data, place)[0])


def _require(whole: bool, found: str) -> None:
    if not whole:
        raise MeshError(f"the file is cut short or broken: it has {found}; get it anew")


_COUNTERS: dict[str, Callable[[bytes], Contents]] = {
    "ply": _ply,
    "off": _off,
    "obj": _obj,
    "stl": _stl,
    "3ds": _3ds,
    "ctm": _ctm,
}
