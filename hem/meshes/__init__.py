"""Meshes as plain arrays: triangles and polygons, whether they are surfaces, and how large."""

from hem.meshes.components import NOTHING, clusters, components, joined, used_only
from hem.meshes.conversions import from_any, from_meshio, from_pyvista, from_trimesh
from hem.meshes.convertible import position_type
from hem.meshes.edges import foretold, undirected_edges
from hem.meshes.manifold import (
    euler_number,
    non_manifold_edges,
    require_manifold,
    require_sound,
    same_way_edges,
    split_vertices,
)
from hem.meshes.measures import (
    areas,
    bounds,
    corners,
    diagonal,
    direction,
    dot,
    length,
    normals,
    position,
    unit,
    volume,
)
from hem.meshes.polygons import PolygonMesh, repeats_a_corner, require_triangles, simplest
from hem.meshes.summary import MeshSummary
from hem.meshes.triangles import TriangleMesh, read_only, repeated_corners

__all__ = [
    "NOTHING", "MeshSummary", "PolygonMesh", "TriangleMesh", "areas", "bounds", "clusters",
    "components", "corners", "diagonal", "direction", "dot", "euler_number", "foretold",
    "from_any", "from_meshio", "from_pyvista", "from_trimesh", "joined", "length",
    "non_manifold_edges", "normals", "position", "position_type", "read_only",
    "repeated_corners", "repeats_a_corner", "require_manifold", "require_sound",
    "require_triangles", "same_way_edges", "simplest", "split_vertices", "undirected_edges",
    "unit", "used_only", "volume",
]  # fmt: skip
