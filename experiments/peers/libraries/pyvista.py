"""PyVista: VTK's meshes; points and cells, with links from points to cells."""

from operator import attrgetter

from experiments.peers.peer import Lazy, Peer

pyvista = Lazy("pyvista")

PEER = Peer(
    title="PyVista",
    distribution="pyvista",
    site="https://docs.pyvista.org/",
    manual="Filters of the whole mesh; `point_neighbors`, `point_cell_ids` and `cell_neighbors` "
    "for one element. Edges are no elements of a surface.",
    more="Drawing, volumes and grids, scalars and vectors on them, slices, contours and "
    "streamlines, and files of simulations: VTK in Python.",
    build=lambda points, triangles: pyvista.PolyData.from_regular_faces(points, triangles),
    faces=lambda m: int(m.n_cells),
    arrays=attrgetter("points", "regular_faces"),
    single={
        "vertex_vertices": attrgetter("point_neighbors"),
        "vertex_faces": attrgetter("point_cell_ids"),
        "face_vertices": lambda m: lambda face: m.get_cell(face).point_ids,
        "face_faces": lambda m: lambda face: m.cell_neighbors(face, "edges"),
    },
    algorithms={
        "vertex_normals": lambda m: m.compute_normals(
            cell_normals=False, split_vertices=False, consistent_normals=False
        )["Normals"],
        "smooth": lambda m: m.smooth(n_iter=1, relaxation_factor=1.0),
        "simplify": lambda m, faces: m.decimate(1 - faces / m.n_cells).n_cells,
    },
)
