"""Triangle meshes, their sources, and what every data structure for them shares."""

from hem.errors import MeshError, NonManifoldError, TopologyError
from hem.families import FAMILIES, generate
from hem.manifold import require_manifold
from hem.mesh import MeshSummary, TriangleMesh

__all__ = [
    "FAMILIES",
    "MeshError",
    "MeshSummary",
    "NonManifoldError",
    "TopologyError",
    "TriangleMesh",
    "generate",
    "require_manifold",
]
