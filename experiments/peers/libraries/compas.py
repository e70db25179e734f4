"""COMPAS: half-edges in dictionaries, all in Python."""

from operator import attrgetter, methodcaller
from typing import Any

import numpy as np

from experiments.peers.peer import Ask, Lazy, Mesh, Peer
from hem.arrays import Array

structures = Lazy("compas.datastructures")


def _build(points: Array, triangles: Array) -> Mesh:
    return structures.Mesh.from_vertices_and_faces(points.tolist(), triangles.tolist())


def _ends(m: Mesh) -> Array:
    return np.array(list(m.edges()))


def _handles(m: Mesh, element: str, numbers: list[int]) -> list[Any]:
    """An edge is the pair of its vertices."""
    if element != "edge":
        return numbers
    return [tuple(it) for it in _ends(m)[numbers].tolist()]


def _edge_faces(m: Mesh) -> Ask:
    """Where there is no face it says None, here −1."""
    ask = m.edge_faces
    return lambda edge: [-1 if it is None else it for it in ask(edge)]


def _insert(m: Mesh, faces: list[int], places: Array) -> int:
    for face, place in zip(faces, places.tolist(), strict=True):
        m.insert_vertex(face, xyz=place)
    return len(faces)


def _split(m: Mesh, edges: list[Any], places: Array) -> int:
    """Its method leaves two faces of four corners, which are split in turn."""
    for (u, v), place in zip(edges, places.tolist(), strict=True):
        faces = m.edge_faces((u, v))
        new = m.split_edge((u, v), allow_boundary=True)
        m.vertex_attributes(new, "xyz", place)
        for face in faces:
            if face is not None:
                m.split_face(face, new, m.face_vertex_descendant(face, new, n=2))
    return len(edges)


def _collapse(m: Mesh, edges: list[Any], places: Array) -> int:
    faces = m.number_of_faces()
    for edge in edges:
        if m.has_edge(edge):
            m.collapse_edge(edge)
    return int(faces - m.number_of_faces()) // 2


PEER = Peer(
    title="COMPAS",
    distribution="compas",
    site="https://compas.dev/compas/latest/",
    manual="Methods of the mesh for one element, by keys; edges are pairs of vertices. For larger "
    "meshes its manual points to libigl and others behind plug-ins. Edges it flips only inside "
    "its remeshing.",
    more="Polygons, attributes of any kind on every element, serialization, networks and "
    "volumetric meshes beside it, plug-ins into Rhino and Blender.",
    build=_build,
    faces=lambda m: int(m.number_of_faces()),
    arrays=methodcaller("to_vertices_and_faces"),
    ends=_ends,
    handles=_handles,
    single={
        "vertex_vertices": attrgetter("vertex_neighbors"),
        "vertex_edges": attrgetter("vertex_edges"),
        "vertex_faces": attrgetter("vertex_faces"),
        "edge_faces": _edge_faces,
        "face_vertices": attrgetter("face_vertices"),
        "face_edges": attrgetter("face_halfedges"),
        "face_faces": attrgetter("face_neighbors"),
    },
    operations={"split_edge": _split, "split_face": _insert, "collapse_edge": _collapse},
    algorithms={
        "vertex_normals": lambda m: [m.vertex_normal(it) for it in m.vertices()],
        "smooth": lambda m: m.smooth_centroid(kmax=1, damping=1.0),
    },
    objects=True,
)
