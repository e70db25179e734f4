"""The thesis' class diagram (figure 4), of the classes as they are here: read from live objects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from inspect import isroutine
from itertools import chain
from typing import Any

from experiments.report.figures.meshes import hexagon
from experiments.report.pages import Html, page
from structures.half_edge_objects import HalfEdgeMesh
from structures.object_tools import (
    EdgeSplittingBehaviour,
    FaceSplittingBehaviour,
    HalfEdgeMeshBuilder,
)

WIDTH, LINE, GAP = 245, 15, 32
"""Of a box; of a line of text; between boxes."""


@dataclass(frozen=True)
class Box:
    """A class: its fields with their types, its methods, and where it stands."""

    name: str
    fields: dict[str, str]
    methods: list[str]
    left: int
    top: int

    @property
    def height(self) -> int:
        """Of the box."""
        return LINE * (len(self.fields) + len(self.methods) + 2)


def live_objects() -> list[list[Any]]:
    """One object of each class, in rows: who uses the mesh, the mesh, its lists, their elements."""
    mesh = HalfEdgeMesh.build(hexagon())
    edges, faces = EdgeSplittingBehaviour(mesh), FaceSplittingBehaviour(mesh)
    edges.split_half_edge(mesh.half_edges[0], (0, 0, 0))
    faces.split_face(mesh.faces[0], (0, 0, 0))
    vertex, half_edge = mesh.vertices[0], next(it for it in mesh.half_edges if it.opposite)
    vertex.subscribe(lambda moved: None)
    mesh.subscribe(lambda edit: None)
    lists = [mesh.vertices, mesh.half_edges, mesh.faces]
    event = vertex.position_changed
    elements = [vertex, half_edge, half_edge.face]
    return [[HalfEdgeMeshBuilder(), edges, faces], [None, mesh], lists, elements, [event]]


def fields_of(it: Any) -> Iterator[tuple[str, str]]:
    """The names of what an object holds, and the class of each; of a list that of what is in it."""
    own = type(it)
    slots = [name for base in own.__mro__ for name in vars(base).get("__slots__", ())]
    properties = [name for name, value in vars(own).items() if isinstance(value, property)]
    names = slots or [*vars(it)] if not isinstance(it, HalfEdgeMesh) else properties
    for name in names:
        value = getattr(it, name)
        many = type(value) is list
        kind = type(value[0] if many else value).__name__
        yield name.lstrip("_"), f"{kind} [*]" if many else kind


def boxes(rows: list[list[Any]]) -> list[Box]:
    """A box for each class, row below row."""
    found: list[Box] = []
    top = 1
    for row in rows:
        made = [
            Box(
                type(it).__name__,
                dict(fields_of(it)),
                _methods(type(it)),
                1 + k * (WIDTH + GAP),
                top,
            )
            for k, it in enumerate(row)
            if it is not None
        ]
        top += max(it.height for it in made) + GAP
        found += made
    return found


def uses(every: list[Box], rows: list[list[Any]]) -> set[tuple[str, str]]:
    """Which class holds, or makes, objects of which other one."""
    names = {it.name for it in every}
    held = {(it.name, kind.removesuffix(" [*]")) for it in every for kind in it.fields.values()}
    makes = {
        (type(it).__name__, name)
        for it in chain.from_iterable(rows)
        for value in vars(type(it)).values()
        if isinstance(value, staticmethod) and (name := value.__annotations__.get("return"))
    }
    return {(a, b) for a, b in held | makes if a != b and {a, b} <= names}


def class_diagram() -> Html:
    """The classes, and who holds whom."""
    rows = live_objects()
    every = boxes(rows)
    at = {it.name: it for it in every}
    lines = [_line(at[a], at[b]) for a, b in sorted(uses(every, rows))]
    size = 3 * (WIDTH + GAP), max(it.top + it.height for it in every) + 1
    return page("classes.html.j2", boxes=every, lines=lines, size=size, width=WIDTH, line=LINE)


def _methods(cls: type) -> list[str]:
    bases = [it for it in cls.__mro__ if it.__module__ == cls.__module__]
    own = {name: value for it in reversed(bases) for name, value in vars(it).items()}
    return [f"{name}()" for name, value in own.items() if isroutine(value) and name[0] != "_"]


def _line(a: Box, b: Box) -> tuple[float, float, float, float]:
    """From box to box, between the sides that face each other."""
    if a.top == b.top:
        ends = (a, b) if a.left < b.left else (b, a)
        y = a.top + 1.6 * LINE + (6 if a.left < b.left else 0)
        xs = (ends[0].left + WIDTH, ends[1].left)
        return (*xs, y, y) if a is ends[0] else (xs[1], xs[0], y, y)
    down = a.top < b.top
    ys = (a.top + a.height, b.top) if down else (a.top, b.top + b.height)
    return a.left + WIDTH / 2, b.left + WIDTH / 2, *ys
