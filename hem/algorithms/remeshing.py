"""Isotropic remeshing: all edges about as long as each other, all valences about six.

Again and again edges that are too long are split, those that are too short are collapsed, edges are
flipped where that evens out valences, and vertices move within their tangent planes to the middle
of their neighbors, and from there back onto the surface that there was. Where that is sharp, they
move along the crease, and no edge of it is flipped. Vertices on the border stay; long edges along
it are split.

Source: Botsch & Kobbelt, A Remeshing Approach to Multiresolution Modeling (2004), section 4.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.arguments import require_count, require_length, require_mesh, require_surface
from hem.algorithms.collapsing import SHORTEST_TO_PLANES, simplifying
from hem.algorithms.loop import Plan as Splits
from hem.algorithms.loop import splitting
from hem.algorithms.nearest import Surface
from hem.algorithms.normals import vertex_normals
from hem.algorithms.parts import (
    NO_WORK,
    Work,
    change,
    cross,
    doing,
    from_smallest,
    move,
    side_keys,
)
from hem.algorithms.simplification import collapsible
from hem.algorithms.smoothing import averages
from hem.arrays import Array, Floats, Indices
from hem.authoring import LEFT, NEEDS_ROOM, RIGHT, C, D, Kernel, Kernels, kernel
from hem.contract import Structure
from hem.errors import MeshError
from hem.meshes import length as length_of
from hem.meshes import normals as face_normals

LONGEST, SHORTEST = 4 / 3, 4 / 5
"""Of the length asked for: what is longer is split, what is shorter is collapsed."""

LEAST_STEPS = 8
"""Of float32, that an edge is long which is split: shorter ones have no middle to speak of."""

LEAST_COSINE = 0.7
"""How far the normal of a face may turn, and how far those at an edge that is flipped differ."""

SHARP = 0.93
"""How far a face may lean away from the normal of a vertex that is on no crease.

Half of what a crease turns by, which lies between both faces: some 45°, as where edges are flipped.
"""

STRAIGHT = 0.04
"""How much of the normals around a vertex may point along a crease: a part of their squares."""

ACROSS = 0.5
"""How far a crease may lean toward the normal of its vertex: the cosine between them."""


class Flips(NamedTuple):
    """Which edges are looked at, and what is known of the vertices."""

    edges: Indices  # (k,): smaller end << 32 | larger end
    next: Indices  # (1,): the place of the next one
    xyz: Floats  # (n, 3)
    excess: Indices  # (n,): valence above 6, or above 4 on the border
    work: Work


@kernel
def facing(xyz: Floats, a: int, b: int, c: int) -> tuple[float, float, float]:
    """The normal of a triangle, as long as twice its area."""
    return cross(xyz[b] - xyz[a], xyz[c] - xyz[a])


@kernel
def agree(n: tuple[float, ...], m: tuple[float, ...]) -> bool:
    """Whether two normals point the same way."""
    both = n[0] * m[0] + n[1] * m[1] + n[2] * m[2]
    one, other = n[0] ** 2 + n[1] ** 2 + n[2] ** 2, m[0] ** 2 + m[1] ** 2 + m[2] ** 2
    return bool(both > LEAST_COSINE * np.sqrt(one) * np.sqrt(other))


def evening_out(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``even_out(m, plan) -> 0``: flip what brings valences nearer to six."""
    edge_between = k["edge_between"]
    diamond, flip_edge = k["diamond"], doing(operations["flip_edge"])

    @kernel
    def even_out(m: Any, plan: Flips) -> int:
        at, xyz, excess = plan.work.at, plan.xyz, plan.excess
        while plan.next[0] < len(plan.edges):
            edge = plan.edges[plan.next[0]]
            a, b = edge >> 32, edge & 0xFFFFFFFF
            e = edge_between(m, a, b)
            if e >= 0 and diamond(m, e, at) == 2 and at[LEFT] >= 0 and at[RIGHT] >= 0:
                c, d = at[C], at[D]
                # The sum of squares falls by twice this much, less 4.
                gain = excess[a] + excess[b] - excess[c] - excess[d]
                one, other = facing(xyz, a, d, c), facing(xyz, b, c, d)
                left, right = facing(xyz, a, b, c), facing(xyz, b, a, d)
                both = left[0] + right[0], left[1] + right[1], left[2] + right[2]
                flat = agree(left, right) and agree(one, both) and agree(other, both)
                if gain > 2 and flat:
                    done = flip_edge(m, e, -1, plan.work)
                    if done == NEEDS_ROOM:
                        return NEEDS_ROOM
                    if done >= 0:
                        excess[a], excess[b] = excess[a] - 1, excess[b] - 1
                        excess[c], excess[d] = excess[c] + 1, excess[d] + 1
            plan.next[0] += 1
        return 0

    return even_out


def remesh(s: Structure, length: float | None = None, iterations: int = 10) -> None:
    """Make all edges about as long as ``length``, the mean of all unless it is said, in place.

    After ten iterations at about the mean, 95 of 100 edges of a scanned model are between 4/5 and
    4/3 of it; some 85 where much is sharp. At three times the mean these are 90, and often half or
    fewer where much is sharp, or on a grid, whose valences ask for no flips. Corners stay where
    they are, and creases that turn by some 45° or more, but for what is finer than the length.
    Edges on the border are split, never collapsed. Handles of what is left are kept, and
    ``compact`` renumbers. Several edits per iteration. Cost per iteration: O(n_t log n_t) for
    bounded valence; where neighbors are searched for or found anew, that for each split, collapse
    and flip. MeshError for what is no length or number, for a length that takes more faces than
    there are handles, and for polygons; TopologyError as ``subdivide``.
    Source: Botsch & Kobbelt (2004).
    """
    require_mesh(s, "remesh")
    require_surface(s, "remesh")
    iterations = require_count("remesh", "iterations", iterations)
    ends = s.points[s.edge_array()].astype(np.float64)
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    wanted = float(lengths.sum()) / max(len(lengths), 1)
    if length is not None:
        wanted = require_length("remesh", "length", length)
        if not 0 < wanted < np.inf:
            raise MeshError(f"remesh takes length as a positive number, not {length!r}")
    area, along = float(s.to_triangles().face_areas().sum()), float(lengths.sum())
    if area + along * wanted > np.iinfo(np.int32).max * wanted * wanted:
        raise MeshError(f"remesh takes a longer length: {wanted!r} makes too many faces")
    surface = Surface(s.points, from_smallest(s.triangles()))
    for _ in range(iterations):
        split_longer(s, LONGEST * wanted)
        limits = LEAST_COSINE, SHORTEST * wanted
        plan = collapsible(s, SHORTEST_TO_PLANES, *limits, longest=LONGEST * wanted)
        change(s, "remesh", simplifying, plan)
        flip_to_even(s)
        relax(s, surface)


def split_longer(s: Structure, length: float) -> None:
    """Split all edges longer than that in the middle, until none is left that has one."""
    before = -1
    while before < s.n_vertices:
        before = s.n_vertices
        keys, _ = side_keys(s)
        ends = np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1)
        places = s.points[ends].astype(np.float64)
        least = LEAST_STEPS * np.spacing(np.abs(s.points[ends]).max(axis=(1, 2)))
        longest = np.maximum(np.float64(length), least)  # and not as float32, as the steps are
        long = np.linalg.norm(places[:, 0] - places[:, 1], axis=1) > longest
        points = places[long].mean(axis=1).astype(np.float32)
        start = np.array([len(s.points)]), np.zeros(1, np.int64), NO_WORK
        change(s, "remesh", splitting, Splits(ends[long], points, *start), len(points))


def flip_to_even(s: Structure) -> None:
    """Flip each edge at most once, in the order of their ends."""
    keys, faces = side_keys(s)
    ends = np.stack([keys >> 32, keys & 0xFFFFFFFF])
    n = len(s.points)
    excess = np.bincount(ends.reshape(-1), minlength=n) - 6
    on_border = np.zeros(n, np.bool_)
    on_border[ends[:, faces == 1]] = True
    excess[on_border] += 2
    xyz = s.points.astype(np.float64)
    change(s, "remesh", evening_out, Flips(keys, np.zeros(1, np.int64), xyz, excess, NO_WORK))


def relax(s: Structure, surface: Surface) -> None:
    """Move vertices within their tangent planes to the means of their neighbors, and back down.

    Where the surface is sharp, along the crease; where creases meet, not at all.
    """
    normals: Array = vertex_normals(s).astype(np.float64)
    toward = averages(s, "remesh", np.ones_like) - s.points.astype(np.float64)
    sharp, creases = find_creases(s, normals)
    along = (toward[sharp] * creases).sum(axis=1, keepdims=True) * creases
    toward -= (toward * normals).sum(axis=1, keepdims=True) * normals
    toward[sharp] = along
    vertices = s.vertices()
    vertices = vertices[toward[vertices].any(axis=1)]
    places = s.points + toward
    places[vertices] = surface.nearest(places[vertices], normals[vertices])
    stay_where_faces_turn(s, places)
    move(s, "remesh", places.astype(np.float32), vertices)


def stay_where_faces_turn(s: Structure, places: Floats) -> None:
    """Put back, in ``places`` (n, 3), the corners of faces that turn, until none does.

    A face can turn only where a corner was moved, or put back just before.
    """
    corners = from_smallest(s.triangles())
    before = face_normals(s.points[corners].astype(np.float64))
    faces = np.arange(len(corners))
    while len(faces):
        was, now = before[faces], face_normals(places[corners[faces]])
        least = LEAST_COSINE * length_of(was) * length_of(now)
        turned = corners[faces[(was * now).sum(axis=1) < least]]
        places[turned] = s.points[turned]
        put_back = np.zeros(len(places), np.bool_)
        put_back[turned] = True
        faces = np.flatnonzero(put_back[corners].any(axis=1))


def find_creases(s: Structure, normals: Array) -> tuple[Indices, Floats]:
    """The vertices (k,) whose faces lean away from their normals, and which way (k, 3) creases run.

    That is where the unit normals of the faces around a vertex point least, across the vertex's
    own. Zeros where they point everywhere, as at the corner of a cube; where they lie in one line,
    as at a fold; and where a crease would run along the vertex's own, as at the tip of a spike.
    """
    corners = from_smallest(s.triangles())
    facing = face_normals(s.points[corners].astype(np.float64))
    sizes = length_of(facing)[:, None]
    leaning = (facing[:, None] * normals[corners]).sum(axis=2) < SHARP * sizes
    sharp = np.unique(corners[leaning])
    face, at = np.nonzero(np.isin(corners, sharp))
    around = facing[face] / np.where(sizes > 0, sizes, 1.0)[face]  # zeros for faces without area
    spread = np.zeros((len(sharp), 3, 3))
    squares = around[:, :, None] * around[:, None]
    np.add.at(spread, np.searchsorted(sharp, corners[face, at]), squares)
    strengths, ways = np.linalg.eigh(spread)
    crease, total = ways[:, :, 0], strengths.sum(axis=1)
    runs = (strengths[:, 0] <= STRAIGHT * total) & (strengths[:, 1] > STRAIGHT**2 * total)
    runs &= np.abs((crease * normals[sharp]).sum(axis=1)) < ACROSS
    return sharp, np.where(runs[:, None], crease, 0.0)
