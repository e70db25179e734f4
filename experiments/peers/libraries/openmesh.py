"""OpenMesh: half-edges in arrays; its Python package is compiled from source."""

from functools import partial
from operator import methodcaller
from typing import Any

from experiments.peers.peer import Ask, Lazy, Mesh, Peer
from hem.arrays import Array

openmesh = Lazy("openmesh")


def _handles(m: Mesh, element: str, numbers: list[int]) -> list[Any]:
    return [getattr(m, f"{element}_handle")(number) for number in numbers]


def _ring(walk: str, m: Mesh) -> Ask:
    """What walks around an element with one of its iterators."""
    around = getattr(m, walk)
    return lambda handle: [it.idx() for it in around(handle)]


def _of_both_half_edges(read: str, m: Mesh) -> Ask:
    half_edge, at = m.halfedge_handle, getattr(m, read)
    return lambda edge: [at(half_edge(edge, 0)).idx(), at(half_edge(edge, 1)).idx()]


def _split(m: Mesh, handles: list[Any], places: Array) -> int:
    for handle, place in zip(handles, list(places), strict=True):
        m.split(handle, m.add_vertex(place))
    return len(handles)


def _collapse(m: Mesh, edges: list[Any], places: Array) -> int:
    done = 0
    for edge in edges:
        half_edge = m.halfedge_handle(edge, 0)
        if not m.is_deleted(edge) and m.is_collapse_ok(half_edge):
            m.collapse(half_edge)
            done += 1
    return done


def _flip(m: Mesh, edges: list[Any], places: Array) -> int:
    done = 0
    for edge in edges:
        if m.is_flip_ok(edge):
            m.flip(edge)
            done += 1
    return done


def _arrays(m: Mesh) -> tuple[Array, Array]:
    m.garbage_collection()
    return m.points(), m.face_vertex_indices()


def _normals(m: Mesh) -> Array:
    m.request_vertex_normals()
    m.request_face_normals()
    m.update_normals()
    return m.vertex_normals()


def _simplify(m: Mesh, faces: int) -> int:
    decimater, quadrics = openmesh.TriMeshDecimater(m), openmesh.TriMeshModQuadricHandle()
    decimater.add(quadrics)
    decimater.initialize()
    decimater.decimate_to_faces(0, faces)
    m.garbage_collection()
    return int(m.n_faces())


PEER = Peer(
    title="OpenMesh",
    distribution="openmesh",
    site="https://openmesh-python.readthedocs.io/",
    manual="Iterators and circulators for one element, `ff_indices` and the like for all; "
    "`is_collapse_ok` and `is_flip_ok` before what they allow.",
    more="Polygons as well as triangles, properties of any type, subdivision and decimation by "
    "modules, files with colors and normals; and all of it in C++ with kernels of one's own.",
    build=lambda points, triangles: openmesh.TriMesh(points, triangles),
    faces=lambda m: sum(not m.is_deleted(it) for it in m.faces()),
    arrays=_arrays,
    ends=lambda m: m.ev_indices(),
    handles=_handles,
    single={
        **{
            f"{source}_{target}": partial(_ring, f"{source[0]}{letter}")
            for source in ("vertex", "face")
            for target, letter in (("vertices", "v"), ("edges", "e"), ("faces", "f"))
        },
        "edge_vertices": partial(_of_both_half_edges, "to_vertex_handle"),
        "edge_faces": partial(_of_both_half_edges, "face_handle"),
    },
    bulk={
        f"{source}_{target}": methodcaller(f"{source[0]}{target[0]}_indices")
        for source in ("vertex", "edge", "face")
        for target in ("vertices", "edges", "faces")
        if (source, target) != ("edge", "edges")
    },
    operations={
        "split_edge": _split,
        "split_face": _split,
        "collapse_edge": _collapse,
        "flip_edge": _flip,
    },
    algorithms={"vertex_normals": _normals, "simplify": _simplify},
)
