"""What people do with meshes, written once over the contract and run on every structure."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hem.contract import Structure

Array = NDArray[np.float64]

KEPT = 0.1
"""The part of the vertices that a simplification leaves."""

IMPACTS = 100
IMPACT_SEED = 23


class Workload(NamedTuple):
    """One workload: ``run(s)`` does it, on a mesh that is its own, and tells how many ``unit``.

    ``scans``: about how many scans of the whole mesh it takes per unit where neighbors are searched
    for, so that what would take hours is left out beforehand.
    """

    title: str
    unit: str
    scans: float
    run: Callable[[Structure], int]


def vertex_normals(s: Structure) -> int:
    """Add every face's normal to its corners: a pass over the faces, no neighbors asked."""
    corners = s.face_vertices(s.faces()).values.reshape(-1, 3)
    a, b, c = (s.points[corners[:, i]] for i in range(3))
    normals, of_faces = np.zeros_like(s.points), np.cross(b - a, c - a)
    for i in range(3):
        np.add.at(normals, corners[:, i], of_faces)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return s.n_vertices


def smoothing(s: Structure) -> int:
    """Move every vertex to the mean of its neighbors, once."""
    vertices = s.vertices()
    rings = s.vertex_vertices(vertices)
    sums = np.add.reduceat(s.points[rings.values].astype(np.float64), rings.offsets[:-1])
    s.move_vertices(vertices, sums / rings.counts[:, None])
    return len(vertices)


def subdivision(s: Structure) -> int:
    """Split every face at its centroid."""
    return len(s.split_all_faces())


def simplification(s: Structure) -> int:
    """Collapse the shortest edge there is until a tenth of the vertices is left."""
    return simplify(s, KEPT)


def simplify(s: Structure, part: float) -> int:
    """Collapse the shortest edge there is until ``part`` of the vertices is left -> how many."""
    wanted = max(4, int(part * s.n_vertices))
    ends = np.sort(s.edge_vertices(s.edges()).values.reshape(-1, 2))
    lengths = np.linalg.norm(s.points[ends[:, 0]] - s.points[ends[:, 1]], axis=1)
    queue = [(x, a, b) for x, (a, b) in zip(lengths.tolist(), ends.tolist(), strict=True)]
    heapq.heapify(queue)
    alive, collapsed = np.ones(len(s.points), np.bool_), 0
    while queue and s.n_vertices > wanted:
        _, a, b = heapq.heappop(queue)
        edge = s.find_edge(a, b) if alive[a] and alive[b] else None
        if edge is None or not s.can_collapse_edge(edge):
            continue
        s.collapse_edge(edge, keep=b)
        alive[a], collapsed = False, collapsed + 1
        ring = s.vertex_vertices(b)
        lengths = np.linalg.norm(s.points[ring] - s.points[b], axis=1)
        for x, v in zip(lengths.tolist(), ring.tolist(), strict=True):
            heapq.heappush(queue, (x, min(v, b), max(v, b)))
    return collapsed


def impacts(s: Structure) -> int:
    """As in a game: split the face that is hit, ask what is around, split an edge there."""
    rng = np.random.default_rng(IMPACT_SEED)
    for face in rng.integers(0, s.n_faces, IMPACTS).tolist():
        corners = s.face_vertices(face)
        center = s.points[corners].mean(axis=0)
        new = s.split_face(face, center).vertex
        ring = s.vertex_vertices(new).tolist()
        for v in ring:
            s.vertex_faces(v)
        edge = s.find_edge(new, min(ring))
        if edge is not None:
            s.split_edge(edge, (s.points[new] + s.points[min(ring)]) / 2)
        s.face_faces(face)
    return IMPACTS


WORKLOADS = {
    "vertex_normals": Workload("Vertex normals", "vertex", 0, vertex_normals),
    "smoothing": Workload("Smoothing", "vertex", 3, smoothing),
    "subdivision": Workload("Subdivision of all faces", "face", 0, subdivision),
    "simplification": Workload("Simplification to a tenth", "collapse", 35, simplification),
    "impacts": Workload("Impacts, as in a game", "impact", 30, impacts),
}
"""Every workload by name. A new one is one function and one line here."""
