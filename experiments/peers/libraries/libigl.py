"""libigl: functions of arrays; it has no mesh, and its adjacency is asked for and kept."""

from collections.abc import Callable
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import numpy as np

from experiments.peers.peer import Ask, Lazy, Mesh, Peer, Rows, row_of
from hem.arrays import Array

igl = Lazy("igl")


def _build(points: Array, triangles: Array) -> Mesh:
    """Arrays as its functions take them, and the neighbors of each triangle."""
    m = SimpleNamespace(V=points, F=triangles.astype(np.int64))
    m.TT = igl.triangle_triangle_adjacency(m.F)[0]
    return m


def _handles(m: Mesh, element: str, numbers: list[int]) -> list[int]:
    """Edges have the same numbers in what collapses them, which writes into its arrays."""
    if element == "edge":
        m.V, m.flaps = m.V.copy(), igl.edge_flaps(m.F)
    return numbers


def _collapse(m: Mesh, edges: list[int], places: Array) -> int:
    """Into one end; it says that it refused by an error."""
    (ends, *more), done = m.flaps, 0
    for edge in edges:
        with suppress(RuntimeError):
            igl.collapse_edge(edge, m.V[ends[edge, 0]], m.V, m.F, ends, *more)
            done += 1
    return done


def _arrays(m: Mesh) -> tuple[Array, Array]:
    """Of a face that is gone all corners are 0."""
    points, triangles, *_ = igl.remove_unreferenced(m.V, m.F[m.F.any(axis=1)])
    return points, triangles


def _topology(m: Mesh) -> Any:
    return igl.edge_topology(m.V, m.F)


def _faces_of_vertex(m: Mesh) -> Ask:
    values, begin = BULK["vertex_faces"](m)
    return lambda vertex: values[begin[vertex] : begin[vertex + 1]]


BULK: dict[str, Callable[[Mesh], Rows]] = {
    "vertex_vertices": lambda m: igl.adjacency_list(m.F),
    "vertex_faces": lambda m: igl.vertex_triangle_adjacency(m.F, len(m.V)),
    "edge_vertices": lambda m: _topology(m)[0],
    "edge_faces": lambda m: _topology(m)[2],
    "face_edges": lambda m: _topology(m)[1],
    "face_faces": lambda m: igl.triangle_triangle_adjacency(m.F)[0],
}

PEER = Peer(
    title="libigl",
    distribution="libigl",
    module="igl",
    site="https://libigl.github.io/",
    manual="A function from vertices and faces to all answers at once; one element is then a row "
    "of that. Its page on design says why there is no mesh class. `collapse_edge` is for closed "
    "meshes, after `edge_flaps`.",
    more="Discrete operators (Laplacians, gradients, geodesics), parametrization, deformation, "
    "Booleans, quadric simplification and much else of geometry processing, over sparse matrices.",
    build=_build,
    faces=lambda m: int(m.F.any(axis=1).sum()),
    arrays=_arrays,
    ends=BULK["edge_vertices"],
    handles=_handles,
    single={
        **{query: row_of(rows) for query, rows in BULK.items() if query != "vertex_faces"},
        "vertex_faces": _faces_of_vertex,
        "face_vertices": row_of(lambda m: m.F),
    },
    bulk=BULK,
    operations={"collapse_edge": _collapse},
    algorithms={
        "vertex_normals": lambda m: igl.per_vertex_normals(m.V, m.F),
        "simplify": lambda m, faces: len(igl.qslim(m.V, m.F.astype(np.int32), faces)[1]),
    },
)
