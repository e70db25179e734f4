"""Voronoi cells as closed meshes that fit together: each wall is cut into triangles only once.

Two cells on either side of a wall have the very same triangles there, one the other way round. So
do cells and what is left when they are taken out, and nothing is between them, not even slivers.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from hem.arrays import Bools, Floats, Indices
from hem.fracture.bodies.solid import to_manifold
from hem.meshes import used_only

_FAR = 4.0  # how far off six sites are that close the outer cells, in radii of all that matters


@dataclass(frozen=True, eq=False)
class Cells:
    """The Voronoi cells of n sites, the walls between them in triangles.

    The part of space is finite: six sites far off, which are no cells here, end it.

    ::

        front  ┊→ back      seen from the back, a triangle's corners run counterclockwise;
               ┊            it is outward as a part of the cell in front
    """

    sites: Floats  # (n, 3)
    vertices: Floats  # (v, 3)
    triangles: Indices  # (t, 3) vertices
    walls: Indices  # (t,): the wall a triangle is a part of
    front: Indices  # (t,): the site before it; those of the six are n …
    back: Indices  # (t,): the site behind it

    def union(self, chosen: Bools, first_label: int = 0) -> Any:
        """Some of the n cells together, as a body for manifold3d. O(t).

        Its faces are labeled ``first_label`` + wall. Of sites in general position: of cells that
        meet in an edge only manifold3d may make another body, and does not say so.
        """
        of = np.append(chosen, np.zeros(6, bool))
        outward, inward = of[self.front] & ~of[self.back], of[self.back] & ~of[self.front]
        triangles = np.concatenate([self.triangles[outward], self.triangles[inward][:, ::-1]])
        labels = np.concatenate([self.walls[outward], self.walls[inward]]) + first_label
        return to_manifold(*used_only(self.vertices, triangles), labels)

    def cell(self, site: int, first_label: int = 0) -> Any:
        """One cell, as a body for manifold3d. O(t)."""
        return self.union(np.arange(len(self.sites)) == site, first_label)


def cells(sites: Floats, center: Floats, radius: float) -> Cells:
    """The cells of n different sites (n, 3), which fill the ball of a radius around a center.

    They are found in coordinates from the center, as Qhull squares them.

    Source: Qhull, by way of scipy (Barber et al., The quickhull algorithm for convex hulls, 1996).
    """
    from scipy.spatial import Voronoi

    extent = max(radius, float(np.abs(sites - center).max()))
    far = center + _FAR * extent * np.concatenate([np.eye(3), -np.eye(3)])
    diagram = Voronoi(np.concatenate([sites, far]) - center)
    triangles, walls, sides = [], [], []
    pairs = diagram.ridge_points.tolist()
    for wall, (corners, (a, b)) in enumerate(zip(diagram.ridge_vertices, pairs, strict=True)):
        if -1 in corners:  # infinite walls lie between two of the six
            continue
        arms = diagram.vertices[corners[1:]] - diagram.vertices[corners[0]]
        across = diagram.points[b] - diagram.points[a]
        from_b = np.cross(arms[:-1], arms[1:]).sum(axis=0) @ across > 0  # counterclockwise
        fan = [(corners[0], *two) for two in pairwise(corners[1:])]
        triangles += fan
        walls += [wall] * len(fan)
        sides += [(a, b) if from_b else (b, a)] * len(fan)
    front, back = np.array(sides, np.int64).T
    made = np.array(triangles, np.int64), np.array(walls)
    return Cells(sites, diagram.vertices + center, *made, front, back)
