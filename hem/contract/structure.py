"""The contract: what every mesh data structure offers, derived from its kernels."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from functools import cache, cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from hem import authoring
from hem.arrays import Array, Bools, Handles, Indices, Points
from hem.authoring import OPERATIONS, QUERIES, Field, Kernel, Operation
from hem.contract import arguments
from hem.contract.attributes import Attribute, EdgeAttribute
from hem.contract.description import Algorithm, Declared, Described
from hem.contract.following import AttributeMethod, Followers, Kept
from hem.contract.operations import Methods, Operations, Prepared
from hem.contract.queries import Queries, QueryMethod, Sweep
from hem.contract.removal import planned, removing
from hem.contract.sides import CornerAttribute
from hem.contract.state import State
from hem.contract.storage import Storage, UncompiledStorage
from hem.contract.surveying import Surveying, centroids
from hem.edit import Edit, Remapping
from hem.engine import Read
from hem.errors import MeshError
from hem.meshes import TriangleMesh

NO_VERTEX = -2
"""Stands for a vertex to keep that is said to be -1, which means that none is said."""


def _said(vertex: Any) -> Any:
    """A vertex that is said, whatever it is; arrays, which are none, are refused later."""
    return NO_VERTEX if not getattr(vertex, "ndim", 0) and vertex == -1 else vertex


@cache
def _uncompiled(kind: Any) -> Any:
    if not kind.compiled:
        return kind
    storage = type("Uncompiled", (UncompiledStorage, kind.storage), {})
    own = {"storage": storage, "compiled": False, "_like": kind, "__module__": kind.__module__}
    return type(kind.__name__, (kind,), own)


def _uncompiled_of(kind: Any, saved: "Snapshot") -> Any:
    return kind.uncompiled()._of(saved)


class Snapshot(NamedTuple):
    """A mesh as it was."""

    records: Any
    attributes: Kept


def _documented(text: str, make: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def bound(self: Any) -> Any:
        method = make(self)
        method.__doc__ = text
        return method

    return bound


def made_once(text: str, make: Callable[[Any], Any]) -> Any:
    """A method that is made when a mesh is first asked for it, and kept: quick to call."""
    attribute = cached_property(_documented(text, make))
    attribute.__doc__ = text
    return attribute


def _query_method(name: str) -> Any:
    source, title = QUERIES[name].source, QUERIES[name].title
    text = (
        f"{title}, of one {source} or of many.\n\n"
        "One handle gives a 1-D array, an array of handles (n,) a ``Ragged`` with n rows, and no\n"
        "argument one of all live elements. Each neighbor comes once; around a vertex or face\n"
        "counterclockwise where the structure knows the order. Cost per handle: thesis, table 1.\n"
        f"Raises MeshError for a handle that names no {source} of this mesh."
    )
    if name == "edge_vertices":
        text += (
            "\nWhere none is recorded, the handle is its ends: they are told of any two vertices."
        )
    return made_once(text, lambda self: self._queries.method(name))


def attribute_method(element: str, kind: type[Attribute], words: str) -> Any:
    """The method ``Structure.vertex_attribute`` and its like."""
    text = (
        f"A value for every {element.replace('_', '-')}, found by its name, or made: the default\n"
        "everywhere.\n\n"
        "``dtype``: float32 unless it is said. ``shape``: of one value, () for a number.\n"
        f"``default``: 0 unless it is said. ``on_split``: see ``Rule``.\n{words}\n"
        "Copies of the mesh and pickles have it, too; ``compact`` renumbers it. Cost O(n) once,\n"
        "then O(edit). MeshError where there is one of the name that is not as it is said, and\n"
        "for a default that the type cannot hold."
    )
    make = _documented(text, lambda self: AttributeMethod(self, self._followers, element, kind))
    return property(make, doc=text)  # kept, it would hold the mesh that holds it


class Structure(Described, Surveying, abstract=True):
    """A triangle mesh held in one data structure, interchangeable behind one contract.

    A subclass declares how it is called and looks (``Described``), its records (a ``NamedTuple`` of
    arrays) and their fields, how it is built and what must hold; its kernels are those of the
    module that it stands in. What it forgets is a TypeError that names the class and the part.

    Any number of threads may ask a mesh at once, as long as none operates on it.
    """

    records_type: ClassVar[type[Any]]
    """The `NamedTuple` of the structure's arrays, with from→to names."""

    fields: ClassVar[tuple[Field, ...]]
    kernels: ClassVar[Mapping[str, Kernel]]
    """By name; those of the module that the class stands in, unless it says others."""

    operations: ClassVar[Mapping[str, Operation]] = OPERATIONS
    """What can be done to this structure, by name."""

    steps: ClassVar[Mapping[str, Any]] = {}
    """How its half-edges can be walked, by name."""

    storage: ClassVar[type[Storage]] = Storage
    """How its records are held."""

    declared: ClassVar[Declared]
    """What follows from all these."""

    holds_polygons: ClassVar[bool] = False
    """Whether faces may have more than three corners, and ``build`` takes a ``PolygonMesh``."""

    compiled: ClassVar[bool] = True
    """Whether kernels are compiled; what is not is slow, and measured on smaller meshes."""

    _like: ClassVar[Any] = None  # of what is not compiled: the class that is

    searches: ClassVar[bool] = False
    """Whether nothing is recorded of neighbors, so that they are searched for in the whole mesh."""

    searches_to_move: ClassVar[bool] = False
    """Whether moving a vertex searches the whole mesh, for the triangles that have its position."""

    rebuilds: ClassVar[bool] = False
    """Whether an edit has neighbors found anew in the whole mesh, which answer until the next."""

    emulated: ClassVar[frozenset[str]] = frozenset()
    """Queries answered without edge records: table 1's N/A."""

    stable_edge_handles: ClassVar[bool] = True
    """Whether an edge keeps its handle as long as it joins the same two vertices.

    Where it does not, an operation may give other edges of the faces that it changes new handles.
    The old ones are refused then; ``find_edge`` finds the new ones. Handles of half-edges have no
    mark that could be refused.
    """

    def __init_subclass__(cls, abstract: bool = False) -> None:
        super().__init_subclass__(abstract)
        if abstract:
            return
        if "records_type" in cls.__dict__:
            own = cls.__dict__.get("kernels") or authoring.kernels_of(cls.__module__)
            cls.kernels = {**authoring.OF_ARRAYS, **own}
        cls.declared = Declared(cls)

    def __init__(self, records: Any) -> None:
        self._state = State(self.declared, records)
        self._queries = Queries(self._state)
        self._followers = Followers(self._state, self._queries)
        self._operations = Operations(self._state, self._queries, self._followers)

    @classmethod
    @abstractmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """The structure of ``mesh``, with stored references of 4 or 8 bytes.

        Positions are float32, which ``structures.build`` sees to. Cost O(n_v + n_t). Raises
        NonManifoldError, with the elements, for what the structure cannot represent.
        """

    @classmethod
    def uncompiled(cls) -> type[Self]:
        """The structure with kernels that Python itself runs: at once, and a hundred times slower.

        A debugger stops in them, and a mesh that is asked but a few times need not wait for the
        compiler. Records, answers and refusals are the same.
        """
        kind: type[Self] = _uncompiled(cls)
        return kind

    def validate(self) -> None:
        """Check every invariant on the raw arrays; no query is used. Cost O(n_v + n_t).

        Raises MeshError that names the broken invariant and the elements that break it.
        """
        authoring.require_records(self.records, self.fields)
        self._require_invariants()

    @abstractmethod
    def _require_invariants(self) -> None:
        """Check what must hold beside what follows from the fields (``require_records``)."""

    def __repr__(self) -> str:
        return (
            f"<{self.title}: {self.n_vertices:,} vertices, {self.n_edges:,} edges, "
            f"{self.n_faces:,} faces>"
        )

    # What there is ---------------------------------------------------------------------------

    @property
    def records(self) -> Any:
        """See ``Surveying.records``."""
        return self._state.records

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays of the records, room for more included, without the count of them."""
        return self._state.storage.arrays(self.records)

    @property
    def n_edges(self) -> int:
        """Number of live undirected edges."""
        return self._queries.count_edges()

    def vertices(self) -> Handles:
        """(n_vertices,) int32: the handles of all live vertices, ascending."""
        return self._state.live("vertex")

    def faces(self) -> Handles:
        """See ``Surveying.faces``."""
        return self._state.live("face")

    def edges(self) -> Indices:
        """(n_edges,) int64: the handles of all live edges, ascending, each undirected edge once."""
        return self._queries.edges()

    def handles(self, element: str) -> Array:
        """The handles of all elements of one kind: ``vertex``, ``edge`` or ``face``."""
        return self._queries.handles(element)

    def to_triangles(self) -> TriangleMesh:
        """The same mesh as points and counterclockwise triangles. Cost O(n_v + n_t)."""
        corners, alive = self.face_vertices(self.faces()).values, self.vertices()
        if len(alive) < len(self.points):
            number = np.zeros(len(self.points), np.int32)
            number[alive] = np.arange(len(alive), dtype=np.int32)
            corners = number[corners]
        return TriangleMesh(self.points[alive], corners.reshape(-1, 3))

    # Queries ---------------------------------------------------------------------------------

    vertex_vertices: QueryMethod = _query_method("vertex_vertices")
    vertex_edges: QueryMethod = _query_method("vertex_edges")
    vertex_faces: QueryMethod = _query_method("vertex_faces")
    edge_vertices: QueryMethod = _query_method("edge_vertices")
    edge_edges: QueryMethod = _query_method("edge_edges")
    edge_faces: QueryMethod = _query_method("edge_faces")
    face_vertices: QueryMethod = _query_method("face_vertices")
    face_edges: QueryMethod = _query_method("face_edges")
    face_faces: QueryMethod = _query_method("face_faces")

    def find_edge(self, a: int, b: int) -> int | None:
        """The handle of the edge between vertices ``a`` and ``b``, or None where there is none.

        Cost: that of ``vertex_edges``. Raises MeshError if ``a`` or ``b`` is no vertex.
        """
        return self._queries.find_edge(a, b)

    # Operations ------------------------------------------------------------------------------
    #
    # Each checks first. If it may not be done, it raises TopologyError with the reason and the
    # elements, and nothing has changed; so it does for a handle that names nothing (any more).
    # MeshError is raised for arguments that are no handles or positions at all. Handles of
    # untouched elements stay valid; new vertices and faces take the next index.

    def operate(self, operation: str, *handles: int, point: ArrayLike | None = None) -> Edit:
        """Do an operation by its name, as the method of that name does where there is one.

        ``handles``: three at most. Raises KeyError for no operation.
        """
        first, *more = handles or (-1,)
        if len(more) > 2:
            raise MeshError(f"{operation} takes three handles at most, not {len(handles)}")
        ends = [_said(it) for it in more] if operation == "collapse_edge" else more
        return self._do[operation](first, point, *ends, *[-1] * (2 - len(ends)))

    def split_edge(self, edge: int, point: ArrayLike) -> Edit:
        """Put a new vertex on an edge; each face there becomes two. The point may lie anywhere.

        Interior: 1 vertex, 3 edges and 2 faces more; border: 1, 2 and 1. Refused between two faces
        of the same corners. Cost O(1) where edges are recorded, else that of finding the faces:
        O(n_ev) or O(n_t). Thesis 4.1.
        """
        return self._do["split_edge"](edge, point)

    def split_face(self, face: int, point: ArrayLike) -> Edit:
        """Put a new vertex into a face, which becomes three.

        1 vertex, 3 edges and 2 faces more. Cost O(1). Thesis 4.3.
        """
        return self._do["split_face"](face, point)

    def collapse_edge(self, edge: int, keep: int | None = None) -> Edit:
        """Merge one end of an edge into the other, ``keep``, which stays where it is.

        ``keep`` is ``edge_vertices(edge)[1]`` unless it is said. Interior: 1 vertex, 3 edges and 2
        faces fewer; border: 1, 2 and 1. Cost O(n_ev), or O(n_t) where neighbors are searched for.
        Thesis 4.2; refused as ``hem.authoring.operations.collapse_edge`` says. That looks only at
        triangles at the edge: where there are polygons, two faces may have the same corners then.
        """
        return self._do["collapse_edge"](edge, None, -1 if keep is None else _said(keep))

    def flip_edge(self, edge: int) -> Edit:
        """Turn an edge inside the two faces at it, so that it joins their other two corners.

        No count changes; a second flip undoes the first. Cost O(1) where edges are recorded, and
        to see that no edge is there yet O(the smaller valence of the two corners).
        """
        return self._do["flip_edge"](edge)

    def add_face(self, a: int, b: int, c: int) -> Edit:
        """Make a face of three vertices, counterclockwise. 1 face and 0 to 3 edges more.

        Every corner must be without faces or share an edge with the surface. Cost O(n_ev); where
        neighbors are searched for, that of the search.
        """
        return self._do["add_face"](a, None, b, c)

    def remove_face(self, face: int) -> Edit:
        """Take a face away. 1 face and 0 to 3 edges fewer; vertices stay. Cost as ``add_face``."""
        return self._do["remove_face"](face)

    def move_vertex(self, vertex: int, point: ArrayLike) -> Edit:
        """Give a vertex another position. Cost O(1); O(n_t) where triangles have own points."""
        return self._do["move_vertex"](vertex, point)

    def add_vertex(self, point: ArrayLike) -> Edit:
        """Make a vertex that no face uses yet. 1 vertex more. O(1), as none is searched for."""
        return self._do["add_vertex"](-1, point)

    def can_collapse_edge(self, edge: int) -> bool:
        """Whether ``collapse_edge`` would do it. Raises TopologyError if there is no such edge."""
        return self._operations.may("collapse_edge", edge)

    def can_flip_edge(self, edge: int) -> bool:
        """Whether ``flip_edge`` would do it. Raises TopologyError if there is no such edge."""
        return self._operations.may("flip_edge", edge)

    @cached_property
    def _do(self) -> Methods:
        """Every operation as a function of its first handle, a point and two more handles."""
        return Methods(self._operations.method)

    # Many operations at once -----------------------------------------------------------------

    def split_edges(self, edges: ArrayLike, points: ArrayLike) -> Handles:
        """Split different edges (k,) at points (k, 3), in order -> the new vertices (k,) int32.

        All are checked before any is split. Subscribers hear of one edit.
        """
        return self._operations.all("split_edges", "split_edge", edges, points)

    def split_faces(self, faces: ArrayLike, points: ArrayLike) -> Handles:
        """Split different faces (k,) at points (k, 3), in order -> the new vertices (k,) int32.

        All are checked before any is split. Subscribers hear of one edit.
        """
        return self._operations.all("split_faces", "split_face", faces, points)

    def split_all_faces(self) -> Handles:
        """Split every face at its centroid -> the new vertices. A face for every side. O(n_t)."""
        faces = self.faces()
        return self._operations.all("split_all_faces", "split_face", faces, centroids(self, faces))

    def collapse_edges(self, edges: ArrayLike, keep: ArrayLike | None = None) -> Bools:
        """Collapse edges (k,) in order, skipping what is gone or refused -> which were done.

        ``keep``: (k,) the ends that stay, each ``edge_vertices(edge)[1]`` unless it is said. Edges
        at a merged vertex live on where edges are recorded and their handles stable; named by their
        ends they are gone.
        Subscribers hear of one edit, or of one each where corners or half-edges have attributes.
        """
        handles = arguments.handles("collapse_edges", edges)
        ends = np.full(len(handles), -1)
        if keep is not None:
            ends = arguments.handles("collapse_edges", keep)
            ends[ends == -1] = NO_VERTEX
        if len(ends) != len(handles):
            given = f"{len(ends)} for {len(handles)}"
            raise MeshError(f"collapse_edges takes one vertex to keep per edge, not {given}")
        rows = arguments.rows(handles, ends)
        if self.told_one_by_one:
            return self._operations.one_by_one(self._do["collapse_edge"], rows)
        return self._operations.persist("collapse_edges", "collapse_edge", rows)

    def move_vertices(self, vertices: ArrayLike, points: ArrayLike) -> None:
        """Give different vertices (k,) the positions (k, 3). One edit. Cost: k moves."""
        self._operations.all("move_vertices", "move_vertex", vertices, points)

    def remove_faces(self, faces: ArrayLike) -> None:
        """Take different faces (k,) away, all at once or none; vertices stay.

        Refused where two fans of what is left would meet in one vertex. Subscribers hear of one
        edit. Cost: that of ``vertex_faces`` at all the corners.
        """
        handles = self._operations.require_different("remove_faces", "face", faces)
        if len(handles):
            self._remove("remove_faces", handles)

    def remove_vertex(self, vertex: int) -> Edit:
        """Take a vertex away, and all faces at it; its neighbors stay.

        1 vertex fewer. Refused where two fans of what is left would meet in one vertex. Cost: that
        of ``vertex_faces`` at the vertex and its neighbors.
        """
        handle = self._operations.require_different("remove_vertex", "vertex", [vertex])
        faces = self.vertex_faces(handle).values.astype(np.int64)
        return self._remove("remove_vertex", faces, int(vertex))

    def _remove(self, called: str, faces: Array, vertex: int = -1) -> Edit:
        """Take faces (k,) away and a vertex that has no others, or -1."""
        plan = planned(self, called, faces, vertex)
        self._queries.count_edges()
        try:
            self.run(removing, plan)
        finally:  # an interrupt comes as soon as compiled code has ended
            edit = Edit(called, -1, plan.log[1 : plan.log[0] + 1])
            self._followers.publish(edit)
        return edit

    def compact(self) -> Remapping:
        """Drop what is dead and the room for more; handles change -> the old ones to the new ones.

        Elements keep their order. Cost O(n_v + n_t).
        """
        edit, remapping = self._compacted()
        self._followers.subscribers.tell(edit)
        return remapping

    def _compacted(self) -> tuple[Edit, Remapping]:
        """As ``compact`` says, but told to the attributes only."""
        self._queries.count_edges()
        edit, records = Edit("compact", -1, np.zeros(0, np.int64)), self.records
        before = [(it, vars(it).copy()) for it in self.attributes()]
        try:
            edit.remapping = remapping = self._renumbered()
            self._followers.carry(edit)
        except BaseException:  # values must not stay at what other elements are called now
            if self.arrays:  # objects were renumbered in their place
                self._state.replace(records=records)
                for attribute, parts in before:
                    vars(attribute).update(parts)
            raise
        return edit, remapping

    def _renumbered(self) -> Remapping:
        """Drop what is dead from the records."""
        number, renumbered = self._state.compact(), self._state.storage.renumbered
        faces = next(number[it] for it in ("face", "triangle") if it in number)
        return Remapping(
            np.asarray(number["vertex"], np.int32),
            np.asarray(faces, np.int32),
            lambda edges: renumbered(arguments.handles("Remapping.edges", edges), number),
        )

    # Algorithms ------------------------------------------------------------------------------

    def run(self, make: Algorithm, plan: Any) -> int:
        """Run an algorithm over this mesh in one go, compiled where the structure is.

        ``make(queries, operations)`` gets the kernels of this structure by name and makes one of
        them, ``algorithm(m, plan) -> result``; it is asked once per structure. ``plan`` is a
        ``NamedTuple`` of arrays. Who writes an algorithm checks the handles in it, for which there
        are kernels such as ``vertex_exists``. Operations need room and scratch, see ``scratch``,
        and are told to subscribers by ``tell``.
        """
        uses, kernels = self.declared.algorithm(make)
        self._state.prepare(kernels)
        return int(uses.run(plan, *self.records))

    def scratch(
        self, splits: int, operations: int | None = None, valence: int | None = None
    ) -> tuple[Any, Array]:
        """Make room for so many splits -> scratch and a log, for all of them or ``operations``.

        ``valence``: the most faces that any vertex has now and will have meanwhile, if the caller
        knows; else every operation is taken to add one. Cost O(1) per split in the long run.
        """
        more = splits if operations is None else operations
        self._queries.count_edges()
        self._state.make_room(splits, 2 * splits)
        self._state.widen(more, valence)
        return self._state.out["edge"], np.zeros(authoring.ENTRIES * (more + 2), np.int64)

    @property
    def followed(self) -> bool:
        """Whether anyone is to be told of edits: subscribers or attributes."""
        return bool(self._followers)

    def tell(self, kind: str, touched: ArrayLike) -> None:
        """Tell subscribers of one edit, by the log of what an algorithm touched."""
        if self._followers:
            self._followers.publish(Edit(kind, -1, touched))

    # What follows every edit -----------------------------------------------------------------

    vertex_attribute: AttributeMethod = attribute_method(
        "vertex", Attribute, "Floating-point values are interpolated, others copied."
    )
    face_attribute: AttributeMethod = attribute_method(
        "face", Attribute, "The parts of a split face copy what it has."
    )
    edge_attribute: AttributeMethod = attribute_method(
        "edge",
        EdgeAttribute,
        "The parts of a split edge copy what it has. MeshError where edges are not recorded.",
    )
    corner_attribute: AttributeMethod = attribute_method(
        "corner",
        CornerAttribute,
        "As for vertices; see ``CornerAttribute``. ``collapse_edges`` does an edit per edge then.\n"
        "Takes memory for as many corners in every face as the largest one has.",
    )

    def attributes(self) -> list[Attribute]:
        """All there are, in the order they were made."""
        return list(self._followers.attributes.values())

    @property
    def told_one_by_one(self) -> bool:
        """Whether every operation is an edit of its own, as corners or half-edges have values.

        A batch does not tell what came where in between, and a seam must not be torn. So it is of
        edges whose handles are not stable.
        """
        stable = ("edge",) if self.stable_edge_handles else ()
        return any(it.element not in ("vertex", "face", *stable) for it in self.attributes())

    def remove_attribute(self, attribute: Attribute) -> None:
        """Have an attribute follow no longer. Raises MeshError if it is not of this mesh."""
        known = self._followers.attributes
        if not any(it is attribute for it in known.values()):
            words = "is no attribute of this mesh, such as s.vertex_attribute(name) gives"
            raise MeshError(f"{attribute!r} {words}")
        del known[attribute.element, attribute.name]

    def subscribe(self, callback: Callable[[Edit], Any]) -> Callable[[], None]:
        """Have ``callback`` called with every ``Edit`` once it is done -> a way to end that.

        All are called, in the order they subscribed, even if one of them raises; what the first of
        them raised is raised then. A callback may ask, but not edit: an algorithm that is under way
        ends with a MeshError where elements were made or removed.
        """
        return self._followers.subscribers.subscribe(callback)

    def copy_touched(self, touched: ArrayLike, points: Points, indices: Handles) -> None:
        """Write what an edit touched into the arrays of a render mesh, clockwise. O(edit).

        ``points`` (n, 3) and ``indices`` (m, 3) have a row for every vertex and face there ever
        was; what is dead becomes zeros. Raises MeshError for what is not there, or has no row.
        """
        self._queries.copy_touched(touched, points, indices)

    # Copies and memory -----------------------------------------------------------------------

    def copy(self) -> Self:
        """The same mesh in arrays of its own: same handles, same attributes, no subscribers."""
        return self._of(self._saved())

    def __reduce__(self) -> tuple[Any, ...]:
        """How ``copy.copy``, ``copy.deepcopy`` and ``pickle`` make a copy: as ``copy`` does."""
        if self._like is not None:  # whose class has no place where another process finds it
            return _uncompiled_of, (self._like, self._saved())
        return self._of, (self._saved(),)

    @classmethod
    def _of(cls, saved: Snapshot) -> Self:
        """The structure of what is its own from here on."""
        made = cls(cls.declared.storage.loaded(saved.records))
        made._followers.adopt(saved.attributes, made)
        return made

    def _saved(self) -> Snapshot:
        return Snapshot(self._state.storage.saved(self.records), self._followers.kept())

    def snapshot(self) -> Snapshot:
        """What ``restore`` needs to make the mesh what it is now. Cost O(n_v + n_t)."""
        self._queries.count_edges()  # what is not known yet would be unknown again, then kept up
        self._state.widen()
        return self._saved()

    def restore(self, snapshot: Snapshot) -> None:
        """Make the mesh what it was, in the same place; there must be as much room. For measuring.

        Attributes that were made since become what they were made. Subscribers are not told. Cost
        O(n_v + n_t).
        """
        self._state.storage.put_back(self.records, snapshot.records)
        self._followers.put_back(snapshot.attributes)

    def memory(self, room: bool = False, names: bool = False) -> dict[str, int]:
        """Bytes per field of live elements, such as ``{"vertex.point": 12 * n_vertices, …}``.

        With ``names`` also what only gives elements their handles (``Field.names``), where there is
        such. With ``room`` that, too, and all that is taken beside: ``dead and room to grow`` is
        what the arrays hold besides, up to as much again after they grew, and is given memory when
        it is first written, see ``hem.room``; ``scratch`` is where queries and operations work,
        little before the first of them.
        """
        taken = self._live_bytes()
        naming = sum(taken.pop(it.name) for it in self.fields if it.names)
        if naming and (names or room):
            taken["names"] = naming
        if not room:
            return taken
        spare = self._state.storage.spare(self.records, sum(taken.values()))
        return taken | {"dead and room to grow": spare, "scratch": self._state.scratch_bytes}

    def _live_bytes(self) -> dict[str, int]:
        """By field, those that only name elements included."""
        counts = {"vertex": self.n_vertices, "edge": self.n_edges, "half_edge": self.n_half_edges}
        counts |= dict.fromkeys(("face", "triangle"), self.n_faces)
        taken = {}
        for it in self.fields:
            size = int(getattr(self.records, it.array).itemsize)
            taken[it.name] = counts[it.element] * it.width * size
        return taken

    # For measuring; nobody else needs it -----------------------------------------------------

    def sweep(self, query: str, handles: Array) -> int:
        """Answer ``query`` for every handle in one compiled loop, keeping nothing -> a checksum.

        Raises MeshError for what names nothing, KeyError for no query.
        """
        return self.prepare_sweep(query, handles).run()

    def prepare_sweep(self, query: str, handles: Array) -> Sweep:
        """Check handles for a ``sweep``, which is run later: what the experiments time."""
        return self._queries.sweep(query, handles)

    def work(self, query: str, handles: Array) -> Indices:
        """(n,) int64: elements of the structure's arrays read to answer ``query``, per handle.

        Exact and the same on every machine; runs uncompiled. Raises as ``sweep``.
        """
        return self._queries.work(query, handles)

    def reads(self, query: str, handle: int) -> list[Read]:
        """Which elements of which fields are read to answer ``query``, in order; see ``work``."""
        return self._queries.reads(query, handle, self.fields)

    def reserve(self, splits: int) -> None:
        """Make all room for so many splits at once, so that none of them has to.

        Room for a vertex and two faces each, where a polygon of n corners takes n - 1 faces, and
        scratch for as many operations of any kind. MeshError for more than indices can name. O(n_v
        + n_t).
        """
        self._operations.reserve(arguments.number("reserve", splits))

    def prepare(self, operation: str, args: ArrayLike, points: ArrayLike | None = None) -> Prepared:
        """Have operations ready to be run in one compiled loop, untold to anyone: for measuring.

        ``args``: (n,) first handles, or (n, 3) all of them. Refused ones are passed over. There is
        room for them all from here on, unless collapses or merges heap up neighbors or corners, see
        ``Prepared.run``; the arrays must stay the same until it is run. Raises KeyError for no
        operation, MeshError without ``points`` where it takes some.
        """
        return self._operations.prepare(operation, args, points)

    def operation_work(self, operation: str, *args: int, point: ArrayLike = (0, 0, 0)) -> int:
        """Do one operation uncompiled -> the array elements it read and wrote, exactly.

        Arguments as for the method of that name, which says what it raises; KeyError for no
        operation.
        """
        return self._operations.work(operation, args, point)
