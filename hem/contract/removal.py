"""Many faces taken away at once, whatever the order: what would be left is looked at first.

One after the other is not always possible. A ring of faces, for one, has a last face whose removal
would leave two parts that meet in a vertex, until the next one is gone.
"""

from typing import Any, NamedTuple

import numpy as np

from hem import authoring
from hem.arrays import Array, Indices, each_once
from hem.authoring import EDGES, FACES, VERTICES, Kernel, Kernels, kernel, log_element
from hem.contract.surveying import Surveying
from hem.edit import FACE, REMOVED, VERTEX
from hem.errors import TopologyError


class Remaining(NamedTuple):
    """The corners (k,) that other faces have at the vertices of the faces to be taken away.

    ``following`` and ``before`` are the vertices beside the corner in its face.
    """

    vertex: Indices
    face: Indices
    following: Indices
    before: Indices

    @property
    def edges(self) -> Indices:
        """(2 k,): the edges at the vertex, as ``vertex << 32 | other end``."""
        return self.vertex << 32 | np.stack([self.following, self.before])

    def pinched(self) -> Indices:
        """The vertices in which more than one fan of faces would be left, ascending. O(k log k).

        A fan of k faces that is not closed has k + 1 edges there.
        """
        vertices, corners = np.unique(self.vertex, return_counts=True)
        edges = each_once(self.edges)
        count = np.bincount(np.searchsorted(vertices, edges >> 32), minlength=len(vertices))
        return vertices[count - corners > 1]


def remaining(s: Surveying, gone: Array, fresh: Array | None = None) -> Remaining:
    """What is left at the vertices of faces (k,), or just of the ``fresh`` ones among them.

    Cost: ``vertex_faces`` of these vertices.
    """
    touched = each_once(s.face_vertices(gone if fresh is None else fresh).values)
    faces = each_once(s.vertex_faces(touched).values)
    faces = faces[~np.isin(faces, gone)]
    corners = s.face_vertices(faces)
    vertex, places = corners.values.astype(np.int64), corners.following
    following, before = vertex[places], np.empty_like(vertex)
    before[places] = vertex
    face = np.repeat(faces.astype(np.int64), corners.counts)
    chosen = np.isin(vertex, touched)
    return Remaining(*(it[chosen] for it in (vertex, face, following, before)))


def vanishing_edges(s: Surveying, gone: Array, left: Remaining) -> int:
    """How many edges have no face any more once these are gone."""
    corners = s.face_vertices(gone)
    here = corners.values.astype(np.int64)
    there = here[corners.following]
    mine = each_once(np.minimum(here, there) << 32 | np.maximum(here, there))
    edges = left.edges
    ends = edges >> 32, edges & 0xFFFFFFFF
    return int((~np.isin(mine, np.minimum(*ends) << 32 | np.maximum(*ends))).sum())


class Removal(NamedTuple):
    """What ``removing`` is told."""

    faces: Array  # (k,) int64, each once
    anchors: Array  # (n, 2) int64: a vertex that keeps faces, and one of them
    counted: Array  # (2,) int64: how many edges are left without a face; a vertex to go, or -1
    log: Array


def planned(s: Surveying, called: str, faces: Array, vertex: int) -> Removal:
    """How to take faces (k,) away and a vertex that has no others, or -1.

    TopologyError where two fans of what is left would meet in one vertex.
    """
    left = remaining(s, faces)
    pinched = left.pinched()
    if len(pinched):
        raise TopologyError(f"cannot {called}: {authoring.Refusal.BETWEEN.words}", vertices=pinched)
    vertices, first = np.unique(left.vertex, return_index=True)
    anchors = np.stack([vertices, left.face[first]], axis=1)
    counted = np.array([vanishing_edges(s, faces, left), vertex])
    return Removal(faces, anchors, counted, np.zeros(len(faces) + authoring.ENTRIES, np.int64))


def removing(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``remove(m, plan) -> 0``: take all faces away, then see that every vertex knows one.

    In between there may be several fans in a vertex, which knows only one of them, or none.
    """
    remove_records, set_vertex_face = k["remove_records"], k["set_vertex_face"]
    kill_vertex = k["kill_vertex"]

    @kernel
    def remove(m: Any, plan: Removal) -> int:
        log, end = plan.log, plan.log[0]
        for i in range(len(plan.faces)):
            remove_records(m, plan.faces[i])
            end = log_element(log, end, FACE + REMOVED, plan.faces[i])
        for i in range(len(plan.anchors)):
            set_vertex_face(m, plan.anchors[i, 0], plan.anchors[i, 1])
        m.counts[FACES] -= len(plan.faces)
        m.counts[EDGES] -= plan.counted[0]
        if plan.counted[1] >= 0:
            kill_vertex(m, plan.counted[1])
            m.counts[VERTICES] -= 1
            end = log_element(log, end, VERTEX + REMOVED, plan.counted[1])
        log[0] = end
        return 0

    return remove
