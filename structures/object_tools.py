"""What the thesis has around its class model: the builder and the behaviours.

See ``structures.half_edge_objects`` for the mesh itself.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hem.arrays import Handles
from hem.edit import Edit
from hem.rendering import mesh_from_render
from structures.half_edge_objects import HalfEdgeMesh
from structures.objects import Face, HalfEdge, Vertex, build_records


class HalfEdgeMeshBuilder:
    """From a render mesh to objects and back (thesis 3.3)."""

    records = staticmethod(build_records)

    @staticmethod
    def from_render_mesh(
        points: ArrayLike, indices: ArrayLike, tolerance: float = 0.0
    ) -> HalfEdgeMesh:
        """The half-edge mesh behind a render mesh: welded, and its winding turned. O(n + m).

        See ``hem.mesh_from_render``.
        """
        return HalfEdgeMesh.build(mesh_from_render(points, indices, tolerance))

    @staticmethod
    def to_render_mesh(mesh: HalfEdgeMesh) -> tuple[NDArray[np.float32], Handles]:
        """Flat points (3 n,) and clockwise indices (3 m,) by the face circulator. O(n_v + n_t)."""
        number = {v.index: i for i, v in enumerate(mesh.vertices)}
        points = [v.point for v in mesh.vertices]
        indices = [number[h.origin.index] for f in mesh.faces for h in mesh.faces.circulator(f)]
        return np.array(points, np.float32).reshape(-1), np.array(indices, np.int32)


class _SplittingBehaviour:
    """Splits a mesh, and remembers the faces that it made."""

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self.mesh = mesh
        self.created_faces: list[Face] = []

    def _remember(self, edit: Edit) -> Vertex:
        self.created_faces += [self.mesh.faces[f] for f in edit.created_faces.tolist()]
        return self.mesh.vertices[edit.vertex]


class EdgeSplittingBehaviour(_SplittingBehaviour):
    """Splits edges of a mesh, and remembers the faces that it made (thesis 4.1)."""

    def split_half_edge(self, half_edge: HalfEdge, point: ArrayLike) -> Vertex:
        """Put a new vertex on an edge -> the vertex. See ``Structure.split_edge``."""
        return self._remember(self.mesh.split_edge(half_edge.edge, point))


class FaceSplittingBehaviour(_SplittingBehaviour):
    """Splits faces of a mesh, and remembers the faces that it made (thesis 4.3)."""

    def split_face(self, face: Face, point: ArrayLike) -> Vertex:
        """Put a new vertex into a face -> the vertex. See ``Structure.split_face``."""
        return self._remember(self.mesh.split_face(face.index, point))

    def split_all_faces(self) -> list[Vertex]:
        """Split every face at its centroid, as one edit -> the new vertices."""
        end = self.mesh.face_end
        made = self.mesh.split_all_faces()
        self.created_faces += self.mesh.faces.items[end:]
        return [self.mesh.vertices[v] for v in made.tolist()]
