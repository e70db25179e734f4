"""What an operation did, for those who follow it."""

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Handles, Indices
from hem.ragged import Ragged

CREATED, CHANGED, REMOVED = range(3)
VERTEX, FACE, PARENT = 0, 3, 6
"""An entry of the log is ``index << 3 | element + what happened``; the first says how many.

Entries of ``PARENT`` follow that of a created element: what it was made of.
"""


class Remapping(NamedTuple):
    """Where ``compact`` moved everything: new handles by old ones, -1 for what was dead."""

    vertices: Handles
    """(old vertices, dead ones included): new vertex by old."""

    faces: Handles
    """(old faces, dead ones included): new face by old."""

    edges: Callable[[ArrayLike], Indices]
    """Handles of edges, (k,) old ones -> (k,) new ones."""


def _listed(code: int) -> Any:
    return property(lambda edit: edit._found[code])


class Edit:
    """What one operation, or one batch of them, did to a mesh: the vertices and faces it touched.

    ``kind``: the method that was called, such as ``split_edge``. ``vertex``: the vertex that a
    split created, or that a move moved; for a collapse the one that is left, else -1. Every element
    is in one list at most: what was created and removed by the same batch is in none. A face is
    changed when its corners are others than before, a vertex when its position is.

    ``compact`` touches nothing but renumbers everything; ``remapping`` says how, else it is None.

    What was created has parents, so that anyone can carry on what belongs to the elements.

    The lists are made when they are asked for; an edit may be kept as long as one likes.
    """

    remapping: Remapping | None = None

    touched: ArrayLike
    """The log: an entry per element and each thing that happened to it."""

    def __init__(self, kind: str, vertex: int, log: ArrayLike) -> None:
        self.kind = kind
        self.vertex = vertex
        self.touched = log

    def __repr__(self) -> str:
        names = ("created", "changed", "removed")
        parts = [
            f"{len(found)} {what}_{kind}"
            for kind in ("vertices", "faces")
            for what in names
            if len(found := getattr(self, f"{what}_{kind}"))
        ]
        return f"Edit({self.kind}: {', '.join(parts) or 'nothing'})"

    created_vertices: Handles = _listed(VERTEX + CREATED)
    """(k,) int32, ascending; so are the others."""
    changed_vertices: Handles = _listed(VERTEX + CHANGED)
    """Those at another position."""
    removed_vertices: Handles = _listed(VERTEX + REMOVED)
    created_faces: Handles = _listed(FACE + CREATED)
    changed_faces: Handles = _listed(FACE + CHANGED)
    """Those with other corners."""
    removed_faces: Handles = _listed(FACE + REMOVED)

    @cached_property
    def vertex_parents(self) -> Ragged:
        """A row for each of ``created_vertices``: what it was put between.

        The ends of a split edge, first the one whose part keeps the handle; the corners of a split
        face; the vertex that was split; nothing for a vertex that was added.
        """
        return self._parents(VERTEX, self.created_vertices)

    @cached_property
    def face_parents(self) -> Handles:
        """(k,) int32: the face that each of ``created_faces`` was a part of, or -1."""
        parents = self._parents(FACE, self.created_faces)
        found = np.full(len(parents), -1, np.int32)
        found[parents.counts > 0] = parents.values
        return found

    def _parents(self, kind: int, created: Handles) -> Ragged:
        """Of each created element the entries that follow its own in the log."""
        log = np.asarray(self.touched, np.int64)
        is_parent = log & 7 == PARENT
        entry = np.arange(len(log)) * ~is_parent
        child = log[np.maximum.accumulate(entry)[is_parent]] if len(log) else log
        mine = (child & 7 == kind + CREATED) & np.isin(child >> 3, created)
        child, parent = child[mine] >> 3, log[is_parent][mine] >> 3
        order = np.argsort(child, kind="stable")
        offsets = np.searchsorted(child[order], np.append(created, np.iinfo(np.int64).max))
        return Ragged(offsets.astype(np.int64), parent[order].astype(np.int32))

    @cached_property
    def _found(self) -> dict[int, Handles]:
        """The net effect: for each element whether it was there before, and whether it is now."""
        found, log = {}, np.asarray(self.touched, np.int64)
        for kind in (VERTEX, FACE):
            code, index = log & 7, log >> 3
            mine = (code >= kind) & (code < kind + 3)
            code, index = code[mine] - kind, index[mine]
            elements, place = np.unique(index, return_inverse=True)
            made, gone = np.zeros((2, len(elements)), np.bool_)
            made[place[code == CREATED]] = True
            gone[place[code == REMOVED]] = True
            wanted = {CREATED: made & ~gone, CHANGED: ~made & ~gone, REMOVED: gone & ~made}
            for what, these in wanted.items():
                found[kind + what] = elements[these].astype(np.int32)
        return found


def generations(edit: Edit) -> Iterator[tuple[Array, Ragged]]:
    """The created vertices and their parents, which are never among those of the same turn."""
    vertices, parents = edit.created_vertices, edit.vertex_parents
    waiting = np.flatnonzero(parents.counts > 0)
    while len(waiting):
        those = parents[waiting]
        late = np.isin(those.values, vertices[waiting])
        ready = np.add.reduceat(late, those.offsets[:-1]) == 0
        yield vertices[waiting[ready]], those[ready]
        waiting = waiting[~ready]


def whole_faces(edit: Edit, faces: Array) -> Array:
    """(k,): the faces that were there before the edit, of which these are parts."""
    found, made = np.array(faces, np.int64), edit.created_faces
    while len(made):
        at = np.minimum(np.searchsorted(made, found), len(made) - 1)
        parent = np.where(made[at] == found, edit.face_parents[at], -1)
        if not (parent >= 0).any():
            break
        found[parent >= 0] = parent[parent >= 0]
    return found
