"""Names for the arrays that meshes are made of."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]

Points = NDArray[np.float32]
"""(n, 3): positions."""

Triangles = NDArray[np.int32]
"""(n, 3): the corners of triangles, counterclockwise from outside."""

Indices = NDArray[np.int64]
"""Indices of elements, computed from a mesh."""

Handles = NDArray[np.int32]
"""Handles of vertices or faces, as queries answer them."""
