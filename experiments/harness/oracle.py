"""The answers to the nine queries from the triangle list alone: what the kernels are checked by.

Nothing of a structure or a library is used here, so that its mistake cannot confirm itself.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array
from hem.contract import QUERIES, Query, Structure
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
    return pack_pairs(s.edge_vertices(edges).values.reshape(-1, 2).astype(np.int64))


def pack_pairs(pairs: Array) -> Array:
    """(k, 2) vertices -> (k,) int64 ``smaller << 32 | larger``."""
    pairs = np.sort(np.asarray(pairs, np.int64), axis=1)
    return (pairs[:, 0] << 32) | pairs[:, 1]


def turned(triangles: Array) -> Array:
    """Triangles (k, 3), each from its smallest corner on: where one begins says nothing."""
    begin = triangles.argmin(axis=1)[:, None]
    return np.take_along_axis(triangles, (begin + np.arange(3)) % 3, axis=1)


def neighbors(triangles: Array, query: Query, key: int) -> Array:
    """The sorted neighbors of one vertex, face or packed edge; edges packed. Cost O(n_t)."""
    return np.unique(RULES[query.name](triangles, key))


def _around(triangles: Array, v: int) -> Array:
    """The vertices that share a face with v."""
    return np.setdiff1d(triangles[(triangles == v).any(axis=1)], [v])


def _spokes(triangles: Array, v: int) -> Array:
    """The edges at v."""
    ring = _around(triangles, v)
    return pack_pairs(np.stack([np.full_like(ring, v), ring], axis=1))


def _ends(edge: int) -> list[int]:
    return [edge >> 32, edge & 0xFFFFFFFF]


def _shared(triangles: Array, corners: ArrayLike) -> Array:
    """How many of the corners each face has."""
    return np.isin(triangles, corners).sum(axis=1)


RULES: dict[str, Callable[[Array, int], Any]] = {
    "vertex_vertices": _around,
    "vertex_edges": _spokes,
    "vertex_faces": lambda t, v: np.flatnonzero((t == v).any(axis=1)),
    "edge_vertices": lambda t, e: _ends(e) if (_shared(t, _ends(e)) == 2).any() else [],
    "edge_edges": lambda t, e: np.setdiff1d(np.concatenate([_spokes(t, v) for v in _ends(e)]), [e]),
    "edge_faces": lambda t, e: np.flatnonzero(_shared(t, _ends(e)) == 2),
    "face_vertices": lambda t, f: t[f],
    "face_edges": lambda t, f: pack_pairs(np.stack([t[f], np.roll(t[f], -1)], axis=1)),
    "face_faces": lambda t, f: np.setdiff1d(np.flatnonzero(_shared(t, t[f]) >= 2), [f]),
}
"""Each query as its definition."""


Named = Callable[[Array], Array]


def check_rows(
    title: str, query: Query, triangles: Array, keys: Array, rows: Any, named: Named | None = None
) -> None:
    """Compare answers with the triangle list. Cost O(n_t) each.

    ``keys``: the vertices or faces that were asked, or (k, 2) the vertices of edges; ``rows``: the
    answer for each. ``named``: the vertices of edges that are answered by number. Raises
    CheckFailedError naming library, query, element and both answers.
    """
    for place, asked in enumerate(keys.tolist()):
        answer = row(rows, place)
        if answer.ndim == 1:  # else edges, each by its two vertices
            answer = answer[answer >= 0].astype(np.int64)
            if named and query.target == "edge" and len(answer):
                answer = named(answer)
        found = np.unique(pack_pairs(answer) if answer.ndim == 2 else answer)
        key = int(pack_pairs(np.array([asked]))[0]) if query.source == "edge" else asked
        expected = neighbors(triangles, query, key)
        if not np.array_equal(found, expected):
            told = f"{title}: {query.name}({asked}) gives {found.tolist()}"
            raise CheckFailedError(f"{told}, the triangle list {expected.tolist()}")


def row(rows: Any, place: int) -> Array:
    """The answer for one element, as its library gives it."""
    if isinstance(rows, tuple):
        values, begin = rows
        return np.asarray(values[begin[place] : begin[place + 1]])
    return np.array([*rows[place]])


def check_told(title: str, triangles: Array, told: Mapping[str, Any]) -> None:
    """The same for what a program tells: by query what was asked, and answered; edges as pairs."""
    for name, every in told.items():
        query = QUERIES[name]
        keys = [asked if query.source == "edge" else asked[0] for asked, _ in every]
        rows = [np.reshape(it, (-1, 2)) if query.target == "edge" else it for _, it in every]
        check_rows(title, query, triangles, np.array(keys), rows)
