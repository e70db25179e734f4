"""Bodies: meshes with an inside, which is what can be broken through."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hem import meshes
from hem.arrays import Array, Bools, Floats, Indices
from hem.errors import MeshError, load_optional
from hem.fracture.pieces import require_triangle_mesh
from hem.meshes import TriangleMesh, components, corners, diagonal, dot, normals, used_only, volume
from hem.sources import meshlab

_INSTEAD = (
    "wrap it in a body with hem.fracture.wrapped(mesh) (--wrap), or break it by the method surface"
)


@dataclass(frozen=True, eq=False)
class Body:
    """A closed, outward oriented mesh that nowhere crosses itself: ``require_body`` makes it.

    Its components may be several, and some of them hollows in others. No vertex is without faces.
    """

    mesh: TriangleMesh

    @cached_property
    def corners(self) -> Floats:
        """(m, 3, 3): of the faces, in float64."""
        return corners(self.mesh.points, self.mesh.triangles)

    @cached_property
    def volume(self) -> float:
        """In the units of the points, cubed."""
        return volume(self.corners)

    @cached_property
    def diagonal(self) -> float:
        """Of the bounding box."""
        return diagonal(self.mesh.points)

    @cached_property
    def manifold(self) -> Any:
        """The body for manifold3d; face i of the mesh is face i there, whatever is cut off it."""
        points, triangles = self.mesh.points.astype(np.float64), self.mesh.triangles
        return to_manifold(points, triangles, np.arange(len(triangles)))

    def contains(self, points: ArrayLike) -> Bools:
        """Which of k positions (k, 3) are inside: (k,). Cost O(faces) each."""
        at = np.asarray(points, np.float64).reshape(-1, 3)
        return windings(self.corners, at) > 0


class Shell(NamedTuple):
    """A closed surface, and the labels of its faces (m,)."""

    mesh: TriangleMesh
    labels: Array


def require_body(mesh: TriangleMesh) -> Body:
    """The body that a mesh encloses.

    Vertices without faces are left out, so that vertices may be renumbered; faces keep their order.
    Raises MeshError with the elements and what to do about them: for a mesh that is empty or open,
    where faces do not fit together or intersect each other, and for one that is inside out, all of
    it or some component. Cost O(m log m), and O(m) for each component if there are several; 0.2 s
    for 50,000 faces, most of it for the intersections, which pymeshlab finds.
    """
    require_triangle_mesh(mesh, "require_body")
    if not len(mesh.triangles):
        raise MeshError("an empty mesh has no inside that could be broken")
    _require_closed(mesh)
    body = Body(TriangleMesh(*used_only(mesh.points, mesh.triangles)))
    if not body.volume > 0:
        raise MeshError(
            f"the mesh is inside out: its volume is {body.volume:.6g}; turn it with mesh.flipped()"
            if body.volume < 0
            else f"the mesh is flat and has no inside; {_INSTEAD}"
        )
    crossing = meshlab.intersecting_faces(body.mesh)
    if len(crossing):
        raise MeshError(f"the mesh intersects itself; {_INSTEAD}", faces=crossing)
    _require_nested(body)
    return body


def wrapped(mesh: TriangleMesh, detail: float = 0.015, offset: float = 0.002) -> TriangleMesh:
    """A body around any mesh, open, intersecting itself or in pieces, as if shrunk onto it.

    A new mesh altogether: its vertices lie ``offset`` × diagonal outside of the old surface, so
    that a sheet becomes a wall of twice that. Where the way in is narrower than ``detail`` ×
    diagonal (a hole, a slit, the mouth of a spout) it is closed, and what is behind it filled;
    edges are rounded. So the teapot becomes one solid piece, with its handle still a handle. The
    number of faces grows with 1 / detail², and so does the time; 0.9 s for the teapot. Raises
    MeshError for a mesh without faces or size, and for numbers that are not between 0 and 1.

    Source: Portaneri et al., Alpha wrapping with an offset, 2022, as pymeshlab has it from CGAL.
    """
    require_triangle_mesh(mesh, "wrapped")
    if not len(mesh.triangles):
        raise MeshError("an empty mesh cannot be wrapped")
    if not all(isinstance(it, Real) and 0 < it < 1 for it in (detail, offset)):
        words = "detail and offset are parts of the diagonal, between 0 and 1"
        raise MeshError(f"{words}, not {detail!r} and {offset!r}")
    percent = {"alpha": 100 * detail, "offset": 100 * offset}
    found = meshlab.apply("generate_alpha_wrap", mesh, percent=percent)
    if not len(found.triangles):
        raise MeshError("there is nothing to wrap: all points of the mesh lie in one place")
    return found


def to_manifold(points: Floats, triangles: Array, labels: Array) -> Any:
    """A closed mesh for manifold3d, whose faces keep their labels (m,) through all operations.

    Raises MeshError where manifold3d does not take it for closed.
    """
    manifold3d = load_optional("manifold3d", "fracture")

    faces, ids = (np.ascontiguousarray(it, np.uint64) for it in (triangles, labels))
    mesh = manifold3d.Mesh64(np.ascontiguousarray(points), faces, face_id=ids)
    made = manifold3d.Manifold(mesh)
    if made.status() != manifold3d.Error.NoError:
        raise MeshError(f"manifold3d takes the mesh for no body: {made.status()}")
    return made


def from_manifold(made: Any) -> tuple[TriangleMesh, Indices]:
    """A mesh from manifold3d, rounded to float32, and the labels of its faces (m,).

    Edges that have no length then are collapsed. Vertices that coincide otherwise, where a surface
    touches itself, and flat faces between others are left: they keep the surface closed.
    """
    raw = made.to_mesh64()
    labels = np.asarray(raw.face_id, np.int64)
    # Faces come ordered by which mesh was handed to manifold3d first, which is chance.
    order = np.argsort(labels, kind="stable")
    points = np.asarray(raw.vert_properties)[:, :3].astype(np.float32)
    mesh = TriangleMesh(points, np.asarray(raw.tri_verts).astype(np.int32)[order])
    return collapsed(mesh, labels[order])


def collapsed(mesh: TriangleMesh, labels: Array) -> tuple[TriangleMesh, Array]:
    """The mesh with edges of no length collapsed, and the labels (m,) of the faces that are left.

    One vertex, three edges and two faces fewer each time; the shape is the same. An edge stays
    whose two ends have more neighbors in common than the corners across it, as two sheets would
    come to hang together there. Cost O(m log m), and O(m) for each such edge.
    """
    points, triangles = mesh.points, mesh.triangles.copy()
    alive = np.ones(len(triangles), bool)
    found = True
    while found:
        found = False
        edges, _ = meshes.undirected_edges(triangles[alive])
        for keep, drop in edges[(points[edges[:, 0]] == points[edges[:, 1]]).all(axis=1)]:
            found |= _collapse(triangles, alive, keep, drop)
    if alive.all():
        return mesh, labels
    return TriangleMesh(*used_only(points, triangles[alive])), labels[alive]


def _collapse(triangles: Array, alive: Bools, keep: int, drop: int) -> bool:
    """Put one vertex in place of another -> whether they were joined by an edge that may go."""
    of_keep = alive & (triangles == keep).any(axis=1)
    of_drop = alive & (triangles == drop).any(axis=1)
    across = of_keep & of_drop
    common = np.intersect1d(triangles[of_keep], triangles[of_drop])
    # Two ends, two corners across; four faces or more, or a tetrahedron would fold flat.
    few = (of_keep | of_drop).sum() <= 4
    if across.sum() != 2 or len(common) != 4 or few:
        return False
    alive[across] = False
    rows = triangles[of_drop]
    rows[rows == drop] = keep
    triangles[of_drop] = rows
    return True


def with_hollows(shells: Sequence[Shell]) -> list[Shell]:
    """The bodies of connected shells, the largest first.

    A shell inside out is a hollow, and belongs to the smallest body around it.
    """
    bodies: list[Shell] = []
    for shell in sorted(shells, key=lambda it: it.mesh.volume(), reverse=True):
        if shell.mesh.volume() > 0 or not bodies:  # one without volume is no hollow of another
            bodies.append(shell)
            continue
        at = shell.mesh.points[:1].astype(np.float64)
        outer = [corners(it.mesh.points, it.mesh.triangles) for it in bodies]
        around = [i for i, it in enumerate(outer) if windings(it, at)[0] > 0]
        # The smallest around is the last. Rounding may put a vertex on the surface: then no other.
        chosen = around[-1] if around else 0
        both = bodies[chosen], shell
        mesh = TriangleMesh(*meshes.joined((it.mesh.points, it.mesh.triangles) for it in both))
        bodies[chosen] = Shell(mesh, np.concatenate([it.labels for it in both]))
    return sorted(bodies, key=lambda it: -it.mesh.volume())


def windings(corners: Floats, at: Floats) -> Indices:
    """How many times a closed surface winds around each of k positions: (k,), 0 outside.

    Counts the faces above each position, those that look up less those that look down. Two faces
    decide on which side of their common edge a position is by the same numbers, so that one of
    them is hit and never both. Positions within rounding of the surface may go either way.
    Only + - and *, element by element and in one order: the same on every machine. Triangles are
    given as their corners, (m, 3, 3) float64. Cost O(m) for each position.
    """
    low, high = corners.min(axis=1), corners.max(axis=1)
    found = np.zeros(len(at), np.int64)
    for i, p in enumerate(at):
        near = (low[:, 0] <= p[0]) & (p[0] <= high[:, 0]) & (low[:, 1] <= p[1])
        near &= (p[1] <= high[:, 1]) & (p[2] <= high[:, 2])
        faces = corners[near]
        turn = _turns(faces, p)
        above = dot(normals(faces), faces[:, 0] - p) * turn > 0
        found[i] = turn[above].sum()
    return found


def _turns(faces: Floats, p: Floats) -> Indices:
    """+1 for the faces over or under p that look up, -1 for those that look down, else 0: (m,).

    Each is a triangle in the plane, and is wound around p as often as its sides to the right of p
    go up rather than down.
    """
    turn = np.zeros(len(faces), np.int64)
    for i in range(3):
        a, b = faces[:, i], faces[:, (i + 1) % 3]
        up = (a[:, 1] <= p[1]) & (p[1] < b[:, 1])
        down = (b[:, 1] <= p[1]) & (p[1] < a[:, 1])
        lower, upper = np.where(up[:, None], a, b), np.where(up[:, None], b, a)
        side = upper - lower
        right = side[:, 0] * (p[1] - lower[:, 1]) - side[:, 1] * (p[0] - lower[:, 0]) > 0
        turn += (up & right).astype(np.int64) - (down & right)
    return turn


def _require_closed(mesh: TriangleMesh) -> None:
    """Raise MeshError unless each edge is in two faces that run along it in opposite directions."""
    edges, faces = meshes.undirected_edges(mesh.triangles)
    border = edges[faces == 1]
    if len(border):
        some = f"{len(border):,} border edge{'s' if len(border) > 1 else ''}"
        raise MeshError(f"the mesh is open, with {some}; {_INSTEAD}", edges=border)
    finders = meshes.non_manifold_edges, meshes.same_way_edges
    bad = np.concatenate([find(mesh.triangles) for find in finders])
    if len(bad):
        raise MeshError(
            "more than two faces meet at an edge, or two that run the same way along it; mend it "
            f"(hem.load and hem.sample take repair=True), {_INSTEAD}",
            edges=bad,
        )


def _require_nested(body: Body) -> None:
    """Raise MeshError unless each component is outward in the open, or a hollow inside another."""
    triangles = body.mesh.triangles
    sides = np.concatenate([triangles[:, :2], triangles[:, 1:]])
    count, component = components(len(body.mesh.points), sides)
    for i in range(count if count > 1 else 0):
        own = component[triangles[:, 0]] == i
        outward = volume(body.corners[own]) > 0
        places = body.mesh.points[component == i].astype(np.float64)
        some = places[:: len(places) // 9 + 1]  # one may lie on another component, which it touches
        around = np.median(windings(body.corners[~own], some))
        if around != (0 if outward else 1):
            raise MeshError(
                "a component lies inside another one that it is no hollow of, or is inside out; "
                "turn its faces around or take it out",
                faces=np.flatnonzero(own),
            )
