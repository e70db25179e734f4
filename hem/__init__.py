"""Triangle meshes, their sources, and what every data structure for them shares."""

from hem.errors import MeshError, NonManifoldError, TopologyError
from hem.families import FAMILIES, generate
from hem.files import load, save
from hem.manifold import require_manifold
from hem.mesh import MeshSummary, TriangleMesh
from hem.samples import SAMPLES, sample
from hem.valence import valence_hubs, valence_mesh

__all__ = [
    "FAMILIES",
    "SAMPLES",
    "MeshError",
    "MeshSummary",
    "NonManifoldError",
    "TopologyError",
    "TriangleMesh",
    "generate",
    "load",
    "require_manifold",
    "sample",
    "save",
    "valence_hubs",
    "valence_mesh",
]
