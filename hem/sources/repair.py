"""Mending what keeps a mesh from being a surface, with pymeshlab's own repair filters."""

from hem import meshes
from hem.errors import NonManifoldError
from hem.meshes import TriangleMesh, require_manifold
from hem.sources.meshlab import apply

# Each filter is applied only where its fault is found: they leave a sound mesh as it is, but they
# may renumber. And as long as it changes something: of several fans it parts off one at a time. In
# this order, since winding can only be made coherent along manifold edges.
_REPAIRS = (
    (meshes.non_manifold_edges, "meshing_remove_duplicate_faces"),
    (meshes.non_manifold_edges, "meshing_repair_non_manifold_edges"),
    (meshes.same_way_edges, "meshing_remove_duplicate_faces"),
    (meshes.same_way_edges, "meshing_re_orient_faces_coherently"),
    (meshes.split_vertices, "meshing_repair_non_manifold_vertices"),
)


def repaired(mesh: TriangleMesh) -> TriangleMesh:
    """The mesh as a surface: itself where it is one, else mended.

    Repeated faces go, faces beyond two go from an edge, faces are turned to run coherently, and a
    vertex of several fans becomes one vertex per fan; such new vertices come last, all others keep
    their index. Raises NonManifoldError for what no filter mends: a one-sided surface, say.
    """
    for fault, filter_name in _REPAIRS:
        before = None
        while len(fault(mesh.triangles)) and before != (len(mesh.points), len(mesh.triangles)):
            before = len(mesh.points), len(mesh.triangles)
            mesh = apply(filter_name, mesh)
    try:
        require_manifold(mesh)
    except NonManifoldError as error:
        found, _, _ = error.reason.partition(";")  # behind it is the advice to repair
        words = f"beyond repair: {found}; use the indexed mesh"
        raise NonManifoldError(words, **error.elements) from error
    return mesh
