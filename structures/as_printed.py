"""What the thesis' listings do, for measuring and for its errata; not a structure to be used.

The algorithms of thesis 3.2.3 to 4.3, told anew over the classes of
``structures.objects.class_model``: the vertex circulator that scans, the search for duplicates, the
builder that scans for every triangle and stops one short, the surgery that forgets references, the
commits of the whole render mesh.
``experiments.claims.errata`` shows each of them beside the sound version,
``structures.half_edge_objects``. Nothing here checks anything, and errors are left as they are.
The listings of breaking, and those of chapter 5, stand in ``structures.printed_breaking``.

Lists shrink when an element is removed, as those of the thesis do, while every element keeps the
index that it was given; ``faults`` says what does not hold together any more.
"""

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.contract import Claims, Described, Look
from structures.objects import Face, FaceList, HalfEdge, Point, Vertex


class RenderCache:
    """The points and triangles that the listings keep for Unity (thesis 3.3.1)."""

    def __init__(self) -> None:
        self.points: list[Point] = []
        self.triangles: dict[int, list[int]] = {}
        self.committed: list[int] = []
        self.commits = 0

    def clear(self) -> None:
        """``ClearMesh``."""
        self.points, self.triangles = [], {}

    def add_vertex(self, point: Point) -> None:
        """``AddMeshVertex``: the list is handed over as a whole."""
        self.points.append(point)

    def set_triangle(self, face: int, corners: list[int]) -> None:
        """``SetMeshTriangles`` within a transaction: one entry, by the index of the face."""
        self.triangles[face] = corners

    def commit(self) -> None:
        """``CommitMeshTriangles``: the whole dictionary becomes a list. Cost O(n_t)."""
        self.committed = [corner for corners in self.triangles.values() for corner in corners]
        self.commits += 1


class AsPrinted(Described):
    """The half-edge mesh of the listings. Plain lists; the winding is that of the render mesh."""

    name, title, abbreviation = "as_printed", "As published", "Published"
    look, order = Look("#c23b22", "X", "-"), 7
    claims = Claims("thesis 3.3.2 to 5: the rows of the listings in experiments/claims/claims.toml")

    def __init__(self) -> None:
        self.vertices: list[Vertex] = []
        self.half_edges: list[HalfEdge] = []
        self.faces: list[Face] = []
        self.render = RenderCache()
        self.stepping = False
        self._lock = False
        self._new_half_edge: Any = None
        self._split: Any = None

    @classmethod
    def build(cls, points: ArrayLike, indices: ArrayLike, whole: bool = False) -> Self:
        """``BuildHalfEdgeFromUnityMesh`` (thesis 3.3.2). Cost O(n_v² + n_t²).

        ``points`` (n, 3), ``indices`` (3 m,) clockwise. ``whole``: with the last triangle, which
        the printed bound of the loop leaves out, so that there is a mesh to operate on.
        """
        mesh = cls()
        rows: list[list[float]] = np.asarray(points, np.float32).reshape(-1, 3).tolist()
        number = [mesh.create_vertex((x, y, z)).index for x, y, z in rows]
        triangles = [number[i] for i in np.asarray(indices).reshape(-1).tolist()]
        for i in range(0, len(triangles) if whole else len(triangles) - 3, 3):
            mesh.add_triangle(*(mesh.vertices[v] for v in triangles[i : i + 3]))
        return mesh

    def add_triangle(self, a: Vertex, b: Vertex, c: Vertex) -> Face:
        """Three half-edges and a face, and the pairs found by a scan of all. Cost O(n_t)."""
        corners = a.index, b.index, c.index
        near = (h for h in self.half_edges if h.origin.index in corners)
        pairs = [h for h in near if h.next.origin.index in corners]
        one = self.create_half_edge(a, None, None)
        face = self.create_face(one)
        two = self.create_half_edge(b, face, one)
        three = self.create_half_edge(c, face, two)
        one.next = three
        for pair in pairs:
            for side in (one, two, three):
                meets = pair.origin.index == side.next.origin.index
                if meets and pair.next.origin.index == side.origin.index:
                    self.create_pair(pair, side)
                    break
        return face

    def create_mesh(self, a: Point, b: Point, c: Point) -> None:
        """``CreateMesh`` (thesis 3.3): a triangle, clockwise, beside what there is. Cost O(n)."""
        one, two, three = map(self.create_vertex, (a, b, c))
        first: Any = self.create_half_edge(one, None, None)
        face = self.create_face(first)
        second = self.create_half_edge(two, face, first)
        first.next = self.create_half_edge(three, face, second)
        self.generate_render_mesh()

    # Lists (thesis 3.2.3) ----------------------------------------------------------------------

    def create_vertex(self, point: Point) -> Vertex:
        """The first vertex at this position, or a new one. Cost O(n_v)."""
        for vertex in self.vertices:
            if vertex.point == point:
                return vertex
        vertex = Vertex(len(self.vertices), point)
        self.vertices.append(vertex)
        return vertex

    def create_half_edge(
        self, vertex: Vertex, face: Face | None, following: HalfEdge | None
    ) -> HalfEdge:
        """``CreateHalfEdge``: its index is the count of the list, whatever was removed."""
        half_edge: Any = HalfEdge(len(self.half_edges), vertex)
        half_edge.face, half_edge.next = face, following
        vertex.half_edge = half_edge
        self.half_edges.append(half_edge)
        return half_edge

    def create_face(self, half_edge: HalfEdge) -> Face:
        """``CreateFace``: sets the references of both; its index is the count of the list."""
        face = Face(len(self.faces), half_edge)
        half_edge.face = face
        self.faces.append(face)
        return face

    @staticmethod
    def create_pair(one: HalfEdge, other: HalfEdge) -> None:
        """``CreatePair``, whatever partners they had."""
        one.opposite, other.opposite = other, one

    @staticmethod
    def face_circulator(face: Face) -> list[HalfEdge]:
        """``GetFaceCirculator``."""
        return FaceList.circulator(face)

    def vertex_circulator(self, vertex: Vertex) -> list[HalfEdge]:
        """``GetVertexCirculator`` (thesis 5): all half-edges are looked at. Cost O(n_t).

        If ``stepping`` it is the better one that chapter 6 asks for, and costs O(n_ev).
        """
        if self.stepping:
            return _step_around(vertex)
        return [h for h in self.half_edges if h.origin.index == vertex.index]

    def remove_face(self, face: Face) -> None:
        """``RemoveFace`` (thesis 4.2). Cost O(n_t)."""
        mine = self.face_circulator(face)
        for h in mine:
            if h.opposite is not None:
                h.opposite.opposite = None
            if len(self.vertex_circulator(h.origin)) <= 0:
                self.remove_vertex(h.origin)
        self.half_edges = [h for h in self.half_edges if h not in mine]
        self.faces.remove(face)

    def remove_vertex(self, vertex: Vertex) -> None:
        """``RemoveVertex``: those behind it move up, and keep their index."""
        self.vertices.remove(vertex)

    # Operations (thesis 4) ---------------------------------------------------------------------

    def split_half_edge(self, split: HalfEdge, point: Point) -> None:
        """``SplitHalfEdge`` (thesis 4.1)."""
        split.face.half_edge = split
        self._split = split
        new_point = self.create_vertex(point)
        new_half_edge: Any = self.create_half_edge(split.origin, None, split)
        self._new_half_edge = new_half_edge
        new_face = self.create_face(new_half_edge)
        split.origin = new_point
        to_split = self.create_half_edge(split.next.next.origin, split.face, split)
        from_new = self.create_half_edge(new_point, new_face, split.next.next)
        self.create_pair(to_split, from_new)
        new_half_edge.next = from_new
        from_new.next.next = new_half_edge
        split.next.next = to_split
        self.render.add_vertex(new_point.point)
        self._set_triangles(split.face)
        self._set_triangles(new_face)
        if not self._lock:
            if split.opposite is not None:
                self._lock = True
                self.split_half_edge(split.opposite, point)
                self.create_pair(self._split, new_half_edge)
                self.create_pair(split, self._new_half_edge)
                self._lock = False
            self.render.commit()

    def collapse_edge(self, half_edge: HalfEdge) -> None:
        """``EdgeCollapse`` (thesis 4.2)."""
        stays, goes = half_edge.next.origin, half_edge.origin
        pair: Any = half_edge.opposite
        around = self.face_circulator(half_edge.face) + self.face_circulator(pair.face)
        ends = half_edge.index, pair.index
        for h in around:
            beyond, next_beyond = h.opposite, h.next.opposite
            if h.index in ends or h.next.index in ends or beyond is None or next_beyond is None:
                continue
            self.create_pair(beyond, next_beyond)
        self.remove_face(half_edge.face)
        self.remove_face(pair.face)
        for h in self.vertex_circulator(goes):
            if h.origin.index == goes.index:
                h.origin = stays
        self.remove_vertex(goes)
        self.generate_render_mesh()

    def split_face(self, face: Face, point: Point, is_transaction: bool = False) -> None:
        """``SplitFace`` (thesis 4.3)."""
        center = self.create_vertex(point)
        self.render.add_vertex(center.point)
        made: list[HalfEdge] = []
        for i, h in enumerate(self.face_circulator(face)):
            if i == 0:
                new_face = face
                new_face.half_edge = h
            else:
                new_face = self.create_face(h)
            outward = self.create_half_edge(center, new_face, h)
            inward = self.create_half_edge(h.next.origin, new_face, outward)
            h.next = inward
            self._set_triangles(new_face)
            made += [outward, inward, h]
        self.create_pair(made[0], made[4])
        self.create_pair(made[3], made[7])
        self.create_pair(made[6], made[1])
        if is_transaction:
            self.render.commit()

    # The render mesh (thesis 3.3.1) ------------------------------------------------------------

    def generate_render_mesh(self) -> None:
        """``GenerateUnityMesh``. Cost O(n_v + n_t)."""
        self.render.clear()
        for face in self.faces:
            self._set_triangles(face)
        for vertex in self.vertices:
            self.render.add_vertex(vertex.point)
        self.render.commit()

    def _set_triangles(self, face: Face) -> None:
        corners = [h.origin.index for h in self.face_circulator(face)]
        self.render.set_triangle(face.index, corners)

    # What holds ---------------------------------------------------------------------------------

    def faults(self) -> dict[str, int]:
        """What does not hold together, and how often; nothing of it is in a sound mesh."""
        found = {
            "half-edges with another face than the next one": sum(
                h.next.face is not h.face for h in self.half_edges
            ),
            "half-edges whose opposite has another one": sum(
                h.opposite is not None and h.opposite.opposite is not h for h in self.half_edges
            ),
            "half-edges without an opposite, though there is one": self._unpaired(),
            "vertices with a half-edge that is gone": sum(
                v.half_edge is not None and v.half_edge not in self.half_edges
                for v in self.vertices
            ),
            "elements with the index of another": sum(
                len(elements) - len({it.index for it in elements})
                for elements in (self.vertices, self.half_edges, self.faces)
            ),
            "corners of the render mesh at another position": self._misplaced(),
        }
        return {what: often for what, often in found.items() if often}

    def _unpaired(self) -> int:
        sides = {(h.origin, h.next.origin) for h in self.half_edges}
        alone = [h for h in self.half_edges if h.opposite is None]
        return sum((h.next.origin, h.origin) in sides for h in alone)

    def _misplaced(self) -> int:
        """Corners of the triangles that are kept for rendering, of the faces there are."""
        wrong = 0
        for face in self.faces:
            corners = self.render.triangles.get(face.index, [])
            for corner, h in zip(corners, self.face_circulator(face), strict=False):
                points = self.render.points
                wrong += corner >= len(points) or points[corner] != h.origin.point
        return wrong


def render_arrays(points: Array, triangles: Array) -> tuple[Array, Array]:
    """Counterclockwise triangles as a render mesh has them: points, and clockwise flat indices."""
    return points, triangles[:, [0, 2, 1]].reshape(-1)


def _step_around(vertex: Vertex) -> list[HalfEdge]:
    """The half-edges that leave a vertex, from one to the next, and at a border both ways.

    A collapse as it is published leaves walks that do not come round: what was met ends them, too.
    """
    found: list[HalfEdge] = []
    h = vertex.half_edge
    while h is not None and h not in found:
        found.append(h)
        h = h.opposite.next if h.opposite is not None else None
    h = found[0].previous.opposite if found else None
    while h is not None and h not in found:
        found.append(h)
        h = h.previous.opposite
    return found
