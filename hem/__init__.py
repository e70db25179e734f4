"""Triangle meshes, their sources, and what every data structure for them shares.

A name is imported when it is first asked for, so that ``import hem`` is quick and
``hem.complexity`` needs NumPy alone.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__all__ = [
    "FAMILIES", "SAMPLES", "Edit", "MeshError", "MeshSummary", "MeshWarning", "NonManifoldError",
    "NotInstalledError", "PolygonMesh", "Ragged", "Recording", "Remapping", "RenderMesh",
    "TopologyError", "TriangleMesh", "Upload", "as_mesh", "find_mesh", "from_meshio",
    "from_pyvista", "from_trimesh", "generate", "load", "load_polygons", "mesh_from_render",
    "record", "require_manifold", "require_sound", "sample", "save", "split_at_seams",
    "valence_hubs", "valence_mesh",
]  # fmt: skip

if TYPE_CHECKING:  # what type checkers and editors see; the table below says it to Python
    from hem.contract import Recording, record
    from hem.edit import Edit, Remapping
    from hem.errors import (
        MeshError,
        MeshWarning,
        NonManifoldError,
        NotInstalledError,
        TopologyError,
    )
    from hem.meshes import (
        MeshSummary,
        PolygonMesh,
        TriangleMesh,
        from_meshio,
        from_pyvista,
        from_trimesh,
        require_manifold,
        require_sound,
    )
    from hem.ragged import Ragged
    from hem.rendering import RenderMesh, Upload, mesh_from_render, split_at_seams
    from hem.sources import (
        FAMILIES,
        SAMPLES,
        as_mesh,
        find_mesh,
        generate,
        load,
        load_polygons,
        sample,
        save,
        valence_hubs,
        valence_mesh,
    )

_NAMES = {
    "hem.contract": ("Recording", "record"),
    "hem.edit": ("Edit", "Remapping"),
    "hem.errors": ("MeshError", "MeshWarning", "NonManifoldError", "NotInstalledError",
        "TopologyError"),
    "hem.meshes": ("MeshSummary", "PolygonMesh", "TriangleMesh", "from_meshio", "from_pyvista",
        "from_trimesh", "require_manifold", "require_sound"),
    "hem.ragged": ("Ragged",),
    "hem.rendering": ("RenderMesh", "Upload", "mesh_from_render", "split_at_seams"),
    "hem.sources": ("FAMILIES", "SAMPLES", "as_mesh", "find_mesh", "generate", "load",
        "load_polygons", "sample", "save", "valence_hubs", "valence_mesh"),
}  # fmt: skip
_MODULES = {name: module for module, names in _NAMES.items() for name in names}
_ROOMS = ("algorithms", "complexity", "contract", "fracture", "meshes", "rendering", "sources")


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
