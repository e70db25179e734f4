"""Meshes as plain arrays: triangles and polygons, whether they are surfaces, and how large.

`hem.meshes.measures` has bounds, lengths, areas, normals and volume.
"""

from hem.meshes.components import NOTHING, clusters, components, joined, used_only
from hem.meshes.edges import undirected_edges
from hem.meshes.manifold import (
    euler_number,
    non_manifold_edges,
    require_manifold,
    require_sound,
    same_way_edges,
    split_vertices,
)
from hem.meshes.polygons import PolygonMesh, repeats_a_corner, require_triangles, simplest
from hem.meshes.summary import MeshSummary
from hem.meshes.triangles import TriangleMesh, repeated_corners

__all__ = [
    "NOTHING", "MeshSummary", "PolygonMesh", "TriangleMesh", "clusters", "components",
    "euler_number", "joined", "non_manifold_edges", "repeated_corners", "repeats_a_corner",
    "require_manifold", "require_sound", "require_triangles", "same_way_edges", "simplest",
    "split_vertices", "undirected_edges", "used_only",
]  # fmt: skip
