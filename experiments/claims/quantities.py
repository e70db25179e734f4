"""What is said in sentences: each a quantity that is measured, and what it must be.

The sentences stand in ``sentences.toml``. A quantity is a list of values, one per size, query or
the like, and the claim holds if all of them lie within its bounds. It is violated if none does, or
if one does not and the claim is of ``every`` one; in between, or where a part of it was not
measured, which is nan, it is undetermined. What no run has to tell is in ``demonstrations.py``.
"""

import itertools
import tomllib
from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from importlib.resources import files
from typing import cast

import numpy as np
import pandas as pd

import structures
from experiments.claims import demonstrations as shown
from experiments.claims.claim import SENTENCES, Between, Claim, JudgedClaim, Kind, Outcome
from experiments.claims.curves import TOO_BUSY, Curves, curves
from experiments.claims.demonstrations import HALF, HALF_EDGES, WINGED
from experiments.harness import ANSWERING, BASE, OPERATIONS, Axis
from experiments.runs import Run
from hem.arrays import Array
from hem.complexity import slope
from hem.contract import QUERIES

Quantity = Callable[[Curves], Iterable[float]]

LARGER = 990  # vertices from which on a mesh is spoken of: others are built and scanned in no time

NEIGHBOR, ADJACENCY, DIRECTED = "triangle_neighbor", "indexed_adjacency", "directed_edge"
PAIRS = ("plankton",)
SPLITS, COLLAPSE = ("split_edge", "split_face"), ("collapse_edge",)
AT_EDGES = "split_edge", "collapse_edge", "flip_edge"
OF_FACES = "face_faces", "face_vertices", "face_edges", "split_face"
BETWEEN_EDGES = "edge_vertices", "edge_faces", "vertex_edges", "face_edges"
LISTED, STEPPING = ("as_printed",), "collapse_stepping"

SOUP_BYTES = 3 * 12  # of a triangle that stores its own three points

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
    for name, row in content.items():
        says, kind, source = row.pop("says"), Kind(row.pop("kind")), row.pop("source")
        if name not in QUANTITIES:
            known = ", ".join(QUANTITIES)
            raise ValueError(f"sentences.toml: {says!r} rests on {name!r}; there are {known}")
        if "exactly" in row:
            row["low"] = row["high"] = row.pop("exactly")
        expects = Between(name, **row)
        claims.append(Claim(f"sentence/{name}", says, kind, source, SENTENCES, says, expects))
    return claims


def judge_sentences(run: Run, claims: Sequence[Claim] | None = None) -> list[JudgedClaim]:
    """Every sentence, or these."""
    every = sentence_claims() if claims is None else claims
    return [_judge(curves(run), claim, cast(Between, claim.expects)) for claim in every]


def _judge(of_run: Curves, claim: Claim, expects: Between) -> JudgedClaim:
    timed = expects.quantity in TIMED
    ask = QUANTITIES[expects.quantity]
    measured = np.array([] if timed and of_run.of_machines else list(ask(of_run)), float)
    values = measured[~np.isnan(measured)]
    inside = (values >= expects.low) & (values <= expects.high)
    outcome = Outcome.CONSISTENT if inside.all() else Outcome.VIOLATED
    unsure = inside.any() > inside.all() or not 0 < len(values) == len(measured)
    if unsure and (inside.all() or not expects.every):
        outcome = Outcome.UNDETERMINED
    reason = f"{inside.sum()} of {len(values)} values are {expects.words}."
    reason += " A part of it was not measured." * (len(values) < len(measured))
    if timed and of_run.too_busy and outcome == Outcome.VIOLATED:
        outcome, reason = Outcome.UNDETERMINED, TOO_BUSY
    elif timed and of_run.of_machines:
        reason = "Times of several machines are not compared."
    return JudgedClaim(claim, outcome, _span(values), reason, values=values)


def _span(values: Array) -> str:
    """What was found: one value, or the smallest and the largest."""
    if not len(values):
        return "–"
    values = np.round(values, 6) + 0
    ends = in_digits(values.min(), 3), in_digits(values.max(), 3)
    return " … ".join(dict.fromkeys(ends))


def in_digits(value: float, count: int) -> str:
    """A number with at most so many digits, without powers: 0.000005, 0.25, 46,400."""
    return f"{Decimal(f'{value:.{count}g}'):,f}"


def break_even(of_run: Curves) -> pd.DataFrame:
    """How many queries or edits after building a structure overtakes the base structure.

    After k it has caught up where build + k · cost is the base's build + k · its cost. Columns:
    subject, structure, vertices, times: 0 where the structure is ahead from the beginning, infinite
    where it never catches up. No rows for several machines, whose times are not compared.
    """
    rows = []
    for subject in () if of_run.of_machines else MIXES:
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
    order = ANSWERING if structures.REGISTRY[structure].rebuilds else "consecutive"
    build = of_run.named("bench_build", structure, order=order).by_size
    asked = of_run.named("bench_queries", structure, subject, "random").by_size
    edited = of_run.named("bench_operations", structure, subject, "batched").by_size
    return pd.DataFrame({"build": build, "each": pd.concat([asked, edited])})


def _work(of_run: Curves, structure: str, subject: str) -> pd.Series:
    """Mean accesses of a query or operation, by size; a call that reads nothing counts as one."""
    return of_run.curve(Axis.WORK_FACES, structure, subject).by_size.clip(lower=1)


def _work_ratios(of_run: Curves, mine: str, other: str, subjects: Iterable[str]) -> Iterable[float]:
    """The work at the largest size of both, one structure's by another's."""
    for subject in subjects:
        one, two = (_work(of_run, name, subject) for name in (mine, other))
        yield from (one / two).dropna().tail(1)


def _bytes_ratio(of_run: Curves, mine: str, other: str) -> Iterable[float]:
    yield of_run.bytes_per_vertex(mine) / of_run.bytes_per_vertex(other)


def _bytes_of_models(of_run: Curves) -> Iterable[float]:
    """Half-edge by indexed, on the judged family and on every real model."""
    yield from _bytes_ratio(of_run, HALF, BASE)
    cases = of_run.cases.query("experiment == 'bench_memory' and reference_bytes == 8")
    models = cases[cases["family"] != of_run.judged_family]
    table = models.assign(bytes=models["samples"].str[0].astype(float))
    both = table.pivot_table(index="family", columns="structure", values="bytes")
    both = both.reindex(columns=[HALF, BASE])
    yield from (both[HALF] / both[BASE]).dropna()


def _answers(of_run: Curves) -> Iterable[float]:
    """How many more queries a triangle-neighbor structure answers without searching the mesh."""
    local = []
    for name in (NEIGHBOR, BASE):
        work = [_work(of_run, name, query).to_numpy() for query in QUERIES]
        local.append(sum(len(it) > 1 and bool(it[-1] < 2 * it[0] + 2) for it in work))
    if all(local):
        yield local[0] - local[1]


def _time_ratios(
    of_run: Curves, experiment: str, subject: str = "", order: str = "", since: int = LARGER
) -> Iterable[float]:
    """The time at every size that both were measured at, half-edge by indexed; nan without any."""
    mine, base = (of_run.named(experiment, it, subject, order).by_size for it in (HALF, BASE))
    return list((mine / base).dropna().loc[since:]) or [np.nan]


def _times(of_run: Curves, mine: str, other: str, subjects: Iterable[str]) -> Iterable[float]:
    """The times at the largest size of both, one structure's by another's; queries at random."""
    for subject in subjects:
        axis = Axis.RANDOM_FACES if subject in QUERIES else Axis.TIME_FACES
        one, two = (of_run.curve(axis, name, subject).by_size for name in (mine, other))
        yield from (one / two).dropna().tail(1)


def _static(of_run: Curves) -> Iterable[float]:
    """Building and bytes, and what a pass over all faces takes."""
    yield from _time_ratios(of_run, "bench_build", order="consecutive", since=0)
    yield from _bytes_ratio(of_run, HALF, BASE)
    yield from _workload(of_run, "vertex_normals")


def _workload(of_run: Curves, name: str) -> Iterable[float]:
    """Compiled: from Python the interpreter would be measured, which is the same for both."""
    return _time_ratios(of_run, "bench_workloads", name, "compiled")


def _detail(of_run: Curves, operation: str, workload: str) -> Iterable[float]:
    """One operation at a time, and all that a workload does of it."""
    yield from _time_ratios(of_run, "bench_operations", operation, "batched")
    yield from _workload(of_run, workload)


def _more_bytes(of_run: Curves) -> Iterable[float]:
    """The query that gains most, of the structures in the order of their bytes."""
    pairs = itertools.pairwise((BASE, NEIGHBOR, HALF))
    gains = [min(_times(of_run, more, less, QUERIES), default=np.nan) for less, more in pairs]
    yield from [] if np.isnan(gains).any() else gains


def _local_update(of_run: Curves) -> Iterable[float]:
    """Render mesh followed edit by edit, by built anew; and in one transaction, by edit by edit."""
    orders = "render mesh built anew", "rendered", "in a transaction"
    costs = [of_run.named("bench_operations", HALF, "split_face", it).by_size for it in orders]
    for before, after in itertools.pairwise(costs):
        yield from (after / before).dropna()


def _extra_bytes(of_run: Curves) -> Iterable[float]:
    """Bytes beyond an indexed mesh, on the largest mesh by on the smallest of the larger."""
    extra = of_run.memory(HALF).by_size - of_run.memory(BASE).by_size
    extra = extra.dropna().loc[LARGER:]
    yield extra.iloc[-1] / extra.iloc[0] if len(extra) > 1 else np.nan


def _pays_at_most(of_run: Curves) -> Iterable[float]:
    """Queries until building is repaid, on the largest mesh by on the smallest of the larger."""
    table = break_even(of_run).query("structure == @HALF and vertices >= @LARGER")
    for _, of_mix in table.groupby("subject", sort=False):
        first, last = of_mix.sort_values("vertices")["times"].to_numpy(float)[[0, -1]]
        if len(of_mix) > 1 and min(first, last) < np.inf:  # where it is repaid at all
            yield last / first


def _edits_after_building(of_run: Curves) -> Iterable[float]:
    """Edge splits per vertex after which the half-edge mesh has overtaken, at the larger sizes."""
    wanted = "structure == @HALF and subject == 'split_edge' and vertices >= @LARGER"
    mine = break_even(of_run).query(wanted)
    yield from mine["times"] / mine["vertices"]


def _slopes(
    of_run: Curves, names: Iterable[str], subjects: Iterable[str], table: str = ""
) -> Iterable[float]:
    """The log-log slopes of work, of what reads nothing as of one access.

    In the number of faces, or without a ``table`` in the valence: there of what is added from one
    to the next of the three largest, so that what is constant does not count.
    """
    axis = Axis.WORK_FACES if table else Axis.WORK_VALENCE
    for name, subject in itertools.product(names, subjects):
        curve = of_run.curve(axis, name, subject, table)
        sizes, work = curve.sizes, curve.centers
        if not table:
            sizes, work = np.diff(sizes[-3:]), np.diff(work[-3:])
        known = len(sizes) > 1
        yield round(float(slope(sizes, np.maximum(work, 1))), 3) if known else np.nan


QUANTITIES: dict[str, Quantity] = {
    "bytes_ratio": _bytes_of_models,
    "bytes_winged_half": lambda of_run: _bytes_ratio(of_run, WINGED, HALF),
    "winged_half": lambda of_run: _work_ratios(of_run, WINGED, HALF, (*QUERIES, *OPERATIONS)),
    "winged_half_time": lambda of_run: _times(of_run, WINGED, HALF, (*QUERIES, *OPERATIONS)),
    "more_bytes": _more_bytes,
    "soup": lambda of_run: [SOUP_BYTES * of_run.faces_per_vertex / of_run.bytes_per_vertex(BASE)],
    "answers": _answers,
    "come_round": lambda of_run: shown.walks_without_test(),
    "edges_both_ways": lambda of_run: _slopes(of_run, (WINGED,), BETWEEN_EDGES),
    "directions": lambda of_run: shown.handling("direction_tests"),
    "handling": lambda of_run: shown.handling("branches", "lines"),
    "previous": lambda of_run: shown.two_steps_back(),
    "local_update": _local_update,
    "cube_vertices": lambda of_run: shown.cube_vertices(),
    "conforming": lambda of_run: shown.half_edges_per_face(),
    "published_splits": lambda of_run: _slopes(of_run, LISTED, SPLITS, "listings"),
    "corrected_splits": lambda of_run: _slopes(of_run, HALF_EDGES, SPLITS, "operations"),
    "published_collapse": lambda of_run: _slopes(of_run, LISTED, COLLAPSE, "listings"),
    "outlook": lambda of_run: _slopes(of_run, LISTED, (*SPLITS, STEPPING), "listings"),
    "corrected_collapse": lambda of_run: _slopes(of_run, HALF_EDGES, COLLAPSE, "operations"),
    "collapse_by_valence": lambda of_run: _slopes(of_run, HALF_EDGES, COLLAPSE),
    "static": _static,
    "dynamic": lambda of_run: _workload(of_run, "impacts"),
    "subdivision": lambda of_run: _slopes(of_run, (HALF,), SPLITS, "operations"),
    "subdivision_time": lambda of_run: _detail(of_run, "split_face", "subdivision"),
    "reduction": lambda of_run: _slopes(of_run, (HALF,), COLLAPSE, "operations"),
    "reduction_time": lambda of_run: _detail(of_run, "collapse_edge", "simplification"),
    "larger_meshes": _extra_bytes,
    "larger_meshes_repay": _pays_at_most,
    "edits_after_building": _edits_after_building,
    "draft_faces": lambda of_run: _times(of_run, BASE, HALF, OF_FACES),
    "books_built": lambda of_run: shown.books_built(),
    "polygon_corners": lambda of_run: shown.polygon_corners(),
    "article_invariants": lambda of_run: shown.article_invariants(),
    "outgoing_kept": lambda of_run: shown.outgoing_kept(),
    "coincident": lambda of_run: shown.coincident_vertices(),
    "almost_free": lambda of_run: _slopes(of_run, PAIRS, ("face_faces",), "queries"),
    "stored_previous": lambda of_run: _work_ratios(of_run, *PAIRS, HALF, QUERIES),
    "directed_bytes": lambda of_run: _bytes_ratio(of_run, DIRECTED, NEIGHBOR),
    "directed_queries": lambda of_run: _work_ratios(of_run, DIRECTED, HALF, QUERIES),
    "adjacency_queries": lambda of_run: _slopes(of_run, (ADJACENCY,), QUERIES, "queries"),
    "adjacency_edits": lambda of_run: _slopes(of_run, (ADJACENCY,), AT_EDGES, "operations"),
}
"""What can be measured of a sentence, by the name that ``sentences.toml`` uses, in its order."""

TIMED = {
    "winged_half_time", "more_bytes", "local_update", "static", "dynamic",
    "subdivision_time", "reduction_time", "larger_meshes_repay", "edits_after_building",
    "draft_faces",
}  # fmt: skip
"""Those that compare times."""
