"""Triangle meshes, their sources, and what every data structure for them shares."""

from hem.errors import MeshError, NonManifoldError, TopologyError
from hem.manifold import require_manifold
from hem.mesh import MeshSummary, TriangleMesh

__all__ = [
    "MeshError",
    "MeshSummary",
    "NonManifoldError",
    "TopologyError",
    "TriangleMesh",
    "require_manifold",
]
