"""PyVista: VTK's meshes; points and cells, with links from points to cells."""

from collections.abc import Callable
from operator import attrgetter
from typing import Any

from experiments.peers.peer import Mesh, Peer
from hem.arrays import Array


def _build(points: Array, triangles: Array) -> Mesh:
    from pyvista import PolyData

    return PolyData.from_regular_faces(points, triangles)


def _faces_of_face(m: Mesh) -> Callable[[int], Any]:
    return lambda face: m.cell_neighbors(face, "edges")


PEER = Peer(
    title="PyVista",
    distribution="pyvista",
    module="pyvista",
    manual="Filters of the whole mesh; `point_neighbors`, `point_cell_ids` and `cell_neighbors` "
    "for one element. Edges are no elements of a surface.",
    more="Drawing, volumes and grids, scalars and vectors on them, slices, contours and "
    "streamlines, and files of simulations: VTK in Python.",
    build=_build,
    faces=lambda m: int(m.n_cells),
    single={
        "vertex_vertices": attrgetter("point_neighbors"),
        "vertex_faces": attrgetter("point_cell_ids"),
        "face_vertices": lambda m: lambda face: m.get_cell(face).point_ids,
        "face_faces": _faces_of_face,
    },
    algorithms={
        "vertex_normals": lambda m: m.compute_normals(
            cell_normals=False, split_vertices=False, consistent_normals=False
        )["Normals"],
        "smooth": lambda m: m.smooth(n_iter=1, relaxation_factor=1.0),
        "simplify": lambda m, faces: m.decimate(1 - faces / m.n_cells).n_cells,
    },
)
