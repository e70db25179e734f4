"""What a mesh consists of, in numbers."""

from dataclasses import dataclass

import numpy as np

from hem.arrays import Indices
from hem.meshes.components import components


@dataclass(frozen=True)
class MeshSummary:
    """What a mesh consists of. Vertices without faces count in `vertices` and `unreferenced` only.

    `euler` is V - E + F and `components` the connected parts, both of the vertices that have
    faces. A vertex' valence is its number of edges; 0 for a mesh without faces.
    """

    vertices: int
    edges: int
    faces: int
    border_edges: int
    components: int
    euler: int
    unreferenced: int
    valence_min: int
    valence_mean: float
    valence_max: int

    def __str__(self) -> str:
        rows = {
            "vertices": f"{self.vertices:,} ({self.unreferenced:,} without faces)",
            "edges": f"{self.edges:,} ({self.border_edges:,} on the border)",
            "faces": f"{self.faces:,}",
            "components": f"{self.components:,}",
            "Euler number": f"{self.euler:,}",
            "valence": f"{self.valence_min:,} … {self.valence_max:,}, mean {self.valence_mean:.2f}",
        }
        return "\n".join(f"{name:<13} {value}" for name, value in rows.items())


def summarize(n: int, n_faces: int, edges: Indices, faces_per_edge: Indices) -> MeshSummary:
    """The summary of n vertices and the faces that have these undirected edges (k, 2)."""
    valence = np.bincount(edges.ravel(), minlength=n)
    used = valence[valence > 0] if len(edges) else np.zeros(1, np.int64)
    unreferenced = int(np.count_nonzero(valence == 0))
    return MeshSummary(
        vertices=n, edges=len(edges), faces=n_faces,
        border_edges=int(np.count_nonzero(faces_per_edge == 1)),
        components=components(n, edges)[0] - unreferenced,
        euler=n - unreferenced - len(edges) + n_faces, unreferenced=unreferenced,
        valence_min=int(used.min()), valence_mean=float(used.mean()), valence_max=int(used.max()),
    )  # fmt: skip
