"""libigl: functions of arrays; it has no mesh, and its adjacency is asked for and kept."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from experiments.peers.peer import Mesh, Peer, Rows
from hem.arrays import Array


def _build(points: Array, triangles: Array) -> Mesh:
    """Arrays as its functions take them, and the neighbors of each triangle."""
    import igl

    m = SimpleNamespace(V=points, F=triangles.astype(np.int64), igl=igl)
    m.TT = igl.triangle_triangle_adjacency(m.F)[0]
    return m


def _topology(m: Mesh) -> Any:
    return m.igl.edge_topology(m.V, m.F)


def _of_vertices(m: Mesh) -> Rows:
    values, begin = m.igl.vertex_triangle_adjacency(m.F, len(m.V))
    return values, begin


def _row_of(rows: Callable[[Mesh], Any]) -> Callable[[Mesh], Callable[[Any], Any]]:
    """What reads the row of one element, of an array that was asked for once."""
    return lambda m: rows(m).__getitem__


def _faces_of_vertex(m: Mesh) -> Callable[[int], Any]:
    values, begin = _of_vertices(m)
    return lambda vertex: values[begin[vertex] : begin[vertex + 1]]


def _neighbors(m: Mesh) -> Rows:
    return m.igl.adjacency_list(m.F)


BULK: dict[str, Callable[[Mesh], Rows]] = {
    "vertex_vertices": _neighbors,
    "vertex_faces": _of_vertices,
    "edge_vertices": lambda m: _topology(m)[0],
    "edge_faces": lambda m: _topology(m)[2],
    "face_edges": lambda m: _topology(m)[1],
    "face_faces": lambda m: m.igl.triangle_triangle_adjacency(m.F)[0],
}

PEER = Peer(
    title="libigl",
    distribution="libigl",
    module="igl",
    manual="A function from vertices and faces to all answers at once; one element is then a row "
    "of that. Its page on design says why there is no mesh class.",
    more="Discrete operators (Laplacians, gradients, geodesics), parametrization, deformation, "
    "Booleans, quadric simplification and much else of geometry processing, over sparse matrices.",
    build=_build,
    faces=lambda m: len(m.F),
    ends=lambda m: _topology(m)[0],
    single={
        **{query: _row_of(rows) for query, rows in BULK.items() if query != "vertex_faces"},
        "vertex_faces": _faces_of_vertex,
        "face_vertices": _row_of(lambda m: m.F),
    },
    bulk=BULK,
    algorithms={
        "vertex_normals": lambda m: m.igl.per_vertex_normals(m.V, m.F),
        "simplify": lambda m, faces: len(m.igl.qslim(m.V, m.F.astype(np.int32), faces)[1]),
    },
)
