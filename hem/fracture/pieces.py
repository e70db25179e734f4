"""What a mesh broke into: its pieces, what they weigh, and the parts that nothing holds."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from hem.arrays import Floats, Indices
from hem.errors import MeshError
from hem.fracture.mass import Mass, of_bodies, of_sheets
from hem.fracture.material import Material
from hem.meshes import TriangleMesh, components, used_only


@dataclass(frozen=True, eq=False)
class Fracture:
    """What a blow made of a mesh: shards, and the rest of it.

    method     how it was broken: ``surface``, ``tetra`` or ``voronoi``
    impact     (3,) float64: where the blow struck, on the surface
    direction  (3,) float64, of length 1: where the blow goes, into the surface
    shards     the pieces that came out, each a mesh of its own; closed bodies but for ``surface``
    rest       what is left, the largest part first; the others are islands that nothing holds
    counts     what became of the break points: ``used``, ``outside``, ``on a vertex`` …
    """

    method: str
    material: Material
    seed: int
    impact: Floats
    direction: Floats
    shards: Sequence[TriangleMesh]
    rest: Sequence[TriangleMesh]
    counts: Mapping[str, int]
    diagonal: float
    """Of the bounding box of what was struck; what the material's lengths are parts of."""

    find_neighbors: Callable[[], Indices]

    def __getstate__(self) -> dict[str, Any]:
        """Pickled with all that is made when it is asked for."""
        made = {"shards": [*self.shards], "rest": [*self.rest]}
        return self.__dict__ | made | {"find_neighbors": self.neighbors.copy}

    @property
    def closed(self) -> bool:
        """Whether the pieces are bodies; else they are parts of a sheet of some thickness."""
        return self.method != "surface"

    @cached_property
    def pieces(self) -> list[TriangleMesh]:
        """All shards, then all parts of the rest."""
        return [*self.shards, *self.rest]

    @cached_property
    def neighbors(self) -> Indices:
        """(k, 2): the pieces that touch along more than a point, each pair once and ascending."""
        return self.find_neighbors()

    def free(self, held: Any) -> Indices:
        """The indices of all pieces but those that are ``held``. MeshError for what are none."""
        try:
            return np.delete(np.arange(len(self.pieces)), held)
        except (IndexError, TypeError, ValueError):
            words = f"{len(self.pieces):,} pieces, not {held!r:.60}"
            raise MeshError(f"what is held are indices of {words}") from None

    @cached_property
    def mass(self) -> Mass:
        """What the pieces weigh. Cost O(faces)."""
        volumes, masses, centers, inertias = self.of_density_1
        density = self.material.density
        return Mass(volumes, density * masses, centers, density * inertias)

    @cached_property
    def of_density_1(self) -> Mass:
        """The same if it were of 1 kg / m³: how they move does not depend on the density."""
        if self.closed:
            return of_bodies(self.pieces, 1.0)
        return of_sheets(self.pieces, 1.0, self.material.thickness * self.diagonal)


def islands(mesh: TriangleMesh) -> list[TriangleMesh]:
    """The connected parts of a mesh, the largest by area first, without vertices no face uses.

    Faces are connected that share a vertex. Vertices and faces keep their order. O(n + m log m).
    """
    require_triangle_mesh(mesh, "islands")
    triangles = mesh.triangles
    if not len(triangles):
        return []
    _, label = components(len(mesh.points), np.concatenate([triangles[:, :2], triangles[:, 1:]]))
    part = label[triangles[:, 0]]
    order = np.argsort(part, kind="stable")
    groups = np.split(triangles[order], np.flatnonzero(np.diff(part[order])) + 1)
    found = [TriangleMesh(*used_only(mesh.points, it), mesh.points.dtype) for it in groups]
    return sorted(found, key=lambda it: -it.area())


def require_triangle_mesh(mesh: Any, called: str) -> None:
    """Raise MeshError for what is no TriangleMesh."""
    if not isinstance(mesh, TriangleMesh):
        raise MeshError(
            f"{called} takes a TriangleMesh, such as hem.load(path), s.to_triangles() or "
            f"polygons.triangulated(), not {type(mesh).__name__}"
        )
