"""The claims in the cells of tables: of the documents, of structures' files, of experiments.

What the thesis prints stands in ``claims.toml``, and what follows from it; what is expected of
another structure or of an experiment's own subjects, in the file of that.
"""

import tomllib
from collections.abc import Iterator, Mapping
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
from experiments.claims.curves import axes_of
from experiments.harness import Axis, Table
from experiments.runs import experiments, tables
from hem.contract import Claims
from structures import NAMED, THESIS

MEMORY_TITLE = "Bytes per vertex"
SYMBOLS = {axis.variable: axis.symbol for axis in Axis}
HOW = {
    "O(1)": "the same at every",
    "O(n)": "in proportion to",
    f"{BOUND}O(n)": "at most in proportion to",
    "O(n²)": "with the square of",
}
"""How a cost of a class moves with its variable."""

Claimed = tuple[Any, Kind, str]  # what is printed, who claims it, and where or why
Said = dict[str, Claimed]  # a row of a table, by structure
Cell = tuple[Table, str, str, Claimed]  # a table, a subject, a structure; what is claimed of them
NOTHING: Claimed = NO_CLAIM, Kind.NOBODY, "nobody claims what it costs"


def load_claims(text: str | None = None) -> list[Claim]:
    """All cells of all tables, row by row; ``text`` instead of the project's claims.toml.

    Raises ValueError naming a table, a subject, a structure, a class or a kind that is none.
    """
    known = files("experiments.claims") / "claims.toml"
    content = tomllib.loads(text or known.read_text("utf-8"))
    rows: dict[tuple[str, str], Said] = {}
    for entry in content["claim"]:
        for row, said in _read(entry):
            rows.setdefault(row, {}).update(said)
    if lacking := set(THESIS).difference(*rows.values(), NAMED if text else ()):
        why = "and its file says that the thesis does; what else is claimed stands there (claims)"
        raise ValueError(f"claims.toml claims nothing of {min(lacking)!r}, {why}")
    cells = [cell for row, said in rows.items() for cell in _of_row(*row, said)]
    cells += [] if text else _of_experiments()
    return [_claim(content["classes"], *cell) for cell in cells]


def _read(entry: dict[str, Any]) -> Iterator[tuple[tuple[str, str], Said]]:
    """What an entry of claims.toml says, by table and subject."""
    kind, source = entry.pop("kind", None), entry.pop("source", None)
    for table, rows in entry.items():
        if table not in tables():
            there = ", ".join(tables())
            raise ValueError(f"claims.toml: no table is called {table!r}; there are {there}")
        for what, cells in rows.items():
            _require_sound(what, cells, kind, source)
            yield (table, what), {name: (it, Kind(kind), source) for name, it in cells.items()}


def _require_sound(what: str, cells: Mapping[str, Any], kind: Any, source: Any) -> None:
    known = [MEMORY, *dict.fromkeys(it for table in tables().values() for it in table.subjects)]
    wrong = ""
    if what not in known:
        raise ValueError(f"claims.toml: no query is called {what!r}; there are {', '.join(known)}")
    if strange := set(cells) - set(NAMED):
        wrong = f"no structure is called {min(strange)!r}"
    elif cells and source is None:
        wrong = "no source is given"
    elif cells and kind not in CLAIMED:
        wrong = f"kind is {kind!r}, none of {', '.join(CLAIMED)}"
    if wrong:
        raise ValueError(f"claims.toml, row {what}: {wrong}")


def _of_row(table_name: str, what: str, said: Said) -> Iterator[Cell]:
    """What is claimed in a row, and what the files of the other structures say of the subject."""
    table = tables()[table_name]
    measured = {it for e in experiments().values() if e.table is table for it in e.structures}
    for name in NAMED:
        if name in said or name in measured:
            yield table, what, name, said.get(name) or _own_claim(name, what, said)


def _own_claim(name: str, what: str, said: Said) -> Claimed:
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
