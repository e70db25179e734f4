"""Families of meshes that can be had at any size up to 2,000,000 vertices."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from hem.errors import MeshError
from hem.meshes import TriangleMesh, require_manifold
from hem.naming import look_up, whole
from hem.sources.cache import cached
from hem.sources.meshlab import apply, installed_version

LARGEST = 2_000_000
SEEDS = 2**32  # from far larger ones, pymeshlab makes points that are none


@dataclass(frozen=True)
class Family:
    """How to make the meshes of one family, and what is known of all of them.

    `make(n_vertices, seed)` gives the mesh of a reachable size near this. A closed family is
    wound outward, a family with a border counterclockwise as seen from above (+z).
    """

    what: str
    sizes: str
    closed: bool
    random: bool
    smallest: int
    make: Callable[[int, int], TriangleMesh]


def generate(family: str, n_vertices: int, seed: int = 0) -> TriangleMesh:
    """A manifold, consistently wound mesh of the family, of a reachable size near this.

    FAMILIES says what there is and which sizes it reaches. `seed` changes the random families only;
    the same arguments always give the same mesh. The mesh is kept on disk (see cache).

    Cost: O(n) or O(n log n) once, some 20 s at worst; afterwards that of reading a file. Raises
    MeshError for a family or a size that does not exist, naming those that do.
    """
    chosen = look_up(family, FAMILIES, "family")
    n_vertices = whole(n_vertices, "a number of vertices")
    if not chosen.smallest <= n_vertices <= LARGEST:
        raise MeshError(
            f"no {family} of {n_vertices:,} vertices: reachable are {chosen.smallest} … "
            f"{LARGEST:,}, {chosen.sizes}"
        )
    variant = whole(seed, "a seed") if chosen.random else 0
    if not 0 <= variant < SEEDS:
        raise MeshError(f"a seed is an integer from 0 to {SEEDS - 1:,}, not {seed:,}")

    def make() -> TriangleMesh:
        mesh = chosen.make(n_vertices, variant)
        require_manifold(mesh)
        return mesh

    return cached(f"{family}-{n_vertices}-{variant}-{_made_by()}", make)


@cache
def _made_by() -> str:
    """What the meshes depend on: this file, and pymeshlab's version."""
    digest = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:12]
    return f"{digest}-pymeshlab-{installed_version()}"


def _sides(n: int, least: int, widest: float, ideal: float) -> tuple[int, int]:
    """Two counts, long side first, whose product is nearest n and whose ratio is sensible.

    The ratio is at most about `widest`, but of small products, as the short side is rounded down;
    and as near to `ideal` as the product allows.
    """
    root = np.sqrt(n)
    short = np.arange(max(least, int(root / np.sqrt(widest))), max(least, int(root)) + 1)
    long = np.maximum(np.rint(n / short).astype(int), short)
    best = np.lexsort((abs(long / short - ideal), abs(short * long - n)))[0]
    return int(long[best]), int(short[best])


def _torus(n: int, seed: int) -> TriangleMesh:
    around, across = _sides(n, least=3, widest=4, ideal=2)
    return apply("create_torus", hsubdiv=around, vsubdiv=across)


def _sphere(n: int, seed: int) -> TriangleMesh:
    levels = np.arange(10)
    off = abs(np.log((10 * 4.0**levels + 2) / n))
    return apply("create_sphere", subdiv=int(np.argmin(off)))


def _grid(n: int, seed: int) -> TriangleMesh:
    columns, rows = _sides(n, least=2, widest=2, ideal=1)
    cell = 1 / (columns - 1)
    width, height = 1.0, cell * (rows - 1)
    return apply("create_grid", numvertx=columns, numverty=rows, absscalex=width, absscaley=height)


def _cone(n: int, seed: int) -> TriangleMesh:
    return apply("create_cone", r0=1, r1=0, h=2, subdiv=n - 2)


def _terrain(n: int, seed: int) -> TriangleMesh:
    # pymeshlab's create_fractal_terrain reaches only (2^k + 1)^2 vertices; the same fractal on a
    # grid reaches any size.
    percent = {"maxheight": 15.0}
    return apply("apply_coord_fractal_displacement", _grid(n, 0), percent=percent, seed=seed)


def _isosurface(n: int, seed: int) -> TriangleMesh:
    # Not pymeshlab's create_noisy_isosurface: its noise has no scale, so that its surface falls
    # into ever more shards as it grows (40 at 29,000 vertices, 4,423 at 1.7 million, some sharing
    # edges), and the box it is cut from leaves them open.
    waves = _waves(seed)
    pilot = 0.05
    per_area = len(_contour(waves, pilot).points) * pilot**2
    return _contour(waves, float(np.sqrt(per_area / n)))


def _waves(seed: int) -> str:
    """A unit sphere's equation and seeded waves on it, too gentle to fold or part its surface."""
    random = np.random.default_rng(seed)
    terms = ["x*x+y*y+z*z-1"]
    for frequency in (4.0, 7.0, 12.0):
        direction = random.normal(size=3)
        kx, ky, kz = frequency * direction / np.linalg.norm(direction)
        phase = random.uniform(0, 2 * np.pi)
        terms.append(f"{0.4 / frequency:.6f}*sin({kx:.6f}*x+{ky:.6f}*y+{kz:.6f}*z+{phase:.6f})")
    return "+".join(term.replace("+-", "-") for term in terms)


def _contour(expression: str, voxel: float) -> TriangleMesh:
    """Marching cubes' vertices double where the surface meets a voxel's corner: hence the weld."""
    reach = 1.1 + 3 * voxel  # the waves add at most 0.19 to the squared radius
    box: dict[str, Any] = {f"min{axis}": -reach for axis in "xyz"}
    box |= {f"max{axis}": reach for axis in "xyz"}
    return apply("create_implicit_surface", voxelsize=voxel, expr=expression, **box).welded()


FAMILIES: dict[str, Family] = {
    "torus": Family(
        what="a torus of exactly two faces a vertex, every valence 6",
        sizes="products of two counts in a ratio of 1 … 4, small ones up to 6.4",
        closed=True, random=False, smallest=9, make=_torus,
    ),
    "sphere": Family(
        what="an icosphere: valence 6 but for twelve vertices of 5",
        sizes="10 · 4^k + 2 (12, 42, 162, 642, …)",
        closed=True, random=False, smallest=12, make=_sphere,
    ),
    "grid": Family(
        what="a flat rectangle of square cells, each cut in two; it has a border",
        sizes="products of two counts in a ratio of 1 … 2, small ones up to 3.5",
        closed=False, random=False, smallest=4, make=_grid,
    ),
    "cone": Family(
        what="a cone and its base: two vertices of valence n - 2, all others of 4",
        sizes="every size",
        closed=True, random=False, smallest=5, make=_cone,
    ),
    "terrain": Family(
        what="a fractal terrain over a rectangle; it has a border",
        sizes="products of two counts in a ratio of 1 … 2, small ones up to 3.5",
        closed=False, random=True, smallest=4, make=_terrain,
    ),
    "isosurface": Family(
        what="a wavy sphere cut by marching cubes: closed, with irregular valences",
        sizes="within 15 percent of every size, within 2 percent from 1,000 on",
        closed=True, random=True, smallest=100, make=_isosurface,
    ),
}  # fmt: skip
"""The families by name, which ``generate`` makes."""
