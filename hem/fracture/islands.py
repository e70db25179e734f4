"""Parts that nothing holds together."""

import numpy as np

from hem.meshes import TriangleMesh, components, used_only
from hem.meshes.measures import areas, corners


def islands(mesh: TriangleMesh) -> list[TriangleMesh]:
    """The connected parts of a mesh, the largest by area first, without vertices no face uses.

    Faces are connected that share a vertex. Vertices and faces keep their order. Cost O(n + m).
    """
    triangles = mesh.triangles
    if not len(triangles):
        return []
    _, label = components(len(mesh.points), np.concatenate([triangles[:, :2], triangles[:, 1:]]))
    part = label[triangles[:, 0]]
    area = np.bincount(part, areas(corners(mesh.points, triangles)))
    return [
        TriangleMesh(*used_only(mesh.points, triangles[part == i]))
        for i in np.argsort(-area, kind="stable")
        if (part == i).any()
    ]
