"""The six algorithms by which Sieger & Botsch compare mesh libraries, each a function of a mesh.

Source: Design, Implementation, and Evaluation of the Surface_mesh Data Structure (2011), section 4.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hem.algorithms.circulating import center, circulate
from hem.algorithms.normals import vertex_normals
from hem.algorithms.parts import change, doing, require_mesh
from hem.algorithms.smoothing import smooth
from hem.algorithms.sqrt3 import Plan, split_all_faces, sqrt3
from hem.authoring import NEEDS_ROOM, VERTEX_END, Kernel, Kernels, kernel
from hem.contract import Structure


def collapsing(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``collapse_new(m, plan) -> 0``: every new vertex into the smallest of its neighbors."""
    vertex_edges, edge_vertices = k["vertex_edges"], k["edge_vertices"]
    collapse_edge = doing(operations["collapse_edge"])

    @kernel
    def collapse_new(m: Any, plan: Plan) -> int:
        out, at = plan.work.out, plan.work.at
        while plan.old[0] + plan.next[0] < m.counts[VERTEX_END]:
            v = plan.old[0] + plan.next[0]
            edge, least = -1, v
            for i in range(vertex_edges(m, v, out)):
                edge_vertices(m, out[i], at)
                if at[0] < least:
                    edge, least = out[i], at[0]
            if edge >= 0 and collapse_edge(m, edge, least, plan.work) == NEEDS_ROOM:
                return NEEDS_ROOM
            plan.next[0] += 1
        return 0

    return collapse_new


def split_and_collapse(s: Structure) -> None:
    """Put a vertex into every face, and collapse each into a corner again; then ``compact``.

    The mesh is what it was, but handles may have changed. Three edits. Cost: a split and a collapse
    per face. MeshError for polygons.
    """
    require_mesh(s, "split_and_collapse")
    change(s, "split_and_collapse", collapsing, split_all_faces(s, "split_and_collapse"))
    s.compact()


SIX: dict[str, Callable[[Structure], Any]] = {
    "circulator": circulate,
    "barycenter": center,
    "normals": vertex_normals,
    "smoothing": smooth,
    "subdivision": sqrt3,
    "collapse": split_and_collapse,
}
"""By the names that they have there."""
