"""Triangle meshes, their sources, and what every data structure for them shares."""

from hem.edit import Edit, Remapping
from hem.errors import MeshError, NonManifoldError, TopologyError
from hem.families import FAMILIES, generate
from hem.files import load, save
from hem.manifold import require_manifold, require_sound
from hem.mesh import MeshSummary, TriangleMesh
from hem.polygons import PolygonMesh
from hem.render import RenderMesh, Upload, mesh_from_render
from hem.samples import SAMPLES, sample
from hem.valence import valence_hubs, valence_mesh

__all__ = [
    "FAMILIES",
    "SAMPLES",
    "Edit",
    "MeshError",
    "MeshSummary",
    "NonManifoldError",
    "PolygonMesh",
    "Remapping",
    "RenderMesh",
    "TopologyError",
    "TriangleMesh",
    "Upload",
    "generate",
    "load",
    "mesh_from_render",
    "require_manifold",
    "require_sound",
    "sample",
    "save",
    "valence_hubs",
    "valence_mesh",
]
