"""The claims in the cells of tables: of the documents, of structures' files, of experiments.

What the thesis prints stands in ``claims.toml``; what is expected of a structure that it does not
print, in that structure's file; what is expected of an experiment's own subjects, in its file.
"""

import tomllib
from collections.abc import Iterator, Mapping
from importlib.resources import files
from typing import Any

from experiments.claims.claim import BOUND, MEMORY, NO_CLAIM, Claim, Exactly, Growth
from experiments.claims.curves import axes_of, table_of
from experiments.harness import ANYONE, Axis, Table
from experiments.runs import experiments, tables
from hem.contract import Claims
from structures import NAMED

MEMORY_TITLE = "Bytes per vertex"
SYMBOLS = {axis.variable: axis.symbol for axis in Axis}
HOW = {
    "O(1)": "the same at every",
    "O(n)": "in proportion to",
    f"{BOUND}O(n)": "at most in proportion to",
    "O(n²)": "with the square of",
}
"""How a cost of a class moves with its variable."""

Row = Mapping[str, Any]


def load_claims(text: str | None = None) -> list[Claim]:
    """All cells of all tables, row by row; ``text`` instead of the project's claims.toml.

    Raises ValueError naming the row for a subject, a structure or a class that does not exist.
    """
    content = tomllib.loads(
        text or (files("experiments.claims") / "claims.toml").read_text("utf-8")
    )
    cells = [cell for row in content["row"] for cell in _of_row(_checked(row))]
    cells += [] if text else _of_experiments()
    return [_claim(*cell, content["classes"]) for cell in cells]


Cell = tuple[Table, str, str, Any, str]
"""The table, the subject, the structure, what is printed, and who claims it."""


def _checked(row: Row) -> Row:
    known = [MEMORY, *dict.fromkeys(it for table in tables().values() for it in table.subjects)]
    what, unknown = row.get("what"), set(row) - {"what", "table", "source", *NAMED}
    if what not in known:
        raise ValueError(f"claims.toml: no query is called {what!r}; there are {', '.join(known)}")
    if unknown or "source" not in row:
        fault = f"no structure is called {min(unknown)!r}" if unknown else "no source is given"
        raise ValueError(f"claims.toml, row {what}: {fault}")
    if row.get("table", table_of(what)) not in tables():
        raise ValueError(f"claims.toml, row {what}: no table is called {row['table']!r}")
    return row


def _of_row(row: Row) -> Iterator[Cell]:
    """What a document prints, and what the files of the other structures say of the subject."""
    what = row["what"]
    table = tables()[row.get("table") or table_of(what)]
    measured = [
        name for it in experiments().values() if it.table is table for name in it.structures
    ]
    for name in NAMED:
        own = getattr(NAMED[name], "claims", Claims("not claimed"))
        if name in row:
            yield table, what, name, row[name], row["source"]
        elif name in measured:
            claimed = None if what == MEMORY else own.costs.get(what) or row.get(own.like)
            yield table, what, name, claimed or NO_CLAIM, own.source


def _of_experiments() -> Iterator[Cell]:
    for it in experiments().values():
        for what, claimed in it.claims.items():
            assert it.table is not None  # it declares none without
            default = claimed.get(ANYONE, NO_CLAIM)
            for name in it.structures:
                yield it.table, what, name, claimed.get(name, default), it.source


def _claim(
    table: Table, what: str, structure: str, printed: Any, source: str,
    classes: Mapping[str, Mapping[str, str]],
) -> Claim:  # fmt: skip
    suffix = "" if table.name in ("queries", "operations") else f"/{table.name}"
    name, title = NAMED[structure].title, table.subjects.get(what, MEMORY_TITLE)
    expects: Exactly | Growth
    if what == MEMORY and printed == NO_CLAIM:
        expects, text = Exactly(None), f"Of the bytes of {name}, nothing is claimed."
    elif what == MEMORY:
        expects = Exactly(printed)
        text = f"{name} takes {printed} bytes per vertex, with references of 8 bytes."
    elif printed != NO_CLAIM and printed not in classes:
        raise ValueError(f"claims.toml, row {what}: {printed!r} is none of {', '.join(classes)}")
    else:
        measured = {axis.variable for axis in axes_of(table.name)}
        grown = {k: v for k, v in classes.get(printed, {}).items() if k in measured}
        expects = Growth(grown)
        words = [f"{HOW.get(it, f'as {it} in')} {SYMBOLS[k]}" for k, it in grown.items()]
        text = f"{title} on {name} costs {printed}: {' and '.join(words)}."
        if not grown:
            text = f"Of {title} on {name}, nothing is claimed. The class that was found is shown."
    return Claim(
        f"{structure}/{what}{suffix}", text, source, table.name, title, expects,
        structure, what, str(printed),
    )  # fmt: skip
