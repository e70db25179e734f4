"""What the thesis says in sentences: each a quantity that was measured, and what it must be.

The sentences stand in ``sentences.toml``. A quantity is a list of values, one per size, query or
the like, and the claim holds if all of them lie within its bounds. It is violated if none does; in
between, or where nothing was measured, it is undetermined.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from importlib.resources import files
from typing import cast

import numpy as np
import pandas as pd
from numpy.typing import NDArray

import hem
import structures
from experiments.claims.breakeven import break_even
from experiments.claims.growth import OPERATIONS
from experiments.claims.judged import Evidence
from experiments.runs.results import Run
from hem.contract import QUERIES
from structures.object_tools import HalfEdgeMeshBuilder
from structures.plankton import Plankton

Array = NDArray[np.float64]

LARGER = 990
"""Vertices from which on a mesh is spoken of: smaller ones are built and scanned in no time."""

Quantity = Callable[[Run], Iterable[float]]


@dataclass(frozen=True)
class Statement:
    """One sentence, what is measured of it (a key of ``QUANTITIES``, and in words), the verdict."""

    quantity: str
    says: str
    source: str
    measured: str
    low: float
    high: float
    values: Array
    outcome: str


def _bytes_ratio(run: Run) -> Iterable[float]:
    evidence = Evidence(run)
    yield evidence.bytes_per_vertex("half_edge") / evidence.bytes_per_vertex("indexed")


def _bytes_winged_half(run: Run) -> Iterable[float]:
    evidence = Evidence(run)
    yield evidence.bytes_per_vertex("winged_edge") / evidence.bytes_per_vertex("half_edge")


def _winged_half(run: Run) -> Iterable[float]:
    """The work of every query and operation at the largest size, winged-edge by half-edge."""
    for what in (*QUERIES, *OPERATIONS):
        winged, half = (_work(run, name, what)[-1:] for name in ("winged_edge", "half_edge"))
        yield from winged / half


def _answers(run: Run) -> Iterable[float]:
    """How many more queries a triangle-neighbor structure answers without searching the mesh."""
    local = {"triangle_neighbor": 0, "indexed": 0}
    for name in local:
        for query in QUERIES:
            work = _work(run, name, query)
            local[name] += bool(len(work) > 1 and work[-1] < 2 * work[0] + 2)
    if any(local.values()):
        yield local["triangle_neighbor"] - local["indexed"]


def _work(run: Run, structure: str, what: str) -> Array:
    """Mean accesses of a query or operation, by size."""
    cases = Evidence(run).curve("work", "faces", structure, what)
    return np.array([max(float(np.mean(it)), 1) for it in cases["samples"]])


def _static(run: Run) -> Iterable[float]:
    """Building a half-edge mesh by building an indexed one, in time; and the bytes of both."""
    cases = run.cases[(run.cases["family"] == "torus") & (run.cases["reference_bytes"] == 4)]
    alone = (cases["experiment"] == "bench_build") & (cases["order"] == "consecutive")
    yield from _by_size(cases[alone])
    yield from _bytes_ratio(run)


def _dynamic(run: Run) -> Iterable[float]:
    """The game-like mix of edits and queries, half-edge by indexed, on 1,000 vertices and more."""
    cases = run.cases[(run.cases["subject"] == "impacts") & (run.cases["vertices"] >= LARGER)]
    yield from _by_size(cases)


def _by_size(cases: pd.DataFrame) -> Iterable[float]:
    columns = zip(cases["structure"], cases["vertices"], cases["samples"], strict=True)
    medians = {(name, vertices): float(np.median(it)) for name, vertices, it in columns}
    for (name, vertices), seconds in medians.items():
        if name == "half_edge" and ("indexed", vertices) in medians:
            yield seconds / medians["indexed", vertices]


def _edits_per_build(run: Run) -> Iterable[float]:
    """Edge splits per vertex after which the half-edge mesh has overtaken, at the larger sizes."""
    table = break_even(run)
    mine = table[(table["structure"] == "half_edge") & (table["what"] == "split_edge")]
    mine = mine[mine["vertices"] >= LARGER]
    yield from (mine["times"] / mine["vertices"]).tolist()


HALF_EDGES = ("half_edge", "half_edge_objects", "plankton")

SPLITS = ("split_edge", "split_face")


def _slopes(
    run: Run, names: Iterable[str], listings: Iterable[str], table: str = "operations"
) -> Iterable[float]:
    """The log-log slopes of work in the number of faces."""
    evidence = Evidence(run)
    for name in names:
        for what in listings:
            cases = evidence.curve("work", "faces", name, what, table)
            if len(cases) > 1:
                work = np.array([float(np.mean(it)) for it in cases["samples"]])
                yield float(np.polyfit(np.log(cases["faces"].to_numpy(float)), np.log(work), 1)[0])


def _half_winged_operations(run: Run) -> Iterable[float]:
    """The work of every operation at the largest size, half-edge by winged-edge."""
    for what in OPERATIONS:
        half, winged = (_work(run, name, what)[-1:] for name in ("half_edge", "winged_edge"))
        yield from half / winged


def _books_built(run: Run) -> Iterable[float]:
    """How many half-edge meshes accept three faces at one edge."""
    points = np.random.default_rng(0).random((5, 3))
    mesh = hem.TriangleMesh(points, [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    built = 0
    for name in HALF_EDGES:
        with suppress(hem.NonManifoldError):
            built += bool(structures.build(name, mesh))
    yield built


def _polygon_corners(run: Run) -> Iterable[float]:
    """The corners of a face of a hundred that is built, asked for and taken away again."""
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    s = structures.build("plankton", hem.PolygonMesh(points, [list(range(100))]))
    s.validate()
    yield len(s.face_vertices(0))
    s.remove_face(0)
    s.validate()


def _article_invariants(run: Run) -> Iterable[float]:
    """The share of half-edges for which what the article says of them holds."""
    s = cast(Plankton, structures.build("plankton", hem.generate("grid", 400)))
    for _ in range(2):
        holds = [
            s.start_vertex(h ^ 1) == s.start_vertex(s.next_half_edge(h))
            and (s.adjacent_face(h) >= 0 or s.outgoing_half_edge(s.start_vertex(h)) == h)
            for h in s.half_edges().tolist()
        ]
        yield float(np.mean(holds))
        s.collapse_edges(s.edges()[::5])
        s.split_all_faces()


def _cube_vertices(run: Run) -> Iterable[float]:
    """The vertices that the builder makes of a render mesh with a seam at every edge."""
    corner = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    indices = [4 * i + k for i in range(6) for k in (0, 2, 1, 0, 3, 2)]  # clockwise
    mesh = HalfEdgeMeshBuilder.from_render_mesh(corner[np.array(sides).ravel()], indices)
    yield mesh.n_vertices


QUANTITIES: dict[str, Quantity] = {
    "bytes_ratio": _bytes_ratio,
    "bytes_winged_half": _bytes_winged_half,
    "winged_half": _winged_half,
    "answers": _answers,
    "static": _static,
    "dynamic": _dynamic,
    "edits_per_build": _edits_per_build,
    "printed_splits": lambda run: _slopes(run, ["as_printed"], SPLITS, "listings"),
    "mended_splits": lambda run: _slopes(run, HALF_EDGES, SPLITS),
    "printed_collapse": lambda run: _slopes(run, ["as_printed"], ["collapse_edge"], "listings"),
    "mended_collapse": lambda run: _slopes(run, HALF_EDGES, ["collapse_edge"]),
    "half_winged_operations": _half_winged_operations,
    "books_built": _books_built,
    "polygon_corners": _polygon_corners,
    "article_invariants": _article_invariants,
    "cube_vertices": _cube_vertices,
}
"""What can be measured of a sentence, by the name that ``sentences.toml`` uses."""


def judged(run: Run) -> list[Statement]:
    """Every sentence with its verdict."""
    content = tomllib.loads((files("experiments.claims") / "sentences.toml").read_text())
    return [_judge(run, row) for row in content["statement"]]


def bounds(statement: Statement) -> str:
    """What the quantity must be, such as ``at least 6``."""
    low, high = statement.low, statement.high
    if low == high:
        return f"{low:g}"
    if np.isinf(low):
        return f"at most {high:g}"
    return f"at least {low:g}" if np.isinf(high) else f"{low:g} to {high:g}"


def span(statement: Statement) -> str:
    """What was found: one value, or the smallest and the largest."""
    values = statement.values
    if not len(values):
        return "–"
    values = np.round(values, 6) + 0
    low, high = f"{values.min():.3g}", f"{values.max():.3g}"
    return low if low == high else f"{low} … {high}"


def _judge(run: Run, row: dict[str, str | float]) -> Statement:
    values = np.array([it for it in QUANTITIES[str(row["quantity"])](run) if not np.isnan(it)])
    low, high = float(row.get("low", -np.inf)), float(row.get("high", np.inf))
    inside = (values >= low) & (values <= high)
    if not len(values):
        outcome = "undetermined"
    elif inside.all():
        outcome = "consistent"
    else:
        outcome = "undetermined" if inside.any() else "violated"
    quantity, says, source, measured = (
        str(row[key]) for key in ("quantity", "says", "source", "measured")
    )
    return Statement(quantity, says, source, measured, low, high, values, outcome)
