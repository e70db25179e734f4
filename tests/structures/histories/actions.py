"""Random operations, told in vertices and faces, so that every structure can be asked for the same.

Used by the differential tests and by the long soak (``python -m tests.structures.soak``).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import hem
from hem.contract import Structure
from tests.structures.histories.surface import Cycle, Point, Surface, loops, path

KINDS = (
    *("split_edge", "split_face", "collapse_edge", "collapse_edge", "collapse_edge", "flip_edge"),
    *("flip_edge", "remove_face", "remove_faces", "remove_vertex", "add_face", "move_vertex"),
    "add_vertex",
)
POLYGON_KINDS = (
    *("insert_vertex", "cut_across", "cut_across", "merge_faces", "merge_faces", "split_vertex"),
    *("erase_center_vertex", "truncate_vertex", "stellate", "fill"),
)
"""What is done to polygons only."""

BATCHES = ("split_edges", "split_faces", "collapse_edges", "move_vertices", "split_all_faces")
NUMBERS = 5040
"""The numbers of an action lie below it."""


class Action(NamedTuple):
    """An operation yet to be aimed: three numbers choose among whatever there is."""

    kind: str
    first: int
    second: int
    third: int


class Aimed(NamedTuple):
    """An operation on an edge (two vertices), on a face, or on vertices.

    Where an operation has a point, it lies between what the new vertex is put between, so that
    whatever is linear in the position stays so; where something is moved to, it lies anywhere.
    """

    kind: str
    elements: Cycle
    keep: int = -1
    points: tuple[Point, ...] = ()


def aim(m: Surface, action: Action) -> Aimed | None:
    """Choose the elements, by what there is; None where there is nothing to choose from."""
    kind, first, _, third = action
    if kind == "add_vertex":
        return Aimed(kind, (), -1, (_anywhere(action),))
    if not m.points:
        return None
    if kind in ("move_vertex", "remove_vertex", "erase_center_vertex", "truncate_vertex"):
        v = _pick(m.points, first)
        # The spokes of a truncated one are told, as the new vertices are made in their order.
        return Aimed(kind, (v, *m.fan(v)) if kind[0] == "t" else (v,), -1, (_anywhere(action),))
    if kind == "move_vertices":
        chosen = _some(m.points, action)
        return Aimed(kind, chosen, -1, (_anywhere(action),) * len(chosen))
    if kind in ("add_face", "fill"):
        return Aimed(kind, _corners(m, action) if kind == "add_face" else _hole(m, action))
    if not m.faces or (kind == "split_all_faces" and len(m.faces) > 60):
        return None
    return _aim_at_faces(m, action) if kind in FACES_TOLD else _aim_at_edge(m, action, third)


FACES_TOLD = ("split_all_faces", "remove_faces", "split_faces", "split_edges", "collapse_edges")
FACES_TOLD += ("split_face", "remove_face", "stellate", "cut_across")


def _aim_at_faces(m: Surface, action: Action) -> Aimed:
    kind, first, second, third = action
    if kind in ("split_edges", "collapse_edges"):
        pairs = _apart(m, action)
        ends = [(a, b) for a, b in zip(pairs[::2], pairs[1::2], strict=True)]
        return Aimed(kind, pairs, -1, tuple(_between(m, it, action) for it in ends))
    if kind == "cut_across":
        f = _pick(m.faces, first)
        row = m.faces[f]
        a = second % len(row)
        b = (a + 2 + third % max(1, len(row) - 3)) % len(row) if third % 9 else third % len(row)
        return Aimed(kind, (f, row[a], row[b]))
    if kind == "split_all_faces":
        chosen = tuple(sorted(m.faces))
    elif kind in ("remove_faces", "split_faces"):
        chosen = _some(m.faces, action)
    else:
        chosen = (_pick(m.faces, first),)
    rows = [m.faces[f] for f in chosen]
    if kind in ("split_all_faces", "stellate"):
        points = tuple(_middle(m, row) for row in rows)
    else:
        points = tuple(_between(m, row, action) for row in rows)
    return Aimed(kind, chosen, -1, points)


def _aim_at_edge(m: Surface, action: Action, third: int) -> Aimed:
    kind, first, second, _ = action
    row = m.faces[_pick(m.faces, first)]
    at = second % len(row)
    a, b = row[at], row[(at + 1) % len(row)]
    if third % 4 > 1:
        a, b = b, a
    if kind == "split_vertex":
        spokes = m.fan(a)
        other = spokes[third % len(spokes)]
        return Aimed(kind, (a, b, other), -1, (_between(m, (a,), action),))
    points = (_between(m, (a, b), action),)
    return Aimed(kind, (a, b), (a, b)[third % 2], points)


def _pick(among: dict[int, Any], number: int) -> int:
    """One of the handles."""
    return [*among][number % len(among)]


def _some(among: dict[int, Any], action: Action) -> Cycle:
    """Up to twelve of the handles, ascending."""
    handles, (_, first, second, third) = [*among], action
    return tuple(
        sorted({handles[(first + second * i) % len(handles)] for i in range(1 + third % 12)})
    )


def _anywhere(action: Action) -> Point:
    return float(action.first % 7), float(action.second % 5), float(action.third % 3)


def _between(m: Surface, parents: Cycle, action: Action) -> Point:
    """A point between vertices, sometimes on one of them."""
    chance = (action.first % 7, action.second % 5, action.third % 3)
    weights = np.array([chance[i % 3] + i for i in range(len(parents))], float)
    weights = weights / weights.sum() if weights.any() else weights + 1 / len(weights)
    x, y, z = (weights @ [m.points[v] for v in parents]).tolist()
    return x, y, z


def _middle(m: Surface, parents: Cycle) -> Point:
    x, y, z = np.mean([m.points[v] for v in parents], axis=0).tolist()
    return x, y, z


def _corners(m: Surface, action: Action) -> Cycle:
    """Often a face that fits onto the border, sometimes any three vertices."""
    vertices, outside, (_, first, second, third) = [*m.points], m.outside(), action
    if outside and third % 4:
        a = _pick(outside, first)
        b = outside[a]
        if third % 4 > 1:
            return a, b, outside[b]
        return a, b, vertices[second % len(vertices)]
    return tuple(vertices[it % len(vertices)] for it in (first, second, third))


def _hole(m: Surface, action: Action) -> Cycle:
    """A hole, or several vertices along it, sometimes any four of a mesh."""
    vertices, outside, (_, first, second, third) = [*m.points], m.outside(), action
    if not outside or not third % 5:
        return tuple(vertices[(first + second * i) % len(vertices)] for i in range(4))
    if third % 5 == 1:
        holes = loops(outside)
        return holes[second % len(holes)]
    return path(outside, _pick(outside, first), 4 + second % 3)


def _apart(m: Surface, action: Action) -> Cycle:
    """The first two corners of some faces, one pair after the other; no vertex comes twice."""
    found: list[int] = []
    handles = [*m.faces]
    for i in range(9):
        a, b, *_ = m.faces[handles[(action.first + action.second * i) % len(handles)]]
        if not {a, b} & set(found):
            found += [a, b]
    return tuple(found)


def perform(s: Structure, aimed: Aimed) -> Any:
    """Do it -> what the method returns, as lists, or why it was refused. Predicates must agree."""
    kind, elements, keep, points = aimed
    try:
        if kind in BATCHES:
            return kind, _in_one_go(s, kind, elements, points)
        if kind in ("move_vertex", "split_face", "add_vertex", "stellate"):
            edit = getattr(s, kind)(*elements, *points)
        elif kind == "remove_faces":
            edit = s.remove_faces(elements)
        elif kind in ("remove_face", "remove_vertex", "add_face", "erase_center_vertex"):
            edit = getattr(s, kind)(*elements)
        elif kind in POLYGON_KINDS:
            edit = ON_POLYGONS[kind](s, *elements, *points)
        else:
            edit = _on_edge(s, kind, s.find_edge(*elements), keep, points[0])
    except hem.TopologyError as refusal:
        return refusal.reason
    return kind, edit.vertex if isinstance(edit, hem.Edit) else edit


def _half_edge(s: Any, a: int, b: int) -> int:
    """The one that runs from a to b."""
    e = s.find_edge(a, b)
    return int(e if s.origin(e) == a else s.twin(e))


def _cut_across(s: Any, f: int, a: int, b: int) -> None:
    ahead = {s.origin(h): h for h in s.face_half_edges(f).tolist()}
    s.split_face(ahead[a], ahead[b])


ON_POLYGONS: dict[str, Callable[..., Any]] = {
    "insert_vertex": lambda s, a, b, point: s.split_edge(_half_edge(s, a, b), point, False),
    "cut_across": _cut_across,
    "merge_faces": lambda s, a, b, _: s.merge_faces(_half_edge(s, a, b)),
    "split_vertex": lambda s, v, a, b, point: s.split_vertex(
        _half_edge(s, v, a), _half_edge(s, v, b), point
    ),
    "truncate_vertex": lambda s, v, *_: s.truncate_vertex(v),
    "fill": lambda s, *corners: s.add_face(*corners),
}


def _in_one_go(s: Structure, kind: str, elements: Cycle, points: tuple[Point, ...]) -> Any:
    """A batch -> what it gives back, as lists."""
    if kind == "split_all_faces":
        return s.split_all_faces().tolist()
    handles: Any = elements
    if kind in ("split_edges", "collapse_edges"):
        pairs = zip(elements[::2], elements[1::2], strict=True)
        handles = [s.find_edge(a, b) for a, b in pairs]
    if kind == "collapse_edges":
        return s.collapse_edges(handles).tolist()
    made = getattr(s, kind)(handles, points)
    return [] if made is None else made.tolist()


def _on_edge(s: Structure, kind: str, edge: Any, keep: int, point: Point) -> hem.Edit:
    if kind == "split_edge":
        return s.split_edge(edge, point)
    allowed = getattr(s, f"can_{kind}")(edge)
    try:
        edit = s.collapse_edge(edge, keep=keep) if kind == "collapse_edge" else s.flip_edge(edge)
    except hem.TopologyError:
        assert not allowed
        raise
    assert allowed
    return edit


def surface_of(s: Structure) -> Surface:
    """The mesh that a structure holds."""
    m, faces = Surface(), faces_of(s)
    for v in s.vertices().tolist():
        m.vertex_end = v
        m.new_vertex(s.points[v])
    m.put(faces)
    m.vertex_end, m.face_end = len(s.points), s.face_end
    return m


def faces_of(s: Structure) -> dict[int, Cycle]:
    """The live faces by handle, each from its smallest corner on."""
    found, handles = {}, s.faces()
    for f, row in zip(handles.tolist(), s.face_vertices(handles).to_list(), strict=True):
        k = row.index(min(row))
        found[f] = (*row[k:], *row[:k])
    return found
