"""How a structure's validator states what must hold. Nothing here uses a structure's queries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Array
from hem.authoring.kernels import EDGES, FACES, VERTICES
from hem.authoring.queries import ELEMENTS
from hem.authoring.records import Field, in_use, live
from hem.errors import MeshError
from hem.meshes import components

RECORDS = {**ELEMENTS, "half_edge": "half_edges", "triangle": "faces"}
"""How errors call the elements that records stand for."""


def require(
    holds: NDArray[np.bool_], invariant: str, elements: str, of: Array | None = None
) -> None:
    """Raise MeshError naming the ``invariant`` and the ``elements`` for which it does not hold.

    ``holds``: (n,) or (n, k) bool, one row per element, or per element in ``of`` (n,).
    """
    if not holds.all():
        rows = np.flatnonzero(~holds if holds.ndim == 1 else ~holds.all(axis=1))
        found = rows if of is None else np.unique(of[rows])
        raise MeshError(f"broken invariant: {invariant}", **{elements: found})


def require_records(records: Any, fields: Sequence[Field]) -> None:
    """Require what follows from the fields alone.

    Live vertices and faces are as many as the structure says, vertices have finite positions, and
    every reference names a live record, or none where it is optional.
    """
    alive = {kind: live(records, fields, kind) for kind in {it.element for it in fields}}
    for field in fields:
        values, kind = in_use(records, fields, field), field.element
        if field.marks and kind in ("vertex", "face", "triangle"):
            element, column = ("vertex", VERTICES) if kind == "vertex" else ("face", FACES)
            require_count(element, int(alive[kind].sum()), int(records.counts[column]))
        if field.target:
            rows = np.flatnonzero(alive[kind])
            _require_references(field, values[rows], alive[field.target], rows)
        else:
            alike = np.isfinite(values).all(axis=1) == ~np.isnan(values).all(axis=1)
            require(alike, "positions are finite", RECORDS[kind])


def _require_references(field: Field, values: Array, alive: Array, rows: Array) -> None:
    named: NDArray[np.bool_] = (values >= 0) & (values < len(alive))
    named[named] = alive[values[named]]
    if field.optional:
        named |= values == -1
    require(named, f"{field.name} is a live {field.target}", RECORDS[field.element], rows)


def require_count(element: str, found: int, counted: int) -> None:
    """Require that so many elements are ``found`` as the structure has ``counted``."""
    if found != counted:
        many = ELEMENTS[element]
        raise MeshError(f"broken invariant: {counted:,} live {many} are counted, not {found:,}")


def require_edges(records: Any, a: Array, b: Array, of: Array | None = None) -> None:
    """Require that all live edges are (a[i], b[i]), as many as the structure says, all different.

    No two join the same two vertices, and none joins one.
    """
    require_count("edge", len(a), int(records.counts[EDGES]))
    require(a != b, "an edge joins two different vertices", "edges", of)
    named = (np.minimum(a, b).astype(np.int64) << 32) | np.maximum(a, b)
    first = np.zeros(len(named), np.bool_)
    first[np.unique(named, return_index=True)[1]] = True
    require(first, "two vertices are joined by at most one edge", "edges", of)


def require_of_vertices(of: Array, at: Array, alive: Array, just: str, there: str) -> None:
    """Require that ``just`` the vertices of live items name one, and that they are ``there``.

    ``of``: (n_v,) the item that a vertex names, or -1. ``at``: (n, k) the vertices of each item.
    ``alive``: (m,) the live items.
    """
    used = np.bincount(at[alive].ravel(), minlength=len(of)) > 0
    require((of >= 0) == used, just, "vertices")
    v = np.flatnonzero(used)
    require((at[of[v]] == v[:, None]).any(axis=1), there, "vertices", v)


def require_triangles(
    face: Array, following: Array, alive: Array, elements: str, of: Array
) -> None:
    """Require that half-edges run round triangles, three in each of their faces.

    ``face``, ``following``: (n,) of each half-edge. ``alive``: (k,) those that lie in live faces,
    called ``of`` (k,) in errors.
    """
    after = following[alive]
    require(face[after] == face[alive], "next lies in the same face", elements, of)
    require(following[following[after]] == alive, "three times next comes round", elements, of)
    sides = np.bincount(face[alive])
    require((sides == 0) | (sides == 3), "a face has three sides", "faces")


def require_one_fan(vertex: Array, clockwise: Array, alive: Array) -> None:
    """Require that the faces around every vertex form one fan.

    ``vertex``: (n,) the vertex of each corner. ``clockwise``: (n,) the corner that follows around
    the same vertex, or -1 at the border. ``alive``: (k,) the corners of live faces.
    """
    _require_one_each(
        vertex, clockwise, alive, "the faces around a vertex form one fan", "vertices"
    )


def require_one_loop(face: Array, following: Array, alive: Array) -> None:
    """Require that the half-edges of every face form one loop.

    ``face``, ``following``: (n,) of each half-edge. ``alive``: (k,) those that lie in live faces.
    """
    _require_one_each(face, following, alive, "the half-edges of a face form one loop", "faces")


def _require_one_each(owner: Array, step: Array, alive: Array, words: str, elements: str) -> None:
    """Require that all items of an owner hang together by steps; -1 is no step."""
    items = alive[step[alive] >= 0]
    group = components(len(owner), np.stack([items, step[items]], axis=1))[1][alive]
    owners = owner[alive][np.unique(group, return_index=True)[1]]
    require(np.bincount(owners) < 2, words, elements)
