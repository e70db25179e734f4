"""The answers to the nine queries from the triangle list alone: what the kernels are checked by.

Nothing of a structure is used here, so that a structure's mistake cannot confirm itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hem.contract.queries import Query
from hem.contract.structure import Structure
from hem.meshes.triangles import TriangleMesh

Array = NDArray[Any]


class CheckFailedError(AssertionError):
    """A structure's answer is not that of the triangle list."""


def check(s: Structure, mesh: TriangleMesh, query: Query, handles: Array) -> None:
    """Compare the answers for ``handles`` (k,) with the triangle list. Cost O(k n_t).

    Raises CheckFailedError naming the structure, the query, the handle and both answers.
    """
    asked = getattr(s, query.name)
    keys = named(s, handles) if query.source == "edge" else handles
    for handle, key in zip(handles.tolist(), keys.tolist(), strict=True):
        answer = asked(handle)
        found = named(s, answer) if query.target == "edge" else answer
        expected = neighbors(mesh.triangles, query, key)
        if sorted(found.tolist()) != expected.tolist():
            raise CheckFailedError(
                f"{s.name}.{query.name}({handle}) gives {sorted(found.tolist())}, "
                f"the triangle list {expected.tolist()}"
            )


def named(s: Structure, edges: Array) -> Array:
    """(k,) int64: edges of any structure, each as its two vertices packed into one integer."""
    return pack(s.edge_vertices(edges).values.reshape(-1, 2).astype(np.int64))


def pack(pairs: Array) -> Array:
    """(k, 2) vertices -> (k,) int64 ``smaller << 32 | larger``."""
    pairs = np.sort(np.asarray(pairs, np.int64), axis=1)
    return (pairs[:, 0] << 32) | pairs[:, 1]


def neighbors(triangles: Array, query: Query, key: int) -> Array:
    """The sorted neighbors of one element, edges packed. Cost O(n_t).

    ``key``: a vertex, a face, or an edge packed.
    """
    if query.source == "face":
        corners = triangles[key]
    else:
        corners = np.array([key] if query.source == "vertex" else [key >> 32, key & 0xFFFFFFFF])
    shared = np.isin(triangles, corners).sum(axis=1)
    if query.target == "face":
        found = np.flatnonzero(shared >= min(len(corners), 2))
    elif query.source == "vertex" or query.source == query.target:
        near = triangles[shared > 0]
        pairs = np.concatenate([near[:, [0, 1]], near[:, [1, 2]], near[:, [2, 0]]])
        pairs = pairs[np.isin(pairs, corners).any(axis=1)]
        found = pairs if query.target == "vertex" else pack(pairs)
    else:
        sides = np.stack([corners, np.roll(corners, -1)], axis=1)
        found = corners if query.target == "vertex" else pack(sides)
    return np.setdiff1d(found, [key] if query.source == query.target else [])
