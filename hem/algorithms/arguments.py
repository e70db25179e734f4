"""What algorithms are asked with, checked before anything changes."""

from __future__ import annotations

from contextlib import suppress
from numbers import Real
from typing import Any

import numpy as np

from hem.algorithms.parts import side_keys
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


def require_surface(s: Structure, called: str) -> None:
    """Raise TopologyError where some splits, flips or collapses would be refused.

    Cost: ``face_faces`` of all; O(n_t log n_t) where nothing is recorded of neighbors.
    """
    inner = 3 * s.n_faces - s.n_edges  # where an edge of the border has one face, they have two
    if s.searches or s.rebuilds:
        keys, faces = side_keys(s)
        inner, crowded = (faces == 2).sum(), keys[faces > 2]
        if len(crowded):
            edges = np.stack([crowded >> 32, crowded & 0xFFFFFFFF], axis=1)
            raise TopologyError(f"cannot {called}: edges lie in more than two faces", edges=edges)
    if len(s.face_faces().values) < 2 * inner:  # each neighbor is told once
        corners = np.sort(s.triangles(), axis=1)
        _, first, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
        raise TopologyError(
            f"cannot {called}: faces have the same three corners; remove one of each pair",
            faces=s.faces()[first[count > 1]],
        )
