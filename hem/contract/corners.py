"""Values of the corners of faces: a vertex may have another one in each face."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.authoring import SIDES
from hem.contract.attributes import Attribute, enlarged, renumbered, widened
from hem.edit import Edit, Remapping, whole_faces
from hem.ragged import Ragged
from hem.room import roomy

ALIKE = 1e-5  # corners whose values differ by less, or by this part of them, are at no seam


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
        """Give the corners of one face or of many their values. Who follows is told."""
        faces, corners = self._corners(self._checked(handles))
        shape, given = (len(corners.values), *self.default.shape), np.asarray(values)
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
        self._rows[face, place] = values

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
