"""Reading and writing ply, text or binary: points, and faces of any number of corners.

Source: Turk, The PLY polygon file format, 1994.
"""

import re
import struct
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array, Points
from hem.errors import MeshError
from hem.ragged import Ragged
from hem.sources.text import Parts, as_ragged, cut_short, uniform

_TYPES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
    "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")
_KEPT = {"vertex": "xyz", "face": _CORNERS}
_BESIDE = {
    "normals": "nx ny nz",
    "texture coordinates": "s t u v texture_u texture_v texcoord texnumber",
    "colors": "red green blue alpha",
}
_WORDS = {name: words for words, names in _BESIDE.items() for name in names.split()}


class _Property(NamedTuple):
    name: str
    kind: str
    length: str  # the type of a list's length; empty for a single number


class _Element(NamedTuple):
    name: str
    rows: int
    properties: list[_Property]


def read_ply(data: bytes) -> Parts:
    """Points and faces of a ply file."""
    order, elements, begin = _header(data)
    numbers = _Numbers(data[begin:], order)
    try:
        found = {element.name: numbers.columns(element) for element in elements}
    except (struct.error, IndexError, ValueError) as error:
        raise cut_short(f"fewer or other numbers than its head says, {error}") from error
    try:
        points = np.stack([found["vertex"][axis] for axis in "xyz"], axis=1).reshape(-1, 3)
    except KeyError as error:
        raise MeshError(f"its head names no {error} of vertices") from error
    faces = found.get("face", {})
    rows: Any = next((faces[name] for name in _CORNERS if name in faces), [])
    dropped = (
        _WORDS.get(name, name) if element in ("vertex", "face") else element
        for element, columns in found.items()
        for name in columns
        if name not in _KEPT.get(element, ())
    )
    corners = as_ragged(rows) if isinstance(rows, list) else uniform(rows)
    return Parts(points, corners, dropped)


def write_ply(points: Points, faces: Ragged) -> bytes:
    """Binary, with every bit. Raises MeshError for faces of more than 255 corners."""
    counts = faces.counts
    if counts.max(initial=0) > 255:
        raise MeshError("faces of more than 255 corners are kept by obj and off")
    kind = "double" if points.dtype == np.float64 else "float"
    axes = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{axes}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    if (counts == 3).all():
        body = np.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
        body["count"], body["corners"] = 3, faces.values.reshape(-1, 3)
        rows = body.tobytes()
    else:
        rows = b"".join(struct.pack(f"<B{len(row)}i", len(row), *row.tolist()) for row in faces)
    return head.encode() + points.astype(points.dtype.newbyteorder("<")).tobytes() + rows


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """The byte order, empty for text; the elements; and where their numbers begin."""
    lines = rb"[^\r]*\r" if re.match(rb"ply[^\r\n]*\r(?!\n)", data) else rb"[^\n]*\n"
    end = re.search(rb"[\r\n][ \t]*end_header\b" + lines, data)
    text, begin = (data[: end.start()], end.end()) if end else (data, 0)
    elements: list[_Element] = []
    order = None
    try:
        for line in text.splitlines():  # not as text, where some letters of UTF-8 part lines
            match line.decode("latin-1").split():
                case ["format", name, _]:
                    order = _ORDERS[name]
                case ["element", name, count]:
                    elements.append(_Element(name, int(count), []))
                case ["property", "list", count, kind, name]:
                    elements[-1].properties.append(_Property(name, _TYPES[kind], _TYPES[count]))
                case ["property", kind, name]:
                    elements[-1].properties.append(_Property(name, _TYPES[kind], ""))
    except (KeyError, IndexError, ValueError) as error:
        raise MeshError(f"its head is not that of a ply file: {error}") from error
    if order is None or not end or not data.startswith(b"ply"):
        raise MeshError("its head is not that of a ply file, or it is cut short; get it anew")
    for it in elements:
        if not 0 <= it.rows <= len(data):
            raise cut_short(f"{len(data):,} bytes, and promises {it.rows:,} of {it.name}")
        if len({prop.name for prop in it.properties}) < len(it.properties):
            raise MeshError(f"its head names a property of {it.name} twice")
        if wrong := [prop.name for prop in it.properties if not _fits(it.name, prop)]:
            raise MeshError(f"its head gives {wrong[0]} of {it.name} a type that it cannot have")
    if len({it.name for it in elements}) < len(elements):
        raise MeshError("its head names an element twice")
    return order, elements, begin


def _fits(element: str, prop: _Property) -> bool:
    """Whether lists have a whole length, coordinates are numbers, and corners lists of integers."""
    if prop.name not in _KEPT.get(element, ()):
        return prop.length not in ("f", "d")
    if element == "vertex":
        return not prop.length
    return prop.length not in ("", "f", "d") and prop.kind not in "fd"


class _Numbers:
    """The numbers behind the head, handed out one after another."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data, self.order, self.at = data, order, 0
        self.words = [] if order else data.split()

    def columns(self, element: _Element) -> dict[str, Any]:
        """The next element's properties by name: a number or a list of numbers for each row."""
        table = self._table(element) if self.order and element.rows else None
        if table is not None:
            return {prop.name: table[prop.name] for prop in element.properties}
        columns: dict[str, list[Any]] = {prop.name: [] for prop in element.properties}
        for _ in range(element.rows):
            for prop in element.properties:
                k = self._take(prop.length, 1)[0] if prop.length else 1
                columns[prop.name].append(self._take(prop.kind, k))
        return columns

    def _take(self, kind: str, k: int) -> Any:
        start = self.at
        if self.order:
            self.at += struct.calcsize(f"{self.order}{k}{kind}")
            return struct.unpack_from(f"{self.order}{k}{kind}", self.data, start)
        self.at += k
        if not start <= self.at <= len(self.words):
            raise IndexError("it ends too early, or has a list of less than nothing")
        number = float if kind in "fd" else int
        return [number(word) for word in self.words[start : self.at]]

    def _table(self, element: _Element) -> Array | None:
        """All rows at once, where every list is as long as that of the first row; else None."""
        start = self.at
        columns: list[Any] = []
        for prop in element.properties:
            k = self._take(prop.length, 1)[0] if prop.length else 1
            self._take(prop.kind, k)
            columns += [(f"{prop.name} length", self.order + prop.length)] if prop.length else []
            columns += [(prop.name, self.order + prop.kind, (k,) if prop.length else ())]
        self.at = start
        size = element.rows * np.dtype(columns).itemsize
        if not 0 < size <= len(self.data) - start:  # nothing, of an element without properties
            return None
        table = np.frombuffer(self.data[start : start + size], columns)
        lengths = [table[f"{prop.name} length"] for prop in element.properties if prop.length]
        if any((length != length[0]).any() for length in lengths):
            return None
        self.at += size
        return table
