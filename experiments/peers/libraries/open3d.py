"""Open3D: its half-edge mesh, made of its mesh of triangles."""

from collections.abc import Callable
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np

from experiments.peers.peer import Ask, Lazy, Mesh, Peer, Rows
from hem.arrays import Array

geometry, utility = Lazy("open3d.geometry"), Lazy("open3d.utility")


def _build(points: Array, triangles: Array) -> Mesh:
    given = utility.Vector3dVector(points), utility.Vector3iVector(triangles)
    return geometry.HalfEdgeTriangleMesh.create_from_triangle_mesh(geometry.TriangleMesh(*given))


def _flat(m: Mesh) -> Any:
    """The mesh of triangles, which most of its methods are about."""
    return geometry.TriangleMesh(m.vertices, m.triangles)


def _around(read: Callable[[Any], int], m: Mesh) -> Ask:
    """What reads each half-edge that leaves a vertex; the lists are asked for once."""
    half_edges, leaving = m.half_edges, m.ordered_half_edge_from_vertex
    return lambda vertex: [read(half_edges[it]) for it in leaving[vertex]]


def _neighbors(m: Mesh) -> Rows:
    flat = _flat(m)
    flat.compute_adjacency_list()
    return flat.adjacency_list


PEER = Peer(
    title="Open3D",
    distribution="open3d",
    site="https://www.open3d.org/docs/release/",
    manual="`half_edges` and `ordered_half_edge_from_vertex` as lists, `adjacency_list` once it "
    "was computed; what changes a mesh makes another one of triangles.",
    more="Point clouds, registration, reconstruction from depth images, voxels, drawing, learning; "
    "the half-edge mesh is a small part of it.",
    build=_build,
    faces=lambda m: len(m.triangles),
    arrays=attrgetter("vertices", "triangles"),
    single={
        "vertex_vertices": partial(_around, lambda it: it.vertex_indices[1]),
        "vertex_faces": partial(_around, attrgetter("triangle_index")),
        "face_vertices": lambda m: m.triangles.__getitem__,
    },
    bulk={"vertex_vertices": _neighbors},
    algorithms={
        "vertex_normals": lambda m: np.asarray(_flat(m).compute_vertex_normals().vertex_normals),
        "smooth": lambda m: _flat(m).filter_smooth_laplacian(1, 1.0),
        "simplify": lambda m, faces: len(_flat(m).simplify_quadric_decimation(faces).triangles),
    },
)
