"""Small meshes drawn record by record, so that one can follow who refers to whom.

A drawing is SVG with a group per record; ``static/explore.js`` lets one choose a record and follow
its references. Without scripts those of some records are drawn, and written beside it.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise, product
from typing import Any, NamedTuple

import numpy as np

import structures
from experiments.harness import OPERATIONS
from experiments.report.figures.meshes import edge_of, hexagon, off_edges
from experiments.report.figures.records import Entry, Key, path, records
from experiments.report.pages import Html, page
from experiments.report.tables import spelled
from hem.arrays import Array
from hem.contract import Navigable, Structure

SCALE, MARGIN = 110.0, 26.0
ASIDE, SHORTER = 8.0, 0.17  # of a half-edge: beside its edge, and cut off at either end
DOT, HEAD = 5.5, 6.0
BEND, CLEAR = 0.14, 7.0  # of an arrow between records: how far aside, and off either number

FACES = "face", "triangle"  # what records of faces are called
ALONG = 0.5, 0.35, 0.65, 0.2, 0.8  # an arrow is where its number may stand, the best first
CENTER, BESIDE = 0, 1  # the two inner vertices of the mesh that is drawn
ABOVE, BELOW = 4, 8  # the other corners of the faces at the edge between them


class Shape(NamedTuple):
    """How a record looks: its outline as SVG has it, its middle, and where its index stands."""

    outline: str
    at: Array
    label: Array


class Pointer(NamedTuple):
    """An arrow from one record to another, and where its words begin, end or have their middle."""

    outline: str
    words: str
    label: Array
    anchor: str

    @property
    def middle(self) -> Array:
        """That of its words."""
        aside = {"start": 3, "middle": 0, "end": -3}[self.anchor]
        return np.add(self.label, (aside * len(self.words), 0))


@dataclass(frozen=True)
class Drawing:
    """What the template ``mesh.html.j2`` needs."""

    width, height = 2 * (MARGIN + 1.7 * SCALE), 2 * (MARGIN + 1.05 * SCALE)

    shapes: Mapping[Key, Shape]
    entries: Mapping[Key, Sequence[Entry]]
    pointers: Sequence[Pointer]
    marked: Mapping[Key, str]
    shown: Collection[Key]

    @property
    def told(self) -> dict[str, list[Any]]:
        """Every record with its references, for the script."""
        return {f"{kind} {row}": list(its) for (kind, row), its in self.entries.items()}


def drawn_records(s: Structure) -> tuple[dict[Key, list[Entry]], dict[Key, Shape]]:
    """The records of a flat mesh, and how its elements are drawn."""
    entries = records(s)
    return entries, shapes_of(s, {kind for kind, _ in entries})


def shapes_of(s: Structure, kinds: Collection[str]) -> dict[Key, Shape]:
    """Every element of a flat mesh, as a record of one of these ``kinds`` where there are any."""
    points = MARGIN + SCALE * (s.points[:, :2] * (1, -1) + (1.7, 1.05))
    face = "triangle" if "triangle" in kinds else "face"
    found: dict[Key, Shape] = {}
    for f, corners in zip(s.faces().tolist(), s.face_vertices(), strict=True):
        middle = points[corners].mean(axis=0)
        outline = f"{_line(0.86 * points[corners] + 0.14 * middle)}Z"
        found[face, f] = Shape(outline, middle, middle)
    for number, e in enumerate(map(int, s.edges())):
        a, b = points[s.edge_vertices(e)]
        line = _arrow(a, b, 0.12) if "edge" in kinds else _line([a, b])
        found["edge", e if "edge" in kinds else number] = Shape(line, (a + b) / 2, (a + b) / 2)
    if isinstance(s, Navigable):
        for h in s.half_edges().tolist():
            a, b = points[[s.origin(h), s.tip(h)]]
            left = _unit(b - a)[::-1] * (1, -1)  # y points down
            a, b = a + ASIDE * left, b + ASIDE * left
            line, middle = _arrow(a, b, SHORTER, left), (a + b) / 2
            found["half_edge", h] = Shape(line, middle, middle + 8 * left)
    for v in s.vertices().tolist():
        away = off_edges(s, v) * (1, -1)
        found["vertex", v] = Shape(_dot(points[v]), points[v], points[v] + 13 * away)
    return found


def _arrow(a: Array, b: Array, shorter: float, side: Array | None = None) -> str:
    """A line with a whole head, or half of one on a ``side``."""
    a, b = a + shorter * (b - a), b - shorter * (b - a)
    return _line([a, b]) + _head(b, b - a, side)


def _head(tip: Array, way: Array, side: Array | None = None) -> str:
    back = tip - HEAD * _unit(way)
    across = HEAD * 0.6 * (_unit(way)[::-1] * (1, -1) if side is None else side)
    return _line([tip, back + across]) + (_line([tip, back - across]) if side is None else "")


def bent(a: Array, b: Array, words: str, along: float = 0.7, to: Array | None = None) -> Pointer:
    """An arrow between the numbers at a and b, its words so far ``along`` it.

    It is bent to the left, as ``explore.js`` draws it, too, or to where a point lies.
    """
    way, length = _unit(b - a), float(np.hypot(*(b - a)))
    a, b = a + min(CLEAR, 0.15 * length) * way, b - min(CLEAR, 0.15 * length) * way
    aside = way[::-1] * (1, -1)
    aside *= 1 if to is None or aside @ (to - a) >= 0 else -1
    control = (a + b) / 2 + BEND * length * aside
    line = f"M{_xy(a)}Q{_xy(control)} {_xy(b)}"
    at = (1 - along) ** 2 * a + 2 * along * (1 - along) * control + along**2 * b + 6 * aside
    anchor = "middle" if abs(aside[0]) < 0.4 else "start" if aside[0] > 0 else "end"
    return Pointer(line + _head(b, b - control), words, at, anchor)


def examples(entries: Mapping[Key, Sequence[Entry]]) -> list[Key]:
    """A record of each kind, each reached from the one before, beginning with the inner vertex."""
    found: dict[str, Key] = {}
    waiting: list[Key] = [("vertex", CENTER)]
    for key in chain(waiting, entries):  # those that nothing leads to come last
        if key in entries and key[0] not in found:
            found[key[0]] = key
            waiting += [(it.target, v) for it in entries[key] for v in it.values]
    return list(found.values())


def record(structure: type[Structure]) -> Html:
    """A small mesh whose records can be chosen; one of each kind is told, the longest is drawn."""
    entries, shapes = drawn_records(structure.build(hexagon()))
    shown = examples(entries)
    most = max(shown, key=lambda key: len(entries[key]))
    arrows = []
    for entry in entries[most]:  # none to what is not there
        ends = (shapes.get((entry.target, it)) for it in entry.values)
        arrows += [bent(shapes[most].at, it.at, spelled(entry.field)) for it in ends if it]
    drawing = Drawing(shapes, entries, arrows, {most: "chosen"}, shown)
    return page("mesh.html.j2", drawing=drawing, caption=f"{structure.title}, on a small mesh")


def walk(structure: type[Structure], query: str) -> Html:
    """The way that a query takes from the inner vertex, stop by stop, and what it finds."""
    s = structure.build(hexagon())
    found = getattr(s, query)(CENTER)
    (entries, shapes), stops = drawn_records(s), path(s, query, CENTER)
    places = [shapes[it.key].at for it in stops if it.key in shapes]
    middle, ways = shapes["vertex", CENTER].at, enumerate(pairwise(places), start=1)
    arrows, taken = [], [it.label for (kind, _), it in shapes.items() if kind in FACES]
    for number, (a, b) in ways:
        sides = product(ALONG, (middle, a + b - middle))
        tried = [bent(a, b, str(number), along, to) for along, to in sides]
        arrows.append(max(tried, key=lambda it: _apart(it.middle, taken)))
        taken.append(arrows[-1].middle)
    faces = {key: "found" for key in shapes if key[0] in FACES and key[1] in found}
    drawing = Drawing(shapes, entries, arrows, faces, [])
    caption = f"{structure.title}: {query.replace('_', ' → ')}"
    return page("mesh.html.j2", drawing=drawing, caption=caption, stops=stops, found=found)


def _apart(number: Array, others: Sequence[Array]) -> float:
    """How far a number lies off others: 1 where all of them can be read."""
    off = abs(np.array(others) - number) / (12, 9)
    return float(off.max(axis=1).min(initial=1))


def _changes(before: Mapping[Key, Any], after: Mapping[Key, Any]) -> dict[Key, str]:
    """Which records are new, and which refer to something else than before."""
    different = [key for key, its in after.items() if before.get(key) != its]
    return {key: "changed" if key in before else "made" for key in different}


def _split_edge(s: Structure) -> Iterator[str]:
    yield f"The edge between {CENTER} and {BESIDE} is to be split."
    v = s.split_edge(edge_of(s), (0, 0, 0)).vertex
    yield "A new vertex on the edge. Each of the two faces at it has become two."
    s.move_vertex(v, (0.1, 0.35, 0))
    yield "The new vertex need not lie on the edge. To move it changes no reference."


def _collapse_edge(s: Structure) -> Iterator[str]:
    yield f"Vertex {CENTER} is to merge into vertex {BESIDE}."
    s.move_vertex(CENTER, (0.2, 0.0, 0))
    yield "Here it is moved on its way, which changes no reference."
    s.collapse_edge(edge_of(s), keep=BESIDE)
    yield "The two faces at the edge are gone. Of the two edges beside each of them one is left."


def _split_face(s: Structure) -> Iterator[str]:
    face = int(s.edge_faces(edge_of(s))[0])
    yield f"Face {face} is to be split."
    s.split_face(face, s.points[s.face_vertices(face)].mean(axis=0))
    yield "A new vertex in the face, which has become three."


def _flip_edge(s: Structure) -> Iterator[str]:
    yield f"The edge between {CENTER} and {BESIDE} is to be flipped."
    s.flip_edge(edge_of(s))
    yield "It has turned within its two faces."
    s.flip_edge(edge_of(s, ABOVE, BELOW))
    yield "Flipped once more it joins the same vertices as before."


STEPS = {it.__name__[1:]: it for it in (_split_edge, _collapse_edge, _split_face, _flip_edge)}
"""By operation what is done for each frame but the first -> what is to be seen then."""
BY_HALF_EDGES = next(it for it in structures.REGISTRY.values() if issubclass(it, Navigable))
"""The first structure that has half-edges: the one to show operations on."""


def operation(name: str) -> Html:
    """An operation frame by frame, each drawn from the mesh that it has left."""
    s = BY_HALF_EDGES.build(hexagon())
    kept = [(words, *drawn_records(s)) for words in STEPS[name](s)]
    frames = []
    for k, (words, entries, shapes) in enumerate(kept):
        after = next((its for _, its, _ in kept[k + 1 :] if its != entries), entries)
        going = entries.keys() - after.keys()
        if k:
            marked = dict.fromkeys(going, "gone") | _changes(kept[k - 1][1], entries)
        else:
            marked = dict.fromkeys(going | entries.keys() & _changes(entries, after), "going")
        frames.append((words, Drawing(shapes, entries, [], marked, [])))
    return page("steps.html.j2", title=OPERATIONS[name], frames=frames)


def _line(points: Any) -> str:
    return "M" + "L".join(map(_xy, points))


def _dot(at: Array) -> str:
    return f"M{_xy(at - (DOT, 0))}a{DOT} {DOT} 0 1 0 {2 * DOT} 0a{DOT} {DOT} 0 1 0 {-2 * DOT} 0Z"


def _xy(at: Array) -> str:
    return f"{at[0]:.1f} {at[1]:.1f}"


def _unit(way: Array) -> Array:
    unit: Array = way / max(float(np.hypot(*way)), 1e-9)
    return unit
