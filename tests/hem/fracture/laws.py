"""What must hold of every fracture, told of the pieces alone, by other routes than they were made.

Used by the tests and by the long soak (``python -m tests.hem.fracture.soak``).
"""

from __future__ import annotations

from functools import cache
from math import ceil

import numpy as np
import trimesh

import hem
from hem.fracture import Fracture, wrapped

EXACT = 1e-6
"""How much the pieces' areas and volumes may differ from the whole, in all."""


def box(nx: int = 8, ny: int = 8, height: float = 0.1) -> hem.TriangleMesh:
    """A thick plate, its large sides of squares cut in two."""
    made = trimesh.creation.box((1, ny / nx, height))
    while len(made.faces) < 4 * nx * ny:
        made = made.subdivide()
    return hem.TriangleMesh(made.vertices, made.faces)


@cache
def surface(name: str) -> hem.TriangleMesh:
    """The models whose surface is broken; the teapot is open and in four parts."""
    if name == "plate":
        return hem.generate("grid", 400)
    return hem.generate("sphere", 642) if name == "sphere" else hem.sample(name)


@cache
def body(name: str) -> hem.TriangleMesh:
    """The models that are broken through."""
    if name == "plate":
        return box()
    return wrapped(hem.sample("teapot"), 0.03) if name == "teapot" else surface(name)


MODELS = ("plate", "sphere", "bunny", "teapot")


def struck(mesh: hem.TriangleMesh, seed: int) -> np.ndarray:
    """Somewhere on a face of a mesh."""
    rng = np.random.default_rng(seed)
    corners = mesh.points[mesh.triangles[rng.integers(len(mesh.triangles))]].astype(float)
    return rng.dirichlet(np.ones(3)) @ corners


def area(mesh: hem.TriangleMesh) -> float:
    a, b, c = (mesh.points[mesh.triangles[:, i]].astype(float) for i in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def volume(mesh: hem.TriangleMesh) -> float:
    """As the sum of the tetrahedra between the faces and a corner; negative if inside out."""
    a, b, c = (mesh.points[mesh.triangles[:, i]].astype(float) - mesh.points[0] for i in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def unpaired(meshes: list[hem.TriangleMesh]) -> tuple[int, int]:
    """How many directed sides have no opposite, by position, and how many there are repeatedly."""
    corners = np.concatenate([it.points[it.triangles] for it in meshes]) + np.float32(0)
    rows = corners.reshape(-1, 3)
    order = np.lexsort(rows.T)
    other = np.concatenate([[False], (rows[order][1:] != rows[order][:-1]).any(axis=1)])
    at = np.empty(len(rows), int)
    at[order] = np.cumsum(other)
    here = at.reshape(-1, 3)
    there = np.roll(here, -1, axis=1)
    forth, count = np.unique(here.astype(np.int64) << 32 | there, return_counts=True)
    back = np.unique(there.astype(np.int64) << 32 | here)
    alone = ~np.isin(forth, back, assume_unique=True)
    return int(alone.sum()), int((count > 1).sum())


def sharing_sides(pieces: list[hem.TriangleMesh]) -> list[list[int]]:
    """The pairs of pieces that have a side in common, by position."""
    ends = []
    for piece in pieces:
        at = [tuple(point) for point in piece.points.tolist()]
        faces = piece.triangles.tolist()
        ends.append({frozenset((at[t[i]], at[t[i - 1]])) for t in faces for i in range(3)})
    several = range(len(ends))
    return [[i, j] for i in several for j in several[i + 1 :] if ends[i] & ends[j]]


@cache
def unbroken(whole: hem.TriangleMesh) -> tuple[float, int, int]:
    """The area of a mesh, and its unpaired sides once welded, as ``unpaired`` counts them."""
    return area(whole), *unpaired([whole.welded()])


def require_surface_laws(whole: hem.TriangleMesh, broken: Fracture, least: float) -> None:
    """Shards and rest make up the surface again, side by side, and none is degenerate."""
    whole_area, alone, again = unbroken(whole)
    assert abs(sum(map(area, broken.pieces)) / whole_area - 1) < EXACT
    now_alone, now_again = unpaired(broken.pieces)
    assert now_again == again
    # A split of a side on the border leaves one more there.
    assert alone <= now_alone <= alone + broken.counts["on an edge"] + 4
    for shard in broken.shards:
        corners = shard.points.astype(float)
        lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
        assert 2 * area(shard) / lengths.max() > 0
        assert area(shard) > 0.4 * least * lengths.min()
    for part in broken.rest:
        hem.require_sound(part)


def require_body_laws(whole: hem.TriangleMesh, broken: Fracture) -> None:
    """Every piece is a closed body, turned outward, and together they have the volume of all."""
    starts = np.cumsum([0, *(len(it.points) for it in broken.pieces)])
    apart = trimesh.Trimesh(
        np.concatenate([it.points.astype(float) for it in broken.pieces]),
        np.concatenate([it.triangles + k for it, k in zip(broken.pieces, starts, strict=False)]),
        process=False,
    )
    assert apart.is_watertight
    assert apart.is_winding_consistent
    assert min(map(volume, broken.pieces)) > 0
    all_of_it = trimesh.Trimesh(whole.points.astype(float), whole.triangles, process=False)
    assert abs(apart.volume / all_of_it.volume - 1) < EXACT


def sample(mesh: hem.TriangleMesh, count: int, seed: int) -> np.ndarray:
    """(count, 3): positions all over the bounding box of a mesh."""
    rng = np.random.default_rng(seed)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    return low + rng.random((count, 3)) * (high.astype(float) - low)


def holders(pieces: list[hem.TriangleMesh], at: np.ndarray) -> np.ndarray:
    """(k,): in how many of the pieces each position lies, by solid angles."""
    total = np.zeros(len(at), int)
    for piece in pieces:
        low, high = piece.points.min(axis=0), piece.points.max(axis=0)
        near = np.flatnonzero(((at >= low) & (at <= high)).all(axis=1))
        for part in np.array_split(near, max(1, ceil(len(near) * len(piece.triangles) / 2e6))):
            total[part] += np.rint(winding(piece, at[part])).astype(int)
    return total


def winding(piece: hem.TriangleMesh, at: np.ndarray) -> np.ndarray:
    """How often a surface winds around positions (Van Oosterom & Strackee, 1983)."""
    corners = piece.points[piece.triangles].astype(float)
    a, b, c = (corners[None, :, i] - at[:, None] for i in range(3))
    x, y, z = (np.linalg.norm(it, axis=2) for it in (a, b, c))
    above = (a * np.cross(b, c)).sum(axis=2)
    below = x * y * z + (a * b).sum(2) * z + (b * c).sum(2) * x + (c * a).sum(2) * y
    return np.arctan2(above, below).sum(axis=1) / (2 * np.pi)
