"""The thesis' half-edge mesh as it was designed: objects and references (thesis 3.2 to 4.3).

The classes stand in ``structures.objects.class_model``; here they fulfill the contract, so that
every experiment runs on them. Kernels and surgery are those of ``structures.half_edge``, told in
objects, and both number their elements alike::

    mesh = structures.build("half_edge_objects", hem.sample("bunny"))
    mesh.half_edges[3].next.opposite.face         # objects
    mesh.vertex_faces(7)                          # handles, as everywhere
    for vertex in mesh.vertices: ...              # called, mesh.vertices() gives the handles

This is the sound version: the vertex circulator steps from half-edge to half-edge, the builder and
the splits search for nothing, every reference is kept up. What the thesis prints is run in
``structures.as_printed``.

Invariants

- Those of ``structures.half_edge``, with None where that has -1.
- Every element stands in its list at its index, and every reference leads to one that does.

Bytes per vertex: Python's own (``memory``), and those of the thesis' runtime (``clr_memory``).
"""

import sys
from collections.abc import Callable
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.authoring import EDGE_END, LEFT, RIGHT, A, C, D, Kernel, append_face, walks
from hem.contract import Claims, Look, Navigable
from hem.edit import CHANGED, VERTEX, Edit
from hem.engine import counting
from hem.errors import MeshError
from hem.meshes import TriangleMesh, read_only
from structures.half_edge import HalfEdge as HalfEdgeArrays
from structures.objects import (
    COUNTED,
    FaceList,
    HalfEdge,
    HalfEdgeList,
    ObjectRecords,
    ObjectStorage,
    Vertex,
    VertexList,
    around,
    class_model,
    index_of,
    records,
)

SHARED = 257  # integers below this one are shared by all who use them
Give = Callable[[HalfEdge], int]  # what a query or a step gives of a half-edge


def around_vertex(give: Give, last: Give | None = None) -> Kernel:
    """Make a query: ``give(h)`` of every half-edge that leaves a vertex. Cost O(n_ev).

    And ``last(h)`` of the last one of an open fan, where the query has something beyond it.
    """

    def query(m: ObjectRecords, v: int, out: Any) -> int:
        leaving, closed = around(m.vertices.items[v])
        count = 0
        for h in leaving:
            out[count] = give(h)
            count += 1
        if closed or not count or last is None:
            return count
        out[count] = last(leaving[-1])
        return count + 1

    return query


def round_face(give: Give) -> Kernel:
    """Make a query: ``give(h)`` of every half-edge of a face. Cost O(1)."""

    def query(m: ObjectRecords, f: int, out: Any) -> int:
        h = m.faces.items[f].half_edge
        for i in range(3):
            out[i] = give(h)
            h = h.next
        return 3

    return query


vertex_vertices = around_vertex(lambda h: h.next.origin.index, lambda h: h.next.next.origin.index)
vertex_edges = around_vertex(lambda h: h.edge, lambda h: h.next.next.index)
vertex_faces = around_vertex(lambda h: h.face.index)
face_vertices, face_edges = round_face(lambda h: h.origin.index), round_face(lambda h: h.edge)


def edge_vertices(m: ObjectRecords, e: int, out: Any) -> int:
    """Cost O(1)."""
    h = m.half_edges.items[e]
    a, b = h.origin.index, h.next.origin.index
    out[0], out[1] = (a, b) if a < b else (b, a)
    return 2


def step(give: Give) -> Kernel:
    """Make a step ``take(m, h)``: ``give`` of the half-edge with index h. Cost O(1)."""

    def take(m: ObjectRecords, h: int) -> int:
        return give(m.half_edges.items[h])

    return take


following, previous = step(lambda h: h.next.index), step(lambda h: h.previous.index)
origin, tip = step(lambda h: h.origin.index), step(lambda h: h.end.index)
twin, face = step(lambda h: index_of(h.opposite)), step(lambda h: h.face.index)
edge_of = step(lambda h: h.edge)


def leaving(m: ObjectRecords, v: int) -> int:
    """The half-edge that is recorded at vertex v, or -1."""
    return index_of(m.vertices.items[v].half_edge)


def within(m: ObjectRecords, f: int) -> int:
    """The half-edge that is recorded at face f."""
    return int(m.faces.items[f].half_edge.index)


edge_edges = walks.edges_at_both_ends(edge_vertices, vertex_edges, edge_of)


def edge_faces(m: ObjectRecords, e: int, out: Any) -> int:
    """Cost O(1)."""
    h = m.half_edges.items[e]
    out[0] = h.face.index
    opposite = h.opposite
    if opposite is None:
        return 1
    out[1] = opposite.face.index
    return 2


def face_faces(m: ObjectRecords, f: int, out: Any) -> int:
    """Cost O(1)."""
    h, count = m.faces.items[f].half_edge, 0
    for _ in range(3):
        opposite = h.opposite
        if opposite is not None:
            count = append_face(out, count, opposite.face.index)
        h = h.next
    return count


# What operations need to know, and what they change (see hem.authoring.operations) --------------


def recorded(elements: int) -> Kernel:
    """Make ``exists(m, index)``: whether a list, by its place in the records, has it live."""

    def exists(m: Any, index: int) -> bool:
        items = m[elements].items
        return 0 <= index < len(items) and items[index] is not None

    return exists


vertex_exists, edge_exists, face_exists = recorded(0), recorded(1), recorded(2)


def coordinate(m: ObjectRecords, v: int, i: int) -> float:
    """x, y or z of vertex v; NaN if it is dead."""
    vertex = m.vertices.items[v]
    return float("nan") if vertex is None else vertex.point[i]


def position(m: ObjectRecords, v: int) -> tuple[float, float, float, float]:
    """Where vertex v is, to be added up: see ``hem.authoring.sums``."""
    x, y, z = m.vertices.items[v].point
    return x, y, z, 1.0


def set_point(m: ObjectRecords, v: int, point: Any) -> None:
    """Give a vertex its position, be it new or not."""
    position = float(point[0]), float(point[1]), float(point[2])
    if v == len(m.vertices.items):
        m.vertices.create(position)
    else:
        m.vertices.items[v].place(position)


def kill_vertex(m: ObjectRecords, v: int) -> None:
    """Make a vertex dead."""
    m.vertices.items[v] = None


def clear_vertex(m: ObjectRecords, v: int) -> None:
    """See to it that vertex v has no faces."""
    m.vertices.items[v].half_edge = None


def left_and_right(h: HalfEdge) -> tuple[HalfEdge | None, HalfEdge | None]:
    """The half-edges of h's edge: first the one that runs from its smaller to its larger vertex."""
    return (h, h.opposite) if h.origin.index < h.end.index else (h.opposite, h)


def diamond(m: ObjectRecords, e: int, at: Any) -> int:
    """Cost O(1)."""
    left, right = left_and_right(m.half_edges.items[e])
    edge_vertices(m, e, at)
    at[LEFT], at[RIGHT], at[C], at[D] = -1, -1, -1, -1
    if left is not None:
        at[LEFT], at[C] = left.face.index, left.previous.origin.index
    if right is not None:
        at[RIGHT], at[D] = right.face.index, right.previous.origin.index
    return (left is not None) + (right is not None)


def find_half_edge(m: ObjectRecords, a: int, b: int) -> HalfEdge | None:
    """The half-edge that runs a → b, if there is one. Cost O(n_ev)."""
    return next((h for h in around(m.vertices.items[a])[0] if h.end.index == b), None)


def are_joined(m: ObjectRecords, a: int, b: int) -> bool:
    """Cost O(n_ev)."""
    return find_half_edge(m, a, b) is not None or find_half_edge(m, b, a) is not None


def edge_between(m: ObjectRecords, a: int, b: int) -> int:
    """The edge between two vertices, or -1. Cost O(n_ev)."""
    h = find_half_edge(m, a, b) or find_half_edge(m, b, a)
    return -1 if h is None else h.edge


def face_left_of(m: ObjectRecords, a: int, b: int) -> int:
    """The face that runs a → b, or -1. Cost O(n_ev)."""
    h = find_half_edge(m, a, b)
    return -1 if h is None else h.face.index


def new_half_edge(m: ObjectRecords, origin: Vertex) -> HalfEdge:
    """Append a half-edge that has no opposite yet."""
    m.counts[EDGE_END] += 1
    return m.half_edges.create(origin)


def lead_from_ends(h: HalfEdge) -> None:
    """Let both ends of h have half-edges in its face."""
    h.origin.half_edge = h
    h.end.half_edge = h.next


def split_edge_records(m: ObjectRecords, e: int, at: Any, v: int, f: int) -> None:
    """Cost O(1): two half-edges of each face stay, one moves on, and three are new."""
    left, right = left_and_right(m.half_edges.items[e])  # they stay with a and v
    middle = m.vertices.items[v]
    on_left, on_right = None, None  # the halves of the edge from v to b
    if left is not None:
        bc, ca = left.next, left.previous
        on_left = new_half_edge(m, middle)
        cv, vc = new_half_edge(m, ca.origin), new_half_edge(m, middle)
        m.half_edges.pair(cv, vc)
        m.faces.enclose(left.face, left, vc, ca)
        m.faces.create(on_left, bc, cv)
        lead_from_ends(on_left)
    if right is not None:
        ad, db, b = right.next, right.previous, right.origin
        on_right = new_half_edge(m, b)
        vd, dv = new_half_edge(m, middle), new_half_edge(m, db.origin)
        m.half_edges.pair(vd, dv)
        right.origin = middle
        m.faces.enclose(right.face, right, ad, dv)
        m.faces.create(on_right, vd, db)
        lead_from_ends(on_right)
    if on_left is not None and on_right is not None:
        m.half_edges.pair(on_left, on_right)


def split_face_records(m: ObjectRecords, face: int, v: int, f: int, corners: Any) -> None:
    """Cost O(1): each face keeps one half-edge of the old one and gets two."""
    it, middle = m.faces.items[face], m.vertices.items[v]
    h = it.half_edge
    corner = {side: side.origin.index for side in (h, h.next, h.previous)}
    ab = min(corner, key=corner.__getitem__)
    bc, ca = ab.next, ab.previous
    corners[0], corners[1], corners[2] = corner[ab], corner[bc], corner[ca]
    av, va = new_half_edge(m, ab.origin), new_half_edge(m, middle)
    bv, vb = new_half_edge(m, bc.origin), new_half_edge(m, middle)
    cv, vc = new_half_edge(m, ca.origin), new_half_edge(m, middle)
    m.half_edges.pair(av, va)
    m.half_edges.pair(bv, vb)
    m.half_edges.pair(cv, vc)
    m.faces.enclose(it, ab, bv, va)
    m.faces.create(bc, cv, vb)
    m.faces.create(ca, av, vc)
    middle.half_edge = va


def leave(m: ObjectRecords, h: HalfEdge) -> HalfEdge | None:
    """Take h out of its edge, whose name stays -> the half-edge that is left of it, if any."""
    opposite = h.opposite
    m.half_edges.remove(h)
    if opposite is None:
        return None
    opposite.opposite = None
    if h.index < opposite.index:
        m.half_edges.put(opposite, h.index)
    return opposite


def unite(m: ObjectRecords, gone: HalfEdge, stays: HalfEdge) -> None:
    """Make one edge of two sides of a triangle that vanishes; what is beyond them meets there."""
    beyond, left = gone.opposite, stays.opposite
    m.half_edges.remove(gone)
    if beyond is not None:
        m.half_edges.put(beyond, stays.index)
        beyond.opposite = left
        if left is not None:
            left.opposite = beyond
        lead_from_ends(beyond)
    else:
        alone = leave(m, stays)
        assert alone is not None  # else an edge without a face would be left, which is refused
        lead_from_ends(alone)


def collapse_records(
    m: ObjectRecords, e: int, at: Any, drop: int, keep: int, around: int, out: Any
) -> None:
    """Cost O(n_ev) for the half-edges that leave ``drop``."""
    left, right = left_and_right(m.half_edges.items[e])
    inward, outward = (left, right) if drop == at[A] else (right, left)  # inward ends at keep
    dropped, kept = m.vertices.items[drop], m.vertices.items[keep]
    for i in range(around):
        h = m.faces.items[out[i]].half_edge
        while h.origin is not dropped:
            h = h.next
        h.origin = kept
    dropped.half_edge = None
    for h in (inward, outward):
        if h is None:
            continue
        following, last = h.next, h.previous
        m.half_edges.remove(h)
        m.faces.remove(h.face)
        if h is inward:
            unite(m, last, following)
        else:
            unite(m, following, last)


def flip_records(m: ObjectRecords, e: int, at: Any, one: int, other: int) -> None:
    """Cost O(1)."""
    ab, ba = left_and_right(m.half_edges.items[e])
    assert ab is not None  # at the border a flip is refused
    assert ba is not None
    bc, ad = ab.next, ba.next
    ca, db = bc.next, ad.next
    ab.origin, ba.origin = db.origin, ca.origin
    m.faces.enclose(m.faces.items[one], ad, ab, ca)
    m.faces.enclose(m.faces.items[other], bc, ba, db)
    ad.origin.half_edge, bc.origin.half_edge = ad, bc


def add_records(m: ObjectRecords, corners: Any, f: int) -> None:
    """Cost O(n_ev)."""
    a, b, c = (m.vertices.items[int(corner)] for corner in corners)
    beyond = [find_half_edge(m, q.index, p.index) for p, q in ((a, b), (b, c), (c, a))]
    sides = [new_half_edge(m, corner) for corner in (a, b, c)]
    for side, opposite in zip(sides, beyond, strict=True):
        if opposite is not None:
            m.half_edges.pair(side, opposite)
    m.faces.create(*sides)
    for corner, side in zip((a, b, c), sides, strict=True):
        corner.half_edge = side


def remove_records(m: ObjectRecords, f: int) -> None:
    """Cost O(1)."""
    face = m.faces.items[f]
    sides = [face.half_edge, face.half_edge.next, face.half_edge.previous]
    for h in sides:
        h.origin.half_edge = None
    m.faces.remove(face)
    for h in sides:
        left = leave(m, h)
        if left is not None:
            lead_from_ends(left)


def set_vertex_face(m: ObjectRecords, v: int, f: int) -> None:
    """Let v know of the face f at it. Cost O(1)."""
    h = m.faces.items[f].half_edge
    while h.origin.index != v:
        h = h.next
    h.origin.half_edge = h


class HalfEdgeMesh(Navigable):
    """The half-edge mesh of the thesis' class model."""

    name, title, abbreviation = "half_edge_objects", "Half-Edge Objects", "Objects"
    look, order = Look("#8c6bb1", "v", "--"), 5
    claims = Claims(
        "the class model of thesis 3.2, with the circulator that chapter 6 asks for",
        like="half_edge",
    )
    storage, compiled = ObjectStorage, False
    records_type = ObjectRecords
    fields = ()

    @classmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """See ``Structure.build``; a reference takes what Python gives it."""
        return cls(records.build_records(mesh))

    @classmethod
    def create(cls, a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Self:
        """A mesh of one triangle, its corners clockwise from outside (``CreateMesh``, thesis 3.3).

        More are added with ``add_vertex`` and ``add_face``.
        """
        return cls.build(TriangleMesh(np.array([a, b, c]), [(0, 2, 1)]))

    # Elements --------------------------------------------------------------------------------

    @property
    def vertices(self) -> VertexList:
        """The vertices as objects; called, their handles."""
        return self.records.vertices

    @property
    def half_edges(self) -> HalfEdgeList:
        """The half-edges as objects; called, their indices."""
        return self.records.half_edges

    @property
    def faces(self) -> FaceList:
        """The faces as objects; called, their handles."""
        return self.records.faces

    @property
    def points(self) -> NDArray[np.float32]:
        """(n, 3) float32: positions by vertex, NaN for dead ones; gathered anew. Cost O(n_v).

        Read-only, as the vertices would not follow.
        """
        return read_only(records.positions(self.records.vertices.items))

    def positions(self, vertices: ArrayLike) -> NDArray[np.float32]:
        """See ``Structure.positions``."""
        items, at = self.records.vertices.items, np.asarray(vertices)
        at = np.arange(len(items))[at] if at.dtype == bool else at
        return records.positions(items[v] for v in at.flat).reshape(*at.shape, 3)

    def subscribe(self, callback: Callable[[Edit], Any]) -> Callable[[], None]:
        """See ``Structure.subscribe``; also told when the ``point`` of a vertex is set."""
        if self.vertices.event is None:
            self.vertices.watch(self._tell_moved)
        return super().subscribe(callback)

    # Behind the contract ---------------------------------------------------------------------

    def _tell_moved(self, vertex: Vertex) -> None:
        items = self.vertices.items
        if vertex.index < len(items) and items[vertex.index] is vertex:
            log = [vertex.index << 3 | VERTEX + CHANGED]
            self._followers.publish(Edit("move_vertex", vertex.index, log))

    def restore(self, snapshot: Any) -> None:
        """See ``Structure.restore``."""
        super().restore(snapshot)
        if self.vertices.event is not None:
            self.vertices.watch(self._tell_moved)

    def _live_bytes(self) -> dict[str, int]:
        """Bytes that Python's objects take, by class and by what their fields hold of their own.

        As ``sys.getsizeof`` tells of the running interpreter; small integers are shared.
        """
        point = (0.0, 0.0, 0.0)
        position = sys.getsizeof(point) + 3 * sys.getsizeof(1.5)
        taken = {}
        for elements in self.records[:-1]:
            kind, n = elements.kind, len(elements)
            sample = next(iter(elements), None)
            taken[f"{kind}.object"] = n * (sys.getsizeof(sample) if sample else 0)
            shared = sum(it is not None for it in elements.items[:SHARED])
            taken[f"{kind}.index"] = sys.getsizeof(SHARED) * (n - shared)
            taken[f"{kind}.list"] = 8 * n
        taken["vertex.point"] = position * len(self.vertices)
        return taken

    def clr_memory(self) -> dict[str, int]:
        """Bytes per field as the runtime of the thesis would lay its classes out: a model."""
        return class_model.clr_memory({it.kind: len(it) for it in self.records[:-1]})

    def validate(self) -> None:
        """Check the objects themselves, then as arrays what ``structures.half_edge`` requires."""
        self._require_invariants()
        HalfEdgeArrays(records.to_arrays(self.records)).validate()

    def _require_invariants(self) -> None:
        """Every element stands in its list, and every reference leads to one that does."""
        m = self.records
        known = {id(it) for elements in m[:-1] for it in elements}
        for elements in m[:-1]:
            many = f"{elements.kind}s" if elements.kind != "vertex" else "vertices"
            for index, element in enumerate(elements.items):
                if element is None:
                    continue
                if element.index != index:
                    raise _broken("an element stands in its list at its index", many, index)
                for name in REFERENCES[elements.kind]:
                    target = getattr(element, name, None)
                    optional = name == "opposite" or elements.kind == "vertex"
                    if id(target) not in known and not (target is None and optional):
                        raise _broken(f"{name} is a live element", many, index)


def fields_accessed(call: Callable[[], object]) -> int:
    """How many fields of the class model's objects a call reads and writes."""
    with counting(COUNTED) as counter:
        call()
    return counter[0]


REFERENCES = {
    "vertex": ("half_edge",),
    "half_edge": ("origin", "face", "next", "opposite"),
    "face": ("half_edge",),
}
"""Which fields of an element refer to another."""


def _broken(invariant: str, elements: str, index: int) -> MeshError:
    return MeshError(f"broken invariant: {invariant}", **{elements: [index]})
