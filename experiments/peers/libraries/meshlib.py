"""MeshLib: half-edges in arrays, named by typed indices."""

from functools import partial
from typing import Any

import numpy as np

from experiments.peers.peer import Ask, Lazy, Mesh, Peer
from hem.arrays import Array

arrays, mr = Lazy("meshlib.mrmeshnumpy"), Lazy("meshlib.mrmeshpy")


def _handles(m: Mesh, element: str, numbers: list[int]) -> list[Any]:
    """An edge is named by one of its two half-edges."""
    made = {"vertex": mr.VertId, "face": mr.FaceId}.get(element, mr.EdgeId)
    return [made(number * (2 if element == "edge" else 1)) for number in numbers]


def _ends(m: Mesh) -> Array:
    every = _handles(m, "edge", [*range(m.topology.undirectedEdgeSize())])
    org, dest = m.topology.org, m.topology.dest
    return np.array([(int(org(it)), int(dest(it))) for it in every])


def _around(ring: str, read: str, m: Mesh) -> Ask:
    """What reads each half-edge around a vertex or in a face."""
    topology, walk = m.topology, getattr(mr, ring)
    if read == "undirected":
        return lambda handle: [int(it.undirected()) for it in walk(topology, handle)]
    at = getattr(topology, read)
    return lambda handle: [int(at(it)) for it in walk(topology, handle)]


def _both(one: str, other: str, m: Mesh) -> Ask:
    """What reads both sides or both ends of an edge."""
    first, second = getattr(m.topology, one), getattr(m.topology, other)
    return lambda edge: [int(first(edge)), int(second(edge))]


def _split(split: str, m: Mesh, handles: list[Any], places: Array) -> int:
    split_one = getattr(m, split)
    for handle, place in zip(handles, places.tolist(), strict=True):
        split_one(handle, mr.Vector3f(*place))
    return len(handles)


def _flip(m: Mesh, edges: list[Any], places: Array) -> int:
    topology = m.topology
    for edge in edges:
        topology.flipEdge(edge)
    return len(edges)


def _collapse(m: Mesh, edges: list[Any], places: Array) -> int:
    """It says whether it refused by what is left; what is told of lost edges is not needed."""
    topology = m.topology
    faces = topology.numValidFaces()
    for edge in edges:
        if not topology.isLoneEdge(edge):
            topology.collapseEdge(edge, lambda lost, kept: None)
    return int(faces - topology.numValidFaces()) // 2


def _arrays(m: Mesh) -> tuple[Array, Array]:
    m.pack()
    return arrays.getNumpyVerts(m), arrays.getNumpyFaces(m.topology)


def _smooth(m: Mesh) -> None:
    params = mr.MeshRelaxParams()
    params.iterations = 1
    mr.relax(m, params)


def _simplify(m: Mesh, faces: int) -> int:
    settings = mr.DecimateSettings()
    settings.maxError = np.finfo(np.float32).max
    settings.maxDeletedFaces = m.topology.numValidFaces() - faces
    mr.decimateMesh(m, settings)
    return int(m.topology.numValidFaces())


PEER = Peer(
    title="MeshLib",
    distribution="meshlib",
    site="https://meshlib.io/documentation/",
    manual="Arrays in and out by `mrmeshnumpy`; `orgRing` and `leftRing` of the topology around "
    "one element. Whole tasks are single calls, and its answer to most questions.",
    more="Offsets, Boolean operations, distances, registration, hole filling, point clouds and "
    "voxels, on many threads and partly on graphics processors. Not free for commercial use.",
    build=lambda points, triangles: arrays.meshFromFacesVerts(triangles, points),
    faces=lambda m: int(m.topology.numValidFaces()),
    arrays=_arrays,
    ends=_ends,
    handles=_handles,
    single={
        "vertex_vertices": partial(_around, "orgRing", "dest"),
        "vertex_edges": partial(_around, "orgRing", "undirected"),
        "vertex_faces": partial(_around, "orgRing", "left"),
        "edge_vertices": partial(_both, "org", "dest"),
        "edge_faces": partial(_both, "left", "right"),
        "face_vertices": partial(_around, "leftRing", "org"),
        "face_edges": partial(_around, "leftRing", "undirected"),
        "face_faces": partial(_around, "leftRing", "right"),
    },
    bulk={"face_vertices": lambda m: arrays.getNumpyFaces(m.topology)},
    operations={
        "split_edge": partial(_split, "splitEdge"),
        "split_face": partial(_split, "splitFace"),
        "collapse_edge": _collapse,
        "flip_edge": _flip,
    },
    algorithms={
        "vertex_normals": lambda m: arrays.toNumpyArray(mr.computePerVertNormals(m)),
        "smooth": _smooth,
        "simplify": _simplify,
    },
)
