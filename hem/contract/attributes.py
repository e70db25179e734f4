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
from hem.authoring import ENDS
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

Way = tuple[int, int]  # where a half-edge starts, and where it ends

RULES = ("interpolate", "copy", "default")

ROUNDING = 1e-6  # faces that are flatter than this part of their length have no direction across


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
        """Give one element or many (n,) their values. Who follows the attribute is told.

        MeshError for what is not live, and for values of another shape or which do not fit.
        """
        rows = self._checked(handles)
        self._put(rows, values)
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

    def _put(self, rows: Any, values: ArrayLike) -> None:
        """Write values into their rows; MeshError for what are none."""
        try:
            self._rows[rows] = fitting(values, self.default.dtype, "the value")
        except (TypeError, ValueError, OverflowError) as error:
            raise MeshError(f"{self!r}: {error}") from error

    def _as_array(self, values: ArrayLike) -> Array:
        try:
            return np.asarray(values)
        except ValueError as error:  # rows of different lengths
            raise MeshError(f"{self!r}: {error}") from error

    def _grow(self) -> None:
        """Have a row for every handle. An edit that was interrupted may not have seen to it."""
        self._rows = enlarged(self._rows, self._end, self.default)

    def _look_at_all(self) -> None:
        """Keep anew whatever a kind of attribute keeps of the mesh beside the values."""

    def _renumber(self, remapping: Remapping) -> None:
        self._rows = renumbered(self._rows, self._numbers(remapping), self._fresh(self._end))

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
        for parts, kept in parts_of_edges(edit):
            rows = self._along(kept)
            for part in parts:
                for one, other in zip(rows, self._along(part), strict=False):
                    if one >= 0 and other >= 0:
                        self._rows[other] = self._rows[one]

    def _along(self, way: Way) -> list[int]:
        """The rows of what joins two vertices, of half-edges first that which runs so."""
        mesh = self.mesh
        try:
            e = mesh.find_edge(*way)
        except MeshError:  # an end went in the same edit
            return []
        if e is None or self.element == "edge":
            return [e] if e is not None else []
        pair = [e, mesh.twin(e)]
        return pair if mesh.origin(e) == way[0] else pair[::-1]


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


def parts_of_edges(edit: Edit) -> list[tuple[list[Way], Way]]:
    """For each edge that was split its parts, all along it, and that which keeps its handle."""
    wholes: dict[Way, tuple[list[Way], Way]] = {}  # by part
    rows = zip(edit.created_vertices.tolist(), edit.vertex_parents.to_list(), strict=True)
    for v, ends in rows:
        if len(ends) != 2:
            continue
        first, second = ends
        way = (first, second) if (first, second) in wholes else (second, first)
        parts, kept = wholes.pop(way, ([way], way))
        i = parts.index(way)
        parts[i : i + 1] = new = (way[0], v), (v, way[1])
        if kept == way:
            kept = new[way[0] != first]
        wholes |= dict.fromkeys(parts, (parts, kept))
    return list({id(parts): (parts, kept) for parts, kept in wholes.values()}.values())


def fitting(values: ArrayLike, dtype: DTypeLike, called: str) -> Array:
    """Values as such a type. ValueError if it makes them more than rounded."""
    given = np.asarray(values)
    if given.dtype == dtype:
        return given
    with np.errstate(over="ignore", invalid="ignore"):
        value = np.array(values, dtype)
    rounded = given.dtype.kind in {"f": "biuf", "c": "biufc"}.get(value.dtype.kind, "")
    fits = np.isfinite(value) == np.isfinite(given) if rounded else value == given
    if not np.all(fits):
        words = f"{value.dtype} cannot hold {called} {values!r:.200}"
        raise ValueError(f"{words}; say another, or another dtype")
    return value


def enlarged(rows: Array, length: int, value: ArrayLike = -1) -> Array:
    """At least so many rows, with a value in those that are new. O(new ones), see ``hem.room``."""
    used = len(rows)
    if length <= used:
        return rows
    rows = longer(rows, used, length)[:length]
    rows[used:] = value
    return rows


def renumbered(rows: Array, number: Array, anew: Array) -> Array:
    """``anew`` with the rows at their new places, -1 for none. Late ones may be missing."""
    number = number[: len(rows)]
    anew[number[number >= 0]] = rows[: len(number)][number >= 0]
    return anew


def widened(rows: Array, width: int) -> Array:
    """Rows of at least so many columns, -1 in those that are new."""
    more = max(width - rows.shape[1], 0)
    return np.pad(rows, [(0, 0), (0, more)], constant_values=-1) if more else rows


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
