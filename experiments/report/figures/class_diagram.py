"""The thesis' class diagram (figure 4), of the classes as they are here: read from live objects."""

from collections.abc import Iterator
from inspect import isroutine
from typing import Any, NamedTuple

from experiments.report.figures.meshes import hexagon
from experiments.report.pages import Html, page
from structures import object_tools as tools
from structures.half_edge_objects import HalfEdgeMesh

WIDTH, LINE, GAP = 270, 15, 32
"""Of a box, which is that of its longest line; of a line of text; between boxes."""


class Box(NamedTuple):
    """A class: its fields with their types, its methods, and where it stands."""

    name: str
    fields: dict[str, str]
    methods: list[str]
    left: int
    top: int
    height: int


def class_diagram() -> Html:
    """The classes, and who holds whom."""
    rows = _live_objects()
    at = {it.name: it for it in _boxes(rows)}
    lines = [_line(at[a], at[b], at) for a, b in sorted(_uses(at, rows))]
    size = 3 * (WIDTH + GAP), max(it.top + it.height for it in at.values()) + 1
    every = list(at.values())
    return page("classes.html.j2", boxes=every, lines=lines, size=size, width=WIDTH, line=LINE)


def _live_objects() -> list[list[Any]]:
    """One object of each class, in rows: who uses the mesh, the mesh, its lists, their elements."""
    mesh = HalfEdgeMesh.build(hexagon())
    edges, faces = tools.EdgeSplittingBehaviour(mesh), tools.FaceSplittingBehaviour(mesh)
    edges.split_half_edge(mesh.half_edges[0], (0, 0, 0))
    faces.split_face(mesh.faces[0], (0, 0, 0))
    vertex, half_edge = mesh.vertices[0], next(it for it in mesh.half_edges if it.opposite)
    vertex.subscribe(lambda moved: None)
    mesh.subscribe(lambda edit: None)
    lists, elements = [mesh.vertices, mesh.half_edges, mesh.faces], [vertex, half_edge]
    users = [tools.HalfEdgeMeshBuilder(), edges, faces]
    return [users, [None, mesh], lists, [*elements, half_edge.face], [vertex.position_changed]]


def _fields(it: Any) -> Iterator[tuple[str, str]]:
    """The names of what an object holds, and the class of each; of a list that of what is in it."""
    own = type(it)
    names = [name for base in own.__mro__ for name in vars(base).get("__slots__", ())] or vars(it)
    if isinstance(it, HalfEdgeMesh):
        names = [name for name, value in vars(own).items() if isinstance(value, property)]
    for name in names:
        value = getattr(it, name)
        many = type(value) is list
        kind = type(value[0] if many else value).__name__
        yield name.lstrip("_"), f"{kind} [*]" if many else kind


def _boxes(rows: list[list[Any]]) -> Iterator[Box]:
    """A box for each class, row below row."""
    top = 1
    for row in rows:
        lowest = top
        for k, it in enumerate(row):
            if it is not None:
                left, fields, methods = 1 + k * (WIDTH + GAP), dict(_fields(it)), _methods(type(it))
                height = LINE * (len(fields) + len(methods) + 2)
                yield Box(type(it).__name__, fields, methods, left, top, height)
                lowest = max(lowest, top + height)
        top = lowest + GAP


def _uses(boxes: dict[str, Box], rows: list[list[Any]]) -> Iterator[tuple[str, str]]:
    """Which class holds, or makes, objects of which other one."""
    held = {
        (name, it.removesuffix(" [*]")) for name, b in boxes.items() for it in b.fields.values()
    }
    for kind in (type(it) for row in rows for it in row):
        makers = [it for it in vars(kind).values() if isinstance(it, staticmethod)]
        made = (it.__annotations__.get("return") for it in makers)
        held |= {(kind.__name__, getattr(it, "__name__", "")) for it in made}
    return ((a, b) for a, b in held if a != b and {a, b} <= boxes.keys())


def _methods(cls: type) -> list[str]:
    bases = [it for it in cls.__mro__ if it.__module__ == cls.__module__]
    own = {name: value for it in reversed(bases) for name, value in vars(it).items()}
    return [f"{name}()" for name, value in own.items() if isroutine(value) and name[0] != "_"]


def _line(a: Box, b: Box, boxes: dict[str, Box]) -> list[tuple[float, float]]:
    """From box to box, between the sides that face each other; beside the boxes between them."""
    if a.top == b.top:
        right = a.left < b.left
        y = a.top + 1.6 * LINE + (6 if right else 0)
        return [(a.left + WIDTH, y), (b.left, y)] if right else [(a.left, y), (b.left + WIDTH, y)]
    if any(min(a.top, b.top) < it.top < max(a.top, b.top) for it in boxes.values()):
        x, y, end = a.left + WIDTH + GAP / 2, a.top + 0.8 * LINE, b.top + 0.8 * LINE
        to = b.left if b.left > a.left else b.left + WIDTH
        return [(a.left + WIDTH, y), (x, y), (x, end), (to, end)]
    down = a.top < b.top
    ys = (a.top + a.height, b.top) if down else (a.top, b.top + b.height)
    return [(a.left + WIDTH / 2, ys[0]), (b.left + WIDTH / 2, ys[1])]
