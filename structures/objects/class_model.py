"""The thesis' class model: vertices, half-edges and faces as objects that refer to each other.

::

    Vertex    point, half_edge (one that leaves it), index, position_changed
    HalfEdge  origin, face, next, opposite (None at the border), index
    Face      half_edge, index

Three lists own them (thesis 3.2). Whoever has one element walks to the others by its references::

    mesh.half_edges[3].next.opposite.face

A position of a list that is dead holds None until ``compact``; indices do not move until then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Generic, TypeVar

import numpy as np

from hem.arrays import Array, Bools
from hem.contract import ELEMENTS, HANDLE_TYPES
from hem.errors import MeshError
from hem.listeners import Listeners
from hem.meshes import position

Point = tuple[float, float, float]


class Vertex:
    """A position, and one half-edge that leaves it; None as long as no face uses it."""

    __slots__ = ("_point", "half_edge", "index", "position_changed")

    def __init__(self, index: int, point: Point, half_edge: HalfEdge | None = None) -> None:
        self.index = index
        self._point = point
        self.half_edge = half_edge
        self.position_changed: PositionChangedEvent | None = None

    def __repr__(self) -> str:
        return f"Vertex({self.index}, {self._point})"

    @property
    def point(self) -> Point:
        """x, y and z, of float32. Setting it raises the event, and tells who follows the mesh.

        MeshError for what is no position, which changes nothing.
        """
        return self._point

    @point.setter
    def point(self, point: Point) -> None:
        with np.errstate(over="ignore"):
            rounded = position(point).astype(np.float32)
        if not np.isfinite(rounded).all():
            raise MeshError(f"a position is three finite numbers of float32, not {point!r}")
        x, y, z = rounded.tolist()
        self._point = x, y, z
        if (event := self.position_changed) is not None:
            try:
                event.tell(self)
            finally:  # it has moved, whatever a subscriber made of it
                event.tell_mesh(self)

    def place(self, point: Point) -> None:
        """Set the point within an operation, of which the mesh tells by itself."""
        self._point = point
        if (event := self.position_changed) is not None:
            event.tell(self)

    def subscribe(self, callback: Callable[[Vertex], Any]) -> Callable[[], None]:
        """Have ``callback`` called with this vertex whenever it has moved -> a way to end that."""
        event = self.position_changed
        if not event:  # none, or the one that all vertices share
            event = self.position_changed = PositionChangedEvent(
                None if event is None else event.tell_mesh
            )
        return event.subscribe(callback)


class HalfEdge:
    """One side of an edge, from ``origin`` on, counterclockwise in ``face``."""

    __slots__ = ("face", "index", "next", "opposite", "origin")

    next: HalfEdge
    face: Face

    def __init__(self, index: int, origin: Vertex) -> None:
        self.index = index
        self.origin = origin
        self.opposite: HalfEdge | None = None

    def __repr__(self) -> str:
        return f"HalfEdge({self.index}, {self.origin.index} → {self.end.index})"

    @property
    def previous(self) -> HalfEdge:
        """The half-edge that leads here: in a triangle the next of the next."""
        return self.next.next

    @property
    def end(self) -> Vertex:
        """Where it ends."""
        return self.next.origin

    @property
    def edge(self) -> int:
        """The handle of its edge: the smaller index of its two half-edges."""
        opposite = self.opposite
        return self.index if opposite is None else min(self.index, opposite.index)


class Face:
    """A triangle, known by one of its half-edges."""

    __slots__ = ("half_edge", "index")

    def __init__(self, index: int, half_edge: HalfEdge) -> None:
        self.index = index
        self.half_edge = half_edge

    def __repr__(self) -> str:
        h = self.half_edge
        return f"Face({self.index}: {h.origin.index}, {h.end.index}, {h.previous.origin.index})"


class PositionChangedEvent(Listeners):
    """Who is to be told when a vertex has moved: its subscribers, and a mesh that has some.

    Vertices without subscribers of their own share one event once the mesh has a subscriber.
    """

    __slots__ = ("tell_mesh",)

    def __init__(self, tell_mesh: Callable[[Vertex], Any] | None = None) -> None:
        super().__init__()
        self.tell_mesh = tell_mesh or (lambda vertex: None)


Element = TypeVar("Element", Vertex, HalfEdge, Face)


class ElementList(Generic[Element]):
    """A list that owns elements by index. Called, it gives the indices of the live ones."""

    __slots__ = ("items",)

    kind = ""

    def __init__(self, items: list[Element | None] | None = None) -> None:
        self.items: list[Any] = [] if items is None else items

    def __getitem__(self, index: int) -> Element:
        """The live element of this index. MeshError where there is none. Cost O(1)."""
        found = self.items[index] if 0 <= index < len(self.items) else None
        if found is None:
            many = ELEMENTS.get(self.kind, f"{self.kind}s")
            raise MeshError(f"no such {self.kind} in this mesh (any more)", **{many: [index]})
        return found

    def __iter__(self) -> Iterator[Element]:
        """The live elements, by index."""
        return (it for it in self.items if it is not None)

    def __len__(self) -> int:
        """Number of live elements. Cost O(n)."""
        return len(self.items) - self.items.count(None)

    def __call__(self) -> Array:
        """(n,) the indices of all live elements, ascending, as handles."""
        return np.flatnonzero(self.alive()).astype(HANDLE_TYPES.get(self.kind, np.int64))

    def alive(self) -> Bools:
        """(end,) bool: which positions hold a live element."""
        return np.array([it is not None for it in self.items], np.bool_)

    def remove(self, element: Element) -> None:
        """Take an element out; its index stays unused. Its references are the caller's to mend."""
        self.items[element.index] = None

    def put(self, element: Element, index: int) -> None:
        """Give an element the index of one that is gone."""
        self.items[element.index] = None
        self.items[index] = element
        element.index = index


class VertexList(ElementList[Vertex]):
    """The vertices."""

    __slots__ = ("event",)
    kind = "vertex"

    def __init__(self, items: list[Vertex | None] | None = None) -> None:
        super().__init__(items)
        self.event: PositionChangedEvent | None = None

    def watch(self, tell_mesh: Callable[[Vertex], Any]) -> None:
        """Have the mesh told whenever the point of a vertex is set. Cost O(n_v)."""
        self.event = PositionChangedEvent(tell_mesh)
        for vertex in self:
            if vertex.position_changed is None:
                vertex.position_changed = self.event
            else:
                vertex.position_changed.tell_mesh = tell_mesh

    def create(self, point: Point) -> Vertex:
        """Append a vertex. No duplicate is searched for. Cost O(1)."""
        vertex = Vertex(len(self.items), point)
        if self.event is not None:
            vertex.position_changed = self.event
        self.items.append(vertex)
        return vertex

    def circulator(self, vertex: Vertex) -> list[HalfEdge]:
        """The half-edges that leave a vertex, counterclockwise. Cost O(n_ev)."""
        return around(vertex)[0]


class HalfEdgeList(ElementList[HalfEdge]):
    """The half-edges."""

    __slots__ = ()
    kind = "half_edge"

    def create(self, origin: Vertex) -> HalfEdge:
        """Append a half-edge that has no face, next and opposite yet. Cost O(1)."""
        half_edge = HalfEdge(len(self.items), origin)
        self.items.append(half_edge)
        return half_edge

    @staticmethod
    def pair(one: HalfEdge, other: HalfEdge) -> None:
        """Make an edge of two half-edges."""
        one.opposite, other.opposite = other, one


class FaceList(ElementList[Face]):
    """The faces."""

    __slots__ = ()
    kind = "face"

    def create(self, a: HalfEdge, b: HalfEdge, c: HalfEdge) -> Face:
        """Append a face of three half-edges that are to follow each other. Cost O(1)."""
        face = Face(len(self.items), a)
        self.items.append(face)
        self.enclose(face, a, b, c)
        return face

    @staticmethod
    def enclose(face: Face, a: HalfEdge, b: HalfEdge, c: HalfEdge) -> None:
        """Let three half-edges run round a face, both ways of reference."""
        face.half_edge = a
        a.face, a.next = face, b
        b.face, b.next = face, c
        c.face, c.next = face, a

    @staticmethod
    def circulator(face: Face) -> list[HalfEdge]:
        """The half-edge of a face, its previous and the one before: clockwise (thesis 3.2.3)."""
        h = face.half_edge
        return [h, h.previous, h.previous.previous]


def around(vertex: Vertex) -> tuple[list[HalfEdge], bool]:
    """The half-edges that leave a vertex, counterclockwise, and whether they come round.

    What chapter 6 of the thesis asks for instead of a scan. Cost O(n_ev).
    """
    start = vertex.half_edge
    found: list[HalfEdge] = []
    if start is None:
        return found, False
    h: HalfEdge | None = start
    while h is not None:
        found.append(h)
        opposite = h.opposite
        h = opposite.next if opposite is not None else None
        if h is start:
            found.reverse()
            return found, True
    found.reverse()
    h = start.next.next.opposite
    while h is not None:
        found.append(h)
        h = h.next.next.opposite
    return found, False


CLR_HEADER, CLR_REFERENCE = 16, 8
"""Bytes of an object's header (sync block index and type handle) and of a reference, on 64 bits."""

CLR_CLASSES = {
    "vertex": {"point": 12, "half_edge": 8, "index": 4, "position_changed": 8},
    "half_edge": {"origin": 8, "face": 8, "next": 8, "opposite": 8, "index": 4},
    "face": {"half_edge": 8, "index": 4},
}
"""The fields that the thesis declares (3.2.2), in bytes: Vector3, references, int, event."""


def clr_memory(counts: Mapping[str, int]) -> dict[str, int]:
    """Bytes per field as the runtime of the thesis would lay its classes out: a model.

    ``counts``: how many objects there are, by class. See ``CLR_CLASSES``; in a list every element
    takes one more reference.
    """
    taken: dict[str, int] = {}
    for kind, n in counts.items():
        fields = CLR_CLASSES[kind]
        size = CLR_HEADER + sum(fields.values())
        taken |= {f"{kind}.header": CLR_HEADER * n}
        taken |= {f"{kind}.{field}": width * n for field, width in fields.items()}
        taken |= {f"{kind}.padding": -size % CLR_REFERENCE * n}
        taken |= {f"{kind}.list": CLR_REFERENCE * n}
    return taken
