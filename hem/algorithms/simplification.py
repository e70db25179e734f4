"""Simplification: the cheapest edge is collapsed, again and again.

What an edge costs is told by error quadrics, or by its length. Borders have planes of their own,
which stand upright on their faces, so that they keep their shape. An edge is passed over where a
face would turn over, or where the surface would break.

Source: Garland & Heckbert, Surface Simplification Using Quadric Error Metrics (1997).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hem.algorithms.arguments import require_count, require_length, require_mesh
from hem.algorithms.buckets import queue_for
from hem.algorithms.collapsing import (
    BORDER,
    INTO,
    QUADRICS,
    ROW,
    SHORTEST_EDGE,
    Plan,
    simplifying,
)
from hem.algorithms.parts import NO_WORK, change, from_smallest, sides_of
from hem.algorithms.quadrics import WIDTH, add_quadrics
from hem.arrays import Array, Floats
from hem.contract import Structure
from hem.errors import MeshError
from hem.naming import look_up

MEASURES = {"quadrics": QUADRICS, "shortest_edge": SHORTEST_EDGE}
"""What an edge costs."""

LEAST_COSINES = (0.7, 0.2)
"""How far the normal of a face may turn in one collapse, and once nothing else is left."""


def simplify(
    s: Structure,
    vertices: int | None = None,
    faces: int | None = None,
    error: float | None = None,
    by: str = "quadrics",
) -> None:
    """Simplify a mesh in place until so few vertices or faces are left, or all else is worse.

    Of vertices those count that have faces; the others stay, as no edge leads to them.
    ``quadrics`` collapses the edge whose planes are least far from where its vertex comes to lie,
    ``shortest_edge`` about the shortest, into one of its ends; that keeps borders as they are.
    ``error`` is the most that a collapse may cost: the root of the mean squared distance to these
    planes, or the length of the edge. It bounds one collapse: once none is left, planes are found
    anew on what there is, again and again, so that the surface may end several times as far away.
    Fewer than asked for are collapsed where faces would turn over or the surface would break.
    Handles of what stays are kept; ``compact`` renumbers.

    An edit, or some where edges have to be tried again. Cost O(n_v log n_v) for bounded
    valence; where neighbors are searched for or found anew, that for each collapse. MeshError for
    polygons, for another measure or number, and where nothing is said to stop at.
    Source: Garland & Heckbert (1997).
    """
    require_mesh(s, "simplify")
    measure = look_up(by, MEASURES, "measure")
    if vertices is None and faces is None and error is None:
        raise MeshError("simplify takes vertices, faces or error: what to stop at")
    most = [
        require_count("simplify", name, 0 if value is None else value)
        for name, value in (("vertices", vertices), ("faces", faces))
    ]
    if vertices is not None:
        most[0] += _without_faces(s)
    bound = np.inf if error is None else require_length("simplify", "error", error)
    for cosine in LEAST_COSINES:
        left = s.n_vertices + 1
        while s.n_vertices < left and s.n_vertices > most[0] and s.n_faces > most[1]:
            left = s.n_vertices
            plan = collapsible(s, measure, cosine, bound, most)
            change(s, "simplify", simplifying, plan)


def _without_faces(s: Structure) -> int:
    used = np.zeros(len(s.points), np.bool_)
    used[s.triangles()] = True
    return s.n_vertices - int(np.count_nonzero(used))


def collapsible(
    s: Structure,
    measure: int,
    cosine: float,
    error: float,
    most: Sequence[int] = (0, 0),
    longest: float = np.inf,
) -> Plan:
    """A plan to begin with, all of it from the triangles, each from its smallest corner."""
    edges, middle, rows = _known(s, measure != SHORTEST_EDGE)
    become = np.zeros((len(rows), 2), np.int32)
    become[:, INTO] = np.arange(len(rows))
    with np.errstate(over="ignore"):  # what is infinite squared bounds nothing
        bounds = np.square([[error], [longest]])
    return Plan(
        most=np.array(most),
        error=bounds[0],
        longest=bounds[1],
        cosine=np.array([cosine]),
        measure=np.array([measure]),
        edges=edges,
        stamp=np.zeros(len(edges), np.int32),
        next=np.zeros(1, np.int64),
        middle=middle,
        rows=rows,
        become=become,
        target=np.zeros(3),
        sum=np.zeros(WIDTH),
        queue=queue_for(len(edges)),
        work=NO_WORK,
    )


def _known(s: Structure, planes: bool) -> tuple[Array, Floats, Floats]:
    """(k, 2) ends of edges, (3,) the middle, (n, ROW) what is known of vertices; see ``Plan``."""
    triangles, n = from_smallest(s.triangles()), len(s.points)
    edges, _, alone = sides_of(triangles, n)
    faces, sides = np.nonzero(alone)
    borders = triangles[faces[:, None], (sides[:, None] + np.arange(3)) % 3]
    rows = np.zeros((n, ROW))
    rows[borders[:, :2], BORDER] = 1
    alive = s.points[s.vertices()].astype(np.float64)
    middle = (alive.min(axis=0) + alive.max(axis=0)) / 2 if len(alive) else np.zeros(3)
    np.subtract(s.points, middle, out=rows[:, :3])
    if planes:
        add_quadrics(rows, triangles, borders)
    return edges, middle, rows
