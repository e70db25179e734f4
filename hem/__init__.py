"""Triangle meshes, their sources, and what every data structure for them shares."""

from importlib import import_module
from typing import Any

from hem.edit import Edit, Remapping
from hem.errors import MeshError, NonManifoldError, TopologyError
from hem.meshes.manifold import require_manifold, require_sound
from hem.meshes.polygons import PolygonMesh
from hem.meshes.triangles import MeshSummary, TriangleMesh
from hem.rendering.render import RenderMesh, Upload, mesh_from_render
from hem.sources.families import FAMILIES, generate
from hem.sources.files import load, save
from hem.sources.samples import SAMPLES, sample
from hem.sources.valence import valence_hubs, valence_mesh

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


def __getattr__(name: str) -> Any:
    """``hem.fracture``, which brings a compiler along, when it is first asked for."""
    if name == "fracture":
        return import_module("hem.fracture")
    raise AttributeError(f"module 'hem' has no attribute {name!r}")
