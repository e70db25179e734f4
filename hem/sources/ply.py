"""Reading and writing ply, text or binary: points, and faces of any number of corners.

Source: Turk, The PLY polygon file format, 1994.
"""

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


class _Property(NamedTuple):
    name: str
    kind: str
    length: str  # the type of a list's length; empty for a single number


class _Element(NamedTuple):
    name: str
    rows: int
    properties: list[_Property]


def read_ply(data: bytes) -> Parts:
    """Points and faces of a ply file; all that it holds besides is passed over."""
    order, elements, at = _header(data)
    rest: Any = data[at:] if order else data[at:].split()
    read = _read_binary if order else _read_text
    found: dict[str, dict[str, Any]] = {}
    at = 0
    try:
        for element in elements:
            found[element.name], at = read(rest, at, element, order)
    except (struct.error, IndexError, ValueError) as error:
        raise cut_short(f"fewer or other numbers than its head says, {error}") from error
    try:
        vertices, faces = found["vertex"], found.get("face", {})
        points = np.stack([vertices[axis] for axis in "xyz"], axis=1).reshape(-1, 3)
    except KeyError as error:
        raise MeshError(f"its head names no {error} of vertices") from error
    rows: Any = next((faces[name] for name in _CORNERS if name in faces), [])
    return points, as_ragged(rows) if isinstance(rows, list) else uniform(rows)


def write_ply(points: Points, faces: Ragged) -> bytes:
    """Binary, with every bit of float32. MeshError for faces of more than 255 corners."""
    counts = faces.counts
    if counts.max(initial=0) > 255:
        raise MeshError("faces of more than 255 corners are kept by obj and off")
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    if (counts == 3).all():
        body = np.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
        body["count"], body["corners"] = 3, faces.values.reshape(-1, 3)
        rows = body.tobytes()
    else:
        rows = b"".join(struct.pack(f"<B{len(row)}i", len(row), *row.tolist()) for row in faces)
    return head.encode() + points.astype("<f4").tobytes() + rows


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """The byte order, empty for text; the elements; and where their numbers begin."""
    text, end, _ = data.partition(b"end_header")
    elements: list[_Element] = []
    order = None
    try:
        for words in (line.split() for line in text.decode("latin-1").splitlines()):
            match words:
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
    begin = data.find(b"\n", len(text)) + 1
    if order is None or not (end and begin) or not data.startswith(b"ply"):
        raise MeshError("its head is not that of a ply file, or it is cut short; get it anew")
    return order, elements, begin


def _read_text(
    words: list[bytes], at: int, element: _Element, _: str
) -> tuple[dict[str, Any], int]:
    names = [prop.name for prop in element.properties]
    if not any(prop.length for prop in element.properties):
        end = at + element.rows * len(names)
        table = np.array(words[at:end]).astype(np.float64).reshape(element.rows, len(names))
        return dict(zip(names, table.T, strict=True)), end
    columns: dict[str, list[Any]] = {name: [] for name in names}
    for _row in range(element.rows):
        for prop in element.properties:
            k = int(words[at]) if prop.length else 1
            values = words[at + 1 : at + 1 + k] if prop.length else words[at : at + 1]
            if len(values) < k:
                raise IndexError("a face without all its corners")
            number = float if prop.kind in "fd" else int
            columns[prop.name].append([number(value) for value in values])
            at += k + bool(prop.length)
    return columns, at


def _read_binary(data: bytes, at: int, element: _Element, order: str) -> tuple[dict[str, Any], int]:
    table = _table(data, at, element, order) if element.rows else None
    if table is not None:
        columns = {prop.name: table[prop.name] for prop in element.properties}
        return columns, at + table.nbytes
    lists: dict[str, list[Any]] = {prop.name: [] for prop in element.properties}
    for _ in range(element.rows):
        for prop in element.properties:
            k = 1
            if prop.length:
                (k,) = struct.unpack_from(order + prop.length, data, at)
                at += struct.calcsize(order + prop.length)
            row = struct.unpack_from(f"{order}{k}{prop.kind}", data, at)
            at += struct.calcsize(f"{order}{k}{prop.kind}")
            lists[prop.name].append(list(row))
    return lists, at


def _table(data: bytes, at: int, element: _Element, order: str) -> Array | None:
    """All rows at once, where every list is as long as that of the first row; else None."""
    columns: list[Any] = []
    first = at
    for prop in element.properties:
        k = 1
        if prop.length:
            (k,) = struct.unpack_from(order + prop.length, data, first)
            columns.append((f"{prop.name} count", order + prop.length))
            first += struct.calcsize(order + prop.length)
        columns.append((prop.name, order + prop.kind, (k,) if prop.length else ()))
        first += struct.calcsize(f"{order}{k}{prop.kind}")
    kind = np.dtype(columns)
    if len(data) < at + element.rows * kind.itemsize:
        return None
    table = np.frombuffer(data, kind, element.rows, offset=at)
    for name in kind.names or ():
        if name.endswith(" count") and (table[name] != table[name][:1]).any():
            return None
    return table
