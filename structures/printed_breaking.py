"""The thesis' listings of breaking (4.4) and of finding edges (5), and the walk that it quotes.

Told anew over ``structures.as_printed``. What a listing calls and no document prints is as plain as
it can be. Nothing here checks anything, and errors are left as they are.
"""

from collections.abc import Iterator, Sequence
from math import cos, pi, sin, sqrt
from random import Random
from typing import Any

import numpy as np

from hem.arrays import Array
from structures.as_printed import AsPrinted
from structures.objects import Face, Point
from structures.plankton import Plankton

NEAR = 1e-5  # how far beside a triangle a point may lie that it contains; a part of its size
RUNAWAY = 999


def simulate_breaking(
    mesh: AsPrinted, impact: Point, circles: Sequence[int], seed: int = 0
) -> list[AsPrinted]:
    """``SimulateBreaking`` (4.4) -> the shards. Cost O(n_t) per break point and per shard.

    ``circles``: what ``GetMaterialBreakingBehaviour`` gives, break points per circle.
    """
    impacted = face_containing(mesh, impact)
    if impacted is None:
        return []
    break_points = breaking_points(impact, circles, seed)
    half_edges = mesh.face_circulator(impacted)
    known = len(mesh.faces)
    mesh.split_face(impacted, impact)
    for h in half_edges:
        mesh.split_half_edge(h, _middle(h.origin.point, h.end.point))
    for point in break_points:
        face = face_containing(mesh, point)
        if face is not None:
            mesh.split_face(face, point)
    shards = []
    for face in mesh.faces[known:]:  # what GetCreatedFaces gives
        corners = [h.origin.point for h in mesh.face_circulator(face)]
        shard = AsPrinted()
        shard.create_mesh(*corners)
        shards.append(shard)
        mesh.remove_face(face)
    return shards


def breaking_points(impact: Point, circles: Sequence[int], seed: int = 0) -> list[Point]:
    """``GetBreakingPoints`` (4.4): scattered in x and z, each circle a disc of radius i + 0.5.

    It looks up the corners of the face that is hit, too, and does not use them.
    """
    x, y, z = impact
    random, found = Random(seed), []
    for i, count in enumerate(circles):
        for _ in range(count):  # Random.insideUnitCircle
            far, angle = (i + 0.5) * sqrt(random.random()), 2 * pi * random.random()
            found.append((x + far * cos(angle), y, z + far * sin(angle)))
    return found


def face_containing(mesh: AsPrinted, point: Point) -> Face | None:
    """``TryGetFaceContainingPoint``, of which only the name is printed: a scan. Cost O(n_t)."""
    for face in mesh.faces:
        if _contains([h.origin.point for h in mesh.face_circulator(face)], point):
            return face
    return None


def find_edges(triangles: Any, a: int, b: int) -> list[int]:
    """``findEdges`` (5): where the triangles begin that have both corners. Cost O(n_t).

    ``triangles``: flat, three indices each.
    """
    result = []
    for i in range(0, len(triangles), 3):
        matches = 0
        for k in range(3):
            corner = triangles[i + k]
            matches += corner == a or corner == b
        if matches == 2:
            result.append(i)
    return result


def quad() -> tuple[Array, Array]:
    """``CreateMesh`` (2.3): a square of two triangles, as a render mesh. (4, 3), (6,) clockwise."""
    return np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0)]), np.array([0, 1, 2, 2, 1, 3])


def quoted_circulator(mesh: Plankton, half_edge: int) -> Iterator[int]:
    """Plankton's ``GetVertexCirculator`` as thesis 5 quotes it. Cost O(n_ev)."""
    if half_edge < 0 or half_edge > len(mesh.half_edges()):
        return
    h, count = half_edge, 0
    while True:
        yield h
        h = mesh.next_half_edge(mesh.pair(h))
        if h < 0:
            raise LookupError("Unset index, cannot continue.")
        if count > RUNAWAY:
            raise LookupError("Runaway vertex circulator")
        count += 1
        if h == half_edge:
            return


def _middle(a: Point, b: Point) -> Point:
    """``VectorMath.GetIntermediateVector``."""
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2


def _contains(corners: Sequence[Point], p: Point) -> bool:
    """Whether a triangle contains a point."""
    sides = [_minus(corners[(i + 1) % 3], corners[i]) for i in range(3)]
    normal = _cross(sides[0], sides[1])
    area = _dot(normal, normal)
    ways = [_minus(p, corner) for corner in corners]
    above = abs(_dot(ways[0], normal)) <= NEAR * area**0.75
    inside = (_dot(_cross(*it), normal) >= -NEAR * area for it in zip(sides, ways, strict=True))
    return area > 0 and above and all(inside)


def _minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Point, b: Point) -> Point:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
