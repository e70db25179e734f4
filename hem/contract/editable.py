"""The operations of the contract, one at a time and many at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Array, Bools, Handles
from hem.authoring import ENTRIES, SIDES, Refusal, compacted
from hem.contract import arguments
from hem.contract.operating import Algorithms
from hem.contract.removal import Removal, remaining, removing, vanishing_edges
from hem.edit import Edit, Remapping
from hem.engine import PERSIST
from hem.errors import MeshError, TopologyError

NO_VERTEX = -2
"""Stands for a vertex to keep that is said to be -1, which means that none is said."""


class Editable(Algorithms, abstract=True):
    """What a mesh can have done to it.

    Each operation checks first. If it may not be done, it raises TopologyError with the reason and
    the elements, and nothing has changed; so it does for a handle that names nothing (any more).
    MeshError is raised for arguments that are no handles or positions at all. Handles of untouched
    elements stay valid; new vertices and faces take the next index.
    """

    # One at a time ---------------------------------------------------------------------------

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
        Thesis 4.2; refused as ``hem.authoring.operations.collapse_edge`` says.
        """
        end = -1 if keep is None else NO_VERTEX if keep == -1 else keep
        return self._do["collapse_edge"](edge, None, end)

    def flip_edge(self, edge: int) -> Edit:
        """Turn an edge inside the two faces at it, so that it joins their other two corners.

        No count changes; a second flip undoes the first. Cost O(1) where edges are recorded, and
        to see that no edge is there yet O(the smaller valence of the two corners).
        """
        return self._do["flip_edge"](edge)

    def add_face(self, a: int, b: int, c: int) -> Edit:
        """Make a face of three vertices, counterclockwise. 1 face and 0 to 3 edges more.

        Every corner must be without faces or share an edge with the surface. Cost O(n_ev).
        """
        return self._do["add_face"](a, None, b, c)

    def remove_face(self, face: int) -> Edit:
        """Take a face away. 1 face and 0 to 3 edges fewer; vertices stay. Cost O(n_ev)."""
        return self._do["remove_face"](face)

    def move_vertex(self, vertex: int, point: ArrayLike) -> Edit:
        """Give a vertex another position. Cost O(1)."""
        return self._do["move_vertex"](vertex, point)

    def add_vertex(self, point: ArrayLike) -> Edit:
        """Make a vertex that no face uses yet. 1 vertex more. O(1), as none is searched for."""
        return self._do["add_vertex"](-1, point)

    def can_collapse_edge(self, edge: int) -> bool:
        """Whether ``collapse_edge`` would do it. Raises TopologyError if there is no such edge."""
        return self._may("collapse_edge", edge)

    def can_flip_edge(self, edge: int) -> bool:
        """Whether ``flip_edge`` would do it. Raises TopologyError if there is no such edge."""
        return self._may("flip_edge", edge)

    # Many at once ----------------------------------------------------------------------------

    def split_edges(self, edges: ArrayLike, points: ArrayLike) -> Handles:
        """Split different edges (k,) at points (k, 3), in order -> the new vertices (k,) int32.

        All are checked before any is split. Subscribers hear of one edit.
        """
        handles = arguments.handles("split_edges", edges)
        return self._all("split_edges", "split_edge", handles, points, self._edge_names(handles))

    def split_faces(self, faces: ArrayLike, points: ArrayLike) -> Handles:
        """Split different faces (k,) at points (k, 3), in order -> the new vertices (k,) int32.

        All are checked before any is split. Subscribers hear of one edit.
        """
        handles = arguments.handles("split_faces", faces)
        return self._all("split_faces", "split_face", handles, points, handles)

    def split_all_faces(self) -> Handles:
        """Split every face at its centroid -> the new vertices. A face for every side. O(n_t)."""
        faces = self.faces()
        corners = self.face_vertices(faces)
        values = corners.values
        if self.most_corners == 3:  # each structure has its own first corner, and sums are rounded
            values = np.sort(values.reshape(-1, 3)).reshape(-1)
        sums = np.add.reduceat(self.points[values], corners.offsets[:-1], 0, np.float64)
        centroids = sums / corners.counts[:, None]
        return self._all("split_all_faces", "split_face", faces, centroids, faces)

    def remove_faces(self, faces: ArrayLike) -> None:
        """Take different faces (k,) away, all at once or none; vertices stay.

        Refused where two fans of what is left would meet in one vertex. Subscribers hear of one
        edit. Cost: that of ``vertex_faces`` at all the corners.
        """
        handles = arguments.handles("remove_faces", faces)
        self._require_different("remove_faces", "face", handles, handles)
        if len(handles):
            self._remove("remove_faces", handles)

    def remove_vertex(self, vertex: int) -> Edit:
        """Take a vertex away, and all faces at it; its neighbors stay.

        1 vertex fewer. Refused where two fans of what is left would meet in one vertex. Cost: that
        of ``vertex_faces`` at the vertex and its neighbors.
        """
        handle = arguments.handles("remove_vertex", [vertex])
        self._require_different("remove_vertex", "vertex", handle, handle)
        faces = self.vertex_faces(handle).values.astype(np.int64)
        return self._remove("remove_vertex", faces, int(vertex))

    def _remove(self, called: str, faces: Array, vertex: int = -1) -> Edit:
        """Take faces (k,) away and a vertex that has no others, or -1."""
        left = remaining(self, faces)
        pinched = left.pinched()
        if len(pinched):
            raise TopologyError(f"cannot {called}: {Refusal.BETWEEN.words}", vertices=pinched)
        vertices, first = np.unique(left.vertex, return_index=True)
        anchors = np.stack([vertices, left.face[first]], axis=1)
        counted = np.array([vanishing_edges(self, faces, left), vertex])
        log = np.zeros(len(faces) + ENTRIES, np.int64)
        self._count_edges()
        self.run(removing, Removal(faces, anchors, counted, log))
        edit = Edit(called, -1, log[1 : log[0] + 1])
        self._publish(edit)
        return edit

    def move_vertices(self, vertices: ArrayLike, points: ArrayLike) -> None:
        """Give different vertices (k,) the positions (k, 3). One edit. Cost O(k)."""
        handles = arguments.handles("move_vertices", vertices)
        self._all("move_vertices", "move_vertex", handles, points, handles)

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
            raise MeshError(
                f"collapse_edges takes one vertex to keep per edge, not {len(ends)} "
                f"for {len(handles)}"
            )
        if self.told_one_by_one:
            names = self._lasting_names(handles)
            return np.array([self._collapsed(e, v) for e, v in zip(names, ends, strict=True)])
        results, log = self._run(
            "collapse_edge", arguments.rows(handles, ends), arguments.NO_POINT, PERSIST
        )
        self._publish(Edit("collapse_edges", -1, log))
        return results >= 0

    def _collapsed(self, name: int, keep: int) -> bool:
        """Whether an edge, by its lasting name, could be collapsed, which is done then."""
        try:
            self._do["collapse_edge"](self._lasting_handle(name), None, keep)
        except TopologyError:
            return False
        return True

    def compact(self) -> Remapping:
        """Drop what is dead and the room for more; handles change -> the old ones to the new ones.

        Elements keep their order. Cost O(n_v + n_t).
        """
        self._count_edges()
        self.records, number = self._compacted()
        sides = self.face_vertices(self.faces()).counts.max(initial=3)
        self.records.counts[SIDES] = sides
        self._repin()
        vertices = number["vertex"].astype(np.int32)
        faces = next(number[it] for it in ("face", "triangle") if it in number).astype(np.int32)
        remapping = Remapping(vertices, faces, lambda edges: self._renumbered(edges, number))
        edit = Edit("compact", -1, np.zeros(0, np.int64))
        edit.remapping = remapping
        self._publish(edit)
        return remapping

    def _compacted(self) -> tuple[Any, dict[str, Array]]:
        """The live records without gaps, and the new number of each old one by kind."""
        return compacted(self.records, self.fields)

    def _renumbered(self, edges: ArrayLike, number: Mapping[str, Array]) -> NDArray[np.int64]:
        recorded = next(it for it in ("half_edge", "edge") if it in number)
        old, numbers = np.asarray(edges, np.int64), np.append(number[recorded], -1)
        known = (old >= 0) & (old < len(numbers))
        return numbers[np.where(known, old, -1)].astype(np.int64)
