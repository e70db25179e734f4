"""The answers to the nine queries from the triangle list alone: what the kernels are checked by.

Nothing of a structure is used here, so that a structure's mistake cannot confirm itself.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.contract import Query, Structure
from hem.meshes import TriangleMesh


class CheckFailedError(AssertionError):
    """A structure's answer is not that of the triangle list."""


def check_query(s: Structure, mesh: TriangleMesh, query: Query, handles: Array) -> None:
    """Compare answers for ``handles`` (k,) with the triangle list; CheckFailedError. O(k n_t)."""
    asked = getattr(s, query.name)
    keys = named(s, handles) if query.source == "edge" else handles
    for handle, key in zip(handles.tolist(), keys.tolist(), strict=True):
        answer = asked(handle)
        found = named(s, answer) if query.target == "edge" else answer
        expected = neighbors(mesh.triangles, query, key)
        if sorted(found.tolist()) != expected.tolist():
            told = f"{s.name}.{query.name}({handle}) gives {sorted(found.tolist())}"
            raise CheckFailedError(f"{told}, the triangle list {expected.tolist()}")


def named(s: Structure, edges: Array) -> Array:
    """(k,) int64: edges of any structure, each as its two vertices packed into one integer."""
    return pack(s.edge_vertices(edges).values.reshape(-1, 2).astype(np.int64))


def pack(pairs: Array) -> Array:
    """(k, 2) vertices -> (k,) int64 ``smaller << 32 | larger``."""
    pairs = np.sort(np.asarray(pairs, np.int64), axis=1)
    return (pairs[:, 0] << 32) | pairs[:, 1]


def neighbors(triangles: Array, query: Query, key: int) -> Array:
    """The sorted neighbors of one vertex, face or packed edge; edges packed. Cost O(n_t)."""
    return np.unique(RULES[query.name](triangles, key))


def _around(triangles: Array, v: int) -> Array:
    """The vertices that share a face with v."""
    return np.setdiff1d(triangles[(triangles == v).any(axis=1)], [v])


def _spokes(triangles: Array, v: int) -> Array:
    """The edges at v."""
    ring = _around(triangles, v)
    return pack(np.stack([np.full_like(ring, v), ring], axis=1))


def _ends(edge: int) -> list[int]:
    return [edge >> 32, edge & 0xFFFFFFFF]


def _shared(triangles: Array, corners: ArrayLike) -> Array:
    """How many of the corners each face has."""
    return np.isin(triangles, corners).sum(axis=1)


RULES: dict[str, Callable[[Array, int], Any]] = {
    "vertex_vertices": _around,
    "vertex_edges": _spokes,
    "vertex_faces": lambda t, v: np.flatnonzero((t == v).any(axis=1)),
    "edge_vertices": lambda t, e: _ends(e),
    "edge_edges": lambda t, e: np.setdiff1d(np.concatenate([_spokes(t, v) for v in _ends(e)]), [e]),
    "edge_faces": lambda t, e: np.flatnonzero(_shared(t, _ends(e)) == 2),
    "face_vertices": lambda t, f: t[f],
    "face_edges": lambda t, f: pack(np.stack([t[f], np.roll(t[f], -1)], axis=1)),
    "face_faces": lambda t, f: np.setdiff1d(np.flatnonzero(_shared(t, t[f]) >= 2), [f]),
}
"""Each query as its definition."""
