"""What programs do with meshes, each algorithm written once over the contract of all structures.

It is compiled for every structure from that one source (``Structure.run``), and interpreted for
those of objects; all structures give the same. ``hem/algorithms/README.md`` shows how to write
one's own. What else changes meshes checks them by `require_mesh` and `require_edges`, and
calculates by `cross`, `dot` and `nearest_weights`.
"""

from hem.algorithms.arguments import require_edges as require_edges
from hem.algorithms.arguments import require_mesh as require_mesh
from hem.algorithms.impacts import impacts
from hem.algorithms.nearest import nearest_weights as nearest_weights
from hem.algorithms.normals import vertex_normals
from hem.algorithms.parts import cross as cross
from hem.algorithms.parts import dot as dot
from hem.algorithms.remeshing import remesh
from hem.algorithms.sieger_botsch import SIX, center, circulate, split_and_collapse
from hem.algorithms.simplification import MEASURES, simplify
from hem.algorithms.smoothing import METHODS, smooth
from hem.algorithms.subdivision import SCHEMES, subdivide

__all__ = [
    "MEASURES", "METHODS", "SCHEMES", "SIX", "center", "circulate", "impacts", "remesh", "simplify",
    "smooth", "split_and_collapse", "subdivide", "vertex_normals",
]  # fmt: skip
