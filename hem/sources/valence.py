r"""Vertices of a wanted valence in a mesh of a fixed number of faces: two variables moved apart.

The mesh is as many separate bipyramids as fit, each two hubs of the wanted valence k over one rim
of k vertices, and a strip of triangles that makes up the number of faces:

      hub        2k faces, 3k edges, k + 2 vertices
     / | \       every face has one hub and two rim vertices (valence 4);
    *--*--*      two edges in three join a hub and the rim
     \ | /
      hub
"""

import numpy as np

from hem.arrays import Floats, Indices
from hem.errors import MeshError
from hem.meshes import TriangleMesh, joined
from hem.naming import whole

_LEAST = 3
_SPACING = 3.0


def valence_mesh(valence: int, n_faces: int) -> TriangleMesh:
    """A manifold mesh of exactly `n_faces` faces whose first vertices all have the valence.

    Vertices 0 … h - 1 are the hubs (see `valence_hubs`); faces come bipyramid by bipyramid. The
    bipyramids are closed and wound outward. Only the strip has a border, and it is empty when
    2 · valence divides n_faces. O(n_faces). Raises MeshError unless 3 <= valence <= n_faces / 2.
    """
    valence, n_faces = whole(valence, "a valence"), whole(n_faces, "a number of faces")
    count = len(valence_hubs(valence, n_faces)) // 2
    rest = n_faces - 2 * valence * count
    return TriangleMesh(*joined([_bipyramids(valence, count), _strip(rest)]))


def valence_hubs(valence: int, n_faces: int) -> range:
    """The vertices of `valence_mesh(valence, n_faces)` that have the wanted valence."""
    valence, n_faces = whole(valence, "a valence"), whole(n_faces, "a number of faces")
    if not _LEAST <= valence <= n_faces // 2:
        raise MeshError(
            f"no vertex of valence {valence:,} in a mesh of {n_faces:,} faces: "
            f"reachable are {_LEAST} … {n_faces // 2:,}, half the faces"
        )
    return range(n_faces // (2 * valence) * 2)


def _bipyramids(valence: int, count: int) -> tuple[Floats, Indices]:
    which = np.arange(count)
    side = int(np.ceil(np.sqrt(count)))
    centers = _SPACING * np.stack([which % side, which // side, 0 * which], axis=1)
    angle = 2 * np.pi * np.arange(valence) / valence
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    hubs = centers[:, None] + np.array([[0, 0, 1.0], [0, 0, -1.0]])
    rims = centers[:, None] + circle

    here = 2 * count + valence * which[:, None] + np.arange(valence)
    there = np.roll(here, -1, axis=1)
    upper = np.broadcast_to(2 * which[:, None], here.shape)
    above = np.stack([upper, here, there], axis=2)
    below = np.stack([upper + 1, there, here], axis=2)
    triangles = np.concatenate([above, below], axis=1)
    return np.concatenate([hubs.reshape(-1, 3), rims.reshape(-1, 3)]), triangles.reshape(-1, 3)


def _strip(n_faces: int) -> tuple[Floats, Indices]:
    """A zigzag band of triangles below the bipyramids, counterclockwise from above."""
    if n_faces == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    step = np.arange(n_faces + 2)
    points = np.stack([step / n_faces, -2.0 + 0.0 * step, 0.0 * step], axis=1) * _SPACING / 2
    points[1::2, 1] -= 1 / np.sqrt(n_faces)
    triangles = step[:n_faces, None] + np.arange(3)
    triangles[1::2] = triangles[1::2, [1, 0, 2]]
    return points, triangles
