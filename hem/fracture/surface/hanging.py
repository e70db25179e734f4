"""Faces that would be left hanging in a single point when others are taken out.

░ gone       ╲ ░ ╱         At v two fans of faces would meet that share no edge there, which no
          1   ╲ ╱   2      surface has. The one with the most area stays, and the faces of the
        ───── v ─────      other come off, too, at whose corners the same may follow.
              ╱ ╲
             ╱ ░ ╲
"""

import numpy as np

from hem.arrays import Array, Indices
from hem.contract import Remaining, Structure, remaining
from hem.meshes import areas, components, corners


def hanging(structure: Structure, gone: Array) -> Indices:
    """The faces that come off besides those that are ``gone`` (k,), in the order they do.

    Cost: ``vertex_faces`` of the vertices of all of these.
    """
    off, fresh = [np.zeros(0, np.int64)], gone
    while True:
        left = remaining(structure, np.concatenate([gone, *off]), fresh)
        at_pinched = np.isin(left.vertex, left.pinched())
        if not at_pinched.any():
            return np.concatenate(off)
        fresh = _loose(structure, Remaining(*(it[at_pinched] for it in left)))
        off.append(fresh)


def _loose(structure: Structure, left: Remaining) -> Indices:
    """The faces in fans that are not the largest at their vertex; of equal ones the first stays."""
    fan = _fans(left)
    vertices = np.sort(structure.face_vertices(left.face).values.reshape(-1, 3), axis=1)
    area = np.bincount(fan, areas(corners(structure.points, vertices)))
    first, largest = np.full(len(area), left.face.max()), np.zeros(left.vertex.max() + 1)
    np.minimum.at(first, fan, left.face)
    np.maximum.at(largest, left.vertex, area[fan])
    # Sums in another order may differ in the last digits, which must not decide.
    may_stay = area[fan] > largest[left.vertex] * (1 - 1e-9)
    stays = np.full(left.vertex.max() + 1, left.face.max())
    np.minimum.at(stays, left.vertex[may_stay], first[fan[may_stay]])
    return np.unique(left.face[first[fan] != stays[left.vertex]])


def _fans(left: Remaining) -> Array:
    """(k,): the fan of each corner, of those whose faces share no edge at the vertex."""
    k = len(left.vertex)
    _, edge = np.unique(left.edges.ravel(), return_inverse=True)
    _, label = components(3 * k, np.stack([np.tile(np.arange(k), 2), k + edge], axis=1))
    return np.unique(label[:k], return_inverse=True)[1]
