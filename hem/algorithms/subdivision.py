"""Subdivision: a finer and smoother mesh of the same shape."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from hem.algorithms.arguments import require_count, require_mesh, require_surface
from hem.algorithms.loop import loop
from hem.algorithms.sqrt3 import sqrt3
from hem.contract import Structure
from hem.errors import MeshError
from hem.naming import look_up

SCHEMES: dict[str, tuple[Callable[[Structure], None], int]] = {
    "loop": (loop, 4),
    "sqrt3": (sqrt3, 3),
}
"""One step of each scheme, by name, and how many faces it makes of each."""


def subdivide(s: Structure, scheme: str = "loop", times: int = 1) -> None:
    """Subdivide a mesh in place, so many times.

    ``loop`` makes four faces of each, ``sqrt3`` three, and leaves borders as they are; see the
    modules of these names. Three edits per time. Cost O(n_t log n_t) or O(n_t) where neighbors are
    recorded; else a search for each split of an edge and each flip. MeshError for another scheme or
    number, for one that takes more faces than there are handles, and for polygons; TopologyError
    for edges in more than two faces and for faces with the same three corners. What a subscriber
    raises ends it after the edit that was told: the mesh is whole, but some edges may not be
    flipped yet.
    Source: Loop (1987); Kobbelt (2000).
    """
    require_mesh(s, "subdivide")
    step, parts = look_up(scheme, SCHEMES, "scheme")
    times = require_count("subdivide", "times", times)
    if s.n_faces and times > math.log(np.iinfo(np.int32).max / s.n_faces, parts):
        raise MeshError(f"subdivide takes fewer times: {times!r:.60} make too many faces")
    require_surface(s, "subdivide")
    for _ in range(times):
        step(s)
