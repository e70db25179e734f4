"""The Utah teapot, evaluated from Martin Newell's 32 bicubic Bézier patches (1975).

`teapot.json` holds his control points, and where the numbers were taken from.
"""

import json
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Bools, Floats, Indices
from hem.errors import MeshError
from hem.meshes import TriangleMesh, joined
from hem.naming import whole

# What is welded together. The handle touches the body in a single point of both, where a weld
# would make a vertex of two fans, which is no surface.
_SHELLS = (("rim", "body", "bottom"), ("handle",), ("spout",), ("lid",))


def teapot(tessellation: int = 10, welded: bool = True) -> TriangleMesh:
    """The teapot with each patch cut into `tessellation`² cells of two triangles each.

    It stands along +z on the xy plane, 3.15 units high, handle towards -x, wound outward. Unwelded,
    each patch has vertices of its own: 32 (n + 1)² of them and 64 n² faces, of which the 8 n at the
    cusps of lid and bottom have no area. Welded, a shell has one vertex per position and no such
    faces: 64 n² - 8 n. The shells are the body with rim and bottom, the handle, the spout and the
    lid: four surfaces with borders, as Newell drew them, that cross but share no vertex.

    O(n²). Raises MeshError for a tessellation below 1; below 2 if welded, since handle and spout
    are then flat, and both sides of them the same triangles.
    """
    least, tessellation = 2 if welded else 1, whole(tessellation, "a tessellation")
    if tessellation < least:
        kind = "welded" if welded else "unwelded"
        raise MeshError(f"the {kind} teapot needs a tessellation of {least} or more")
    _, parts = _control_points()
    if not welded:
        return _tessellated(np.ones(len(parts), bool), tessellation)
    shells = [_tessellated(np.isin(parts, it), tessellation).welded() for it in _SHELLS]
    return TriangleMesh(*joined((it.points, it.triangles) for it in shells))


@cache
def _control_points() -> tuple[Floats, NDArray[np.str_]]:
    """(32, 4, 4, 3) points, and the part that each patch belongs to."""
    data = json.loads(files("hem.sources").joinpath("teapot.json").read_text(encoding="utf-8"))
    patches = np.array(data["patches"]).reshape(-1, 4, 4)
    return np.array(data["points"])[patches], np.array(data["parts"])


def _tessellated(chosen: Bools, n: int) -> TriangleMesh:
    control, _ = _control_points()
    points = _blend(_blend(control[chosen], n).swapaxes(1, 2), n)
    one_patch = _cells(n)
    start = (n + 1) ** 2 * np.arange(len(points))
    return TriangleMesh(points.reshape(-1, 3), (start[:, None, None] + one_patch).reshape(-1, 3))


def _blend(control: Floats, n: int) -> Floats:
    """Bézier curves over the last but one axis, (…, 4, 3), at n + 1 parameters: (…, n + 1, 3).

    The sum pairs the terms that change places when a curve is run backwards, so that two patches
    find the same floating-point numbers along their common border and can be welded exactly.
    """
    t, s = np.arange(n + 1)[:, None] / n, np.arange(n, -1, -1)[:, None] / n
    p = [control[..., i, None, :] for i in range(4)]
    ends = s * s * s * p[0] + t * t * t * p[3]
    middle = 3 * (s * t * s) * p[1] + 3 * (t * s * t) * p[2]
    return ends + middle


def _cells(n: int) -> Indices:
    """Two triangles for each of the n² cells between (n + 1)² vertices."""
    grid = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    return np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3)
