"""Breaking a body into Voronoi cells around the impact (the thesis' outlook: other methods)."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Floats
from hem.errors import MeshError
from hem.fracture.blow import Blow, generator
from hem.fracture.blow import sites as sites_of
from hem.fracture.bodies.cells import cells
from hem.fracture.bodies.solid import Body, Shell, from_manifold, require_body, with_hollows
from hem.fracture.bodies.walls import touching
from hem.fracture.material import Material
from hem.fracture.material import material as named
from hem.fracture.pieces import Fracture, require_triangle_mesh
from hem.fracture.surface import closest
from hem.meshes import TriangleMesh, bounds, length, normals, position

VANISHING = 1e-9  # a piece of less than this part of the body's volume is dropped
_THIN = 4  # so is one thinner than so many roundings of the largest coordinate, nearly flat
_CLOSE = 1e-6  # sites nearer to each other than this part of the diagonal are one
_DISTANT = 10_000  # diagonals to the nearest site, as walls are found from squares of distances
_TOUCH = 1e-9  # pieces are neighbors that share more than this part of the diagonal's square
_MISSING = 1e-3  # the part of the volume that rounding to float32 may lose, in all


def voronoi(
    mesh: TriangleMesh | Body, impact: ArrayLike, material: Material | str = "glass",
    force: float = 1.0, seed: int = 0, direction: ArrayLike | None = None,
    sites: ArrayLike | None = None,
) -> Fracture:  # fmt: skip
    """Break a body into the Voronoi cells of sites around the impact.

    impact     (3,): where it is struck; the nearest point of the surface is
    force      J / kg: hem.fracture.Blow says how it decides on the sites
    direction  (3,): where the blow goes, of any length; into the surface if not given
    sites      (k, 3): to break into exactly their cells, all of the body, instead of those of the
               blow, the nearest at most 10,000 diagonals away. Those whose cells the body has no
               part in are counted outside

    The shards are closed bodies, in the order of their sites, a cell in several parts with the
    largest first. What is beyond the reach of the blow is the rest; parts of it that no longer
    hang together are bodies of their own, the largest first. With the shards they fill the body:
    the volumes add up to the body's within 1e-6 of it, or 1e-3 if it is far from the origin for its
    size. Vertices are rounded to float32, and neighbors coincide up to that.

    Counts: ``used`` sites, positions ``outside``, ``repeated`` sites that are nearer than 1e-6
    diagonals to an earlier one and left out, and ``vanished`` pieces, of less than 1e-9 of the
    volume or thinner than what float32 can hold. The sites of a blow are the same on every
    machine, and the pieces as far as Qhull's and manifold3d's float64 are; again on the same one.

    Cost O(sites × faces). Raises MeshError for a mesh that is no body (pass what ``require_body``
    gave to have it checked only once), an impact farther away than half a diagonal, sites that are
    none, a mesh so far from the origin that a thousandth of the volume is lost, and for what
    hem.fracture.Blow refuses.

    Source: Raghavachary, Fracture generation on polygonal meshes using Voronoi polygons, 2002.
    """
    if not isinstance(mesh, Body):
        require_triangle_mesh(mesh, "voronoi")
    body = mesh if isinstance(mesh, Body) else require_body(mesh)
    chosen = material if isinstance(material, Material) else named(material)
    generator(seed)  # raises for what is none
    blow = _aimed(body, position(impact, "an impact"), direction, force)
    plan = _scattered(body, blow, chosen, seed) if sites is None else _given(body, sites)
    made = _cut(body, plan)
    shards, rest = ([it.mesh for it in pieces] for pieces in (made.shards, made.rest))
    walls, least = [it.labels for it in made.shards + made.rest], _TOUCH * body.diagonal**2
    counts = {"used": plan.breaking - made.missed, "outside": plan.outside + made.missed}
    broken = Fracture(
        "voronoi", chosen, seed, blow.impact, blow.direction, shards, rest,
        counts | {"repeated": plan.repeated, "vanished": made.vanished}, body.diagonal,
        find_neighbors=lambda: touching(shards + rest, walls, least),
    )  # fmt: skip
    if abs(float(broken.mass.volumes.sum()) - body.volume) > _MISSING * body.volume:
        raise MeshError(
            "so far from the origin float32 cannot hold the pieces of a mesh; move it there first"
        )
    return broken


class _Plan(NamedTuple):
    """The sites to break at: cells of the first ones break off, the others' stay whole."""

    sites: Floats
    breaking: int
    outside: int
    repeated: int


class _Made(NamedTuple):
    shards: list[Shell]  # labeled by the walls that faces are on, negative where they are on none
    rest: list[Shell]
    missed: int
    vanished: int


def _aimed(body: Body, at: Floats, direction: ArrayLike | None, force: float) -> Blow:
    """The blow on the surface next to a position."""
    across = normals(body.corners)
    faces = np.flatnonzero(across.any(axis=1))  # those without area look nowhere
    face, spot = closest(body.corners[faces], at)
    with np.errstate(over="ignore"):
        far = float(length(spot - at))
    if not far <= body.diagonal / 2:
        raise MeshError(
            f"the impact is {far:.6g} away from the mesh, more than half the diagonal of "
            f"{body.diagonal:.6g}; the surface is nearest to it at {spot.round(6).tolist()}"
        )
    way: Any = -across[faces[face]] if direction is None else direction
    return Blow(spot, way, force)


def _scattered(body: Body, blow: Blow, material: Material, seed: int) -> _Plan:
    found = sites_of(blow, material, body.diagonal, body.contains, seed)
    points, repeated = _distinct(found.points, body.diagonal)
    return _Plan(np.concatenate([points, found.anchors]), len(points), found.outside, repeated)


def _given(body: Body, sites: ArrayLike) -> _Plan:
    try:
        points = np.array(sites, np.float64)
    except (TypeError, ValueError, OverflowError):
        points = np.zeros(0)
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        raise MeshError(f"sites are a row of three numbers each, not {sites!r:.60}")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise MeshError("sites are not finite", rows=np.flatnonzero(bad))
    with np.errstate(over="ignore"):
        away = length(points - np.mean(bounds(body.mesh.points), axis=0))
    if not away.min() <= _DISTANT * body.diagonal:
        words = f"all sites are more than {_DISTANT:,.0f} diagonals away from the mesh"
        raise MeshError(f"{words}, where a wall in it cannot be told")
    # To all of the body others are nearer: nothing but digits of the walls would be lost to them.
    far = away > away.min() + body.diagonal
    found, repeated = _distinct(points[~far], body.diagonal)
    return _Plan(found, len(found), int(far.sum()), repeated)


def _distinct(points: Floats, diagonal: float) -> tuple[Floats, int]:
    """Without those that are too close to an earlier one, and how many these were."""
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(_CLOSE * diagonal, output_type="ndarray")
    again = np.unique(pairs.max(axis=1)) if len(pairs) else np.zeros(0, np.int64)
    return np.delete(points, again, axis=0), len(again)


def _cut(body: Body, plan: _Plan) -> _Made:
    """Cut the body at the walls of the cells."""
    low, high = bounds(body.mesh.points)
    cut = cells(plan.sites, (low + high) / 2, body.diagonal / 2)
    thin = _THIN * float(np.spacing(np.abs(body.mesh.points).max()))
    label = len(body.mesh.triangles)  # of the first wall
    shards: list[Shell] = []
    missed = vanished = 0
    for site in range(plan.breaking):
        parts, lost = _parts(cut.cell(site, label) ^ body.manifold, body, thin)
        shards += parts
        missed += not parts and not lost
        vanished += lost
    rest: list[Shell] = []
    if plan.breaking < len(plan.sites):
        broken = cut.union(np.arange(len(plan.sites)) < plan.breaking, label)
        rest, lost = _parts(body.manifold - broken, body, thin)
        vanished += lost
    return _Made(shards, rest, missed, vanished)


def _parts(made: Any, body: Body, thin: float) -> tuple[list[Shell], int]:
    """The connected bodies, the largest first, and how many parts were too small and vanished."""
    found = made.decompose()
    least = VANISHING * body.volume
    large = [it for it in found if abs(it.volume()) > max(least, thin * it.surface_area() / 2)]
    shells = [
        Shell(mesh, label - len(body.mesh.triangles)) for mesh, label in map(from_manifold, large)
    ]
    return with_hollows(shells), len(found) - len(large)
