"""Subdivision: a finer and smoother mesh of the same shape."""

from __future__ import annotations

from collections.abc import Callable

from hem.algorithms.arguments import require_count, require_mesh, require_surface
from hem.algorithms.loop import loop
from hem.algorithms.sqrt3 import sqrt3
from hem.contract import Structure
from hem.naming import look_up

SCHEMES: dict[str, Callable[[Structure], None]] = {"loop": loop, "sqrt3": sqrt3}
"""One step of each scheme, by name."""


def subdivide(s: Structure, scheme: str = "loop", times: int = 1) -> None:
    """Subdivide a mesh in place, so many times.

    ``loop`` makes four faces of each, ``sqrt3`` three, and leaves borders as they are; see the
    modules of these names. Three edits per time. Cost O(n_t log n_t) or O(n_t) where neighbors are
    recorded; else a search for each split of an edge and each flip. MeshError for another scheme or
    number, and for polygons; TopologyError for edges in more than two faces and for faces with the
    same three corners. What a subscriber raises ends it after the edit that was told: the mesh is
    whole, but some edges may not be flipped yet.
    Source: Loop (1987); Kobbelt (2000).
    """
    require_mesh(s, "subdivide")
    step = look_up(scheme, SCHEMES, "scheme")
    times = require_count("subdivide", "times", times)
    require_surface(s, "subdivide")
    for _ in range(times):
        step(s)
