"""The lists of ``structures.half_edge_objects``: made of a mesh, and to and from arrays."""

import gc
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hem import authoring
from hem.arrays import Array, Bools
from hem.authoring import EDGES, ENDLESS, FACES, VALENCE, VERTEX_END, VERTICES, counted
from hem.contract import UncompiledStorage
from hem.engine import InterpretedUses
from hem.meshes import TriangleMesh, require_manifold
from structures.half_edge import HalfEdgeRecords
from structures.objects import class_model
from structures.objects.class_model import (
    Face,
    FaceList,
    HalfEdge,
    HalfEdgeList,
    Vertex,
    VertexList,
)

ROOM = [authoring.VERTEX_ROOM, authoring.EDGE_ROOM, authoring.FACE_ROOM]

COUNTED = (Vertex, HalfEdge, Face, class_model.ElementList)
"""The classes whose fields count as work when they are read or written."""


class ObjectRecords(NamedTuple):
    """What the kernels are given: the lists that own everything."""

    vertices: VertexList
    half_edges: HalfEdgeList
    faces: FaceList
    counts: Array  # how many of them there are, see hem.authoring.kernels


def build_records(mesh: TriangleMesh) -> ObjectRecords:
    """One vertex per point, one half-edge per index, one face per three (thesis 3.3.2).

    Every half-edge is looked up once by its two vertices, and met by its opposite: O(n_v + n_t)
    expected. Raises NonManifoldError with the elements for what half-edges cannot represent.
    """
    require_manifold(mesh)
    n = len(mesh.points)
    open_sides: dict[int, HalfEdge] = {}
    with _uncollected():
        vertices = [Vertex(i, (x, y, z)) for i, (x, y, z) in enumerate(mesh.points.tolist())]
        half_edges: list[Any] = []
        faces: list[Any] = []
        for f, corners in enumerate(mesh.triangles.tolist()):
            h = 3 * f
            a, b, c = corners
            sides = ab, bc, ca = [HalfEdge(h + i, vertices[v]) for i, v in enumerate(corners)]
            face = Face(f, ab)
            ab.face = bc.face = ca.face = face
            ab.next, bc.next, ca.next = bc, ca, ab
            for side, origin, end in ((ab, a, b), (bc, b, c), (ca, c, a)):
                opposite = open_sides.pop(end * n + origin, None)
                if opposite is None:
                    open_sides[origin * n + end] = side
                else:
                    side.opposite, opposite.opposite = opposite, side
                if vertices[origin].half_edge is None:
                    vertices[origin].half_edge = side
            half_edges += sides
            faces.append(face)
    n_edges = (len(half_edges) + len(open_sides)) // 2
    lists = VertexList([*vertices]), HalfEdgeList(half_edges), FaceList(faces)
    return ObjectRecords(*lists, count_records(*lists, n_edges))


def positions(vertices: Iterable[Vertex | None]) -> NDArray[np.float32]:
    """(k, 3): NaN for dead ones."""
    dead = (np.nan,) * 3
    rows = [dead if it is None else it.point for it in vertices]
    return np.array(rows, np.float32).reshape(-1, 3)


def to_arrays(m: ObjectRecords) -> HalfEdgeRecords:
    """The same half-edges by index, as ``structures.half_edge`` has them. O(n_v + n_t)."""
    half_edge = np.full((len(m.half_edges.items), 4), -1, np.int32)
    for h in m.half_edges:
        half_edge[h.index] = h.origin.index, h.face.index, h.next.index, index_of(h.opposite)
    leaving = [-1 if v is None else index_of(v.half_edge) for v in m.vertices.items]
    within = [-1 if f is None else f.half_edge.index for f in m.faces.items]
    counts = m.counts.copy()
    counts[ROOM] = len(leaving), len(half_edge), len(within)
    known = np.array(leaving, np.int32), np.array(within, np.int32)
    return HalfEdgeRecords(positions(m.vertices.items), *known, half_edge, counts)


def index_of(element: Any) -> int:
    """The index of an element; -1 for None."""
    return -1 if element is None else int(element.index)


def count_records(
    vertices: VertexList, half_edges: HalfEdgeList, faces: FaceList, n_edges: int
) -> Array:
    """The array ``counts`` for lists that grow by themselves."""
    count = counted(len(vertices.items), n_edges, len(faces.items), len(half_edges.items))
    count[ROOM] = ENDLESS
    count[VERTICES], count[FACES] = len(vertices), len(faces)
    return count


def from_arrays(arrays: HalfEdgeRecords) -> ObjectRecords:
    """Objects for records by index, dead ones included. Cost O(n_v + n_t)."""
    with _uncollected():
        rows = arrays.vertex_point[: arrays.counts[VERTEX_END]].tolist()
        vertices: list[Any] = [
            Vertex(i, (x, y, z)) if x == x else None for i, (x, y, z) in enumerate(rows)
        ]
        half_edge = arrays.half_edge.tolist()
        half_edges: list[Any] = [
            HalfEdge(i, vertices[row[0]]) if row[1] >= 0 else None
            for i, row in enumerate(half_edge)
        ]
        within = enumerate(arrays.face_half_edge.tolist())
        faces: list[Any] = [Face(f, half_edges[h]) if h >= 0 else None for f, h in within]
        for h, (_, face, following, opposite) in zip(half_edges, half_edge, strict=True):
            if h is not None:
                h.face, h.next = faces[face], half_edges[following]
                h.opposite = half_edges[opposite] if opposite >= 0 else None
        for vertex, leaving in zip(vertices, arrays.vertex_half_edge.tolist(), strict=True):
            if vertex is not None and leaving >= 0:
                vertex.half_edge = half_edges[leaving]
    counts = arrays.counts.copy()
    counts[ROOM] = ENDLESS
    return ObjectRecords(VertexList(vertices), HalfEdgeList(half_edges), FaceList(faces), counts)


class ObjectUses(InterpretedUses):
    """Counts the fields of the class model."""

    counted_classes = COUNTED


class ObjectStorage(UncompiledStorage):
    """Records in lists of objects; kept and copied as arrays."""

    uses = ObjectUses

    def alive(self, records: Any, element: str, rows: Any = slice(None)) -> Bools:
        """See ``Storage.alive``."""
        lists: dict[str, Any] = {"vertex": records.vertices, "face": records.faces}
        items = lists.get(element, records.half_edges).items
        chosen = items[rows] if isinstance(rows, slice) else [items[row] for row in rows.tolist()]
        return np.array([it is not None for it in chosen], np.bool_)

    def compacted(self, records: Any) -> tuple[ObjectRecords, dict[str, Array]]:
        """See ``Storage.compacted``; the lists stay the same."""
        m, number = records, {}
        lists: dict[str, Any] = {it.kind: it for it in m[:-1]}
        for kind, elements in lists.items():
            alive = elements.alive()
            number[kind] = np.where(alive, np.cumsum(alive) - 1, -1)
            elements.items[:] = list(elements)
            for index, element in enumerate(elements.items):
                element.index = index
        count = count_records(m.vertices, m.half_edges, m.faces, int(m.counts[EDGES]))
        count[VALENCE] = m.counts[VALENCE]
        return m._replace(counts=count), number

    def saved(self, records: Any) -> HalfEdgeRecords:
        """See ``Storage.saved``: a pickle of objects would follow their references without end."""
        return to_arrays(records)

    def loaded(self, saved: Any) -> ObjectRecords:
        """See ``Storage.loaded``."""
        return from_arrays(saved)

    def put_back(self, records: Any, saved: Any) -> None:
        """See ``Storage.put_back``."""
        fresh: tuple[Any, ...] = from_arrays(saved)
        *lists, counts = fresh
        for mine, its in zip(records, lists, strict=False):
            mine.items[:] = its.items
        np.copyto(records.counts, counts)

    def arrays(self, records: Any) -> tuple[Array, ...]:
        """There are none to measure: the bytes are those of the objects, see ``memory``."""
        return ()

    def spare(self, records: Any, taken: int) -> int:
        """See ``Storage.spare``: references to nothing."""
        return 8 * sum(len(it.items) - len(it) for it in records[:-1])


@contextmanager
def _uncollected() -> Iterator[None]:
    """Make many objects without the garbage collector looking through all of them in between."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
