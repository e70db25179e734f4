"""A mesh as its faces and nothing else, and whether they are a surface.

The truth in random histories. No structure is asked and no rule of ``hem`` is used: what an
operation makes is made face by face, as its drawing shows, and it may be done where a surface of
the same Euler number is left.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple, Self

import numpy as np

import hem

Cycle = tuple[int, ...]
Side = tuple[int, int]
Point = tuple[float, float, float]


class UnsoundError(Exception):
    """What would be left is no surface, or another one."""


class Change(NamedTuple):
    """A step that cannot be divided: faces with other corners, and what they were made of."""

    before: dict[int, Cycle]
    """The corners that the faces had; those that are new had none."""

    after: dict[int, Cycle]
    """The corners that they have; those that are gone have none."""

    sides: tuple[set[Side], set[Side]]
    """Sides of faces that are gone, and those that are new, as they run."""

    edges: tuple[set[Side], set[Side]]
    """Edges that are gone, and those that are new, the smaller end first."""

    vertices: dict[int, Cycle]
    """New vertices and what each was put between."""

    parts: dict[int, int]
    """New faces and what each was a part of."""

    heirs: dict[Side, Side]
    """Edges that took the place of others, either way round."""

    gone: int
    """A vertex that is gone, or -1."""


def from_smallest(corners: Iterable[int]) -> Cycle:
    """The same cycle from its smallest corner on."""
    row = tuple(corners)
    k = row.index(min(row))
    return row[k:] + row[:k]


def sides_of(corners: Cycle) -> list[Side]:
    """Its sides, as they run."""
    return list(zip(corners, corners[1:] + corners[:1], strict=True))


def all_sides(rows: dict[int, Cycle]) -> set[Side]:
    """Those of many faces."""
    return {it for row in rows.values() for it in sides_of(row)}


def net_sides(
    before: dict[int, Cycle], after: dict[int, Cycle]
) -> tuple[tuple[set[Side], set[Side]], tuple[set[Side], set[Side]]]:
    """The sides that went and came with these faces, and the edges, if nothing lies beyond them."""
    sides = all_sides(before), all_sides(after)
    edges = [{both(*it) for it in some} for some in sides]
    return (
        (sides[0] - sides[1], sides[1] - sides[0]),
        (edges[0] - edges[1], edges[1] - edges[0]),
    )


def both(a: int, b: int) -> Side:
    """The edge between two vertices, the smaller first."""
    return (a, b) if a < b else (b, a)


class Surface:
    """Faces and positions by handle, and what follows from them."""

    def __init__(self) -> None:
        self.faces: dict[int, Cycle] = {}
        self.points: dict[int, Point] = {}
        self.sides: dict[Side, int] = {}
        self.around: dict[int, frozenset[int]] = {}
        self.n_edges = self.face_end = self.vertex_end = 0
        self.changes: list[Change] = []
        self.moved: set[int] = set()

    @classmethod
    def of(cls, mesh: hem.TriangleMesh | hem.PolygonMesh) -> Self:
        """The same faces and positions."""
        made = cls()
        for point in mesh.points.tolist():
            made.new_vertex(point)
        made.put({f: tuple(row.tolist()) for f, row in enumerate(mesh.face_rows())})
        made.face_end = len(made.faces)
        made.changes.clear()
        return made

    # What follows from the faces ---------------------------------------------------------------

    @property
    def euler(self) -> int:
        """V - E + F, vertices without faces included."""
        return len(self.points) - self.n_edges + len(self.faces)

    def edges(self) -> list[Side]:
        """Every edge, the smaller end first."""
        return sorted({both(a, b) for a, b in self.sides})

    def outside(self) -> dict[int, int]:
        """From every vertex on the border to the next one, with the surface on the right."""
        return {b: a for a, b in self.sides if (b, a) not in self.sides}

    def fan(self, v: int) -> list[int]:
        """The vertices around v, counterclockwise; from the border on, where it lies there."""
        beside = [self.beside(f, v) for f in sorted(self.around[v])]
        if not beside:
            return []
        follows, behind = dict(beside), {before for _, before in beside}
        start = next((after for after, _ in beside if after not in behind), beside[0][0])
        found = [start]
        while found[-1] in follows and follows[found[-1]] != start:
            found.append(follows[found[-1]])
        return found

    def beside(self, f: int, v: int) -> Side:
        """The corners after and before v in a face."""
        row = self.faces[f]
        at = row.index(v)
        return row[(at + 1) % len(row)], row[at - 1]

    def back(self, f: int) -> int:
        """The face that has the same corners, the other way round; -1 if there is none."""
        row = self.faces[f]
        beyond = self.sides.get((row[1], row[0]), -1)
        return beyond if self.faces.get(beyond) == from_smallest(row[::-1]) else -1

    # Changing them -----------------------------------------------------------------------------

    def new_vertex(self, point: Iterable[float]) -> int:
        """A vertex that no face has yet."""
        v, self.vertex_end = self.vertex_end, self.vertex_end + 1
        self.move(v, point)
        self.around[v] = frozenset()
        return v

    def new_faces(self, count: int) -> range:
        """Handles of new faces."""
        self.face_end += count
        return range(self.face_end - count, self.face_end)

    def move(self, v: int, point: Iterable[float]) -> None:
        """Have v lie there, as float32."""
        x, y, z = np.array(tuple(point), np.float32).tolist()
        self.points[v] = x, y, z
        self.moved.add(v)

    def put(
        self,
        made: dict[int, Cycle],
        *,
        vertices: dict[int, Cycle] | None = None,
        parts: dict[int, int] | None = None,
        heirs: dict[Side, Side] | None = None,
        gone: int = -1,
    ) -> None:
        """Give faces these corners, or take them away; UnsoundError where that is no surface."""
        before = {f: self.faces[f] for f in made if f in self.faces}
        after = {f: from_smallest(row) for f, row in made.items() if row}
        rows = (*before.values(), *after.values())
        edges = {both(*side) for row in rows for side in sides_of(row)}
        there = {it for it in edges if self._has_edge(it)}
        self._unlink(before)
        self._link(after)
        here = {it for it in edges if self._has_edge(it)}
        self.n_edges += len(here) - len(there)
        if gone >= 0:
            del self.points[gone]
            if self.around.pop(gone):
                raise UnsoundError("faces without a vertex")
        touched = {v for row in rows for v in row} - {gone}
        if not all(map(self._is_one_fan, touched)):
            raise UnsoundError("two fans in a vertex")
        heirs = {(b, a): (d, c) for (a, b), (c, d) in (heirs or {}).items()} | (heirs or {})
        sides = all_sides(before), all_sides(after)
        self.changes.append(
            Change(
                before,
                after,
                (sides[0] - sides[1], sides[1] - sides[0]),
                (there - here, here - there),
                vertices or {},
                parts or {},
                heirs,
                gone,
            )
        )

    def renumber(self, number: dict[int, int]) -> None:
        """Let faces have each other's handles."""
        rows = {number[f]: self.faces[f] for f in number}
        self._unlink({f: self.faces[f] for f in number})
        self._link(rows)

    def require(self, holds: bool) -> None:
        """Raise UnsoundError unless something holds."""
        if not holds:
            raise UnsoundError

    def _has_edge(self, edge: Side) -> bool:
        return edge in self.sides or edge[::-1] in self.sides

    def _unlink(self, rows: dict[int, Cycle]) -> None:
        for f, row in rows.items():
            del self.faces[f]
            for v, side in zip(row, sides_of(row), strict=True):
                del self.sides[side]
                self.around[v] -= {f}

    def _link(self, rows: dict[int, Cycle]) -> None:
        for f, row in rows.items():
            if len(row) < 3 or len({*row}) < len(row):
                raise UnsoundError("a face of fewer corners")
            if not {*row} <= self.points.keys():
                raise UnsoundError("a corner that is no vertex")
            self.faces[f] = row
            for v, side in zip(row, sides_of(row), strict=True):
                if side in self.sides:
                    raise UnsoundError("two faces on the same side of an edge")
                self.sides[side] = f
                self.around[v] |= {f}

    def _is_one_fan(self, v: int) -> bool:
        spokes = self.fan(v)
        closed = len(spokes) > 1 and (v, spokes[-1]) in self.sides
        return len(spokes) == len(self.around[v]) + (len(spokes) > 0 and not closed)

    # As a whole --------------------------------------------------------------------------------

    def state(self) -> dict[str, object]:
        """What ``restore`` needs."""
        return {name: it if isinstance(it, int) else it.copy() for name, it in vars(self).items()}

    def restore(self, state: dict[str, object]) -> None:
        """Be as it was."""
        vars(self).update(state)

    def compact(self) -> tuple[dict[int, int], dict[int, int]]:
        """Number what is live from 0 on, in order -> the new numbers of vertices and faces."""
        vertex, face = (
            {it: k for k, it in enumerate(sorted(of))} for of in (self.points, self.faces)
        )
        faces = {face[f]: tuple(vertex[v] for v in row) for f, row in self.faces.items()}
        points = {vertex[v]: point for v, point in self.points.items()}
        fresh = type(self)()
        for v in range(len(points)):
            fresh.new_vertex(points[v])
        fresh.put(dict(sorted(faces.items())))
        fresh.face_end = len(faces)
        self.restore(vars(fresh))
        return vertex, face


def path(following: dict[int, int], start: int, most: int) -> Cycle:
    """So many vertices, each following the last, none twice."""
    found = [start]
    while len(found) < most and following.get(found[-1], start) not in found:
        found.append(following[found[-1]])
    return tuple(found)


def loops(following: dict[int, int]) -> list[Cycle]:
    """The closed ways, each from its smallest vertex."""
    found = {from_smallest(path(following, v, len(following))) for v in following}
    return sorted(found)
