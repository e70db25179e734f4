"""What the documents say in sentences: each a quantity that is measured, and what it must be.

The sentences stand in ``sentences.toml``. A quantity is a list of values, one per size, query or
the like, and the claim holds if all of them lie within its bounds. It is violated if none does; in
between, or where nothing was measured, it is undetermined.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib.resources import files
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

import hem
import structures
from experiments.claims.break_even import break_even
from experiments.claims.claim import SENTENCES, Between, Claim
from experiments.claims.curves import Curve, Curves, curves
from experiments.claims.outcome import Outcome
from experiments.claims.verdicts import JudgedClaim
from experiments.harness import BASE, OPERATIONS, Axis
from experiments.runs import Run
from hem.complexity import slope
from hem.contract import QUERIES
from structures.object_tools import HalfEdgeMeshBuilder
from structures.plankton import Plankton

Array = NDArray[np.float64]
Quantity = Callable[[Curves], Iterable[float]]

LARGER = 990
"""Vertices from which on a mesh is spoken of: smaller ones are built and scanned in no time."""

HALF, WINGED = "half_edge", "winged_edge"
HALF_EDGES = (HALF, "half_edge_objects", "plankton")
SPLITS = ("split_edge", "split_face")


def sentence_claims() -> list[Claim]:
    """Every sentence. Raises ValueError naming one whose quantity nobody measures."""
    content = tomllib.loads((files("experiments.claims") / "sentences.toml").read_text("utf-8"))
    return [_claim(row) for row in content["statement"]]


def _claim(row: dict[str, Any]) -> Claim:
    name = row["quantity"]
    if name not in QUANTITIES:
        raise ValueError(
            f"sentences.toml: {row['says']!r} rests on {name!r}; there are {', '.join(QUANTITIES)}"
        )
    low, high = float(row.get("low", -np.inf)), float(row.get("high", np.inf))
    return Claim(
        key=f"sentence/{name}",
        text=row["says"],
        source=row["source"],
        table=SENTENCES,
        title=row["says"],
        expects=Between(name, row["measured"], low, high),
    )


def judge_sentences(run: Run) -> list[JudgedClaim]:
    """Every sentence, judged."""
    return [judge_sentence(curves(run), claim) for claim in sentence_claims()]


def judge_sentence(of_run: Curves, claim: Claim) -> JudgedClaim:
    """One sentence: consistent if every value lies within the bounds, violated if none does."""
    expects = cast(Between, claim.expects)
    measured = np.array(list(QUANTITIES[expects.quantity](of_run)), float)
    values = measured[~np.isnan(measured)]
    inside = (values >= expects.low) & (values <= expects.high)
    if not len(values) or (inside.any() and not inside.all()):
        outcome = Outcome.UNDETERMINED
    else:
        outcome = Outcome.CONSISTENT if inside.all() else Outcome.VIOLATED
    reason = f"{inside.sum()} of {len(values)} values are {expects.words}."
    return JudgedClaim(claim, outcome, span(values), reason, values=values)


def span(values: Array) -> str:
    """What was found: one value, or the smallest and the largest."""
    if not len(values):
        return "–"
    values = np.round(values, 6) + 0
    low, high = f"{values.min():.3g}", f"{values.max():.3g}"
    return low if low == high else f"{low} … {high}"


def ratios(mine: Curve, other: Curve, at_least: int = 0) -> list[float]:
    """Cost by cost at every size that both were measured at."""
    costs, others = mine.by_size, other.by_size
    return [costs[n] / others[n] for n in sorted(costs.keys() & others.keys()) if n >= at_least]


def _work(of_run: Curves, structure: str, subject: str) -> Array:
    """Mean accesses of a query or operation, by size; a call that reads nothing counts as one."""
    return np.maximum(of_run.curve(Axis.WORK_FACES, structure, subject).centers, 1)


def _work_ratios(of_run: Curves, mine: str, other: str, subjects: Iterable[str]) -> Iterable[float]:
    """The work at the largest size, one structure's by another's."""
    for subject in subjects:
        costs, others = (_work(of_run, name, subject)[-1:] for name in (mine, other))
        if len(costs) and len(others):
            yield float(costs[0] / others[0])


def _bytes_ratio(of_run: Curves, mine: str, other: str) -> Iterable[float]:
    yield of_run.bytes_per_vertex(mine) / of_run.bytes_per_vertex(other)


def _answers(of_run: Curves) -> Iterable[float]:
    """How many more queries a triangle-neighbor structure answers without searching the mesh."""
    local = {
        name: sum(_is_local(_work(of_run, name, query)) for query in QUERIES)
        for name in ("triangle_neighbor", BASE)
    }
    if all(local.values()):
        yield local["triangle_neighbor"] - local[BASE]


def _is_local(work: Array) -> bool:
    return bool(len(work) > 1 and work[-1] < 2 * work[0] + 2)


def _static(of_run: Curves) -> Iterable[float]:
    """Building a half-edge mesh by building an indexed one, in time; and the bytes of both."""
    mine, base = (of_run.named("bench_build", it, order="consecutive") for it in (HALF, BASE))
    yield from ratios(mine, base)
    yield from _bytes_ratio(of_run, HALF, BASE)


def _dynamic(of_run: Curves) -> Iterable[float]:
    """The game-like mix of edits and queries, half-edge by indexed, on 1,000 vertices and more."""
    mine, base = (of_run.named("bench_workloads", it, "impacts") for it in (HALF, BASE))
    yield from ratios(mine, base, at_least=LARGER)


def _edits_per_build(of_run: Curves) -> Iterable[float]:
    """Edge splits per vertex after which the half-edge mesh has overtaken, at the larger sizes."""
    table = break_even(of_run)
    mine = table[(table["structure"] == HALF) & (table["subject"] == "split_edge")]
    mine = mine[mine["vertices"] >= LARGER]
    yield from (mine["times"] / mine["vertices"]).tolist()


def _slopes(
    of_run: Curves, names: Iterable[str], subjects: Iterable[str], table: str
) -> Iterable[float]:
    """The log-log slopes of work in the number of faces."""
    for name in names:
        for subject in subjects:
            curve = of_run.curve(Axis.WORK_FACES, name, subject, table)
            if len(curve) > 1:
                yield float(slope(curve.sizes, curve.centers))


def _published(subjects: Iterable[str]) -> Quantity:
    return lambda of_run: _slopes(of_run, ("as_printed",), subjects, "listings")


def _corrected(subjects: Iterable[str]) -> Quantity:
    return lambda of_run: _slopes(of_run, HALF_EDGES, subjects, "operations")


def _books_built(of_run: Curves) -> Iterable[float]:
    """How many half-edge meshes accept three faces at one edge."""
    points = np.random.default_rng(0).random((5, 3))
    mesh = hem.TriangleMesh(points, [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    built = 0
    for name in HALF_EDGES:
        with suppress(hem.NonManifoldError):
            built += bool(structures.build(name, mesh))
    yield built


def _polygon_corners(of_run: Curves) -> Iterable[float]:
    """The corners of a face of a hundred that is built, asked for and taken away again."""
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    s = structures.build("plankton", hem.PolygonMesh(points, [list(range(100))]))
    s.validate()
    yield len(s.face_vertices(0))
    s.remove_face(0)
    s.validate()


def _article_invariants(of_run: Curves) -> Iterable[float]:
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


def _cube_vertices(of_run: Curves) -> Iterable[float]:
    """The vertices that the builder makes of a render mesh with a seam at every edge."""
    corner = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    indices = [4 * i + k for i in range(6) for k in (0, 2, 1, 0, 3, 2)]  # clockwise
    mesh = HalfEdgeMeshBuilder.from_render_mesh(corner[np.array(sides).ravel()], indices)
    yield mesh.n_vertices


QUANTITIES: dict[str, Quantity] = {
    "bytes_ratio": lambda of_run: _bytes_ratio(of_run, HALF, BASE),
    "bytes_winged_half": lambda of_run: _bytes_ratio(of_run, WINGED, HALF),
    "winged_half": lambda of_run: _work_ratios(of_run, WINGED, HALF, (*QUERIES, *OPERATIONS)),
    "answers": _answers,
    "static": _static,
    "dynamic": _dynamic,
    "edits_per_build": _edits_per_build,
    "printed_splits": _published(SPLITS),
    "mended_splits": _corrected(SPLITS),
    "printed_collapse": _published(["collapse_edge"]),
    "mended_collapse": _corrected(["collapse_edge"]),
    "half_winged_operations": lambda of_run: _work_ratios(of_run, HALF, WINGED, OPERATIONS),
    "books_built": _books_built,
    "polygon_corners": _polygon_corners,
    "article_invariants": _article_invariants,
    "cube_vertices": _cube_vertices,
}
"""What can be measured of a sentence, by the name that ``sentences.toml`` uses."""
