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
        answer = _sorted(row(rows, place), named if query.target == "edge" else None)
        _require_same(title, query, triangles, asked, answer)


def _require_same(title: str, query: Query, triangles: Array, asked: Any, answer: Array) -> None:
    """``asked``: a vertex or face, or the two vertices of an edge; ``answer``: ascending."""
    key = int(pack(np.array([asked]))[0]) if query.source == "edge" else asked
    expected = neighbors(triangles, query, key)
    if not np.array_equal(answer, expected):
        raise CheckFailedError(
            f"{title}: {query.name}({asked}) gives {answer.tolist()}, "
            f"the triangle list {expected.tolist()}"
        )


def row(rows: Rows, place: int) -> Array:
    """The answer for one element, as its library gives it."""
    if isinstance(rows, tuple):
        values, begin = rows
        return np.asarray(values[begin[place] : begin[place + 1]])
    return np.array([*rows[place]])


def _sorted(answer: Array, named: Named | None) -> Array:
    """Each once: vertices and faces as they are, edges by their two vertices."""
    if named and answer.ndim == 2:  # by vertices already
        return np.unique(pack(answer))
    numbers = answer[answer >= 0].astype(np.int64)
    return np.unique(pack(named(numbers)) if named and len(numbers) else numbers)


def check_told(title: str, triangles: Array, told: Mapping[str, Any]) -> None:
    """The same for what a program tells: by query what was asked, and answered; edges as pairs."""
    for name, every in told.items():
        query = QUERIES[name]
        for asked, answer in every:
            given = np.array(answer).reshape(-1, 2 if query.target == "edge" else 1)
            found = pack(given) if query.target == "edge" else given[:, 0]
            key = asked if query.source == "edge" else int(asked[0])
            _require_same(title, query, triangles, key, np.unique(found))
