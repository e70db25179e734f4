"""The claims in the cells of tables: of the documents, of structures' files, of experiments.

What the thesis prints stands in ``claims.toml``; what is expected of a structure that it does not
print, in that structure's file; what is expected of an experiment's own subjects, in its file.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib.resources import files
from typing import Any

from experiments.claims.claim import BOUND, MEMORY, NO_CLAIM, Claim, Exactly, Growth
from experiments.harness import ANYONE, Axis, Experiment, Table
from experiments.runs.catalog import experiments, tables
from hem.contract import Claims
from structures import NAMED, REGISTRY

MEMORY_TITLE = "Bytes per vertex"
MEMORY_TABLE = "queries"
"""The table whose first row are the bytes."""

SYMBOLS = {axis.variable: axis.symbol for axis in Axis}

Row = dict[str, Any]
DOCUMENTED = "documented"
"""Under it a row names the structures that the documents themselves speak of."""


def load_claims(text: str | None = None) -> list[Claim]:
    """All cells of all tables, row by row; ``text`` instead of the project's claims.toml.

    Raises ValueError naming the row for a subject, a structure or a class that does not exist.
    """
    content = tomllib.loads(
        text or (files("experiments.claims") / "claims.toml").read_text("utf-8")
    )
    classes = content["classes"]
    rows = [_completed(_checked(row)) for row in content["row"]]
    rows += [] if text else _of_experiments()
    return [
        _claim(row, structure, printed, classes)
        for row in rows
        for structure, printed in _printed(row).items()
    ]


@lru_cache(maxsize=1)
def _axes() -> dict[str, set[str]]:
    """By table the variables that claims are judged in."""
    variables: dict[str, set[str]] = {}
    for it in experiments().values():
        if it.table is not None:
            variables.setdefault(it.table.name, set()).update(axis.variable for axis in it.axes)
    return variables


def _table_of(row: Row) -> Table:
    name = row.get("table") or next(
        (it.name for it in tables().values() if row["what"] in it.subjects), MEMORY_TABLE
    )
    if name not in tables():
        raise ValueError(f"claims.toml, row {row['what']}: no table is called {name!r}")
    return tables()[name]


def _checked(row: Row) -> Row:
    known = [MEMORY, *dict.fromkeys(it for table in tables().values() for it in table.subjects)]
    if row.get("what") not in known:
        raise ValueError(
            f"claims.toml: no query is called {row.get('what')!r}; there are {', '.join(known)}"
        )
    unknown = set(row) - {"what", "table", "source", *NAMED}
    if unknown or "source" not in row:
        fault = f"no structure is called {min(unknown)!r}" if unknown else "no source is given"
        raise ValueError(f"claims.toml, row {row['what']}: {fault}")
    return row


def _printed(row: Row) -> dict[str, Any]:
    return {name: row[name] for name in NAMED if name in row}


def _completed(row: Row) -> Row:
    """A row with what is claimed of the structures that the documents do not print."""
    if _table_of(row).name == "listings":
        return row
    more = {name: _own_claim(name, row) for name, structure in REGISTRY.items() if name not in row}
    return {**row, **more, DOCUMENTED: tuple(_printed(row))}


def _own_claims(name: str) -> Claims:
    """What a structure's own file claims; nothing where the thesis prints it."""
    return getattr(REGISTRY[name], "claims", Claims("not claimed"))


def _own_claim(name: str, row: Row) -> str:
    if row["what"] == MEMORY:
        return NO_CLAIM
    claims = _own_claims(name)
    return str(claims.costs.get(row["what"]) or row.get(claims.like, NO_CLAIM))


def _source(row: Row, structure: str) -> str:
    """Who claims it: the document of the row, or the structure's own file."""
    documented = structure in row.get(DOCUMENTED, (structure,))
    return str(row["source"]) if documented else _own_claims(structure).source


def _of_experiments() -> Iterator[Row]:
    for experiment in experiments().values():
        for subject, claimed in experiment.claims.items():
            yield {
                "what": subject,
                "table": experiment.table.name if experiment.table else "",
                "source": experiment.source,
                **_of_everyone(experiment, claimed),
            }


def _of_everyone(experiment: Experiment, claimed: Mapping[str, str]) -> dict[str, str]:
    default = claimed.get(ANYONE, NO_CLAIM)
    return {name: claimed.get(name, default) for name in experiment.structures}


def _claim(
    row: Row, structure: str, printed: Any, classes: Mapping[str, Mapping[str, str]]
) -> Claim:
    what, table = row["what"], _table_of(row)
    suffix = "" if table.name in ("queries", "operations") else f"/{table.name}"
    shared = {
        "key": f"{structure}/{what}{suffix}",
        "source": _source(row, structure),
        "table": table.name,
        "structure": structure,
        "subject": what,
        "printed": str(printed),
    }
    if what == MEMORY:
        expects = Exactly(None if printed == NO_CLAIM else printed)
        return Claim(
            text=_bytes_text(structure, printed), title=MEMORY_TITLE, expects=expects, **shared
        )
    if printed != NO_CLAIM and printed not in classes:
        raise ValueError(f"claims.toml, row {what}: {printed!r} is none of {', '.join(classes)}")
    measured = _axes()[table.name]
    growth = Growth({k: v for k, v in classes.get(printed, {}).items() if k in measured})
    title = table.subjects[what]
    return Claim(
        text=_text(structure, title, printed, growth), title=title, expects=growth, **shared
    )


def _bytes_text(structure: str, printed: Any) -> str:
    name = NAMED[structure].title
    if printed == NO_CLAIM:
        return f"Of the bytes of {name}, nothing is claimed."
    return f"{name} takes {printed} bytes per vertex, with references of 8 bytes."


def _text(structure: str, title: str, printed: str, growth: Growth) -> str:
    name = NAMED[structure].title
    if not growth.classes:
        return f"Of {title} on {name}, nothing is claimed. The class that was found is shown."
    grown = [f"{_how(it)} {SYMBOLS[variable]}" for variable, it in growth.classes.items()]
    return f"{title} on {name} costs {printed}: {' and '.join(grown)}."


def _how(growth: str) -> str:
    """How a cost of a class moves with its variable."""
    words = {
        "O(1)": "the same at every",
        "O(n)": "in proportion to",
        f"{BOUND}O(n)": "at most in proportion to",
        "O(n²)": "with the square of",
    }
    return words.get(growth, f"as {growth} in")
