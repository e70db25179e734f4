"""The data structures, one file each, behind one contract.

Whatever class in this folder fulfills ``hem.contract.Structure`` is found: a new structure is a new
file, and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

import numpy as np

from hem.contract import REFERENCE_TYPES, Described, Structure
from hem.errors import MeshError
from hem.meshes import require_triangles
from hem.naming import look_up
from hem.sources import as_mesh

NAMED: dict[str, Any] = {}
"""Everything that has a name in a table; what is as published is measured, and not to be used."""


def find_described(folders: Iterable[str], package: str) -> dict[str, Any]:
    """Every class with a name that a module in a package's folders defines, by name and in order.

    Raises TypeError for a class that forgets a part, has the name or the look of another, or
    claims what is claimed of none.
    """
    found = [
        it
        for module in iter_modules(folders, f"{package}.")
        for it in vars(import_module(module.name)).values()
        if isinstance(it, type) and issubclass(it, Described) and it.__module__ == module.name
    ]
    found.sort(key=lambda it: (it.order, it.name))
    for part in ("name", "abbreviation", "look"):  # which it may have inherited
        known: dict[Any, Any] = {}
        for it in found:
            other = known.setdefault(own := getattr(it, part), it)
            if other is not it:
                raise TypeError(f"{it.__module__} and {other.__module__} have one {part}: {own!r}")
    names = {"", *NAMED, *(it.name for it in found)}
    for it in found:
        if not it.name.isidentifier():
            raise TypeError(f"{it.__module__}: its name is {it.name!r}, no word such as half_edge")
        if hasattr(it, "claims") and it.claims.like not in names:
            raise TypeError(f"{it.__module__} claims what is claimed of no {it.claims.like!r}")
    return {it.name: it for it in found}


NAMED |= find_described(__path__, __name__)

REGISTRY: dict[str, type[Structure]] = {
    name: it for name, it in NAMED.items() if issubclass(it, Structure)
}
"""Every structure by name, those of the thesis' table 1 first."""

NAMES = tuple(REGISTRY)
"""Their names."""

THESIS = tuple(name for name, it in NAMED.items() if it.thesis)
"""Those of the thesis' table 1."""

__all__ = ["NAMED", "NAMES", "REGISTRY", "THESIS", "Structure", "build"]


def build(name: str, mesh: Any, reference_bytes: int = 4, *, compiled: bool = True) -> Structure:
    """The structure called ``name``, holding ``mesh``.

    >>> s = structures.build("half_edge", hem.valence_mesh(6, 12))
    >>> s.vertex_faces(0)
    array([1, 2, 3, 4, 5, 0], dtype=int32)

    ``mesh`` is a ``TriangleMesh``, a ``PolygonMesh``, or what else ``hem.as_mesh`` takes: a path,
    a pair of arrays, the mesh of another library, another structure. Positions are held as float32,
    see ``TriangleMesh``. ``reference_bytes``: 4, or 8 as the thesis counts. ``compiled``: see
    ``Structure.uncompiled``.

    Cost O(n_v + n_t). Raises NonManifoldError, with the elements, for what the structure cannot
    represent, MeshError for polygons where it holds triangles, for what is no mesh, and for a name
    or a reference size that does not exist.
    """
    kind: Any = look_up(name, REGISTRY, "structure")
    if not (isinstance(reference_bytes, int | np.integer) and reference_bytes in REFERENCE_TYPES):
        raise MeshError(f"references take 4 or 8 bytes, not {reference_bytes!r}")
    given = as_mesh(mesh).astype(np.float32)
    if not kind.holds_polygons:
        able = " or ".join(it for it in NAMES if REGISTRY[it].holds_polygons)
        given = require_triangles(given, f"build {able}")
    built: Structure = (kind if compiled else kind.uncompiled()).build(given, reference_bytes)
    return built
