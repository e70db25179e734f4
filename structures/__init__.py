"""The data structures, one file each, behind one contract."""

from __future__ import annotations

from typing import Any

from hem.contract.structure import REFERENCE_TYPES, Structure
from hem.meshes.polygons import PolygonMesh, require_triangles
from hem.meshes.triangles import TriangleMesh
from structures.as_printed import AsPrinted
from structures.half_edge import HalfEdge
from structures.half_edge_objects import HalfEdgeMesh
from structures.indexed import Indexed
from structures.plankton import Plankton
from structures.triangle_neighbor import TriangleNeighbor
from structures.winged_edge import WingedEdge

REGISTRY: dict[str, type[Structure]] = {
    structure.name: structure
    for structure in (Indexed, TriangleNeighbor, WingedEdge, HalfEdge, HalfEdgeMesh, Plankton)
}
"""Every structure by name, those of the thesis' table 1 first. A new one is one entry here."""

NAMES = tuple(REGISTRY)

THESIS = ("indexed", "triangle_neighbor", "winged_edge", "half_edge")
"""Those of the thesis' table 1."""

NAMED: dict[str, Any] = {**REGISTRY, AsPrinted.name: AsPrinted}
"""Everything that has a name in a table; what is as printed is measured, and not to be used."""

__all__ = ["NAMED", "NAMES", "REGISTRY", "THESIS", "Structure", "build"]


def build(name: str, mesh: TriangleMesh | PolygonMesh, reference_bytes: int = 4) -> Structure:
    """The structure called ``name``, holding ``mesh``.

    ``reference_bytes``: 4, or 8 as the thesis counts. Cost O(n_v + n_t). Raises NonManifoldError,
    with the elements, for what the structure cannot represent, MeshError for polygons where it
    holds triangles; KeyError or ValueError for a name or a reference size that does not exist.
    """
    if name not in REGISTRY:
        raise KeyError(f"no structure is called {name!r}; there are {', '.join(NAMES)}")
    if reference_bytes not in REFERENCE_TYPES:
        raise ValueError(f"references take 4 or 8 bytes, not {reference_bytes!r}")
    kind: Any = REGISTRY[name]
    if not kind.holds_polygons:
        mesh = require_triangles(mesh)
    built: Structure = kind.build(mesh, reference_bytes)
    return built
