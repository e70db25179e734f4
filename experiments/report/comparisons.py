"""Tables of numbers, and the same in words. Each raises MissingError where nothing was measured."""

from collections import Counter
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from experiments.bench_fracture import FIND, SHATTER, VISITED, WAYS
from experiments.bench_workloads import COMPILED, WORKLOADS
from experiments.claims import BY_TIME, MIXES, Family, class_told, curves
from experiments.harness import BASE, Axis, own_mesh
from experiments.report.pages import Html, numbers, part, text_table
from experiments.report.rows import two_digits
from experiments.report.session import MissingError, require
from experiments.report.style import TITLES
from experiments.report.tables import SHOWN, count, digits, duration
from experiments.runs import Run
from hem.complexity import Verdict, judge
from hem.contract import QUERIES
from structures import NAMES, REGISTRY

ARRAYS, OBJECTS = "half_edge", "half_edge_objects"

FLAT = 1.1
"""Work that grows by no more than this, from the smallest mesh to the largest, does not grow."""


def medians(run: Run, experiment: str, scale: float = 1.0) -> pd.DataFrame:
    """The cases of an experiment, each with the median of its samples as ``cost``."""
    cases = run.cases[run.cases["experiment"] == experiment]
    return cases.assign(cost=scale * cases["samples"].map(np.median).astype(float))


def at_largest(cases: pd.DataFrame, *by: str) -> pd.DataFrame:
    """The cases on the largest mesh of each group."""
    largest = cases.groupby(list(by))["vertices"].transform("max")
    return cases[cases["vertices"] == largest]


def objects_against_arrays(run: Run) -> Html:
    """Work and time of queries and operations, at the largest size that both were measured at."""
    rows = []
    for subject, title in TITLES.items():
        found = []
        for axis in (Axis.WORK_FACES, Axis.TIME_FACES):
            both = (curves(run).curve(axis, name, subject).by_size for name in (ARRAYS, OBJECTS))
            found.append(pd.concat(both, axis=1).dropna())
        sizes = [set(it.index) for it in found if len(it)]
        if shared := set.intersection(*sizes) if sizes else set():
            costs = [cost for it in found for cost in it.reindex([max(shared)]).to_numpy()[0]]
            rows.append((title, *costs, _ratio(run, costs[3], costs[2]), max(shared)))
    return numbers(rows, {
        "": str, "accesses, arrays": count, "accesses, objects": count,
        "time, arrays (compiled)": duration, "time, objects (Python)": duration,
        "slower": lambda value: f"{digits(value)} ×", "vertices": count,
    })  # fmt: skip


def workloads(run: Run, order: str = COMPILED) -> Html:
    """Time per unit of workloads on each structure's largest mesh, compiled or from Python."""
    cases = medians(run, "bench_workloads").query("order == @order")
    largest = at_largest(cases, "structure", "subject")
    table = largest.pivot_table("cost", ["structure", "vertices"], "subject")
    shown = [name for name in WORKLOADS if name in table]
    every: Any = table[shown].reindex(NAMES, level="structure").iterrows()
    rows = [(REGISTRY[name].title, size, *costs) for (name, size), costs in every]
    heads = [f"{WORKLOADS[it].title}, per {WORKLOADS[it].unit}" for it in shown]
    return numbers(rows, {order: str, "vertices": count, **dict.fromkeys(heads, duration)})


def bytes_held(run: Run, width: int) -> pd.DataFrame:
    """The bytes of structures on the largest mesh of each family, on all versions of one's own."""
    cases = medians(run, "bench_memory").query("reference_bytes == @width")
    own, mesh = own_mesh.of_run(run.folder), ["family", "vertices", "faces"]
    cases = cases.sort_values("vertices") if own else at_largest(cases, "family")
    table = cases.pivot_table("cost", mesh, "structure", sort=False)
    return table[[name for name in NAMES if name in table]]


def bytes_by_mesh(run: Run) -> Html:
    """Bytes per vertex with references of 8 bytes, see ``bytes_held``."""
    table = bytes_held(run, 8).sort_index()
    every: Any = table.T.items()
    rows = [(family, n, faces / n, *(sizes / n)) for (family, n, faces), sizes in every]
    heads: dict[str, Any] = {"": str, "vertices": count, "faces per vertex": two_digits}
    return numbers(rows, heads | {REGISTRY[str(it)].title: "{:,.1f}".format for it in table})


def by_family(families: Sequence[Family]) -> Html:
    """What became of the claims on queries on each family, by time, and what the first denies."""
    require(families, "timed any query")
    heads = ["Family", "vertices", "edges at a vertex", "most at one"]
    heads += [*(it.label for it in BY_TIME), f"not as on the {families[0].name}"]
    rows = []
    for it in families:
        mesh, counts = it.largest, [Counter(it.outcomes(axis).values()) for axis in BY_TIME]
        marks = (" ".join(f"{found[kind]} {kind.mark}" for kind in SHOWN) for found in counts)
        mean = two_digits(2 * mesh["edges"] / mesh["vertices"])
        size, most = (f"{mesh[name]:,}" for name in ("vertices", "valence_max"))
        denied = part("denied", it, families[0], BY_TIME) or "–"
        rows.append((it.name, size, mean, most, *marks, denied))
    return text_table(heads, rows)


def families_in_words(families: Sequence[Family]) -> Html:
    """Which families say something else than the judged one, and how their valences differ."""
    first, *others = families
    denied = {it.name: sum(len(list(it.against(first, axis))) for axis in BY_TIME) for it in others}
    means = [2 * it.largest["edges"] / it.largest["vertices"] for it in families]
    most = max(it.largest["valence_max"] for it in families)
    return part("families", first.name, denied, means, most)


def shattering(run: Run, compiled: bool = True) -> Html:
    """Breaking a surface, each structure at the largest size that the indexed mesh has, too.

    Or, not ``compiled``, the structures that Python runs, each at its largest size.
    """
    names = [name for name in NAMES if REGISTRY[name].compiled == compiled]
    found = [curves(run).named("bench_fracture", name, SHATTER) for name in names]
    cases = pd.concat([it.cases.assign(cost=it.centers) for it in found])
    base = cases[cases["structure"] == BASE].set_index("vertices")["cost"]
    shared: Any = cases[cases["vertices"] <= base.index.max()] if len(base) else cases
    rows = []
    for it in shared.groupby("structure", sort=False).tail(1).itertuples():
        title = REGISTRY[it.structure].title
        times = _ratio(run, base.get(it.vertices, np.nan), it.cost)
        row = title, it.vertices, it.handles, it.handles * it.cost, 1 / it.cost
        rows.append((*row, times) if compiled else row)
    heads: dict[str, Any] = {"": str, "vertices": count, "shards": count, "in all": duration}
    heads |= {"shards per second": count}
    heads |= {"times faster than indexed": digits} if compiled else {}
    return numbers(rows, heads)


def _ratio(run: Run, one: float, other: float) -> float:
    """How many times as long one takes; nan of several machines, whose times are not compared."""
    return np.nan if run.machines else one / other


def face_finding(run: Run) -> Html:
    """How the ways to find a face grow with the number of faces, one row each."""
    rows = []
    for way in WAYS:
        orders = f"{way}, {VISITED}", way
        found = [curves(run).named("bench_fracture", ARRAYS, FIND, it) for it in orders]
        if all(map(len, found)):
            counted, timed = found
            latency = timed.cases["latency"].astype(float)
            work = judge(counted.sizes, counted.samples, exact=True)
            time = judge(timed.sizes, timed.samples, latency=latency)
            rows.append((way, work, time, counted.largest, timed.largest))
    return numbers(rows, {
        "": str, "faces looked at: slope": _slope, "time: slope": _slope,
        "faces, largest mesh, mean": count, "time, largest mesh": duration,
    })  # fmt: skip


def overtaking(table: pd.DataFrame) -> Html:
    """After how many queries or edits each structure has repaid its building, on the largest mesh.

    A column per query or edit.
    """
    largest = at_largest(table, "subject")
    times = largest.pivot_table("times", "structure", ["subject", "vertices"], sort=False)
    rows = [(REGISTRY[str(name)].title, *each) for name, each in times.T.items()]
    heads = [f"{MIXES[subject]}, {size:,} vertices" for subject, size in map(tuple, times.columns)]
    return numbers(rows, {"until repaid": str, **dict.fromkeys(heads, _until)})


def _until(times: float) -> str:
    return "never" if times == np.inf else digits(times)


def _slope(verdict: Verdict) -> str:
    """With the memory's part taken out, and as measured."""
    slope, low, high = map(two_digits, (verdict.slope, verdict.slope_low, verdict.slope_high))
    raw = two_digits(verdict.raw_slope)
    return f"{slope} ({low} … {high}), {class_told(verdict)}; as measured {raw}"


def bytes_in_words(run: Run) -> Html:
    """How many times as much half-edges take as triangles by index; MissingError if not weighed."""
    names, weigh = (ARRAYS, BASE), curves(run).bytes_per_vertex
    found = {width: [weigh(name, width) for name in names] for width in (8, 4)}
    require(not np.isnan(list(found.values())).any(), "weighed a half-edge and an indexed mesh")
    return part("bytes_in_words", found)


def waiting_in_words(run: Run) -> Html:
    """How the times of queries grow whose work does not, compiled, beside the memory's latency."""
    measured, grown = curves(run), []
    names = [it for it in NAMES if REGISTRY[it].compiled and not run.machines]
    for asked in product(names, QUERIES):
        found = [measured.curve(it, *asked) for it in (Axis.WORK_FACES, *BY_TIME)]
        work, *times = found
        if all(len(it) > 1 for it in found) and work.largest <= FLAT * work.centers[0]:
            grown.append([it.largest / it.centers[0] for it in times])
    sets = measured.curve(Axis.RANDOM_FACES, ARRAYS, "vertex_faces").cases
    latency = measured.latency(sets["working_set"].to_numpy(float))
    if not grown or sets.empty or latency is None:
        raise MissingError("This run has not counted and timed queries of a half-edge mesh, too.")
    in_order, at_random = np.median(grown, axis=0)
    sizes = sets["faces"].iloc[[0, -1]].tolist()
    return part("waiting", len(grown), sizes, in_order, at_random, latency[-1] / latency[0])
