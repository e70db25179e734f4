"""What is said in sentences: each a quantity that is measured, and what it must be.

The sentences stand in ``sentences.toml``: what the documents say, and what this study expects. A
quantity is a list of values, one per size, query or the like, and the claim holds if all of them
lie within its bounds. It is violated if none does; in between, or where nothing was measured, it is
undetermined.
"""

import tomllib
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib.resources import files
from typing import cast

import numpy as np
import pandas as pd

import hem
import structures
from experiments.claims.claim import (
    EXPECTATIONS,
    SENTENCES,
    Between,
    Claim,
    JudgedClaim,
    Outcome,
)
from experiments.claims.curves import Curves, curves
from experiments.claims.errata import BOOK
from experiments.harness import BASE, OPERATIONS, Axis
from experiments.runs import Run
from hem.arrays import Array
from hem.complexity import slope
from hem.contract import QUERIES
from structures.object_tools import HalfEdgeMeshBuilder
from structures.plankton import Plankton

Quantity = Callable[[Curves], Iterable[float]]

LARGER = 990  # vertices from which on a mesh is spoken of: others are built and scanned in no time

HALF, WINGED, DIRECTED = "half_edge", "winged_edge", "directed_edge"
NEIGHBOR = "triangle_neighbor"
HALF_EDGES = (HALF, "half_edge_objects", "plankton")
SPLITS, COLLAPSE = ("split_edge", "split_face"), ("collapse_edge",)

MIXES = {
    "vertex_faces": "faces around a vertex",
    "face_faces": "faces beside a face",
    "split_edge": "edge splits",
    "collapse_edge": "edge collapses",
}
"""What is done after building, one query or operation each."""


def sentence_claims() -> list[Claim]:
    """Every sentence. Raises ValueError naming one whose quantity nobody measures."""
    content = tomllib.loads((files("experiments.claims") / "sentences.toml").read_text("utf-8"))
    claims = []
    tables = {"statement": SENTENCES, "expectation": EXPECTATIONS}
    for table, row in ((table, row) for kind, table in tables.items() for row in content[kind]):
        name, says = row["quantity"], row["says"]
        if name not in QUANTITIES:
            known = ", ".join(QUANTITIES)
            raise ValueError(f"sentences.toml: {says!r} rests on {name!r}; there are {known}")
        bounds = {end: float(row[end]) for end in ("low", "high") if end in row}
        expects = Between(name, row["measured"], **bounds)
        claims.append(Claim(f"sentence/{name}", says, row["source"], table, says, expects))
    return claims


def judge_sentences(run: Run) -> list[JudgedClaim]:
    """Every sentence: consistent if every value lies within its bounds, violated if none does."""
    return [_judge(curves(run), claim, cast(Between, claim.expects)) for claim in sentence_claims()]


def _judge(of_run: Curves, claim: Claim, expects: Between) -> JudgedClaim:
    measured = np.array(list(QUANTITIES[expects.quantity](of_run)), float)
    values = measured[~np.isnan(measured)]
    inside = (values >= expects.low) & (values <= expects.high)
    outcome = Outcome.CONSISTENT if inside.all() else Outcome.VIOLATED
    if not len(values) or inside.any() > inside.all():
        outcome = Outcome.UNDETERMINED
    reason = f"{inside.sum()} of {len(values)} values are {expects.words}."
    return JudgedClaim(claim, outcome, _span(values), reason, values=values)


def _span(values: Array) -> str:
    """What was found: one value, or the smallest and the largest."""
    if not len(values):
        return "–"
    values = np.round(values, 6) + 0
    low, high = f"{values.min():.3g}", f"{values.max():.3g}"
    return low if low == high else f"{low} … {high}"


def break_even(of_run: Curves) -> pd.DataFrame:
    """After how many queries or edits per build a structure overtakes the base structure.

    It takes longer to build and answers faster. After k it has caught up where build + k · cost is
    the base's build + k · its cost. Columns: subject, structure, vertices, times: 0 where the
    structure is ahead from the beginning, infinite where it never catches up.
    """
    rows = []
    for subject in MIXES:
        base = _costs(of_run, BASE, subject)
        for structure in structures.NAMES:
            if structure != BASE and structures.REGISTRY[structure].compiled:
                more = (_costs(of_run, structure, subject) - base).dropna().sort_index()
                times = more["build"].clip(lower=0) / -more["each"]
                times = times.where(more["each"] < 0, np.inf)
                rows += [(subject, structure, n, k) for n, k in times.items()]
    return pd.DataFrame(rows, columns=["subject", "structure", "vertices", "times"])


def _costs(of_run: Curves, structure: str, subject: str) -> pd.DataFrame:
    """Seconds to build and per query or edit, by number of vertices."""
    build = of_run.named("bench_build", structure, order="consecutive").by_size
    asked = of_run.named("bench_queries", structure, subject, "random").by_size
    edited = of_run.named("bench_operations", structure, subject, "batched").by_size
    return pd.DataFrame({"build": build, "each": pd.concat([asked, edited])})


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
    local = []
    for name in (NEIGHBOR, BASE):
        work = [_work(of_run, name, query) for query in QUERIES]
        local.append(sum(len(it) > 1 and bool(it[-1] < 2 * it[0] + 2) for it in work))
    if all(local):
        yield local[0] - local[1]


def _time_ratios(of_run: Curves, experiment: str, subject: str = "", order: str = "") -> pd.Series:
    """The time at every size that both were measured at, half-edge by indexed."""
    mine, base = (of_run.named(experiment, it, subject, order).by_size for it in (HALF, BASE))
    return (mine / base).dropna()


def _static(of_run: Curves) -> Iterable[float]:
    yield from _time_ratios(of_run, "bench_build", order="consecutive")
    yield from _bytes_ratio(of_run, HALF, BASE)


def _dynamic(of_run: Curves) -> Iterable[float]:
    """Compiled: from Python the interpreter would be measured, which is the same for both."""
    yield from _time_ratios(of_run, "bench_workloads", "impacts", "compiled").loc[LARGER:]


def _edits_per_build(of_run: Curves) -> Iterable[float]:
    """Edge splits per vertex after which the half-edge mesh has overtaken, at the larger sizes."""
    wanted = "structure == @HALF and subject == 'split_edge' and vertices >= @LARGER"
    mine = break_even(of_run).query(wanted)
    yield from mine["times"] / mine["vertices"]


def _slopes(
    of_run: Curves, names: Iterable[str], subjects: Iterable[str], table: str
) -> Iterable[float]:
    """The log-log slopes of work in the number of faces."""
    for name in names:
        for subject in subjects:
            curve = of_run.curve(Axis.WORK_FACES, name, subject, table)
            if len(curve) > 1:
                yield float(slope(curve.sizes, curve.centers))


def _books_built(of_run: Curves) -> Iterable[float]:
    """How many half-edge meshes accept three faces at one edge."""
    built = 0
    for name in HALF_EDGES:
        with suppress(hem.NonManifoldError):
            built += bool(structures.build(name, BOOK))
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
    "published_splits": lambda of_run: _slopes(of_run, ("as_printed",), SPLITS, "listings"),
    "corrected_splits": lambda of_run: _slopes(of_run, HALF_EDGES, SPLITS, "operations"),
    "published_collapse": lambda of_run: _slopes(of_run, ("as_printed",), COLLAPSE, "listings"),
    "corrected_collapse": lambda of_run: _slopes(of_run, HALF_EDGES, COLLAPSE, "operations"),
    "half_winged_operations": lambda of_run: _work_ratios(of_run, HALF, WINGED, OPERATIONS),
    "books_built": _books_built,
    "polygon_corners": _polygon_corners,
    "article_invariants": _article_invariants,
    "cube_vertices": _cube_vertices,
    "directed_bytes": lambda of_run: _bytes_ratio(of_run, DIRECTED, NEIGHBOR),
    "directed_queries": lambda of_run: _work_ratios(of_run, DIRECTED, HALF, QUERIES),
}
"""What can be measured of a sentence, by the name that ``sentences.toml`` uses."""
