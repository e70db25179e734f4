"""Subdivision: a finer and smoother mesh of the same shape."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hem.algorithms.arguments import require_count, require_mesh
from hem.algorithms.loop import loop
from hem.algorithms.parts import side_keys
from hem.algorithms.sqrt3 import sqrt3
from hem.contract import Structure
from hem.errors import TopologyError
from hem.naming import look_up

SCHEMES: dict[str, Callable[[Structure], None]] = {"loop": loop, "sqrt3": sqrt3}
"""One step of each scheme, by name."""


def subdivide(s: Structure, scheme: str = "loop", times: int = 1) -> None:
    """Subdivide a mesh in place, so many times.

    ``loop`` makes four faces of each, ``sqrt3`` three, and leaves borders as they are; see the
    modules of these names. Three edits per time. Cost O(n_t log n_t) or O(n_t) where neighbors are
    recorded. MeshError for another scheme or number, and for polygons; TopologyError for what is no
    surface, such as two faces with the same three corners.
    """
    require_mesh(s, "subdivide")
    step = look_up(scheme, SCHEMES, "scheme")
    times = require_count("subdivide", "times", times)
    _require_surface(s)
    for _ in range(times):
        step(s)


def _require_surface(s: Structure) -> None:
    """Raise TopologyError where some splits or flips would be refused."""
    keys, faces = side_keys(s)
    crowded = keys[faces > 2]
    if len(crowded):
        edges = np.stack([crowded >> 32, crowded & 0xFFFFFFFF], axis=1)
        raise TopologyError("cannot subdivide: edges lie in more than two faces", edges=edges)
    if len(s.face_faces().values) < 2 * (faces == 2).sum():  # each neighbor is told once
        corners = np.sort(s.triangles(), axis=1)
        _, first, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
        raise TopologyError(
            "cannot subdivide: faces have the same three corners; remove one of each pair",
            faces=s.faces()[first[count > 1]],
        )
