"""The claims of ``claims.toml``, read."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from hem.contract import QUERIES, Claims
from structures import NAMED, REGISTRY

OPERATIONS = {
    "split_edge": "Split edge",
    "split_face": "Split face",
    "collapse_edge": "Collapse edge",
    "flip_edge": "Flip edge",
    "add_face": "Add face",
    "remove_face": "Remove face",
}
"""The operations that are measured, and how a table calls them."""

TABLES = {
    "queries": "Table 1",
    "operations": "Operations",
    "listings": "The listings, as printed and mended",
}
"""The tables: the thesis' table 1, what its chapters 4 and 5 say of operations, and what its own
listings really cost."""

LISTINGS = {"build": "Build from a render mesh"}
"""What is measured of the listings beside the operations."""

VARIABLES = {"faces": "n_t", "valence": "n_ev"}
"""What a claim is judged in, one held while the other moves, and its symbol in the thesis."""

MEMORY = "memory"
NO_CLAIM = "N/A"
BOUND = "≤ "
"""What a class begins with that is claimed as a bound only."""


@dataclass(frozen=True)
class Claim:
    """One case of a table: what is printed of one structure, and where.

    ``subject`` is a query, an operation or "memory"; ``table`` one of ``TABLES``. ``expected``: the
    growth class per variable, empty where nothing is claimed; ``bytes_per_vertex`` for the memory
    row, else None.
    """

    subject: str
    table: str
    structure: str
    printed: str
    source: str
    expected: dict[str, str]
    bytes_per_vertex: int | None = None

    @property
    def title(self) -> str:
        """The head of the row."""
        return "Bytes per vertex" if self.subject == MEMORY else title_of(self.subject)


def title_of(what: str) -> str:
    """How a table calls a query or an operation."""
    return OPERATIONS.get(what) or LISTINGS.get(what) or QUERIES[what].title


def load_claims(text: str | None = None) -> list[Claim]:
    """All claims in the order of the table, row by row; ``text`` instead of the project's file.

    Raises ValueError naming the row for a query, a structure or a class that does not exist.
    """
    content = tomllib.loads(text or (files("experiments.claims") / "claims.toml").read_text())
    return [
        _claim(row, structure, content["classes"])
        for row in map(_completed, content["row"])
        for structure in row
        if structure in NAMED
    ]


def _completed(row: dict[str, Any]) -> dict[str, Any]:
    """A checked row, with what structures claim that the thesis does not print."""
    row = _checked(row)
    if "table" in row:
        return row
    others = {name: it.claims for name, it in REGISTRY.items() if not it.thesis}
    return row | {name: _claimed(it, row) for name, it in others.items()}


def _claimed(claims: Claims, row: dict[str, Any]) -> str:
    what = row["what"]
    if what in claims.costs:
        return claims.costs[what]
    return NO_CLAIM if what == MEMORY else row.get(claims.like, NO_CLAIM)


def _checked(row: dict[str, Any]) -> dict[str, Any]:
    known = (MEMORY, *QUERIES, *OPERATIONS, *LISTINGS)
    if row.get("what") not in known:
        raise ValueError(
            f"claims.toml: no query is called {row.get('what')!r}; there are {', '.join(known)}"
        )
    unknown = set(row) - {"what", "table", "source", *NAMED}
    if unknown or "source" not in row:
        fault = f"no structure is called {min(unknown)!r}" if unknown else "no source is given"
        raise ValueError(f"claims.toml, row {row['what']}: {fault}")
    return row


def _claim(row: dict[str, Any], structure: str, classes: dict[str, dict[str, str]]) -> Claim:
    what, printed, source = row["what"], row[structure], _source(row, structure)
    table = row.get("table", "operations" if what in OPERATIONS else "queries")
    if table not in TABLES:
        raise ValueError(f"claims.toml, row {what}: no table is called {table!r}")
    if what == MEMORY:
        size = None if printed == NO_CLAIM else printed
        return Claim(what, table, structure, str(printed), source, {}, size)
    if printed != NO_CLAIM and printed not in classes:
        raise ValueError(f"claims.toml, row {what}: {printed!r} is none of {', '.join(classes)}")
    expected = classes.get(printed, {})
    if table == "listings":  # measured by size alone
        expected = {variable: it for variable, it in expected.items() if variable == "faces"}
    return Claim(what, table, structure, printed, source, expected)


def _source(row: dict[str, Any], structure: str) -> str:
    own = structure in REGISTRY and not REGISTRY[structure].thesis and "table" not in row
    return REGISTRY[structure].claims.source if own else row["source"]
