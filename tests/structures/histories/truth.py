"""What an operation makes of a mesh, from the faces alone: predicted, not asked of a structure.

``predict`` does to a ``Surface`` what the drawings in ``hem.authoring.operations`` show. Which part
of a polygon keeps its handle is the structure's to choose: then ``Predicted.free`` says between
which faces, and ``adopt`` takes over what was chosen.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from tests.structures.histories.actions import Aimed
from tests.structures.histories.surface import (
    Change,
    Cycle,
    Point,
    Surface,
    UnsoundError,
    both,
    net_sides,
    sides_of,
)


class Predicted(NamedTuple):
    """What an edit must tell: elements by what happened to them, and the parents of new ones."""

    vertex: int
    created: tuple[set[int], set[int]]
    """Vertices and faces, as in the lists below."""

    changed: tuple[set[int], set[int]]
    removed: tuple[set[int], set[int]]
    vertices: dict[int, Cycle]
    parts: dict[int, int]
    returned: object
    """What a batch gives back, else None."""

    changes: list[Change]


def predict(m: Surface, aimed: Aimed) -> Predicted | None:
    """Do it to the surface -> what must be told, or None if it is refused and nothing changed."""
    before = m.state()
    m.changes, m.moved = [], set()
    euler = m.euler
    try:
        vertex, returned = OPERATIONS[aimed.kind](m, aimed)
        m.require(aimed.kind not in KEEPING or m.euler == euler)
    except UnsoundError:
        m.restore(before)
        return None
    return _told(m, before, vertex, returned)


def _told(m: Surface, before: dict[str, object], vertex: int, returned: object) -> Predicted:
    """The net effect, by comparing what there was with what there is."""
    points, faces = before["points"], before["faces"]
    assert isinstance(points, dict)
    assert isinstance(faces, dict)
    vertices = {v: row for change in m.changes for v, row in change.vertices.items()}
    parts = {f: of for change in m.changes for f, of in change.parts.items()}
    changed = {f for f in faces.keys() & m.faces.keys() if faces[f] != m.faces[f]}
    new = m.points.keys() - points.keys(), m.faces.keys() - faces.keys()
    gone = points.keys() - m.points.keys(), faces.keys() - m.faces.keys()
    return Predicted(
        vertex,
        (set(new[0]), set(new[1])),
        (m.moved & points.keys(), changed),
        (set(gone[0]), set(gone[1])),
        {v: vertices.get(v, ()) for v in new[0]},
        {f: parts.get(f, -1) for f in new[1]},
        returned,
        m.changes,
    )


Made = tuple[int, object]
"""The vertex that an operation is about, or -1, and what a batch returns."""


def split_edge(m: Surface, a: int, b: int, point: Point) -> int:
    """Every face at it becomes two; the part at the smaller end keeps the handle."""
    a, b = both(a, b)
    beside = [f for f in (m.sides.get((a, b)), m.sides.get((b, a))) if f is not None]
    m.require(all(len(m.faces[f]) == 3 for f in beside))
    v, new = m.new_vertex(point), m.new_faces(len(beside))
    made = {}
    for old, f in zip(beside, new, strict=True):
        made[old] = tuple(v if it == b else it for it in m.faces[old])
        made[f] = tuple(v if it == a else it for it in m.faces[old])
    parts = dict(zip(new, beside, strict=True))
    m.put(made, vertices={v: (a, b)}, parts=parts, heirs={(a, v): (a, b), (v, b): (a, b)})
    return v


def split_face(m: Surface, f: int, point: Point) -> int:
    """A triangle at every side; the one at the smallest corner keeps the handle."""
    row = m.faces[f]
    v, new = m.new_vertex(point), m.new_faces(len(row) - 1)
    handles = (f, *new)
    made = {g: (row[i], row[(i + 1) % len(row)], v) for i, g in enumerate(handles)}
    m.put(made, vertices={v: row}, parts=dict.fromkeys(new, f))
    return v


def collapse_edge(m: Surface, a: int, b: int, keep: int) -> int:
    """One end takes the place of the other; triangles there vanish, polygons lose a corner.

    Of a tetrahedron two coincident triangles would be left. Polygons may lie back to back.
    """
    drop, euler, made = a + b - keep, m.euler, {}
    for f in m.around[drop]:
        row = m.faces[f]
        if {(drop, keep), (keep, drop)} & {*sides_of(row)}:
            rest = tuple(v for v in row if v != drop)
            made[f] = rest if len(rest) > 2 else ()
        else:
            made[f] = tuple(keep if v == drop else v for v in row)
    own = {*m.fan(keep)}
    heirs = {(keep, x): (drop, x) for x in m.fan(drop) if x != keep and x not in own}
    triangles = all(len(m.faces[f]) == 3 for f in made)
    m.put(made, heirs=heirs, gone=drop)
    m.require(m.euler == euler and len(m.around[keep]) > 0)
    m.require(not triangles or all(m.back(f) < 0 for f, row in made.items() if row))
    return keep


def flip_edge(m: Surface, a: int, b: int) -> int:
    """It joins the other two corners then; the face at the smaller of them becomes the one at a."""
    a, b = both(a, b)
    m.require((a, b) in m.sides and (b, a) in m.sides)
    left, right = m.sides[a, b], m.sides[b, a]
    m.require(len(m.faces[left]) == len(m.faces[right]) == 3)
    (c,), (d,) = ({*m.faces[f]} - {a, b} for f in (left, right))
    one, other = (left, right) if c < d else (right, left)
    m.require(c != d)
    m.put({one: (a, d, c), other: (b, c, d)}, heirs={(d, c): (a, b)})
    return -1


def add_face(m: Surface, *corners: int) -> int:
    """Where it fits."""
    (f,) = m.new_faces(1)
    m.put({f: corners})
    m.require(m.back(f) < 0)
    return -1


def remove_vertex(m: Surface, v: int) -> int:
    """And all its faces."""
    m.put(dict.fromkeys(m.around[v], ()), gone=v)
    return -1


def move_vertices(m: Surface, vertices: Cycle, points: tuple[Point, ...]) -> None:
    """No face has other corners."""
    for v, point in zip(vertices, points, strict=True):
        m.move(v, point)


def insert_vertex(m: Surface, a: int, b: int, point: Point) -> int:
    """The faces there have a corner more."""
    made, v = {}, m.new_vertex(point)
    for x, y in ((a, b), (b, a)):
        f = m.sides.get((x, y))
        if f is not None:
            row = m.faces[f]
            made[f] = tuple(it for w in row for it in ((w, v) if w == x else (w,)))
    m.put(made, vertices={v: (a, b)}, heirs={(a, v): (a, b), (v, b): (a, b)})
    return v


def cut_across(m: Surface, f: int, a: int, b: int) -> int:
    """An edge between two corners of a face; either part may keep the handle."""
    row = m.faces[f]
    m.require(a != b)
    i, j = row.index(a), row.index(b)
    parts = [(row + row)[x : (y if y > x else y + len(row)) + 1] for x, y in ((i, j), (j, i))]
    (g,) = m.new_faces(1)
    m.put({f: parts[0], g: parts[1]}, parts={g: f})
    return -1


def merge_faces(m: Surface, a: int, b: int) -> int:
    """The face on the left takes in the one on the right."""
    m.require((a, b) in m.sides and (b, a) in m.sides)
    stays, goes = m.sides[a, b], m.sides[b, a]
    one, other = _starting(m.faces[stays], b), _starting(m.faces[goes], a)
    m.put({stays: one + other[1:-1], goes: ()})
    return -1


def split_vertex(m: Surface, v: int, first: int, second: int, point: Point) -> int:
    """The new vertex takes the edges from the first to before the second, counterclockwise."""
    spokes = m.fan(v)
    m.require(first != second)
    taken = _starting(tuple(spokes), first)
    taken = taken[: taken.index(second)]
    made, w = {}, m.new_vertex(point)
    for f in m.around[v]:
        after, before = m.beside(f, v)
        put = {(True, True): (w,), (True, False): (v, w), (False, True): (w, v)}
        new = put.get((after in taken, before in taken), (v,))
        made[f] = tuple(it for u in m.faces[f] for it in (new if u == v else (u,)))
    heirs = {(w, x): (v, x) for x in taken}
    m.put(made, vertices={w: (v,)}, heirs=heirs)
    return w


def erase_center_vertex(m: Surface, v: int) -> int:
    """All faces at it become one, which may have the handle of any of them."""
    spokes, faces = m.fan(v), sorted(m.around[v])
    m.require(len(spokes) == len(faces) > 0)
    ring: list[int] = []
    for x in spokes:
        row = _starting(m.faces[m.sides[v, x]], v)
        ring += row[1:-1]
    m.put(dict.fromkeys(faces, ()) | {faces[0]: tuple(ring)}, gone=v)
    return -1


def truncate_vertex(m: Surface, v: int, *spokes: int) -> int:
    """A vertex on every edge, an edge between each two that follow, and the vertex erased."""
    m.require(len(spokes) == len(m.around[v]) >= 3)
    at = m.points[v]
    new = []
    for x in spokes:
        third = zip(at, m.points[x], strict=True)
        new.append(insert_vertex(m, v, x, tuple(2 / 3 * p + 1 / 3 * q for p, q in third)))  # type: ignore[arg-type]
    for x in new:
        f = m.sides[v, x]
        cut_across(m, f, x, m.beside(f, v)[1])
    erase_center_vertex(m, v)
    return -1


def _starting(row: Cycle, v: int) -> Cycle:
    at = row.index(v)
    return row[at:] + row[:at]


def _split_edges(m: Surface, aimed: Aimed) -> Made:
    ends = list(zip(aimed.elements[::2], aimed.elements[1::2], strict=True))
    new = [split_edge(m, a, b, p) for (a, b), p in zip(ends, aimed.points, strict=True)]
    return -1, new


def _collapse_edges(m: Surface, aimed: Aimed) -> Made:
    """One after the other, each where it may be."""
    done = []
    for a, b in zip(aimed.elements[::2], aimed.elements[1::2], strict=True):
        before = m.state()
        try:
            collapse_edge(m, a, b, max(a, b))
        except UnsoundError:
            m.restore(before)
            done.append(False)
        else:
            done.append(True)
    return -1, done


def _split_faces(m: Surface, aimed: Aimed) -> Made:
    pairs = zip(aimed.elements, aimed.points, strict=True)
    return -1, [split_face(m, f, point) for f, point in pairs]


def _move(m: Surface, aimed: Aimed) -> Made:
    move_vertices(m, aimed.elements, aimed.points)
    return (aimed.elements[0], None) if aimed.kind == "move_vertex" else (-1, [])


def _remove_faces(m: Surface, aimed: Aimed) -> Made:
    m.put(dict.fromkeys(aimed.elements, ()))
    return -1, None


def _one(operate: Callable[..., int]) -> Callable[[Surface, Aimed], Made]:
    """An operation of its elements, and of a point if it has one."""
    return lambda m, aimed: (operate(m, *aimed.elements, *aimed.points), None)


def _untold(operate: Callable[..., int]) -> Callable[[Surface, Aimed], Made]:
    """An operation of its elements alone."""
    return lambda m, aimed: (operate(m, *aimed.elements), None)


OPERATIONS: dict[str, Callable[[Surface, Aimed], Made]] = {
    "split_edge": _one(split_edge),
    "split_face": _one(split_face),
    "stellate": _one(split_face),
    "collapse_edge": lambda m, aimed: (collapse_edge(m, *aimed.elements, aimed.keep), None),
    "flip_edge": _untold(flip_edge),
    "add_face": _untold(add_face),
    "fill": _untold(add_face),
    "add_vertex": lambda m, aimed: (m.new_vertex(*aimed.points), None),
    "remove_face": _remove_faces,
    "remove_faces": _remove_faces,
    "remove_vertex": _untold(remove_vertex),
    "move_vertex": _move,
    "move_vertices": _move,
    "split_edges": _split_edges,
    "split_faces": _split_faces,
    "split_all_faces": _split_faces,
    "collapse_edges": _collapse_edges,
    "insert_vertex": _one(insert_vertex),
    "cut_across": _untold(cut_across),
    "merge_faces": _untold(merge_faces),
    "split_vertex": _one(split_vertex),
    "erase_center_vertex": _untold(erase_center_vertex),
    "truncate_vertex": _untold(truncate_vertex),
}

KEEPING = {*OPERATIONS} - {"add_face", "fill", "add_vertex"}
KEEPING -= {"remove_face", "remove_faces", "remove_vertex"}
"""Operations that keep Euler's number."""

FREE = ("cut_across", "erase_center_vertex", "truncate_vertex")
"""Operations after which faces may have each other's handles."""


def adopt(m: Surface, told: Predicted, faces: dict[int, Cycle], parts: dict[int, int]) -> Predicted:
    """Have the handles, and the parents of new ones, that a structure chose among those touched.

    AssertionError if it has other faces there, or a part of a face has another parent than that.
    """
    old = {f: row for it in reversed(told.changes) for f, row in it.before.items()}
    old = {f: old[f] for f in told.changed[1] | told.removed[1]}
    mine = {f: m.faces[f] for f in told.created[1] | told.changed[1]}
    pool = {f for change in told.changes for f in (*change.before, *change.after)}
    theirs = {faces[f]: f for f in pool & faces.keys()}
    assert theirs.keys() == {*mine.values()}, f"faces {theirs} instead of {mine}"
    number = {f: theirs[row] for f, row in mine.items()}
    m.renumber(number)
    after = {number[f]: row for f, row in mine.items()}
    new = after.keys() - old.keys()
    for f, g in number.items():
        assert g not in new or parts[g] == f or (f not in old and parts[g] in old), (
            f"{g} of {parts}"
        )
    change = Change(
        old,
        after,
        *net_sides(old, after),
        told.vertices,
        parts,
        {new: of for it in told.changes for new, of in it.heirs.items()},
        *(told.removed[0] or {-1}),
    )
    return told._replace(
        created=(told.created[0], {*new}),
        changed=(told.changed[0], {f for f in after.keys() & old.keys() if after[f] != old[f]}),
        removed=(told.removed[0], old.keys() - after.keys()),
        parts=parts,
        changes=[change],
    )
