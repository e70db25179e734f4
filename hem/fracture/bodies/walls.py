"""Which pieces have walls in common, from the triangles that their walls consist of."""

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hem.arrays import Floats, Indices
from hem.meshes import NOTHING, TriangleMesh, corners, joined, length, normals


class _Walls(NamedTuple):
    """All triangles of walls, of all pieces, ordered by wall."""

    wall: Indices  # (t,): which wall between two sites
    piece: Indices  # (t,)
    corners: Floats  # (t, 3, 3)
    normals: Floats  # (t, 3), of twice the area's length
    areas: Floats  # (t,)


def touching(pieces: Sequence[TriangleMesh], labels: Sequence[Indices], least: float) -> Indices:
    """The pairs of pieces that have an area of more than ``least`` in common: (k, 2), ascending.

    ``labels`` are those of each piece's faces, (m,): the wall a face is on, or negative. On a wall
    with one piece on each side, these two touch. Where there are more, since the body is no longer
    connected there, each triangle's middle is sought among the triangles on the other side. Cost
    O(t log t) for t triangles on walls, and quadratic in those of such a wall.
    """
    walls = _gathered(pieces, labels)
    pairs: dict[tuple[int, int], float] = defaultdict(float)
    begins = np.flatnonzero(np.diff(walls.wall, prepend=-1))
    for of_wall in np.split(np.arange(len(walls.wall)), begins)[1:]:
        one, other = _sides(walls, of_wall)
        for here, there in ((one, other), (other, one)):
            for pair, area in _met(walls, here, there).items():
                pairs[pair] = max(pairs[pair], area)
    found = sorted(pair for pair, area in pairs.items() if area > least)
    return np.array(found, np.int64).reshape(-1, 2)


def _gathered(pieces: Sequence[TriangleMesh], labels: Sequence[Indices]) -> _Walls:
    all_labels = np.concatenate([np.zeros(0, np.int64), *labels])
    points, triangles = joined([NOTHING, *((it.points, it.triangles) for it in pieces)])
    piece = np.repeat(np.arange(len(pieces)), [len(it.triangles) for it in pieces])
    order = np.argsort(all_labels, kind="stable")
    order = order[all_labels[order] >= 0]
    at = corners(points, triangles[order])
    across = normals(at)
    return _Walls(all_labels[order], piece[order], at, across, length(across) / 2)


def _sides(walls: _Walls, of_wall: Indices) -> tuple[Indices, Indices]:
    """The triangles of a wall that look one way, as its largest does, and the other way."""
    largest = of_wall[np.argmax(walls.areas[of_wall])]
    alike = walls.normals[of_wall] @ walls.normals[largest] > 0
    return of_wall[alike], of_wall[~alike]


def _met(walls: _Walls, here: Indices, there: Indices) -> dict[tuple[int, int], float]:
    """How much of the triangles here lies against which pieces' there."""
    ours, theirs = walls.piece[here], walls.piece[there]
    if len(set(ours.tolist())) == 1 and len(set(theirs.tolist())) == 1:
        facing = np.full(len(here), theirs[0])
    else:
        facing = _facing(walls, here, there)
    met: dict[tuple[int, int], float] = defaultdict(float)
    for a, b, area in zip(ours.tolist(), facing.tolist(), walls.areas[here].tolist(), strict=True):
        if b >= 0 and a != b:
            met[min(a, b), max(a, b)] += area
    return met


def _facing(walls: _Walls, here: Indices, there: Indices) -> Indices:
    """The piece there that the middle of each triangle here lies on, or -1."""
    axis = int(np.argmax(np.abs(walls.normals[here].sum(axis=0))))
    plane = [i for i in range(3) if i != axis]
    triangles = walls.corners[there][:, :, plane]
    turn = np.sign(walls.normals[there][:, axis]) * (-1 if axis == 1 else 1)
    found = np.full(len(here), -1)
    for i, middle in enumerate(walls.corners[here].mean(axis=1)[:, plane]):
        depth = np.full(len(there), np.inf)
        for j in range(3):
            side = triangles[:, (j + 1) % 3] - triangles[:, j]
            arm = middle - triangles[:, j]
            depth = np.minimum(depth, turn * (side[:, 0] * arm[:, 1] - side[:, 1] * arm[:, 0]))
        hit = np.flatnonzero((depth >= 0) & (walls.areas[there] > 0))
        if len(hit):
            found[i] = walls.piece[there[hit[np.argmax(depth[hit])]]]
    return found
