"""How many vertices and faces a file holds, counted without pymeshlab.

pymeshlab silently loads the first half of many truncated files, and silently leaves out what it
cannot use. These counts, from the file's own words, are what its result is held against.
"""

import re
import struct
from collections.abc import Callable
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


def _require(whole: bool, found: str) -> None:
    if not whole:
        raise MeshError(f"the file is cut short or broken: it has {found}; get it anew")


_COUNTERS: dict[str, Callable[[bytes], Contents]] = {
    "ply": _ply,
    "off": _off,
    "obj": _obj,
    "stl": _stl,
    "3ds": _3ds,
}
