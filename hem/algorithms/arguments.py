"""What algorithms are asked with, checked before anything changes."""

from __future__ import annotations

from typing import Any

import numpy as np

from hem.contract import Structure
from hem.errors import MeshError


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
    """The value, if it is a number from 0 on, infinity included; else MeshError."""
    if isinstance(value, int | float | np.number) and float(value) >= 0:
        return float(value)
    raise MeshError(f"{called} takes {name} as a length from 0 on, not {value!r}")
