"""Values of edges and half-edges where an operation moves these from place to place."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.authoring import BITS
from hem.contract.attributes import EdgeAttribute, enlarged
from hem.edit import Edit, Remapping

Way = tuple[int, int]  # where a half-edge starts, and where it ends


class SideAttribute(EdgeAttribute):
    """Of edges or half-edges that are the sides of faces: side i of face f has row 3 f + i.

    It is kept how every side ran when it was last looked at. After an edit the sides of the faces
    that it touched find their values by how they run now. An edge has its value on both sides.
    """

    def __setitem__(self, handles: Any, values: ArrayLike) -> None:
        """See ``Attribute``."""
        rows = self._checked(handles)
        self._rows[rows] = values
        if self.element == "edge":
            rows = np.atleast_1d(rows)
            twin = self._state.declared.step("twin", self._state.records, rows)
            self._rows[twin[twin >= 0]] = self._rows[rows[twin >= 0]]
        self._listeners.tell(np.atleast_1d(np.asarray(handles)))

    # Behind it ---------------------------------------------------------------------------------

    def _checked(self, handles: Any) -> Any:
        rows = super(EdgeAttribute, self)._checked(handles)
        return rows >> BITS if self.element == "edge" else rows

    def _numbers(self, remapping: Remapping) -> Array:
        return np.where(np.repeat(remapping.faces < 0, 3), -1, sides_of(remapping.faces))

    def _look_at_all(self) -> None:
        self._ran = np.full((self._end, 2), -1)
        self._look_at(sides_of(self.mesh.faces()))

    def _look_at(self, sides: Array) -> list[Way]:
        """Keep how these sides run -> that."""
        ways = np.stack([self.mesh.origin(sides), self.mesh.tip(sides)], axis=1)
        self._ran = enlarged(self._ran, len(self._rows))
        self._ran[sides] = ways
        return [(a, b) for a, b in ways.tolist()]

    def _inherit(self, edit: Edit) -> None:
        before = sides_of(np.concatenate([edit.changed_faces, edit.removed_faces]))
        before = before[before < len(self._ran)]  # or an edit was interrupted
        ran = zip(self._ran[before].tolist(), before.tolist(), strict=True)
        was = {(a, b): h for (a, b), h in ran}
        if self.element == "edge":
            was |= {(b, a): h for (a, b), h in was.items()}
        sides = sides_of(np.concatenate([edit.changed_faces, edit.created_faces]))
        now = self._look_at(sides)
        heir = self._heirs(edit, was, now, sides)
        sources = [was.get(way, heir(k)) for k, way in enumerate(now)]
        source = np.array(sources, np.int64)
        if self.element == "edge":  # the face beyond a new one may know it
            beyond = self.mesh.twin(sides)
            apart = (source < 0) & (beyond >= 0) & ~np.isin(beyond, sides)
            source[apart] = beyond[apart]
        values = self._rows[source]
        values[source < 0] = self.default
        self._rows[sides] = values

    def _heirs(
        self, edit: Edit, was: dict[Way, int], now: list[Way], sides: Array
    ) -> Callable[[int], int]:
        """Make ``heir(k)``: the row of what the k-th of the sides there are now was, or -1.

        The parts of an edge that was split run as it did; the first is the edge that there was, and
        what the second has is up to the rule. A flipped one leaves the face at the vertex where it
        started. Those at a vertex that was merged stay in their faces.
        """
        rows = zip(edit.created_vertices.tolist(), edit.vertex_parents.to_list(), strict=True)
        split = {v: ends for v, ends in rows if len(ends) == 2}
        parts = 1 if self.on_split == "default" else 2
        merged, kept = len(edit.removed_vertices) > 0, {*now, *((b, a) for a, b in now)}
        flipped = {} if len(edit.created_vertices) else was.keys() - kept
        left = {a: was[a, b] for a, b in flipped}

        def heir(k: int) -> int:
            (x, y), apex = now[k], now[k - k % 3 + (k + 1) % 3][1]
            if (y, x) in was:  # the edge was there, and only its side is new
                return -1
            if y in split.get(x, ())[:parts]:
                return was.get((sum(split[x]) - y, y), -1)
            if x in split.get(y, ())[:parts]:
                return was.get((x, sum(split[y]) - x), -1)
            return int(sides[k]) if merged else left.get(apex, -1)

        return heir


def sides_of(faces: Array) -> Array:
    """(3 n,) the sides of faces (n,)."""
    return (3 * faces.astype(np.int64)[:, None] + np.arange(3)).reshape(-1)
