"""Smoothing: every vertex toward the mean of its neighbors, again and again.

Sources: Sieger & Botsch (2011) for the pass; Taubin, A Signal Processing Approach to Fair Surface
Design (1995), for the one that hardly shrinks what it smooths.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_count, require_mesh
from hem.algorithms.parts import cornering, living_face, living_vertex, locating, move, not_finite
from hem.arrays import Array, Floats, Indices, Points
from hem.authoring import FACE_END, VALENCE, Kernel, Kernels, Sum, is_point, kernel, sums
from hem.contract import Structure
from hem.naming import look_up

SPREAD = 0x2545F491
"""An odd number that takes vertices that are near each other far apart."""

BORDER = -1
"""Where in a plan is told what goes for vertices on the border."""

METHODS = {"laplace": (1.0,), "taubin": (0.5, -0.53)}
"""How far vertices go toward the mean in the passes of one iteration; away from it is negative."""


class Around(NamedTuple):
    """What is found of the neighbors of every vertex."""

    sums: Floats  # (n, 4): their positions and how many there are
    turns: Indices  # (n,): 0 where they close around it; no rows where they do everywhere
    out: Any


class Plan(NamedTuple):
    """How far vertices go toward the mean of their neighbors, and where to."""

    around: Around
    part: Floats  # of the way to their mean, by number of neighbors; last to that along the border
    share: Floats  # that part of each of them
    places: Points  # (n, 3) float32: where vertices come to lie
    out: Any


@kernel
def mixed(v: int) -> int:
    """What a vertex counts as, in 39 bits: each for itself, as the whole grows with ``spread``.

    Sums differ, too, by far most. Those of millions fit into 64 bits, which Python's own numbers do
    not wrap around.
    """
    spread = v * SPREAD & 0x7FFFFFFF
    return spread + (spread * spread >> 24)


def adding_neighbors(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``add_neighbors(m, plan) -> 0``: a pass over the faces, which asks for no neighbors.

    Each face adds to a corner the next one, which comes next in no other face. At a vertex where
    the faces close around it the corners before are those after it, and what they count as cancels
    out.
    """
    lives, corners, position = living_face(k), cornering(k["face_vertices"]), k["position"]

    @kernel
    def add_neighbors(m: Any, plan: Around) -> int:
        total, turns = plan.sums, plan.turns
        for f in range(m.counts[FACE_END]):
            if lives(m, f):
                a, b, c = corners(m, f, plan)
                first = position(m, a)
                sums.add_to(total, a, position(m, b))
                sums.add_to(total, b, position(m, c))
                sums.add_to(total, c, first)
                if len(turns) > 0:
                    p, q, r = mixed(a), mixed(b), mixed(c)
                    turns[a] += q - r
                    turns[b] += r - p
                    turns[c] += p - q
        return 0

    return add_neighbors


@kernel
def none_along(m: Any, v: int, plan: Plan) -> Sum:
    """Stands for ``adding_along`` where vertices on the border stay."""
    return sums.nothing()


def adding_along(k: Kernels) -> Kernel:
    """Make ``add_along(m, v, plan) -> total``: of the neighbors along the border."""
    vertex_vertices, face_left_of, position = k["vertex_vertices"], k["face_left_of"], k["position"]

    @kernel
    def add_along(m: Any, v: int, plan: Plan) -> Sum:
        total, out = sums.nothing(), plan.out
        for i in range(vertex_vertices(m, v, out)):
            if face_left_of(m, v, out[i]) < 0 or face_left_of(m, out[i], v) < 0:
                total = sums.plus(total, position(m, out[i]))
        return total

    return add_along


def averaging(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``average(m, plan) -> vertex``, where vertices on the border stay.

    The first whose place is not finite, or -1.
    """
    return _averaging(k, none_along)


def averaging_borders(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``average(m, plan) -> vertex``, where they move along it."""
    return _averaging(k, adding_along(k))


def _averaging(k: Kernels, add_along: Kernel) -> Kernel:
    lives, where = living_vertex(k), locating(k["coordinate"])

    @kernel
    def average(m: Any, plan: Plan) -> int:
        total, turns, places, first = plan.around.sums, plan.around.turns, plan.places, -1
        for v in range(len(places)):
            if not lives(m, v):
                continue
            a, b, c, n = total[v, 0], total[v, 1], total[v, 2], total[v, 3]
            way = int(n)
            if len(turns) > 0 and turns[v] != 0:
                way = BORDER
                a, b, c, n = sums.parts(add_along(m, v, plan))
            stay, share = 1 - plan.part[way], plan.share[way]
            if way == BORDER and n > 0:  # more than two where fans of faces meet
                share = plan.part[way] / n
            x, y, z = where(m, v)
            x, y, z = stay * x + share * a, stay * y + share * b, stay * z + share * c
            place = np.float32(x), np.float32(y), np.float32(z)
            places[v, 0], places[v, 1], places[v, 2] = place
            if first < 0 and not is_point(place):
                first = v
        return first

    return average


def averages(
    s: Structure, kind: str, inside: Callable[[Array], Array], border: float = 0.0
) -> Points:
    """(n, 3) float32: vertices moved toward the mean of their neighbors; see ``Plan``.

    MeshError where one would not be finite any more.
    """
    n, counted = len(s.points), not (s.searches or s.rebuilds)  # where edges are not searched for
    closed = counted and 2 * s.n_edges == 3 * s.n_faces
    turns = np.zeros(0 if closed else n, np.int64)
    around = Around(np.zeros((n, 4)), turns, np.zeros(3, np.int64))
    s.run(adding_neighbors, around)
    neighbors = np.arange(1.0, most_neighbors(s, around) + 1)
    part = np.concatenate([[0.0], inside(neighbors), [border]])
    share = part / np.concatenate([[1.0], neighbors, [2.0]])
    out = s.scratch(0)[0] if border else around.out
    plan = Plan(around, part, share, np.zeros((n, 3), np.float32), out)
    with np.errstate(over="ignore"):
        if s.run(averaging_borders if border else averaging, plan) >= 0:
            raise not_finite(s, kind, plan.places)
    return plan.places


def most_neighbors(s: Structure, around: Around) -> int:
    """As many as any vertex has, or more: the bound on valences, where there is one."""
    known = int(s.records.counts[VALENCE])
    return known or int(around.sums[:, 3].max(initial=0))


def smooth(s: Structure, iterations: int = 1, method: str = "laplace") -> None:
    """Smooth a mesh in place, all vertices at once; those on the border stay.

    ``laplace`` moves each to the mean of its neighbors, where one beyond an edge of four faces
    counts twice. ``taubin`` moves half the way there and then a little further back: twenty
    iterations keep the volume of a fine mesh to some percent, more make it grow ever more, and a
    coarse mesh shrinks. One edit per pass. Cost per iteration: one or two times ``face_vertices``
    of all, and O(n_v); O(n_v n_t) where moving a vertex searches. MeshError for another method or
    number, for polygons, and where a position would not be finite any more: the passes before stay.
    Source: Sieger & Botsch (2011); Taubin (1995).
    """
    require_mesh(s, "smooth")
    passes = look_up(method, METHODS, "method")
    for _ in range(require_count("smooth", "iterations", iterations)):
        for part in passes:
            move(s, "smooth", averages(s, "smooth", partial(np.full_like, fill_value=part)))
