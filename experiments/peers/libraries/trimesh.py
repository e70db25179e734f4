"""trimesh: arrays of points and triangles, and properties that are computed once and kept."""

from collections.abc import Callable
from operator import attrgetter
from typing import Any

from experiments.peers.peer import Mesh, Peer
from hem.arrays import Array

PROPERTIES = {
    "vertex_vertices": "vertex_neighbors",
    "vertex_faces": "vertex_faces",
    "edge_vertices": "edges_unique",
    "face_edges": "faces_unique_edges",
}


def _build(points: Array, triangles: Array) -> Mesh:
    from trimesh import Trimesh

    return Trimesh(points, triangles, process=False)


def _row_of(name: str) -> Callable[[Mesh], Callable[[Any], Any]]:
    """What reads the row of one element, of a property that was asked for once."""
    return lambda m: getattr(m, name).__getitem__


def _smooth(m: Mesh) -> None:
    from trimesh.smoothing import filter_laplacian

    filter_laplacian(m, iterations=1, lamb=1.0)


PEER = Peer(
    title="trimesh",
    distribution="trimesh",
    module="trimesh",
    manual="Properties of the whole mesh, computed when they are first asked for and kept until it "
    "changes; one element is then a row. A mesh changes as a whole.",
    more="Loading some thirty formats, scenes, ray casts, Booleans, voxels, mass and collision, "
    "slicing, sampling: a tool box around a mesh that stays as it is.",
    build=_build,
    faces=lambda m: len(m.faces),
    ends=attrgetter("edges_unique"),
    single={
        **{query: _row_of(name) for query, name in PROPERTIES.items()},
        "face_vertices": _row_of("faces"),
    },
    bulk={query: attrgetter(name) for query, name in PROPERTIES.items()},
    fresh=lambda m: m.copy(include_cache=False),
    algorithms={
        "vertex_normals": attrgetter("vertex_normals"),
        "smooth": _smooth,
        "simplify": lambda m, faces: len(m.simplify_quadric_decimation(face_count=faces).faces),
    },
)
