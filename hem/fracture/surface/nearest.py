"""The face nearest to a position: by walking there, and by looking at every face."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.algorithms import nearest_weights, require_mesh
from hem.arrays import Array, Floats
from hem.contract import Structure
from hem.engine import kept
from hem.errors import MeshError
from hem.fracture.surface.breaking import JUMP, finding, make_plan
from hem.meshes import bounds, corners, length
from hem.meshes import position as as_position

ROUNDING = 32 * float(np.finfo(np.float32).eps)  # on a surface: a part of the largest coordinate
NEAR = 1e-3  # how far from its face a walk may end and be believed: of the face's longest side
FAR = 0.5  # how far from the surface a position may be at all: a part of the diagonal


class Found(NamedTuple):
    """The face nearest to a position, and how it was found.

    point    (3,): where on the face
    visited  how many faces were looked at
    scanned  whether every face was
    """

    face: int
    point: Floats
    visited: int
    scanned: bool


@np.errstate(over="ignore")
def nearest_face(structure: Structure, position: ArrayLike, start: int = JUMP) -> Found:
    """The face nearest to a position (3,), found by walking from face to face over ``face_faces``.

    The walk begins at the nearest of n_t^(1/3) faces (Mücke, Saias & Zhu, Fast randomized point
    location without preprocessing, 1996), or at ``start``. It is believed where the position lies
    on the face that it ends in, or beside it by a thousandth of its longest side or 32 roundings.
    Elsewhere another face may be nearer, such as the other side of a thin plate, and every face is
    looked at.

    Cost where the walk is believed O(n_t^(1/3)), from ``start`` O(√n_t), times that of
    ``face_faces``; else O(n_v + n_t). Raises MeshError for no position, one farther from the
    surface than half the diagonal of the bounding box, a start that is no face, a mesh without
    faces, and for polygons.
    """
    require_mesh(structure, "nearest_face")
    p = as_position(position)
    if start != JUMP:
        structure.face_vertices(start)  # raises for what is no face
    out, log = structure.scratch(0)
    plan = make_plan(p, 0.0, out, log, start=np.array([start]))
    face = structure.run(finding, plan)
    if face >= 0:
        _, point = closest(face_corners(structure, np.array([face])), p)
        near = max(ROUNDING * float(np.abs(plan.xyz).max()), NEAR * float(plan.longest[0]))
        if length(point - p) <= near:
            return Found(face, point, int(plan.visited[0]), False)
    found, (low, high) = scanned(structure, p), bounds(structure.points)
    far, size = length(found.point - p), length(high - low)
    if far > FAR * size:
        raise MeshError(
            f"{_words(p)} is {far:.4g} from the mesh, more than half of its size {size:.4g}; "
            f"the nearest point on it is {_words(found.point)}"
        )
    return found


def scanned(structure: Structure, position: ArrayLike) -> Found:
    """The same by looking at every face, the first of those that are equally near. Cost O(n_t)."""
    require_mesh(structure, "scanned")
    p, faces = as_position(position), structure.faces()
    if not len(faces):
        raise MeshError("there are no faces that could be near to anything")
    nearest, point = closest(face_corners(structure, faces), p)
    return Found(int(faces[nearest]), point, len(faces), True)


def corner_vertices(structure: Structure, faces: Array) -> Array:
    """(k, 3): the corners of triangles, from the smallest vertex on, as all structures agree."""
    vertices = structure.face_vertices(faces).values.reshape(-1, 3)
    turned = (vertices.argmin(axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(vertices, turned, axis=1)


def face_corners(structure: Structure, faces: Array) -> Floats:
    """(k, 3, 3): where the corners of faces are, from the smallest vertex on."""
    return corners(structure.points, corner_vertices(structure, faces))


def _words(p: Array) -> str:
    return f"({', '.join(f'{x:.6g}' for x in p.tolist())})"


@kept
def closest(corners: Array, p: Array) -> tuple[int, Array]:
    """Of triangles (k, 3, 3) the first nearest to p (3,), and the point on it. Cost O(k)."""
    best, least, point = -1, np.inf, np.zeros(3)
    for i in range(len(corners)):
        u, v, w = nearest_weights(corners[i], p)
        apart = 0.0
        for j in range(3):
            apart += (
                u * corners[i, 0, j] + v * corners[i, 1, j] + w * corners[i, 2, j] - p[j]
            ) ** 2
        if apart < least:
            best, least = i, apart
            for j in range(3):
                point[j] = u * corners[i, 0, j] + v * corners[i, 1, j] + w * corners[i, 2, j]
    return best, point
