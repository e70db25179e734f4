"""What algorithms are asked with, checked before anything changes."""

from __future__ import annotations

from contextlib import suppress
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

from hem.algorithms.parts import living_vertex
from hem.arrays import each_once
from hem.authoring import VERTEX_END, Kernel, Kernels, kernel, walks
from hem.contract import Structure
from hem.errors import MeshError, TopologyError


def require_mesh(s: Any, called: str) -> None:
    """Raise MeshError for what is no structure, or holds larger faces than triangles."""
    if not isinstance(s, Structure):
        raise MeshError(
            f"{called} takes a structure, such as structures.build('half_edge', mesh), "
            f"not {type(s).__name__}"
        )
    if s.most_corners > 3:
        faces = s.faces()
        larger = faces[s.face_vertices(faces).counts > 3]
        if len(larger):
            raise MeshError(
                f"{called} takes triangles only; build one of to_triangles() or triangulated()",
                faces=larger,
            )


def require_count(called: str, name: str, value: Any, least: int = 0) -> int:
    """The value, if it is an integer of at least so much; else MeshError."""
    if isinstance(value, int | np.integer) and not isinstance(value, bool) and value >= least:
        return int(value)
    raise MeshError(f"{called} takes {name} as an integer from {least} on, not {value!r}")


def require_length(called: str, name: str, value: Any) -> float:
    """The value, if it is a real number from 0 on, infinity included; else MeshError."""
    if isinstance(value, Real) and not isinstance(value, bool):
        with suppress(OverflowError):  # an integer that is no float any more
            if float(value) >= 0:
                return float(value)
    raise MeshError(f"{called} takes {name} as a length from 0 on, not {value!r:.60}")


class Counting(NamedTuple):
    """The scratch to count with."""

    out: Any


def finding_pillows(k: Kernels, operations: Kernels) -> Kernel:
    """Make ``find(m, plan) -> vertex``: one that two faces share both of their edges at, or -1.

    Such faces have the same three corners. There is one fan of faces at every vertex.
    """
    lives, count_faces = living_vertex(k), walks.counting(k["vertex_faces"])
    count_neighbors = walks.counting(k["vertex_vertices"])

    @kernel
    def find(m: Any, plan: Counting) -> int:
        for v in range(m.counts[VERTEX_END]):
            faces = count_faces(m, v, plan.out) if lives(m, v) else 0
            if faces == 2 and count_neighbors(m, v, plan.out) == 2:
                return v
        return -1

    return find


def require_edges(s: Structure, called: str) -> None:
    """Raise TopologyError for edges in more than two faces, or in two that pass them the same way.

    Cost O(n_t log n_t) where nothing is recorded of neighbors; else O(1), as none can be held.
    """
    if s.searches or s.rebuilds:
        here = s.triangles().astype(np.int64)
        sides = np.sort((here << 32 | np.roll(here, -1, axis=1)).reshape(-1))
        crowded = each_once(sides[1:][sides[1:] == sides[:-1]])
        if len(crowded):
            edges = np.sort(np.stack([crowded >> 32, crowded & 0xFFFFFFFF], axis=1), axis=1)
            words = "edges lie in more than two faces, or in two that pass them the same way"
            raise TopologyError(f"cannot {called}: {words}", edges=np.unique(edges, axis=0))


def require_surface(s: Structure, called: str) -> None:
    """Raise TopologyError where some splits, flips or collapses would be refused.

    Cost: ``vertex_faces`` of all; O(n_t log n_t) where nothing is recorded of neighbors.
    """
    require_edges(s, called)
    if not (s.searches or s.rebuilds) and s.run(finding_pillows, Counting(s.scratch(0)[0])) < 0:
        return
    corners = np.sort(s.triangles(), axis=1)
    _, first, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    if (count > 1).any():
        raise TopologyError(
            f"cannot {called}: faces have the same three corners; remove one of each pair",
            faces=s.faces()[first[count > 1]],
        )
