"""Indexed mesh with adjacency, found when first asked for and thrown away by an edit.

This is what most programs have: an index buffer, and beside it what a pass over all triangles finds
of their neighbors. Half-edge 3 t + i runs from corner i of triangle t to its next corner::

    triangle     0: (0, 2, 4)   1: (4, 2, 3)   counterclockwise from outside
    row_end      0: 1   1: 1   2: 3   3: 4   4: 6   where the row of each vertex ends
    row_face     | 0 |  | 0  1 | 1 | 0  1 |         its faces
    slot_first   | 0 |  | 1  4 | 5 | 2 -1 |         the half-edges that leave it, in slots
    slot_next    2: 3   all others: -1              half-edge → the next one in its slot

The last two are a map from an edge to its faces: each row is a hash table of its own, with as many
slots as half-edges leave its vertex. That to b is in the slot that b is hashed to. So the map lies
in memory where its vertices do, is filled without probing, takes O(1) at any valence, and stores no
keys: who looks for a → b reads the corner that a half-edge ends at.

Invariants

- The corners of a triangle are three different vertices that exist.
- While ``standing``, rows and slots are those of the live triangles, each in ascending order.
- Dead: a triangle has corners -1, a vertex has no position (NaN).

Whoever asks for neighbors has all of them found first, in O(n_v + n_t), unless they are standing.
Every edit but a move throws them away. One that must know its faces has all found once more, as
such programs do, though a single search would be less: a sequence of edits takes O(n_t) each, but
to split a face O(1). Copies and what is restored begin with nothing found. Nothing keeps the mesh
from being non-manifold, and an edge is named by its two vertices.

Bytes per vertex: 36 of the indexed mesh and 4 + 2 · 3 · 3 · 4 = 76 of rows and map, together 112,
with indices of 4 bytes in any case. ``memory()`` counts the arrays, which are there from the start.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from hem.arrays import Array
from hem.authoring import (
    FACE_END,
    LEFT,
    OF_ARRAYS,
    RIGHT,
    VERTEX_END,
    A,
    B,
    C,
    D,
    Field,
    Kernel,
    Kernels,
    distinct,
    kernel,
    kernels_of,
    packed,
    require,
    walks,
    without,
)
from hem.contract import Claims, Look, PackedEdges, PackedStorage
from hem.engine import kept
from hem.errors import MeshError
from hem.meshes import TriangleMesh
from hem.room import longer, rows
from structures.indexed import Indexed, IndexedRecords, edge_vertices, pack


class IndexedAdjacencyRecords(NamedTuple):
    """The index buffer, and what was found of its neighbors."""

    vertex_point: Array  # (n_v, 3) float32
    triangle: Array  # (n_t, 3) vertices
    row_end: Array  # (n_v,) where the row of each vertex ends; the first begins at 0
    row_face: Array  # (3 n_t,) in rows
    slot_first: Array  # (3 n_t,) in rows, -1 for an empty slot
    slot_next: Array  # (3 n_t,) half-edge → half-edge, or -1
    standing: Array  # (1,) bool: whether these four are those of the triangles
    counts: Array  # how many of them there are, see hem.authoring.kernels


# Finding all neighbors ----------------------------------------------------------------------------


@kernel
def slot(b: int, begin: int, end: int) -> int:
    """Where in a row the half-edges to b are (Knuth, The Art of Computer Programming 3, 6.4)."""
    return begin + ((b * 0x9E3779B1 & 0xFFFFFFFF) * (end - begin) >> 32)


@kept
def find_neighbors(m: IndexedAdjacencyRecords) -> None:
    """Fill the rows and the map, unless they are standing. Cost O(n_v + n_t)."""
    if m.standing[0]:
        return
    for v in range(m.counts[VERTEX_END]):
        m.row_end[v] = 0
    for t in range(m.counts[FACE_END]):
        if m.triangle[t, 0] >= 0:
            for i in range(3):
                m.row_end[m.triangle[t, i]] += 1
    begin = 0
    for v in range(m.counts[VERTEX_END]):
        faces = m.row_end[v]
        m.row_end[v] = begin  # moves on to the end as the row is filled
        begin += faces
    for t in range(m.counts[FACE_END]):
        if m.triangle[t, 0] >= 0:
            for i in range(3):
                v = m.triangle[t, i]
                m.row_face[m.row_end[v]] = t
                m.row_end[v] += 1
    begin = 0
    for v in range(m.counts[VERTEX_END]):
        end = m.row_end[v]
        for k in range(begin, end):
            m.slot_first[k] = -1
        for k in range(end - 1, begin - 1, -1):  # so that each slot begins with the smallest
            t, i = m.row_face[k], 0
            while m.triangle[t, i] != v:
                i += 1
            place = slot(m.triangle[t, (i + 1) % 3], begin, end)
            m.slot_next[3 * t + i] = m.slot_first[place]
            m.slot_first[place] = 3 * t + i
        begin = end
    m.standing[0] = True


# Whoever asks comes past here ---------------------------------------------------------------------


@kernel
def row(m: IndexedAdjacencyRecords, v: int) -> tuple[int, int]:
    """Where the row of a vertex begins and ends."""
    if not m.standing[0]:
        find_neighbors(m)
    return int(m.row_end[v - 1]) if v > 0 else 0, int(m.row_end[v])


@kernel
def ending_at(m: IndexedAdjacencyRecords, h: int, b: int) -> int:
    """The first half-edge from h on in its slot that ends at b, or -1."""
    while h >= 0 and m.triangle[h // 3, (h + 1) % 3] != b:
        h = m.slot_next[h]
    return h


@kernel
def find(m: IndexedAdjacencyRecords, a: int, b: int) -> int:
    """The first half-edge that runs a → b, or -1. Cost O(1) expected."""
    begin, end = row(m, a)
    return ending_at(m, m.slot_first[slot(b, begin, end)], b) if begin < end else -1


# The nine queries, while neighbors are standing: O(1), vertex to vertex and edge_edges O(n_ev) ----


@kernel
def vertex_vertices(m: IndexedAdjacencyRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    begin, end = row(m, v)
    count = 0
    for k in range(begin, end):
        t = m.row_face[k]
        for i in range(3):
            if m.triangle[t, i] != v:
                out[count] = m.triangle[t, i]
                count += 1
    return distinct(out, count)


vertex_edges = packed.vertex_edges(vertex_vertices)


@kernel
def vertex_faces(m: IndexedAdjacencyRecords, v: int, out: Array) -> int:
    """Cost O(n_ev)."""
    begin, end = row(m, v)
    for k in range(begin, end):
        out[k - begin] = m.row_face[k]
    return end - begin


edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges)


@kernel
def edge_faces(m: IndexedAdjacencyRecords, e: int, out: Array) -> int:
    """Cost O(1) expected."""
    a, b = e >> 32, e & 0xFFFFFFFF
    count = 0
    for start, tip in ((a, b), (b, a)):
        h = find(m, start, tip)
        while h >= 0:
            out[count] = h // 3
            count += 1
            h = ending_at(m, m.slot_next[h], tip)
    return count


@kernel
def face_faces(m: IndexedAdjacencyRecords, f: int, out: Array) -> int:
    """Cost O(1) expected."""
    count = 0
    for i in range(3):
        side = pack(m.triangle[f, i], m.triangle[f, (i + 1) % 3])
        count += edge_faces(m, side, out[count:])
    return distinct(out, without(out, count, f))


# What operations need to know, and what they change (see hem.authoring.operations) --------------


@kernel
def look_left(m: IndexedAdjacencyRecords, a: int, b: int, at: Array, side: int, corner: int) -> int:
    """Write the face that runs a → b to a diamond -> 1, or 0 if none does, or 3 if several do."""
    h = find(m, a, b)
    at[side], at[corner] = -1, -1
    if h < 0:
        return 0
    at[side], at[corner] = h // 3, m.triangle[h // 3, (h + 2) % 3]
    return 1 if ending_at(m, m.slot_next[h], b) < 0 else 3


@kernel
def diamond(m: IndexedAdjacencyRecords, e: int, at: Array) -> int:
    """Cost O(1) expected."""
    edge_vertices(m, e, at)
    left = look_left(m, at[A], at[B], at, LEFT, C)
    return min(left + look_left(m, at[B], at[A], at, RIGHT, D), 3)


@kernel
def face_left_of(m: IndexedAdjacencyRecords, a: int, b: int) -> int:
    """The triangle that runs a → b, or -1. Cost O(1) expected."""
    h = find(m, a, b)
    return h // 3 if h >= 0 else -1


@kernel
def are_joined(m: IndexedAdjacencyRecords, a: int, b: int) -> bool:
    """Cost O(1) expected."""
    return find(m, a, b) >= 0 or find(m, b, a) >= 0


edge_between = packed.between(are_joined)


RECORDED = frozenset(OF_ARRAYS) | {"edge_vertices", "face_vertices", "face_edges", "face_exists"}
"""Kernels that ask for no neighbors."""


def forgetting(change: Kernel) -> Kernel:
    """Make the same change of triangles, after which no neighbors are known."""

    @kernel
    def changed(m: IndexedAdjacencyRecords, *arguments: Any) -> None:
        m.standing[0] = False
        change(m, *arguments)

    return changed


OF_INDEXED = {
    name: forgetting(it) if name.endswith(("_records", "clear_vertex")) else it
    for name, it in Indexed.kernels.items()
}
"""The kernels of the indexed mesh that serve here, too. So end the names of all that edit."""


def index_buffer(m: IndexedAdjacencyRecords) -> IndexedRecords:
    """What is more than found."""
    return IndexedRecords(m.vertex_point, m.triangle, m.counts)


def with_adjacency(m: IndexedRecords, known: Any = None) -> IndexedAdjacencyRecords:
    """An index buffer and room for its neighbors, behind what is ``known`` of them."""
    n = m.triangle.size
    if n > np.iinfo(np.int32).max:
        raise MeshError(f"{len(m.triangle):,} faces have more half-edges than int32 can name")
    sizes, standing = (len(m.vertex_point), n, n, n), np.zeros(1, np.bool_)
    found = [rows(size, dtype=np.int32, zeros=True) for size in sizes]
    if known is not None:
        old, standing = known[2:6], known.standing
        found = [longer(it, len(it), k, True)[:k] for it, k in zip(old, sizes, strict=True)]
    end, face, first, following = found
    return IndexedAdjacencyRecords(
        m.vertex_point, m.triangle, end, face, first, following, standing, m.counts
    )


class AdjacencyStorage(PackedStorage):
    """The storage of an index buffer: but for growth nothing that was found is kept."""

    def __init__(self, fields: Any, step: Any) -> None:
        super().__init__(Indexed.fields, step)

    def prepare(self, records: Any, kernels: Iterable[str]) -> None:
        """See ``Storage.prepare``."""
        if not records.standing[0] and not RECORDED.issuperset(kernels):
            find_neighbors(records)

    def with_room(self, records: Any, vertices: int, faces: int) -> Any:
        """See ``Storage.with_room``."""
        return with_adjacency(super().with_room(index_buffer(records), vertices, faces), records)

    def compacted(self, records: Any) -> tuple[Any, dict[str, Array]]:
        """See ``Storage.compacted``."""
        kept, number = super().compacted(index_buffer(records))
        return with_adjacency(kept), number

    def saved(self, records: Any) -> Any:
        """See ``Storage.saved``."""
        return with_adjacency(super().saved(index_buffer(records)))

    def arrays(self, records: Any) -> tuple[Array, ...]:
        """See ``Storage.arrays``; without the word that they are standing."""
        return super().arrays(records)[:-1]


class IndexedAdjacency(PackedEdges):
    """The indexed mesh with adjacency."""

    name, title, abbreviation = "indexed_adjacency", "Indexed Adjacency", "Adj"
    look, order = Look("#999933", "h", "-."), 8
    claims = Claims("no document says what it costs; what is found is shown")
    rebuilds, storage = True, AdjacencyStorage
    records_type = IndexedAdjacencyRecords
    kernels: ClassVar[Kernels] = {**OF_INDEXED, **kernels_of(__name__)}
    fields = (
        *Indexed.fields,
        Field("vertex.row_end", "row_end"),
        Field("triangle.row_face", "row_face", 3),
        Field("triangle.slot_first", "slot_first", 3),
        Field("triangle.slot_next", "slot_next", 3),
    )

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``. Any mesh is accepted; the indices are 4 bytes in any case."""
        return cls(with_adjacency(Indexed.build(mesh).records))

    def _require_invariants(self) -> None:
        """Those at the top of this file."""
        m, faces = self.records, self.faces()
        corner = m.triangle[faces]
        require(corner != np.roll(corner, 1, axis=1), "corners differ", "faces", of=faces)
        if m.standing[0]:
            other = with_adjacency(index_buffer(m))
            find_neighbors(other)
            ends, h = m.row_end == other.row_end, 3 * faces[:, None] + np.arange(3)
            require(ends[: m.counts[VERTEX_END]], "a row ends after its faces", "vertices")
            rows = (m.row_face == other.row_face) & (m.slot_first == other.slot_first)
            of = np.sort(corner, axis=None)
            require(rows[: len(of)], "a row is that of its vertex", "vertices", of)
            slots = m.slot_next[h] == other.slot_next[h]
            require(slots, "a slot has the half-edges hashed to it", "faces", faces)
