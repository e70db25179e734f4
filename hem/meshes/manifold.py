"""Is it a surface? Diagnosis from the triangles alone, independent of every structure.

A mesh is a surface when every edge is in at most two faces, two faces run along their common edge
in opposite directions, and the faces around a vertex form one fan. Everything here is O(m log m).
"""

import numpy as np

from hem.arrays import Indices, Triangles, each_once
from hem.errors import MeshError, NonManifoldError
from hem.meshes.components import components
from hem.meshes.edges import edge_keys, half_edges, key_vertices, undirected_edges
from hem.meshes.triangles import TriangleMesh


def non_manifold_edges(triangles: Triangles) -> Indices:
    """Edges in more than two faces: (k, 2) vertices."""
    edges, faces = undirected_edges(triangles)
    return edges[faces > 2]


def same_way_edges(triangles: Triangles) -> Indices:
    """Edges in two faces that both run the same way along it: (k, 2) vertices."""
    start, end = half_edges(triangles)
    keys = edge_keys(start, end)
    order = np.argsort(keys, kind="stable")
    unique, first, count = np.unique(keys[order], return_index=True, return_counts=True)
    two = first[count == 2]
    same = start[order[two]] == start[order[two + 1]]
    return key_vertices(unique[count == 2][same])


def split_vertices(triangles: Triangles) -> Indices:
    """Vertices whose faces form more than one fan: (k,) vertices.

    Two corners at a vertex are in one fan when a chain of faces, each sharing with the next an
    edge at that vertex, leads from one to the other.
    """
    fans, fan = components(triangles.size, _joined_corners(triangles))
    vertex_of_fan = np.empty(fans, np.int64)
    vertex_of_fan[fan] = triangles.ravel()
    return np.flatnonzero(np.bincount(vertex_of_fan) > 1)


def euler_number(mesh: TriangleMesh) -> int:
    """V - E + F over the vertices that have faces."""
    vertices = each_once(mesh.triangles)
    return len(vertices) - len(undirected_edges(mesh.triangles)[0]) + len(mesh.triangles)


def require_sound(mesh: TriangleMesh, euler: int | None = None) -> None:
    """What must hold after any operation, from the triangles alone, whatever structure made them.

    A manifold surface, no face twice, and Euler's number as predicted. Raises NonManifoldError or
    MeshError with the elements.
    """
    require_manifold(mesh)
    _, first = np.unique(np.sort(mesh.triangles, axis=1), axis=0, return_index=True)
    again = np.setdiff1d(np.arange(len(mesh.triangles)), first)
    if len(again):
        raise MeshError("faces have the same three corners as others", faces=again)
    if euler is not None and euler_number(mesh) != euler:
        raise MeshError(f"Euler's number is {euler_number(mesh)} instead of {euler}")


def require_manifold(mesh: TriangleMesh) -> None:
    """Raise NonManifoldError, with all offending edges, vertices and faces, unless a surface."""
    crowded = non_manifold_edges(mesh.triangles)
    twisted = same_way_edges(mesh.triangles)
    split = split_vertices(mesh.triangles)
    found = []
    for bad, one, many, words in (
        (crowded, "edge", "edges", "in more than two faces"),
        (twisted, "edge", "edges", "along which both faces run the same way"),
        (split, "vertex", "vertices", "where more than one fan of faces meets"),
    ):
        if len(bad):
            found.append(f"{len(bad):,} {one if len(bad) == 1 else many} {words}")
    if not found:
        return
    edges = np.concatenate([crowded, twisted])
    raise NonManifoldError(
        f"the mesh is no manifold surface: {', '.join(found)}; "
        "mend it (hem.load and hem.sample take repair=True, a command --repair), or use the "
        "indexed mesh",
        edges=edges,
        vertices=split,
        faces=_faces_at(mesh.triangles, edges, split),
    )


def _joined_corners(triangles: Triangles) -> Indices:
    """(k, 2): pairs of corners (3f + i) at the same vertex whose faces share an edge there."""
    start, end = half_edges(triangles)
    keys = edge_keys(start, end)
    corner = np.arange(len(keys))
    following = corner - corner % 3 + (corner + 1) % 3
    low = np.where(start < end, corner, following)
    high = np.where(start < end, following, corner)
    order = np.argsort(keys, kind="stable")
    same = keys[order[1:]] == keys[order[:-1]]
    one, other = order[:-1][same], order[1:][same]
    return np.concatenate([np.stack([ends[one], ends[other]], axis=1) for ends in (low, high)])


def _faces_at(triangles: Triangles, edges: Indices, vertices: Indices) -> Indices:
    """Faces that have one of these edges or vertices, ascending."""
    bad = np.isin(edge_keys(*half_edges(triangles)), edge_keys(edges[:, 0], edges[:, 1]))
    at_edge = bad.reshape(-1, 3).any(axis=1)
    at_vertex = np.isin(triangles, vertices).any(axis=1)
    return np.flatnonzero(at_edge | at_vertex)
