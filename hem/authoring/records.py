"""The arrays of a structure as records: which are live, room for more, dropping the dead ones.

A structure's records are a ``NamedTuple`` of arrays, one row per record, and a last array
``counts`` (see ``kernels``). The rows before an end are in use, those behind it are room. All
that is done here follows from the structure's fields, which say what each column refers to.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hem.arrays import Array
from hem.authoring.kernels import (
    EDGE_END,
    EDGE_GROWTH,
    EDGE_ROOM,
    EDGES,
    FACE_END,
    FACE_ROOM,
    FACES,
    SIDES,
    VALENCE,
    VERTEX_END,
    VERTEX_ROOM,
    VERTICES,
)
from hem.authoring.slices import in_slices
from hem.errors import MeshError
from hem.room import longer, roomy, rows

REFERENCE_TYPES = {4: np.int32, 8: np.int64}
"""Bytes of a stored reference to the type that holds it. The thesis counts 8 (section 7)."""

ENDS = {
    "vertex": VERTEX_END,
    "edge": EDGE_END,
    "half_edge": EDGE_END,
    "face": FACE_END,
    "triangle": FACE_END,
}
"""Where ``counts`` says how many records of a kind are in use."""

UNKNOWN = -1
"""The number of edges of a structure that would have to search for them."""

ENDLESS = 1 << 62
"""Room for records that a structure does not have."""


class Field(NamedTuple):
    """One field of one record: ``half_edge.twin`` is 1 element wide in the array ``half_edge``.

    ``target`` is the kind of record it refers to, empty for a position; where the reference is
    ``optional``, -1 is none. Of each kind of record one field ``marks`` the dead: it is negative
    there, and a vertex has no position (NaN). What only ``names`` elements, so that there are
    handles, is no part of what the structure is said to take.
    """

    name: str
    array: str
    width: int = 1
    target: str = ""
    marks: bool = False
    optional: bool = False
    names: bool = False

    @property
    def element(self) -> str:
        """The record that has the field, such as ``half_edge``."""
        return self.name.split(".")[0]


def counted(
    n_vertices: int,
    n_edges: int,
    n_faces: int,
    edge_records: int = ENDLESS,
    edge_growth: int = 3,
    sides: int = 3,
    valence: int = 0,
) -> Array:
    """The array ``counts`` of a structure just built, with no room for more and nothing dead.

    ``edge_records``: how many edges or half-edges are recorded, if they are; ``edge_growth``: how
    many of them a new face may need; ``sides``: the most that a face has; ``valence``: the most
    edges that a vertex has, or 0 where nobody has counted them yet.
    """
    count = np.zeros(12, np.int64)
    count[EDGE_GROWTH], count[SIDES] = edge_growth, sides
    count[VALENCE] = max(valence, sides) if valence else 0
    count[[VERTICES, VERTEX_END, VERTEX_ROOM]] = n_vertices
    count[[FACES, FACE_END, FACE_ROOM]] = n_faces
    count[EDGES], count[EDGE_ROOM] = n_edges, edge_records
    count[EDGE_END] = 0 if edge_records == ENDLESS else edge_records
    return count


def live(
    records: Any, fields: Sequence[Field], element: str, rows: Any = slice(None)
) -> NDArray[np.bool_]:
    """(end,) bool: which of the records of a kind are live, or which of ``rows``. O(rows)."""
    mark = next(it for it in fields if it.marks and ENDS[it.element] == ENDS[element])
    values = in_use(records, fields, mark)[rows, 0]
    alive: NDArray[np.bool_] = ~np.isnan(values) if element == "vertex" else values >= 0
    return alive


def in_use(records: Any, fields: Sequence[Field], field: Field) -> Array:
    """(end, width): a field of all records that are in use, dead ones included. A view."""
    used = getattr(records, field.array)[: records.counts[ENDS[field.element]]]
    values: Array = used[:, _columns(fields)[field.name]] if used.ndim == 2 else used[:, None]
    return values


def grown(records: Any, fields: Sequence[Field], vertices: int, faces: int) -> Any:
    """The same records with room for so many more vertices and faces, in place where there is some.

    See ``hem.room``. Cost O(records) where they are moved, into twice as much room or more, so that
    one new element costs O(1) in the long run.
    """
    count, arrays = records.counts.copy(), records._asdict()
    wanted = {VERTEX_END: vertices, FACE_END: faces, EDGE_END: count[EDGE_GROWTH] * faces}
    rooms = {VERTEX_END: VERTEX_ROOM, FACE_END: FACE_ROOM, EDGE_END: EDGE_ROOM}
    short = [end for end, room in rooms.items() if count[end] + wanted[end] > count[room]]
    growing = [(it.array, ENDS[it.element]) for it in fields if ENDS[it.element] in short]
    for name, end in growing:  # all, before any takes memory
        kind, needed = arrays[name].dtype, count[end] + wanted[end]
        if needed > _most_rows(arrays[name]):
            raise MeshError(
                f"{needed:,} records are more than references of {kind.itemsize} "
                "bytes can name; build with reference_bytes=8"
            )
    for name, end in growing:
        arrays[name] = longer(arrays[name], count[end], count[end] + wanted[end])
    for end in short:
        mine = [arrays[it.array] for it in fields if ENDS[it.element] == end]
        count[rooms[end]] = min(min(len(it), _most_rows(it)) for it in mine)
    return type(records)(**(arrays | {"counts": count}))


def _most_rows(array: Array) -> int:
    """How many records references of an array's width can name; of positions there is no bound."""
    return int(np.iinfo(array.dtype).max) if array.dtype.kind == "i" else ENDLESS


def compacted(records: Any, fields: Sequence[Field]) -> tuple[Any, dict[str, Array]]:
    """The live records, renumbered without gaps in the order they had -> them, and the numbers.

    The numbers are by kind of record: (end,) the new one of each, -1 for the dead. O(records).
    """
    kinds = dict.fromkeys(it.element for it in fields)
    alive = {kind: np.flatnonzero(live(records, fields, kind)) for kind in kinds}
    number = {kind: _numbers(rows, records.counts[ENDS[kind]]) for kind, rows in alive.items()}
    columns, arrays = _columns(fields), {}
    for field in fields:
        if field.array not in arrays:
            old, kept = getattr(records, field.array), alive[field.element]
            arrays[field.array] = rows(len(kept), *old.shape[1:], dtype=old.dtype)
            old.take(kept, axis=0, out=arrays[field.array], mode="clip")
        if field.target:
            array = arrays[field.array]
            part = array[:, None] if array.ndim == 1 else array[:, columns[field.name]]
            in_slices(_renumber, len(part), part, number[field.target])
    was, recorded = records.counts, [kind for kind in alive if ENDS[kind] == EDGE_END]
    edge_records = len(alive[recorded[0]]) if recorded else ENDLESS
    own = edge_records, was[EDGE_GROWTH], was[SIDES], was[VALENCE]
    count = counted(was[VERTICES], was[EDGES], was[FACES], *own)
    return type(records)(**arrays, counts=count), {kind: it[:-1] for kind, it in number.items()}


@njit(cache=True, nogil=True)
def _renumber(begin: int, end: int, part: int, references: Array, number: Array) -> None:
    """Put the new numbers into columns of references."""
    for i in range(begin, end):
        for j in range(references.shape[1]):
            references[i, j] = number[references[i, j]]


def _numbers(rows: Array, end: int) -> Array:
    """(end + 1,): the new number of each old one, -1 for those not among ``rows``; the last is -1.

    So the -1 of a reference to none leads to -1. Of 4 bytes where they will do: fresh memory is
    what takes the time.
    """
    dtype = np.int32 if end < np.iinfo(np.int32).max else np.int64
    number = np.full(end + 1, -1, dtype)
    number[rows] = np.arange(len(rows), dtype=dtype)
    return number


def copied(records: Any) -> Any:
    """The same records in arrays of their own."""
    *arrays, counts = records
    return type(records)(*map(roomy, arrays), counts.copy())


def field_at(fields: Sequence[Field], array: str, column: int) -> tuple[str, int]:
    """What a column of an array is called, and where it is in its field: the neighbor 2 of three.

    Of an array without fields it is the array's name.
    """
    columns = _columns(fields)
    for field in fields:
        taken = columns[field.name]
        if field.array == array and taken.start <= column < taken.stop:
            return field.name, column - taken.start
    return array, column


def _columns(fields: Sequence[Field]) -> dict[str, slice]:
    """Which columns of its array each field takes."""
    taken: dict[str, int] = {}
    columns = {}
    for field in fields:
        begin = taken.get(field.array, 0)
        taken[field.array] = begin + field.width
        columns[field.name] = slice(begin, begin + field.width)
    return columns
