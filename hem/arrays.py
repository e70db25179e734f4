"""Names for the arrays that meshes are made of."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]

Points = NDArray[np.floating[Any]]
"""(n, 3): positions, float32, and float64 where a mesh was asked to keep them so."""

Triangles = NDArray[np.int32]  # (n, 3): the corners of triangles, counterclockwise from outside
Indices = NDArray[np.int64]  # indices of elements, computed from a mesh
Handles = NDArray[np.int32]  # handles of vertices or faces, as queries answer them


def each_once(values: Array) -> Array:
    """(k,): the values, ascending, each once. `np.unique` hashes them, which takes far longer."""
    ordered = np.sort(values, axis=None)
    return ordered[np.flatnonzero(np.append(True, ordered[1:] != ordered[:-1])[: len(ordered)])]
