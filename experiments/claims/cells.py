"""The claims in the cells of tables: of the documents, of structures' files, of experiments.

What the thesis prints stands in ``claims.toml``, and what follows from it; what is expected of
another structure or of an experiment's own subjects, in the file of that.
"""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from importlib.resources import files
from typing import Any

from experiments.claims.claim import (
    BOUND,
    CLAIMED,
    MEMORY,
    NO_CLAIM,
    NOT_POSSIBLE,
    Claim,
    Exactly,
    Growth,
    Kind,
)
from experiments.claims.curves import axes_of, table_of
from experiments.harness import Axis, Table
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

Entry = Mapping[str, Any]  # one of claims.toml
Claimed = tuple[Any, Kind, str]  # what is printed, who claims it, and where or why
Cell = tuple[Table, str, str, Claimed]  # a table, a subject, a structure; what is claimed of them
NOTHING: Claimed = NO_CLAIM, Kind.NOBODY, "nobody claims what it costs"


def load_claims(text: str | None = None) -> list[Claim]:
    """All cells of all tables, row by row; ``text`` instead of the project's claims.toml.

    Raises ValueError naming the row for a subject, a structure, a class or a kind that is none.
    """
    known = files("experiments.claims") / "claims.toml"
    content = tomllib.loads(text or known.read_text("utf-8"))
    rows: dict[tuple[str, str], list[Entry]] = {}
    for entry in map(_checked, content["row"]):
        name = entry.get("table") or table_of(entry["what"])
        rows.setdefault((name, entry["what"]), []).append(entry)
    cells = [cell for row, entries in rows.items() for cell in _of_row(*row, entries)]
    cells += [] if text else _of_experiments()
    return [_claim(content["classes"], *cell) for cell in cells]


def _checked(entry: Entry) -> Entry:
    known = [MEMORY, *dict.fromkeys(it for table in tables().values() for it in table.subjects)]
    what, claimed = entry.get("what"), set(entry) - {"what", "table", "kind", "source"}
    wrong = ""
    if what not in known:
        raise ValueError(f"claims.toml: no query is called {what!r}; there are {', '.join(known)}")
    if claimed - set(NAMED):
        wrong = f"no structure is called {min(claimed - set(NAMED))!r}"
    elif claimed and "source" not in entry:
        wrong = "no source is given"
    elif claimed and entry.get("kind") not in CLAIMED:
        wrong = f"kind is {entry.get('kind')!r}, none of {', '.join(CLAIMED)}"
    elif entry.get("table", table_of(what)) not in tables():
        wrong = f"no table is called {entry['table']!r}"
    if wrong:
        raise ValueError(f"claims.toml, row {what}: {wrong}")
    return entry


def _of_row(table_name: str, what: str, entries: Sequence[Entry]) -> Iterator[Cell]:
    """What is claimed in a row, and what the files of the other structures say of the subject."""
    table = tables()[table_name]
    said: dict[str, Claimed] = {}
    for entry in entries:
        for name in set(entry) & set(NAMED):
            said[name] = entry[name], Kind(entry["kind"]), entry["source"]
    measured = {it for e in experiments().values() if e.table is table for it in e.structures}
    for name in NAMED:
        if name in said or name in measured:
            yield table, what, name, said.get(name) or _own_claim(name, what, said)


def _own_claim(name: str, what: str, said: Mapping[str, Claimed]) -> Claimed:
    """What a structure's file claims of a subject, by itself or as is ``said`` of another."""
    own: Claims | None = getattr(NAMED[name], "claims", None)
    if own and what in own.costs:
        return own.costs[what], Kind.EXPECTED, own.source
    if own and what != MEMORY and own.like in said:
        printed, kind, _ = said[own.like]
        return printed, Kind.EXPECTED if kind is Kind.EXPECTED else Kind.FOLLOWS, own.source
    return NOTHING


def _of_experiments() -> Iterator[Cell]:
    for it in experiments().values():
        for what in it.claims:
            assert it.table is not None  # it declares none without
            for name in it.structures:
                printed = it.expected(what, name) or NO_CLAIM
                kind = Kind.NOBODY if printed == NO_CLAIM else Kind.EXPECTED
                yield it.table, what, name, (printed, kind, it.source)


def _claim(
    classes: Mapping[str, Mapping[str, str]],
    table: Table, what: str, structure: str, claimed: Claimed,
) -> Claim:  # fmt: skip
    printed, kind, source = claimed
    suffix = "" if table.name in ("queries", "operations") else f"/{table.name}"
    name, title = NAMED[structure].title, table.subjects.get(what, MEMORY_TITLE)
    expects: Exactly | Growth
    silent = printed in (NO_CLAIM, NOT_POSSIBLE)
    if what == MEMORY and silent:
        expects, text = Exactly(None), f"Of the bytes of {name}, nothing is claimed."
    elif what == MEMORY:
        expects = Exactly(printed)
        text = f"{name} takes {printed} bytes per vertex, with references of 8 bytes."
    elif not silent and printed not in classes:
        claimed_by = f"what {source!r} claims of {what} on {structure}"
        raise ValueError(f"{claimed_by}: {printed!r} is none of {', '.join(classes)}")
    else:
        measured = {axis.variable for axis in axes_of(table.name)}
        grown = {k: v for k, v in classes.get(printed, {}).items() if k in measured}
        expects = Growth(grown)
        words = [f"{HOW.get(it, f'as {it} in')} {SYMBOLS[k]}" for k, it in grown.items()]
        text = f"{title} on {name} costs {printed}: {' and '.join(words)}."
        if not grown:
            text = f"Of {title} on {name}, nothing is claimed."
    return Claim(
        f"{structure}/{what}{suffix}", text, kind, source, table.name, title, expects,
        structure, what, str(printed),
    )  # fmt: skip
