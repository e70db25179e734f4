"""Values of the sides of faces, where an operation moves these, and of the corners of faces."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.authoring import BITS, SIDES
from hem.contract.attributes import (
    Attribute,
    EdgeAttribute,
    Way,
    enlarged,
    renumbered,
    widened,
)
from hem.edit import Edit, Remapping, whole_faces
from hem.ragged import Ragged
from hem.room import roomy

ALIKE = 1e-5  # corners whose values differ by less, or by this part of them, are at no seam


class SideAttribute(EdgeAttribute):
    """Of edges or half-edges that are the sides of faces: side i of face f has row 3 f + i.

    It is kept how every side ran when it was last looked at. After an edit the sides of the faces
    that it touched find their values by how they run now. An edge has its value on both sides.
    """

    def __setitem__(self, handles: Any, values: ArrayLike) -> None:
        """See ``Attribute``."""
        rows = self._checked(handles)
        self._put(rows, values)
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


class CornerAttribute(Attribute):
    """Of the corners of faces: a vertex may have another value in each face, as at a seam.

    Handles are those of faces. A face has a row per corner, in the order of ``face_vertices``;
    those of many faces (k,) come one face after the other, and may be written as (k, 3, …). A new
    vertex lies between the corners of the very face that it was put into. A corner that comes into
    a face by a flip or a collapse has the value it has beside it, on the same side of a seam.

    Every face has room for the values of as many corners as the largest one has, and for 4 bytes
    beside each: a polygon of 3,000 corners takes a thousand times the memory that triangles take.
    Once it is gone, ``compact`` gives that back.
    """

    def __getitem__(self, handles: Any) -> Any:
        """(corners, …) of one face, or of many, one after the other."""
        faces, corners = self._corners(self._checked(handles))
        return self._known(np.repeat(faces, corners.counts), corners.values)[0]

    def __setitem__(self, handles: Any, values: ArrayLike) -> None:
        """Give the corners of one face or of many their values. See ``Attribute``."""
        faces, corners = self._corners(self._checked(handles))
        shape, given = (len(corners.values), *self.default.shape), self._as_array(values)
        whole = given.size == np.prod(shape) and given.shape != self.default.shape
        self._write(faces, corners, given.reshape(shape) if whole else given)
        self._listeners.tell(faces)

    def clear(self) -> None:
        """See ``Attribute.clear``."""
        self._keys = np.full((0, 3), -1, np.int32)  # of which vertex a row is the corner
        super().clear()
        faces, corners = self._corners(self._state.live("face"))
        self._write(faces, corners, self.default)

    def state(self) -> tuple[Array, ...]:
        """See ``Attribute.state``."""
        return self.values.copy(), self._keys[: self._end].copy()

    def restore(self, state: tuple[Array, ...]) -> None:
        """See ``Attribute.restore``."""
        self._rows, self._keys = map(roomy, state)

    # Behind it ---------------------------------------------------------------------------------

    def _fresh(self, *rows: int) -> Array:
        return super()._fresh(*rows, self._keys.shape[1])

    def _grow(self) -> None:
        wide = int(self._state.records.counts[SIDES])
        if wide > self._keys.shape[1]:
            self._keys = widened(self._keys, wide)
            rows, self._rows = self._rows, self._fresh(len(self._rows))
            self._rows[:, : rows.shape[1]] = rows
        super()._grow()
        self._keys = enlarged(self._keys, len(self._rows))

    def _renumber(self, remapping: Remapping) -> None:
        self._grow()
        number, wide = self._numbers(remapping), int(self._state.records.counts[SIDES])
        rows, keys = self._rows[:, :wide], np.append(remapping.vertices, -1)[self._keys[:, :wide]]
        self._keys = renumbered(keys, number, np.full((self._end, wide), -1, np.int32))
        self._rows = renumbered(rows, number, self._fresh(self._end))

    def _inherit(self, edit: Edit) -> None:
        """All corners of what was touched are written anew, as a face may begin elsewhere."""
        touched = np.concatenate([edit.changed_faces, edit.created_faces])
        faces, corners = self._corners(touched)
        owners = np.repeat(whole_faces(edit, faces), corners.counts)
        self._write(faces, corners, self._carried(edit, owners, corners.values))

    def _corners(self, faces: Array) -> tuple[Array, Ragged]:
        faces = np.atleast_1d(faces).astype(np.int64)
        return faces, self._queries.ask("face_vertices", faces)

    def _write(self, faces: Array, corners: Ragged, values: ArrayLike) -> None:
        """Have just these corners in these faces."""
        face = np.repeat(faces, corners.counts)
        place = np.arange(len(face)) - np.repeat(corners.offsets[:-1], corners.counts)
        self._keys[faces] = -1
        self._keys[face, place] = corners.values
        self._put((face, place), values)

    def _known(self, faces: Array, vertices: Array) -> tuple[Array, Array]:
        """(n, …) the values of vertices in faces, and (n,) which of them are corners there."""
        same = self._keys[faces] == vertices[:, None]
        values, known = super()._fresh(len(faces)), same.any(axis=1)
        values[known] = self._rows[faces[known], same[known].argmax(axis=1)]
        return values, known

    def _carried(self, edit: Edit, faces: Array, vertices: Array) -> Array:
        """(n, …): what corners had before the edit, or get by the rule."""
        values, known = self._known(faces, vertices)
        created = np.isin(vertices, edit.created_vertices)
        if self.on_split != "default" and (created & ~known).any():
            at = np.searchsorted(edit.created_vertices, vertices[created & ~known])
            parents = edit.vertex_parents[at]
            new = np.flatnonzero(created & ~known)[parents.counts > 0]
            parents = parents[parents.counts > 0]
            if len(new):
                own = np.repeat(faces[new], parents.counts)
                between = self._carried(edit, own, parents.values)
                values[new] = self._put_between(between, vertices[new], parents)
        for i in np.flatnonzero(~known & ~created):
            values[i] = self._from_beside(edit, int(faces[i]), int(vertices[i]))
        return values

    def _from_beside(self, edit: Edit, face: int, vertex: int) -> Array:
        """What a corner had in another face of the edit, on this face's side of a seam."""
        before = np.concatenate([edit.removed_faces, edit.changed_faces])
        there = before[(self._keys[before] == vertex).any(axis=1)]
        gone = np.intersect1d(self._keys[face], edit.removed_vertices)[:1]
        if not len(gone):
            return self._known(there[:1], np.array([vertex]))[0][0] if len(there) else self.default
        own = self._known(np.array([face]), gone)[0][0]
        for other in there:
            (at_gone, value), known = self._known(np.repeat(other, 2), np.append(gone, vertex))
            if known.all() and on_one_side(at_gone, own):
                return value
        return own


def on_one_side(one: Array, other: Array) -> bool:
    """Whether two corners of a vertex have one value; what was interpolated differs by rounding."""
    if one.dtype.kind != "f":
        return np.array_equal(one, other)
    return np.allclose(one, other, rtol=ALIKE, atol=ALIKE, equal_nan=True)
