"""Triangle meshes, their sources, and what every data structure for them shares.

A name is imported when it is first asked for, so that ``import hem`` is quick and
``hem.complexity`` needs NumPy alone.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # what type checkers and editors see; the table below says it to Python
    from hem.contract.recording import Recording as Recording
    from hem.contract.recording import record as record
    from hem.edit import Edit as Edit
    from hem.edit import Remapping as Remapping
    from hem.errors import MeshError as MeshError
    from hem.errors import MeshWarning as MeshWarning
    from hem.errors import NonManifoldError as NonManifoldError
    from hem.errors import TopologyError as TopologyError
    from hem.meshes import MeshSummary as MeshSummary
    from hem.meshes import PolygonMesh as PolygonMesh
    from hem.meshes import TriangleMesh as TriangleMesh
    from hem.meshes import require_manifold as require_manifold
    from hem.meshes import require_sound as require_sound
    from hem.meshes.conversions import from_meshio as from_meshio
    from hem.meshes.conversions import from_pyvista as from_pyvista
    from hem.meshes.conversions import from_trimesh as from_trimesh
    from hem.ragged import Ragged as Ragged
    from hem.rendering import RenderMesh as RenderMesh
    from hem.rendering import Upload as Upload
    from hem.rendering import mesh_from_render as mesh_from_render
    from hem.rendering import split_at_seams as split_at_seams
    from hem.sources.families import FAMILIES as FAMILIES
    from hem.sources.families import generate as generate
    from hem.sources.files import as_mesh as as_mesh
    from hem.sources.files import load as load
    from hem.sources.files import load_polygons as load_polygons
    from hem.sources.files import save as save
    from hem.sources.named import find_mesh as find_mesh
    from hem.sources.samples import SAMPLES as SAMPLES
    from hem.sources.samples import sample as sample
    from hem.sources.valence import valence_hubs as valence_hubs
    from hem.sources.valence import valence_mesh as valence_mesh

_NAMES = {
    "hem.contract.recording": ("Recording", "record"),
    "hem.edit": ("Edit", "Remapping"),
    "hem.errors": ("MeshError", "MeshWarning", "NonManifoldError", "TopologyError"),
    "hem.meshes": (
        "MeshSummary",
        "PolygonMesh",
        "TriangleMesh",
        "require_manifold",
        "require_sound",
    ),
    "hem.meshes.conversions": ("from_meshio", "from_pyvista", "from_trimesh"),
    "hem.ragged": ("Ragged",),
    "hem.rendering": ("RenderMesh", "Upload", "mesh_from_render", "split_at_seams"),
    "hem.sources.families": ("FAMILIES", "generate"),
    "hem.sources.files": ("as_mesh", "load", "load_polygons", "save"),
    "hem.sources.named": ("find_mesh",),
    "hem.sources.samples": ("SAMPLES", "sample"),
    "hem.sources.valence": ("valence_hubs", "valence_mesh"),
}
_MODULES = {name: module for module, names in _NAMES.items() for name in names}
_ROOMS = ("algorithms", "complexity", "contract", "fracture", "meshes", "rendering", "sources")

__all__ = sorted(_MODULES)


def __getattr__(name: str) -> Any:
    """Import a public name, or a room such as ``hem.fracture``, on first use."""
    if name in _MODULES:
        value = getattr(import_module(_MODULES[name]), name)
    elif name in _ROOMS:
        value = import_module(f"hem.{name}")
    else:
        raise AttributeError(f"module 'hem' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_ROOMS})
