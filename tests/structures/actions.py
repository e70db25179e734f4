"""Random operations, told in vertices and faces, so that every structure can be asked for the same.

Used by the differential tests and by the long soak (``python -m tests.structures.soak``).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import hem
from hem.contract import Structure
from hem.meshes import euler_number

KINDS = (
    *("split_edge", "split_face", "collapse_edge", "collapse_edge", "collapse_edge", "flip_edge"),
    *("flip_edge", "remove_face", "remove_faces", "remove_vertex", "add_face", "move_vertex"),
)
BATCHES = ("split_edges", "split_faces", "collapse_edges", "move_vertices", "split_all_faces")
LISTS = ("created_vertices", "changed_vertices", "removed_vertices")
LISTS += ("created_faces", "changed_faces", "removed_faces")


class Action(NamedTuple):
    """An operation yet to be aimed: three numbers choose among whatever there is."""

    kind: str
    first: int
    second: int
    third: int


class Aimed(NamedTuple):
    """An operation on an edge (two vertices), on a face, or on vertices."""

    kind: str
    elements: tuple[int, ...]
    keep: int
    point: tuple[float, float, float]


def aim(s: Structure, action: Action) -> Aimed | None:
    """Choose the elements, by what ``s`` has; None where there is nothing to choose from."""
    kind, first, second, third = action
    faces, vertices = s.faces(), s.vertices()
    point = (first % 7, second % 5, third % 3)
    if kind in ("move_vertex", "remove_vertex"):
        return Aimed(kind, (int(vertices[first % len(vertices)]),), -1, point)
    if kind == "add_face":
        return Aimed(kind, _corners(s, action), -1, point)
    if not len(faces):
        return None
    face = int(faces[first % len(faces)])
    if kind == "split_all_faces":
        return Aimed(kind, (), -1, point) if len(faces) < 100 else None
    if kind in ("remove_faces", "split_faces", "move_vertices"):
        those = vertices if kind == "move_vertices" else faces
        chosen = those[(first + second * np.arange(1 + third % 12)) % len(those)]
        return Aimed(kind, tuple(np.unique(chosen).tolist()), -1, point)
    if kind in ("split_edges", "collapse_edges"):
        return Aimed(
            kind, _apart(s, faces[(first + second * np.arange(9)) % len(faces)]), -1, point
        )
    if kind in ("split_face", "remove_face"):
        return Aimed(kind, (face,), -1, point)
    corners = s.face_vertices(face).tolist()
    a, b = corners[second % 3], corners[(second + 1) % 3]
    return Aimed(kind, (a, b), (a, b)[third % 2], point)


def _corners(s: Structure, action: Action) -> tuple[int, ...]:
    """Often a face that fits onto the border, sometimes any three vertices."""
    vertices = s.vertices()
    rows = s.face_vertices(s.faces()).values.reshape(-1, 3)
    sides = {
        pair
        for i in range(3)
        for pair in zip(rows[:, i].tolist(), rows[:, i - 2].tolist(), strict=True)
    }
    border = sorted((b, a) for a, b in sides if (b, a) not in sides)
    _, first, second, third = action
    if border and third % 4:
        a, b = border[first % len(border)]
        onward = [y for x, y in border if x == b]
        if onward and third % 4 > 1:
            return a, b, onward[second % len(onward)]
        return a, b, int(vertices[second % len(vertices)])
    return tuple(int(vertices[it % len(vertices)]) for it in (first, second, third))


def _apart(s: Structure, faces: np.ndarray) -> tuple[int, ...]:
    """The first two corners of some faces, one pair after the other; no vertex comes twice."""
    found: list[int] = []
    for a, b, _ in s.face_vertices(faces).values.reshape(-1, 3).tolist():
        if not {a, b} & set(found):
            found += [a, b]
    return tuple(found)


def perform(s: Structure, aimed: Aimed) -> Any:
    """Do it -> what the edit names, or why it was refused. The predicates must agree."""
    kind, elements, keep, point = aimed
    try:
        if kind in BATCHES:
            return _in_one_go(s, kind, elements, point)
        if kind == "remove_faces":
            edit = _told(s, lambda: s.remove_faces(elements))
        elif kind == "move_vertex" or kind == "split_face":
            edit = getattr(s, kind)(*elements, point)
        elif kind in ("remove_face", "remove_vertex", "add_face"):
            edit = getattr(s, kind)(*elements)
        else:
            edit = _on_edge(s, kind, s.find_edge(*elements), keep, point)
    except hem.TopologyError as refusal:
        return refusal.reason
    parents = edit.vertex_parents.to_list(), edit.face_parents.tolist()
    return edit.vertex, *(getattr(edit, name).tolist() for name in LISTS), parents


def _in_one_go(s: Structure, kind: str, elements: tuple[int, ...], point: Any) -> Any:
    """A batch -> what it gives back, as lists."""
    if kind == "split_all_faces":
        return kind, s.split_all_faces().tolist()
    handles: Any = elements
    if kind in ("split_edges", "collapse_edges"):
        pairs = zip(elements[::2], elements[1::2], strict=True)
        handles = [s.find_edge(a, b) for a, b in pairs]
    if kind == "collapse_edges":
        return kind, s.collapse_edges(handles).tolist()
    made = getattr(s, kind)(handles, [point] * len(handles))
    return kind, [] if made is None else made.tolist()


def _told(s: Structure, operate: Callable[[], None]) -> hem.Edit:
    """What subscribers hear of an operation that tells nobody else."""
    heard: list[hem.Edit] = []
    unsubscribe = s.subscribe(heard.append)
    try:
        operate()
    finally:
        unsubscribe()
    return heard[0]


def _on_edge(s: Structure, kind: str, edge: int, keep: int, point: Any) -> hem.Edit:
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


def faces_of(s: Structure) -> dict[int, tuple[int, ...]]:
    """The live triangles by face, each from its smallest corner on."""
    faces = s.faces()
    rows = s.face_vertices(faces).values.reshape(-1, 3)
    turned = (rows.argmin(axis=1)[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(rows, turned, axis=1).tolist()
    return dict(zip(faces.tolist(), map(tuple, corners), strict=True))


EULER = dict.fromkeys(("add_face", "remove_face", "remove_faces", "remove_vertex"))
"""Operations that may change Euler's number; all others keep it."""


def check(many: list[Structure], euler: int | None) -> int:
    """Both validators, the counts, and that all structures hold the same mesh -> Euler's number.

    ``euler``: what the number must be, None if the last operation may have changed it.
    """
    expected, first = faces_of(many[0]), many[0].to_triangles()
    hem.require_sound(first, euler)
    edges = len(
        {frozenset(p) for t in expected.values() for p in zip(t, t[1:] + t[:1], strict=True)}
    )
    for s in many:
        s.validate()
        assert faces_of(s) == expected
        assert (s.n_faces, s.n_edges) == (len(expected), edges)
        assert len(s.vertices()) == s.n_vertices == len(first.points)
        assert len(s.edges()) == s.n_edges
        assert np.array_equal(s.to_triangles().points, first.points)
        assert np.array_equal(s.points, many[0].points, equal_nan=True)
    return euler_number(first)
