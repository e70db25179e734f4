"""Breaking tetrahedra out of a body, as the thesis' outlook has it (chapter 6): its surface is
broken, and each shard gets a fourth point inside.

    ──a─────────b──   The fourth point d lies under the middle of the shard's face. Sides that lean
       ╲       ╱      at most half the angle between two faces never meet those of the neighbor;
        ╲     ╱       where anything else is in the way, a hollow opposite or a wall, d rises until
         ╲   ╱        nothing is. Some tetrahedra, the nearest to the impact first, are split into
          ╲ ╱         four by a break point inside, as a face is into three.
           d

The rest is the body with a pit for each shard: the very operation that splits a face at a point
makes it of the face, so that it stays closed.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.algorithms import require_mesh
from hem.arrays import Array, Bools, Floats
from hem.contract import Structure
from hem.fracture.blow import MOST_SITES, Blow, generator
from hem.fracture.bodies.overlap import crossing, overlapping
from hem.fracture.bodies.solid import Shell, require_body, with_hollows
from hem.fracture.material import Material
from hem.fracture.material import material as named
from hem.fracture.pieces import Fracture, islands
from hem.fracture.surface import break_surface, face_corners, in_place
from hem.meshes import TriangleMesh, areas, bounds, dot, length, normals, unit

SLENDER = 3.0  # a shard is at most so many times as deep as its face is wide
LEAN = 0.9  # the part of half the angle between two faces that a side may lean
RAISED = 0.7  # what is left of the depth of a shard that is in the way of another one
SHALLOW = 0.02  # what is less deep than this part of its width is left in place
_SIDES = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]  # a, b, c as seen from outside, d below


def tetrahedra(
    structure: Structure, impact: ArrayLike, material: Material | str = "glass", force: float = 1.0,
    seed: int = 0,
) -> Fracture:  # fmt: skip
    """Break tetrahedra out of the body that a structure holds, in place -> the pieces.

    impact  (3,): taken to the nearest point of the surface
    force   J / kg: the break points on the surface are the material's × √force, which makes no more
            than 1,000 of them; the shards are at most material.scale × diagonal × √force deep, and
            a part of 1 - 1/(1 + force/10) of them is split by a break point inside

    The surface is broken as by ``shatter``, which says what becomes of break points; here a shard
    stays in place that could be but a sliver (``too shallow``). Shards are closed, outward
    oriented, and overlap neither each other nor the rest, which the structure keeps, a closed
    body. The same seed gives the same shards on every structure. An interrupt, or what a subscriber
    raises, ends it after an edit: the mesh is whole, but may be split without its pits.

    Cost: that of ``shatter``, and O(shards × faces near them). Raises MeshError for what is no body
    and as ``shatter`` does. Source: thesis, chapter 6.
    """
    require_mesh(structure, "tetrahedra")
    chosen = material if isinstance(material, Material) else named(material)
    more = np.sqrt(Blow(np.zeros(3), np.array([0.0, 0.0, 1.0]), force).force)
    require_body(structure.to_triangles())
    denser = min(more, max(MOST_SITES / max(sum(chosen.circles), 1), 1))
    scattered = replace(chosen, circles=tuple(round(it * denser) for it in chosen.circles))
    broken, faces, size = break_surface(structure, impact, scattered, seed)
    draw = generator(seed).random
    corners = face_corners(structure, faces)
    fourth = _fourth_points(structure, faces, corners, chosen.scale * size * more, draw)
    solids = np.concatenate([corners, fourth[:, None]], axis=1)
    deep = _free(structure, faces, solids, size)
    solids = solids[deep]
    structure.split_faces(faces[deep], solids[:, 3])
    shards = [TriangleMesh(it, _SIDES) for it in _split_inside(solids, broken.target, force, draw)]
    inside = (len(shards) - len(solids)) // 3
    return in_place(
        structure, broken, shards, {"inside": inside, "too shallow": int((~deep).sum())},
        parts=_bodies, method="tetra", material=chosen, seed=seed, diagonal=size,
    )  # fmt: skip


def _bodies(mesh: TriangleMesh) -> list[TriangleMesh]:
    """The connected bodies of a closed mesh, the largest first, hollows with what is around."""
    return [it.mesh for it in with_hollows([Shell(it, np.zeros(0)) for it in islands(mesh)])]


def _fourth_points(
    structure: Structure, faces: Array, corners: Array, depth: float, random: Any
) -> Floats:
    """(k, 3): one under the middle of each face, as deep as the angles at its sides allow."""
    sides = np.stack([length(corners[:, (i + 1) % 3] - corners[:, (i + 2) % 3]) for i in range(3)])
    around = sides.sum(axis=0)
    # Of the inscribed circle.
    middle = (sides.T[:, :, None] * corners).sum(axis=1) / around[:, None]
    radius = 2 * areas(corners) / around
    wanted = np.minimum(depth, SLENDER * np.sqrt(areas(corners)))
    wanted = wanted * (0.5 + 0.5 * random(len(faces)))
    with np.errstate(invalid="ignore"):  # of a face of no area, whose point is NaN
        allowed = radius * _steepest(structure, faces, corners)
    down = -_units(corners) * np.minimum(wanted, allowed)[:, None]
    return (middle + down).astype(np.float32).astype(np.float64)


def _steepest(structure: Structure, faces: Array, corners: Array) -> Floats:
    """(k,): the tangent of the angle at which the sides of a shard may go down."""
    beyond = structure.face_faces(faces)
    mine = np.repeat(_units(corners), beyond.counts, axis=0)
    others = face_corners(structure, beyond.values)
    middle = np.repeat(corners.mean(axis=1), beyond.counts, axis=0)
    theirs = _units(others)
    # Convex edges, at which the other face falls off, leave less than half a turn inside.
    falls = dot(others.mean(axis=1) - middle, mine) < 0
    cosine = np.clip(dot(mine, theirs), -1, 1)
    half_tangent = np.sqrt((1 + cosine) / np.maximum(1 - cosine, 1e-12))  # of half the inner angle
    steep = np.where(falls, LEAN * half_tangent, np.inf)
    return np.minimum.reduceat(steep, beyond.offsets[:-1])


def _free(structure: Structure, faces: Array, solids: Array, size: float) -> Bools:
    """Raise the fourth points, in place, until nothing is in the way -> (k,) which have a depth."""
    least = 1e-7 * size
    middle = solids[:, :3].mean(axis=1)
    low, high = bounds(solids.reshape(-1, 3))
    others = face_corners(structure, np.setdiff1d(structure.faces(), faces))
    near = ((others.max(axis=1) > low) & (others.min(axis=1) < high)).all(axis=1)
    skin = np.concatenate([others[near], solids[:, :3]])
    width = np.sqrt(areas(solids[:, :3]))
    deep = np.ones(len(solids), np.bool_)
    while True:
        height = -dot(solids[:, 3] - middle, _units(solids[:, :3]))
        deep &= height > np.maximum(SHALLOW * width, 4 * least)
        inside = np.flatnonzero(deep)
        blocked = overlapping(solids[inside], least) | crossing(solids[inside], skin, least)
        if not blocked.any():
            return deep
        raised = inside[blocked]
        up = middle[raised] + RAISED * (solids[raised, 3] - middle[raised])
        solids[raised, 3] = up.astype(np.float32)


def _split_inside(solids: Array, impact: Array, force: float, random: Any) -> Floats:
    """(n, 4, 3): the tetrahedra, those nearest to the impact as four each."""
    far = length(solids.mean(axis=1) - impact)
    nearest = np.argsort(far, kind="stable")[: round(len(solids) * (1 - 1 / (1 + force / 10)))]
    weights = 0.1 + random((len(solids), 4))
    at = (weights[:, :, None] * solids).sum(axis=1) / weights.sum(axis=1)[:, None]
    at = at.astype(np.float32).astype(np.float64)
    counts = np.ones(len(solids), int)
    counts[nearest] = 4
    parts = np.repeat(solids, counts, axis=0)
    first = (np.cumsum(counts) - counts)[nearest]
    for corner in range(4):
        parts[first + corner, corner] = at[nearest]
    return parts


def _units(corners: Array) -> Floats:
    """(k, 3): the normals of triangles, of length 1; NaN for those of no area."""
    with np.errstate(invalid="ignore"):
        return unit(normals(corners))
