"""Whether a position is inside a closed surface.

Only + - and *, element by element and in one order: the answers are the same on every machine.
Triangles are given as their corners, (m, 3, 3) float64.
"""

import numpy as np

from hem.arrays import Floats, Indices
from hem.meshes.measures import dot, normals


def windings(corners: Floats, at: Floats) -> Indices:
    """How many times a closed surface winds around each of k positions: (k,), 0 outside.

    Indices the faces above each position, those that look up less those that look down. Two faces
    decide on which side of their common edge a position is by the same numbers, so that one of
    them is hit and never both. Positions within rounding of the surface may go either way.
    Cost O(m) for each position.
    """
    low, high = corners.min(axis=1), corners.max(axis=1)
    found = np.zeros(len(at), np.int64)
    for i, p in enumerate(at):
        near = (low[:, 0] <= p[0]) & (p[0] <= high[:, 0]) & (low[:, 1] <= p[1])
        near &= (p[1] <= high[:, 1]) & (p[2] <= high[:, 2])
        faces = corners[near]
        turn = _turns(faces, p)
        above = dot(normals(faces), faces[:, 0] - p) * turn > 0
        found[i] = turn[above].sum()
    return found


def _turns(faces: Floats, p: Floats) -> Indices:
    """+1 for the faces over or under p that look up, -1 for those that look down, else 0: (m,).

    Each is a triangle in the plane, and is wound around p as often as its sides to the right of p
    go up rather than down.
    """
    turn = np.zeros(len(faces), np.int64)
    for i in range(3):
        a, b = faces[:, i], faces[:, (i + 1) % 3]
        up = (a[:, 1] <= p[1]) & (p[1] < b[:, 1])
        down = (b[:, 1] <= p[1]) & (p[1] < a[:, 1])
        lower, upper = np.where(up[:, None], a, b), np.where(up[:, None], b, a)
        side = upper - lower
        right = side[:, 0] * (p[1] - lower[:, 1]) - side[:, 1] * (p[0] - lower[:, 0]) > 0
        turn += (up & right).astype(np.int64) - (down & right)
    return turn
