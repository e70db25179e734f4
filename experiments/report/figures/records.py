"""What a structure records of a mesh: which record refers to which, its bytes, and its walks."""

import inspect
import re
import textwrap
from collections.abc import Iterator
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

import hem
from experiments.report.pages import Html, text_table
from experiments.report.tables import spelled
from hem.authoring import REFERENCE_TYPES, in_use, live
from hem.contract import Structure

Key = tuple[str, int]
"""A record: its kind, as in ``Field.target``, and its index."""

VERTICES = 10_000
"""Of the closed mesh that is weighed: so many that what objects share counts little."""


class Entry(NamedTuple):
    """The references of a record under one name; -1 is none."""

    field: str
    target: str
    values: tuple[int, ...]


def records(s: Structure) -> dict[Key, list[Entry]]:
    """Every live record and what it refers to; positions and other numbers are left out. O(n)."""
    found: dict[Key, list[Entry]] = {}
    for key, entry in _entries(s) if s.fields else _entries_of_objects(s):
        found.setdefault(key, []).extend([entry] if entry.target else [])
    return found


def _entries(s: Structure) -> Iterator[tuple[Key, Entry]]:
    for field in s.fields:
        kind, name = field.name.split(".")
        values = in_use(s.records, s.fields, field)
        for row in np.flatnonzero(live(s.records, s.fields, kind)).tolist():
            referring = tuple(map(int, values[row])) if field.target else ()
            yield (kind, row), Entry(name, field.target, referring)


def _entries_of_objects(s: Structure) -> Iterator[tuple[Key, Entry]]:
    """Of lists of objects: what stands in their slots, if it is of one of the lists."""
    lists = s.records[:-1]
    kinds = {type(it): elements.kind for elements in lists for it in elements}
    for elements in lists:
        for slot in next(iter(elements)).__slots__:
            held = {it.index: getattr(it, slot) for it in elements}
            targets = {kinds[type(it)] for it in held.values() if type(it) in kinds}
            for index, value in held.items():
                at = value.index if type(value) in kinds else -1
                yield (elements.kind, index), Entry(slot, "".join(targets), (at,))


class Term(NamedTuple):
    """The bytes of a kind of record: how many there are per vertex, and its fields."""

    kind: str
    per_vertex: float
    fields: dict[str, float]


def byte_terms(structure: type[Structure], reference_bytes: int) -> list[Term]:
    """What a vertex of a large closed mesh takes, with the records that come with it."""
    s = structure.build(hem.generate("torus", VERTICES), reference_bytes)
    counts = {"vertex": s.n_vertices, "edge": s.n_edges, "half_edge": s.n_half_edges}
    terms: dict[str, Term] = {}
    for name, size in s.memory().items():
        kind, field = name.split(".")
        count = counts.get(kind, s.n_faces)
        terms.setdefault(kind, Term(kind, count / s.n_vertices, {})).fields[field] = size / count
    return list(terms.values())


def formula(terms: list[Term]) -> str:
    """As chapter 7 of the thesis writes it: ``12 + 8 + 2 · 8 + 6 · 32 = 228``."""
    parts = []
    for kind, per_vertex, fields in sorted(terms, key=lambda it: it.kind != "vertex"):
        if kind == "vertex":
            parts += [f"{size:.4g}" for size in fields.values()]
        else:
            parts.append(f"{per_vertex:.4g} · {sum(fields.values()):.4g}")
    total = sum(term.per_vertex * sum(term.fields.values()) for term in terms)
    return f"{' + '.join(parts)} = {total:,.4g}"


def byte_table(structure: type[Structure]) -> Html:
    """The bytes per vertex of a large closed mesh, kind by kind.

    For every size of a reference, the thesis' first; for one where the size changes nothing.
    """
    every = {it: byte_terms(structure, it) for it in sorted(REFERENCE_TYPES)}
    alone = {formula(terms): size for size, terms in every.items()}  # those that differ
    sizes = {size: every[size] for size in sorted(alone.values(), reverse=True)}
    sums, rows = [], []
    for size, terms in sizes.items():
        of = f"With references of {size} bytes" if len(sizes) > 1 else "Whatever a reference takes"
        sums.append(Html("<p>{}: {}</p>").format(of, formula(terms)))
        for kind, per_vertex, fields in terms:
            widths = ", ".join(f"{spelled(it)} {width:.4g}" for it, width in fields.items())
            each, taken = f"{per_vertex:.4g}", f"{per_vertex * sum(fields.values()):,.4g}"
            width = f"{size} bytes" if len(sizes) > 1 else "any"
            rows.append((width, spelled(kind), each, widths, taken))
    heads = "A reference", "Record", "Per vertex", "Bytes of its fields", "Bytes per vertex"
    return Html("").join([*sums, text_table(heads, rows)])


class Stop(NamedTuple):
    """A record on the way of a query, and which of its fields are read there, in order."""

    key: Key
    fields: list[str]


def path(s: Structure, query: str, handle: int) -> list[Stop]:
    """The way of a query through the records, as its kernel goes.

    A stop at numbers that belong to no single record has the name of their array.
    """
    apart = {it.name: it.name.split(".")[1] for it in s.fields if it.width > 1 and not it.target}
    reads = ((apart.get(it.field, it.field), it.row) for it in s.reads(query, handle))
    split = ((field.rpartition("."), row) for field, row in reads)
    stops = groupby(split, key=lambda it: (it[0][0] or it[0][2], it[1]))
    return [Stop(key, [name for (*_, name), _ in read]) for key, read in stops]


def described(structure: type[Structure]) -> str:
    """What its file, or one it is built on, says of its records and invariants, as Markdown."""
    places: list[Any] = [*structure.__mro__, structure.records_type]
    texts = [inspect.getdoc(inspect.getmodule(it)) or "" for it in places]
    text = next((it for it in texts if "\nInvariants\n" in it), texts[0])
    return fenced(text).replace("\nInvariants\n", "\n**Invariants**\n")


def fenced(text: str) -> str:
    """A docstring whose drawings and examples, behind a double colon, are blocks of Markdown."""

    def block(found: re.Match[str]) -> str:
        words, lines = found[1] and f"{found[1]}:", textwrap.dedent(found[2]).rstrip()
        return f"{words}\n\n```text\n{lines}\n```\n"

    return re.sub(r"(?m)(^|\S)::\n\n((?: +.*(?:\n|\Z)|\n(?= ))+)", block, text)
