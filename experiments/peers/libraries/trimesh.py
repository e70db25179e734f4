"""trimesh: arrays of points and triangles, and properties that are computed once and kept."""

from operator import attrgetter

from experiments.peers.peer import Lazy, Peer, row_of

trimesh, smoothing = Lazy("trimesh"), Lazy("trimesh.smoothing")
PROPERTIES = {
    "vertex_vertices": "vertex_neighbors",
    "vertex_faces": "vertex_faces",
    "edge_vertices": "edges_unique",
    "face_edges": "faces_unique_edges",
}
"""No neighbors of faces: `face_adjacency` has them as pairs, and a face has no row there."""

PEER = Peer(
    title="trimesh",
    distribution="trimesh",
    site="https://trimesh.org/",
    manual="Properties of the whole mesh, computed when they are first asked for and kept until it "
    "changes; one element is then a row. A mesh changes as a whole.",
    more="Loading a dozen formats, scenes, ray casts, Booleans, voxels, mass and collision, "
    "slicing, sampling: a tool box around a mesh that stays as it is.",
    build=lambda points, triangles: trimesh.Trimesh(points, triangles, process=False),
    faces=lambda m: len(m.faces),
    arrays=attrgetter("vertices", "faces"),
    ends=attrgetter("edges_unique"),
    single={
        **{query: row_of(attrgetter(name)) for query, name in PROPERTIES.items()},
        "face_vertices": row_of(attrgetter("faces")),
    },
    bulk={query: attrgetter(name) for query, name in PROPERTIES.items()},
    fresh=lambda m: m.copy(include_cache=False),
    algorithms={
        "vertex_normals": attrgetter("vertex_normals"),
        "smooth": lambda m: smoothing.filter_laplacian(m, iterations=1, lamb=1.0),
        "simplify": lambda m, faces: len(m.simplify_quadric_decimation(face_count=faces).faces),
    },
)
