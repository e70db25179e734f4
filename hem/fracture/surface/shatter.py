"""Breaking a surface, as the thesis does (4.4): in the plane as printed, and on any curved surface.

The face under the impact is found, split there, and its edges are split in the middle; break points
scattered in growing circles split the faces under them; what was split is taken out, face by face.
Beyond what is printed: every part of a split face comes out (as printed, the third that keeps the
index of its face stays behind), and so do faces that would be left hanging in a single point, so
that the rest is a sound mesh.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.algorithms import require_edges, require_mesh
from hem.arrays import Floats, Indices
from hem.contract import Attribute, Structure
from hem.edit import Edit
from hem.errors import MeshError
from hem.fracture.blow import generator
from hem.fracture.mass import positive
from hem.fracture.material import MATERIALS, Material
from hem.fracture.material import material as named
from hem.fracture.pieces import Fracture, islands
from hem.fracture.surface.breaking import OUTCOMES, Plan, breaking, make_plan
from hem.fracture.surface.hanging import hanging
from hem.fracture.surface.nearest import (
    ROUNDING,
    corner_vertices,
    face_corners,
    nearest_face,
)
from hem.meshes import TriangleMesh, bounds, length, normals, unit

TOLERANCE = 1e-5  # what is nearer to a vertex or an edge lies on it: a part of the diagonal


class LazyMeshes(Sequence[TriangleMesh]):
    """Meshes that are made when the first of them is asked for."""

    def __init__(self, make: Callable[[], list[TriangleMesh]]) -> None:
        self._make = make

    @cached_property
    def _meshes(self) -> list[TriangleMesh]:
        return self._make()

    def __len__(self) -> int:
        return len(self._meshes)

    def __getitem__(self, index: Any) -> Any:
        """One mesh, or some."""
        return self._meshes[index]


def shatter(
    structure: Structure, impact: ArrayLike, material: Material | str | Attribute = "glass",
    seed: int = 0, scale: float | None = None,
) -> Fracture:  # fmt: skip
    """Break the surface that a structure holds, in place, around an impact (3,) -> the pieces.

    The impact is taken to the nearest point of the surface. ``material``: one, its name, or an
    attribute of faces that holds places in ``list(MATERIALS)``: then that of the face that is hit
    counts, as the thesis' ``materialType``. ``scale``: how far apart the circles of break points
    lie, in units of the mesh; the material's unless it is said, 1 as printed. Points are placed in
    the plane of the face that is hit and carried straight over the surface. Those that come to lie
    beyond the border are dropped, and so are those within a tolerance of a vertex: 1e-5 of the
    diagonal of the bounding box of all vertices, or 32 roundings of the largest coordinate if that
    is more. Within that tolerance of an edge the edge is split. ``Fracture.counts`` tells how many.

    The structure keeps the rest, sound, in which no handle changed; subscribers hear of one edit
    for what was split and one for what came out. An interrupt, or what a subscriber raises, ends it
    after an edit: the mesh is whole, but may be split and not broken yet; of objects, which Python
    itself runs, an interrupt may come within one. The same seed gives the same shards on every
    structure and machine.

    Cost: a walk to the face, as ``nearest_face`` says, and of O(√n_t) to each point, and the
    splits; O(n_v + n_t) for the bounding box and what is left, and O(n_t log n_t) where nothing is
    recorded of neighbors, to see that edges have two faces at most. Raises MeshError for an impact
    that is no position or not near the surface, for polygons, and for a mesh without faces or
    without size; TopologyError for edges in more than two faces. Source: thesis 4.4.
    """
    require_mesh(structure, "shatter")
    require_edges(structure, "shatter")
    chosen = _chosen(structure, impact, material)
    broken, new, size = break_surface(structure, impact, chosen, seed, scale)
    loose = hanging(structure, new)
    faces = np.concatenate([new, loose])
    corners = structure.points[corner_vertices(structure, faces)]
    shards = LazyMeshes(lambda: [TriangleMesh(one, [(0, 1, 2)]) for one in corners])
    structure.remove_faces(faces)
    return in_place(
        structure, broken, shards, {"broken off": len(loose)},
        method="surface", material=chosen, seed=seed, diagonal=size,
    )  # fmt: skip


def _chosen(
    structure: Structure, impact: ArrayLike, material: Material | str | Attribute
) -> Material:
    if isinstance(material, Material):
        return material
    if not isinstance(material, Attribute):
        return named(material)
    if material.element != "face" or material.mesh is not structure:
        raise MeshError(f"{material!r} is no attribute of the faces of this mesh")
    if material.default.ndim or material.default.dtype.kind not in "iub":
        raise MeshError(f"a material is one integer per face, its place, not {material!r}")
    face = nearest_face(structure, impact).face
    known, place = list(MATERIALS.values()), material[face]
    if not 0 <= place < len(known):
        words = f"material {place} is none of {len(known)}: {', '.join(MATERIALS)}"
        raise MeshError(words, faces=[face])
    return known[int(place)]


def in_place(
    structure: Structure, broken: Plan, shards: Sequence[TriangleMesh], counts: dict[str, int],
    parts: Callable[[TriangleMesh], list[TriangleMesh]] = islands, **told: Any,
) -> Fracture:  # fmt: skip
    """The fracture of what ``break_surface`` broke; the structure keeps the rest, in ``parts``."""
    left = structure.to_triangles()  # now: the structure may change before the rest is asked for
    rest = LazyMeshes(lambda: parts(left))
    became = {words: int((broken.outcome == it).sum()) for words, it in OUTCOMES.items()}
    return Fracture(
        impact=broken.target, direction=-np.cross(broken.frame[0], broken.frame[1]), shards=shards,
        rest=rest, counts=became | counts, find_neighbors=lambda: sharing_edges([*shards, *rest]),
        **told,
    )  # fmt: skip


def break_surface(
    structure: Structure, impact: ArrayLike, material: Material, seed: int,
    scale: float | None = None,
) -> tuple[Plan, Indices, float]:  # fmt: skip
    """Split all that ``shatter`` splits -> what became of it, the split faces, the diagonal.

    One edit, of which followers are told whatever happens.
    """
    found = nearest_face(structure, impact)
    low, high = bounds(structure.points)
    size = float(length(high - low))
    if not size > 0:
        raise MeshError("all vertices lie in one point; there is no surface that could be broken")
    tolerance = max(TOLERANCE * size, ROUNDING * float(np.abs([low, high]).max()))
    offsets = break_points(material, seed, material.scale * size if scale is None else scale)
    frame, start = tangent(structure, found.face), np.array([found.face])
    out, log = structure.scratch(len(offsets) + 4)
    plan = make_plan(found.point, tolerance, out, log, start=start, frame=frame, offsets=offsets)
    try:
        done = structure.run(breaking, plan)
    finally:
        split = Edit("break_surface", -1, log[1 : log[0] + 1])
        if log[0]:
            structure.tell(split.kind, split.touched)
    if done < 0:
        raise RuntimeError("there was not enough room for the splits")
    new = np.union1d(split.created_faces, split.changed_faces).astype(np.int64)
    return plan, new, size


def break_points(material: Material, seed: int, step: float) -> Floats:
    """(k, 2) float64: break points around 0, circle by circle, uniform in each (thesis 4.4).

    Circle i, from 0, has the radius (i + 0.5) · ``step``. By rejection, so that nothing but exact
    arithmetic decides, the same on every machine. Raises MeshError for a step that is no length,
    and a seed that is none.
    """
    step = min(positive(step, "the scale of the circles"), 1e100)  # whose square is a number, too
    random = generator(seed).random
    circles = [np.zeros((0, 2))]
    for i, count in enumerate(material.circles):
        within = np.zeros((0, 2))
        while len(within) < count:
            tried = 2 * random((count, 2)) - 1
            inside = tried[:, 0] * tried[:, 0] + tried[:, 1] * tried[:, 1] <= 1
            within = np.concatenate([within, tried[inside]])
        circles.append(within[:count] * ((i + 0.5) * step))
    return np.concatenate(circles)


def tangent(structure: Structure, face: int) -> Floats:
    """(2, 3): two axes in the plane of a face, as near to x, y or z as can be."""
    (normal,) = normals(face_corners(structure, np.array([face])))
    if not normal.any():
        raise MeshError("the face under the impact has no area; strike beside it", faces=[face])
    normal = unit(normal)
    axis = np.zeros(3)
    axis[np.abs(normal).argmin()] = 1
    first = unit(axis - normal * normal[np.abs(normal).argmin()])
    return np.stack([first, np.cross(normal, first)])


def sharing_edges(pieces: Sequence[TriangleMesh]) -> Indices:
    """(k, 2): the pieces that share an edge, by position, each pair once and ascending.

    Cost O(faces log faces), and that of the pairs.
    """
    from scipy.sparse import csr_array, triu

    corners = np.concatenate([it.points[it.triangles] for it in pieces])
    owner = np.repeat(np.arange(len(pieces)), [len(it.triangles) for it in pieces])
    _, vertex = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    vertex = vertex.reshape(-1, 3)
    sides = np.sort(np.concatenate([vertex, np.roll(vertex, -1, axis=1)]).reshape(2, -1).T)
    _, side = np.unique(sides, axis=0, return_inverse=True)
    holds = csr_array((np.ones(len(side)), (np.repeat(owner, 3), side)))
    return np.unique(np.stack(triu(holds @ holds.T, 1).nonzero(), axis=1, dtype=np.int64), axis=0)
