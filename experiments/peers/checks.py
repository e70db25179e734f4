"""Whether a library's answers are those of the triangle list."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from experiments.harness.oracle import CheckFailedError, neighbors, pack
from experiments.peers.peer import Rows
from hem.arrays import Array
from hem.contract import QUERIES, Query

Named = Callable[[Array], Array]


def check_rows(
    title: str, query: Query, triangles: Array, keys: Array, rows: Rows, named: Named | None = None
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
        found = np.unique(pack(answer) if answer.ndim == 2 else answer)
        key = int(pack(np.array([asked]))[0]) if query.source == "edge" else asked
        expected = neighbors(triangles, query, key)
        if not np.array_equal(found, expected):
            raise CheckFailedError(
                f"{title}: {query.name}({asked}) gives {found.tolist()}, "
                f"the triangle list {expected.tolist()}"
            )


def row(rows: Rows, place: int) -> Array:
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
