"""Taking out what rounding has left of no length, so that a closed surface stays closed."""

import numpy as np

from hem.arrays import Array, Bools
from hem.meshes import TriangleMesh, undirected_edges, used_only


def collapsed(mesh: TriangleMesh, labels: Array) -> tuple[TriangleMesh, Array]:
    """The mesh with edges of no length collapsed, and the labels (m,) of the faces that are left.

    One vertex, three edges and two faces fewer each time; the shape is the same. An edge stays
    whose two ends have more neighbors in common than the corners across it, as two sheets would
    come to hang together there. Cost O(m log m), and O(m) for each such edge.
    """
    points, triangles = mesh.points, mesh.triangles.copy()
    alive = np.ones(len(triangles), bool)
    found = True
    while found:
        found = False
        edges, _ = undirected_edges(triangles[alive])
        for keep, drop in edges[(points[edges[:, 0]] == points[edges[:, 1]]).all(axis=1)]:
            found |= _collapse(triangles, alive, keep, drop)
    if alive.all():
        return mesh, labels
    return TriangleMesh(*used_only(points, triangles[alive])), labels[alive]


def _collapse(triangles: Array, alive: Bools, keep: int, drop: int) -> bool:
    """Put one vertex in place of another -> whether they were joined by an edge that may go."""
    of_keep = alive & (triangles == keep).any(axis=1)
    of_drop = alive & (triangles == drop).any(axis=1)
    across = of_keep & of_drop
    common = np.intersect1d(triangles[of_keep], triangles[of_drop])
    # Two ends, two corners across; four faces or more, or a tetrahedron would fold flat.
    few = (of_keep | of_drop).sum() <= 4
    if across.sum() != 2 or len(common) != 4 or few:
        return False
    alive[across] = False
    rows = triangles[of_drop]
    rows[rows == drop] = keep
    triangles[of_drop] = rows
    return True
