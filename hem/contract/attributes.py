"""Values that belong to the elements of a mesh, and follow every edit of it.

An attribute has a row for every handle there ever was, as ``points`` has. What an edit leaves alone
keeps its rows. What it creates gets them by the attribute's rule, from what it was made of
(``Edit.vertex_parents``, ``Edit.face_parents``).
"""

from collections.abc import Callable
from typing import Any, Literal
from weakref import ref

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from hem.arrays import Array
from hem.authoring import ENDS, SIDES
from hem.contract import arguments
from hem.contract.queries import Queries
from hem.contract.state import State
from hem.contract.surveying import Surveying
from hem.edit import Edit, Remapping, generations, whole_faces
from hem.errors import MeshError
from hem.listeners import Listeners
from hem.ragged import Ragged
from hem.room import longer, roomy

Rule = Literal["interpolate", "copy", "default"]
"""What a new element gets: a value between its parents' by where it lies, that of its first parent,
or the default, which it also gets where it has no parents."""

RULES = ("interpolate", "copy", "default")

ROUNDING = 1e-6  # faces that are flatter than this part of their length have no direction across
ALIKE = 1e-5  # corners whose values differ by less, or by this part of them, are at no seam


class Attribute:
    """A number, or an array of them, for each element of one kind.

    ``a[handle]`` and ``a[handles]`` read, ``a[handles] = values`` writes; both check the handles.
    ``a.values`` are all rows at once. ``Structure.vertex_attribute`` and its like make one.

    The mesh holds it, and not the other way round, so that a mesh that is dropped is freed at once.
    What is asked of an attribute that outlives its mesh goes by the parts of that.
    """

    def __init__(
        self, mesh: Surveying, state: State, queries: Queries, element: str, name: str,
        default: Array, on_split: Rule | None = None,
    ) -> None:  # fmt: skip
        self._mesh, self._state, self._queries = ref(mesh), state, queries
        self.element, self.name, self.default = element, name, default
        between = element in ("vertex", "corner") and default.dtype.kind == "f"
        self.on_split = on_split or ("interpolate" if between else "copy")
        if self.on_split not in RULES:
            raise MeshError(f"on_split is one of {', '.join(RULES)}, not {on_split!r}")
        if self.on_split == "interpolate" and default.dtype.kind != "f":
            raise MeshError(f"{default.dtype} values cannot be interpolated; on_split='copy' can")
        self._listeners = Listeners()
        self.clear()

    def __repr__(self) -> str:
        return f"<{self.element} attribute {self.name!r}, {self.default.dtype} {self.values.shape}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """A deep copy, or a pickle, brings a copy of the mesh, of which it is the attribute.

        Copy both at once, as in ``copy.deepcopy((mesh, attribute))``, and hold both; subscribers
        are not of the copy. ``copy.copy`` brings the mesh itself, and so the attribute itself.
        MeshError for one that was removed, or has outlived its mesh: its ``values`` can be copied.
        """
        if all(it is not self for it in self.mesh.attributes()):
            raise MeshError(f"{self!r} was removed from its mesh; copy its values instead")
        return _found, (self.mesh, self.element, self.name)

    @property
    def mesh(self) -> Any:
        """The mesh whose elements have the values. MeshError once it is gone, held by nobody."""
        mesh = self._mesh()
        if mesh is None:
            raise MeshError(f"{self!r} has outlived its mesh; hold that as well to go on with it")
        return mesh

    @property
    def values(self) -> Array:
        """(end, …): a row per handle, those of dead elements included.

        A view: writing here tells nobody, and an edit may put others in its place.
        """
        self._grow()
        return self._rows[: self._end]

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> Array:
        return np.array(self.values, dtype)

    def __getitem__(self, handles: Any) -> Any:
        """The value of one element or (n, …) of many: a copy. MeshError for what is not live."""
        rows = self._checked(handles)
        return self._rows[rows].copy()

    def __setitem__(self, handles: Any, values: ArrayLike) -> None:
        """Give one element or many (n,) their values. Who follows the attribute is told."""
        rows = self._checked(handles)
        self._rows[rows] = values
        self._listeners.tell(np.atleast_1d(rows))

    def subscribe(self, callback: Callable[[Array], Any]) -> Callable[[], None]:
        """Have ``callback`` called with the handles (n,) that are written to -> a way to end it."""
        return self._listeners.subscribe(callback)

    def follow(self, edit: Edit) -> None:
        """Carry the values over an edit that was just done. Cost O(edit)."""
        if edit.remapping is not None:
            self._renumber(edit.remapping)
            self._look_at_all()
        else:
            self._grow()
            self._inherit(edit)

    def state(self) -> tuple[Array, ...]:
        """What ``restore`` needs, in arrays of its own."""
        return (self.values.copy(),)

    def restore(self, state: tuple[Array, ...]) -> None:
        """Have the values of a ``state`` again."""
        self._rows = roomy(state[0])
        self._look_at_all()

    def clear(self) -> None:
        """Have the default everywhere, as if just made."""
        self._rows = self._fresh(0)
        self._grow()
        self._look_at_all()

    # Behind it ---------------------------------------------------------------------------------

    @property
    def _end(self) -> int:
        return int(self._state.records.counts[ENDS.get(self.element, ENDS["face"])])

    def _fresh(self, *rows: int) -> Array:
        return np.tile(self.default, rows + (1,) * self.default.ndim)

    def _checked(self, handles: Any) -> Any:
        """One handle or an array of them, if they name live elements."""
        rows = arguments.integers(repr(self), handles).astype(np.int64)
        self._grow()
        element = "face" if self.element == "corner" else self.element
        self._state.require(element, np.atleast_1d(rows))
        return rows

    def _grow(self) -> None:
        """Have a row for every handle. An edit that was interrupted may not have seen to it."""
        self._rows = enlarged(self._rows, self._end, self.default)

    def _look_at_all(self) -> None:
        """Keep anew whatever a kind of attribute keeps of the mesh beside the values."""

    def _renumber(self, remapping: Remapping) -> None:
        number = self._numbers(remapping)
        rows, self._rows = self._rows, self._fresh(self._end)
        self._rows[number[number >= 0]] = rows[: len(number)][number >= 0]

    def _numbers(self, remapping: Remapping) -> Array:
        """The new row of every old one after ``compact``, -1 for what is dead."""
        return remapping.vertices if self.element == "vertex" else remapping.faces

    def _inherit(self, edit: Edit) -> None:
        """Give what was created its rows."""
        if self.on_split == "default":
            return
        if self.element == "face":
            made = edit.created_faces
            self._rows[made] = self._rows[whole_faces(edit, made)]
            return
        for vertices, parents in generations(edit):
            values = self._rows[parents.values]
            self._rows[vertices] = self._put_between(values, vertices, parents)

    def _put_between(self, values: Array, vertices: Array, parents: Ragged) -> Array:
        """By the rule: (n, …) for ``vertices`` (n,), from the ``values`` of all their parents."""
        first = parents.offsets[:-1]
        if self.on_split == "copy":
            return values[first]
        at = self.mesh.positions
        share = shares(at(vertices), at(parents.values), parents)
        share = share.reshape(-1, *(1,) * self.default.ndim)
        return np.add.reduceat(values * share, first).astype(values.dtype)


def _found(mesh: Any, element: str, name: str) -> Attribute:
    found: Attribute = getattr(mesh, f"{element}_attribute")(name)
    return found


class EdgeAttribute(Attribute):
    """Of edges or half-edges. The new part of an edge that is split has what the old part has."""

    def _checked(self, handles: Any) -> Any:
        rows = super()._checked(handles)
        if self.element == "edge":
            return self._state.edge_names(np.atleast_1d(rows)).reshape(rows.shape)
        return rows

    def _numbers(self, remapping: Remapping) -> Array:
        return remapping.edges(np.arange(len(self._rows)))

    def _inherit(self, edit: Edit) -> None:
        if self.on_split == "default":
            return
        for v, ends in zip(edit.created_vertices.tolist(), edit.vertex_parents, strict=True):
            if len(ends) == 2:
                old, new = (self.mesh.find_edge(v, int(end)) for end in ends)
                for one, other in self._sides(v, old, new):
                    self._rows[other] = self._rows[one]

    def _sides(self, middle: int, old: int | None, new: int | None) -> list[tuple[int, int]]:
        """Which row goes into which where an edge was split: half-edges keep their direction."""
        if old is None or new is None:  # split again by the same batch
            return []
        if self.element == "edge":
            return [(old, new)]
        mesh = self.mesh
        apart = (mesh.origin(old) == middle) == (mesh.origin(new) == middle)
        one, other = [old, mesh.twin(old)], [new, mesh.twin(new)]
        pairs = zip(one, other[::-1] if apart else other, strict=True)
        return [(h, g) for h, g in pairs if h >= 0 and g >= 0]


class HalfEdgeAttribute(EdgeAttribute):
    """Of half-edges. Values go where their half-edges go, of which it is kept how they ran.

    An edge keeps its handle when one of its faces is taken away, and so the half-edge that is left
    may move into the place of the one that is gone.
    """

    def _inherit(self, edit: Edit) -> None:
        mesh, faces = self.mesh, np.concatenate([edit.changed_faces, edit.created_faces])
        if len(edit.removed_faces):
            known = edit.removed_faces < len(self._within)  # or an edit was interrupted
            h = self._within[edit.removed_faces[known]].reshape(-1)
            h = h[h >= 0]
            h = h[self._state.alive("half_edge", h)]
            moved = h[mesh.origin(h) != self._ran[h, 0]]
            self._rows[moved] = self._rows[self._ran[moved, 1]]
            faces = np.concatenate([faces, mesh.face(moved)])
        super()._inherit(edit)
        self._look_at(np.unique(faces[faces >= 0]))

    def _look_at_all(self) -> None:
        self._ran = np.full((0, 2), -1)  # of each half-edge the origin and the twin
        self._within = np.full((0, 3), -1)  # of each face the half-edges
        self._look_at(self.mesh.faces())

    def _look_at(self, faces: Array) -> None:
        """Keep how the half-edges of these faces run. Cost O(corners)."""
        mesh, wide = self.mesh, max(3, self.mesh.most_corners)
        self._ran = enlarged(self._ran, len(self._rows))
        self._within = enlarged(widened(self._within, wide), self.mesh.face_end)
        self._within[faces] = -1
        first = h = mesh.face_half_edge(faces)
        for corner in range(wide):
            twin = mesh.twin(h)
            self._within[faces, corner] = h
            self._ran[h, 0], self._ran[h, 1] = mesh.origin(h), twin
            self._ran[twin[twin >= 0], 1] = h[twin >= 0]
            h = mesh.next(h)
            faces, first, h = (it[h != first] for it in (faces, first, h))
            if not len(faces):
                return


def enlarged(rows: Array, length: int, value: ArrayLike = -1) -> Array:
    """At least so many rows, with a value in those that are new. O(new ones), see ``hem.room``."""
    used = len(rows)
    if length <= used:
        return rows
    rows = longer(rows, used, length)[:length]
    rows[used:] = value
    return rows


def widened(rows: Array, width: int) -> Array:
    """Rows of at least so many columns, -1 in those that are new."""
    more = max(width - rows.shape[1], 0)
    return np.pad(rows, [(0, 0), (0, more)], constant_values=-1) if more else rows


class CornerAttribute(Attribute):
    """Of the corners of faces: a vertex may have another value in each face, as at a seam.

    Handles are those of faces. A face has a row per corner, in the order of ``face_vertices``;
    those of many faces (k,) come one face after the other, and may be written as (k, 3, …). A new
    vertex lies between the corners of the very face that it was put into. A corner that comes into
    a face by a flip or a collapse has the value it has beside it, on the same side of a seam.
    """

    def __init__(self, *made: Any) -> None:
        self._keys = np.full((0, 3), -1, np.int32)  # of which vertex a row is the corner
        super().__init__(*made)

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
        self._keys = self._keys[:0]
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
        number, old = self._numbers(remapping), np.append(remapping.vertices, -1)[self._keys]
        super()._renumber(remapping)
        self._keys = np.full(self._rows.shape[:2], -1, np.int32)
        self._keys[number[number >= 0]] = old[: len(number)][number >= 0]

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


def shares(points: Array, of_parents: Array, parents: Ragged) -> Array:
    """For every parent of a vertex at ``points`` (n, 3) its share; those of a vertex add up to 1.

    What is linear over the parents is so at the vertex, too, even beyond them. Where the vertex
    lies off their plane, its foot on it counts; where they all coincide, each counts alike.
    """
    found = np.empty(len(parents.values))
    for n in np.unique(parents.counts):
        rows = np.flatnonzero(parents.counts == n)
        places = parents.offsets[rows][:, None] + np.arange(n)
        corners = of_parents[places].astype(np.float64)
        middle = corners.mean(axis=1)
        apart = np.nan_to_num(corners - middle[:, None])  # a parent may be gone by now
        beside = np.nan_to_num(points[rows] - middle)[:, None]
        found[places] = 1 / n + (beside @ np.linalg.pinv(apart, ROUNDING))[:, 0]
    return found
