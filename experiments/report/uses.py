"""Which structure for which use: every structure beside the best one, by what decides the use.

And advice to play with: sliders for a mesh and a workload, and the structures in order.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np
import pandas as pd

from experiments.advice import ALIKE, PRESETS, SIGMAS, UNMODELED, Prices
from experiments.bench_workloads import COMPILED
from experiments.claims import Curves, Kind, curves, load_claims
from experiments.harness import Axis
from experiments.report.pages import Html, page, part, text_table
from experiments.report.session import MissingError, require
from experiments.report.tables import digits, duration, markdown_rows
from experiments.runs import Run
from hem.contract import QUERIES
from structures import REGISTRY, Structure

Costs = Callable[[Curves, str], pd.Series]
"""What a structure costs, by the number of vertices."""


def bytes_per_vertex(measured: Curves, structure: str) -> pd.Series:
    """With references of 4 bytes."""
    sizes = measured.memory(structure, 4).by_size
    return sizes / sizes.index.to_numpy(float)


PRINTED = {it.subject for it in load_claims() if it.kind is Kind.PRINTED}
TABLE_1 = [it for it in QUERIES if it in PRINTED]
"""The queries that the thesis prints costs of."""


def queries(measured: Curves, structure: str) -> pd.Series:
    """The queries of table 1 together, each once, in random order."""
    costs = [measured.curve(Axis.RANDOM_FACES, structure, it).by_size for it in TABLE_1]
    return pd.concat(costs, axis=1).dropna().sum(axis=1)


def workload(name: str) -> Costs:
    """A compiled workload."""
    return lambda measured, it: measured.named("bench_workloads", it, name, COMPILED).by_size


@dataclass(frozen=True)
class Use:
    """What a mesh is used for, and the cost that decides which structure should hold it.

    ``suits``: whether a structure can be used so at all; ``unfit``: why others cannot. ``largest``:
    compared on the largest mesh that all were measured on, or on the smallest.
    """

    title: str
    compared: str
    costs: Costs
    written: Callable[[float], str] = duration
    suits: Callable[[type[Structure]], bool] = lambda structure: True
    unfit: str = ""
    largest: bool = True


WEIGHED = "bytes per vertex", bytes_per_vertex, lambda it: f"{digits(it)} bytes"
EIGHT = "the eight queries of table 1, each once, at random"

USES = {
    "drawn": Use("Only drawn", *WEIGHED),
    "normals": Use("Drawn, normals renewed", "vertex normals", workload("vertex_normals")),
    "asked": Use("Picked and measured", EIGHT, queries),
    "edited": Use("Edited in real time", "an impact, as in a game", workload("impacts")),
    "simplified": Use("Simplified", "a vertex, to a tenth of them", workload("simplification")),
    "tight": Use(
        "Asked for neighbors, memory tight",
        *WEIGHED,
        suits=lambda it: not it.searches,
        unfit="search the whole mesh for neighbors",
    ),
    "polygons": Use(
        "Of polygons", *WEIGHED, suits=lambda it: it.holds_polygons, unfit="hold triangles alone"
    ),
    "small": Use("Small", EIGHT, queries, largest=False),
}
"""A new use is one line here."""


def left_out() -> Html:
    """Who is compared for no use, or not for some, and why."""
    interpreted = [it.title for it in REGISTRY.values() if not it.compiled]
    unfit = {
        use: [it.title for it in REGISTRY.values() if it.compiled and not use.suits(it)]
        for use in USES.values()
        if use.unfit
    }
    return part("left_out", interpreted, unfit)


def ranking(run: Run, name: str) -> pd.Series:
    """The costs of a use by compiled structure, the least first; its name is the vertices.

    Of those that suit and were measured, on a mesh that all of them were. Empty if there is none.
    """
    use = USES[name]
    suited = (name for name, it in REGISTRY.items() if it.compiled and use.suits(it))
    costs = {name: use.costs(curves(run), name) for name in suited}
    table = pd.DataFrame({name: it for name, it in costs.items() if len(it)}).dropna()
    if run.machines or table.empty:
        return pd.Series(dtype=float, name=0)
    return table.sort_index().iloc[-1 if use.largest else 0].sort_values(kind="stable")


def beside(run: Run, one: str, other: str) -> Html:
    """How many queries each of two structures answers faster, and their bytes; or MissingError."""
    measured = curves(run)
    asked = partial(measured.curve, Axis.RANDOM_FACES)
    ratios = {it: asked(one, it).by_size / asked(other, it).by_size for it in QUERIES}
    table = pd.DataFrame(ratios).dropna()
    require(len(table) and not run.machines, "measured the queries of both on one mesh and machine")
    vertices, found = table.index[-1], table.iloc[-1]
    faster, slower = (found < 1 / ALIKE).sum(), (found > ALIKE).sum()
    titles = [REGISTRY[it].title for it in (one, other)]
    sizes = [measured.bytes_per_vertex(it) for it in (one, other)]
    return part("beside", vertices, titles, faster, slower, len(found), sizes)


def by_valence(run: Run) -> pd.DataFrame:
    """The time of each query by compiled structure, at the least, a middle and the largest valence.

    Rows are query and valence. Raises MissingError where none was measured.
    """
    names = [name for name, it in REGISTRY.items() if it.compiled and not run.machines]
    rows = {}
    for query in QUERIES:
        found = {it: curves(run).curve(Axis.TIME_VALENCE, it, query) for it in names}
        costs = {it: pd.Series(one.centers, one.sizes) for it, one in found.items() if len(one)}
        table = pd.DataFrame(costs).dropna()
        for place in (0, len(table) // 2, -1) if len(table) > 2 else ():
            rows[query, int(table.index[place])] = table.iloc[place]
    require(rows, "measured queries at three valences on one machine")
    return pd.DataFrame(rows).T


def fastest_by_valence(run: Run) -> Html:
    """The fastest structures for each query, by valence, with their times."""
    table = by_valence(run)
    ranked = (row.sort_values(kind="stable") for _, row in table.iterrows())
    told = pd.Series([f"{best(it)}, {duration(it.iloc[0])}" for it in ranked], table.index)
    every = told.unstack(fill_value="–")  # a stopped run has not the same valences of each query
    rows = [(QUERIES[it].title, *every.loc[it]) for it in table.index.unique(level=0)]
    return text_table(["", *(f"{it:,} edges at the vertex" for it in every)], rows)


def best(found: pd.Series) -> str:
    """The titles of the structures that are alike the best one, as in a sentence."""
    alike = found[found <= ALIKE * found.min()]
    titles = [REGISTRY[str(name)].title for name in alike.index]
    return " or ".join(filter(None, [", ".join(titles[:-1]), *titles[-1:]]))


HOW_TO_READ = (
    "The best comes first, with its cost, the others with how many times as much they cost; within "
    "a tenth of the best they are bold. Normals cost what they do per vertex, an impact what one "
    "does, and queries what all eight of them do together."
)
HEADS = "Use", "What is compared", "Vertices", "The best first"


def recommended(run: Run) -> Html:
    """For each use the structures, the best first. Raises MissingError if nothing was measured."""
    return text_table(HEADS, _rows(run, "<strong>{}</strong>", '<span class="whole">{} {}</span>'))


def recommended_markdown(run: Run) -> str:
    """The same in Markdown."""
    return markdown_rows([HEADS, *_rows(run, "**{}**", "{} {}")])


def _rows(run: Run, bold: str, pair: str) -> list[tuple[str, str, str, str]]:
    """The structures with their costs: those that are alike the best one bold."""
    rows: list[tuple[str, str, str, str]] = []
    for name, use in USES.items():
        found = ranking(run, name)
        words: list[str] = []
        for structure, cost in found.items():
            title, ratio = REGISTRY[str(structure)].title, cost / found.iloc[0]
            beside = f"{digits(ratio, 3 if ratio < 2 else 2)} ×" if words else use.written(cost)
            words.append(pair.format(bold.format(title) if ratio <= ALIKE else title, beside))
        if words:
            rows.append((use.title, use.compared, f"{found.name:,}", Html(" · ".join(words))))
    require(rows, "measured on one machine what decides between structures")
    return rows


SLID = attrgetter("what", "times", "share_of_faces", "per_frame", "in_order", "edits", "gain")
"""What ``advice.js`` needs of a row of a workload."""
POINTS = 9
"""Sizes that prices are given at where they were measured, beside one on either side: between them,
and beyond, their logarithms follow straight lines."""


def advice_sliders(run: Run) -> Html:
    """The prices of a run, on irregular meshes if it has them, on a page; or MissingError."""
    prices = Prices(run).irregular
    low, high = prices.measured
    require(low < high and not run.machines, "measured what advice rests on")
    sizes = np.array([8, *np.geomspace(low, high, POINTS), 100 * high])
    whats = sorted({row.what for it in PRESETS.values() for row in it.rows})
    measured = (name for name in REGISTRY if name in prices.structures)
    try:
        structures = [_prices(prices, name, whats, sizes) for name in measured]
    except KeyError as error:
        raise MissingError(f"This run cannot advise: {error.args[0]}.") from error
    presets = [
        {"title": it.title, "frames": it.frames, "rows": list(map(SLID, it.rows))}
        for it in PRESETS.values()
    ]
    data = {"sizes": sizes.tolist(), "structures": structures, "workloads": presets}
    return page("sliders.html.j2", data=data | {"sigmas": SIGMAS, "unmodeled": UNMODELED})


def _prices(prices: Prices, name: str, whats: list[str], sizes: Any) -> dict[str, Any]:
    """By what is asked, at each size: seconds at random and in order, and how far both are off."""
    costs = {}
    for what in whats:
        priced = [[prices.price(name, what, n, it) for n in sizes] for it in (0.0, 1.0)]
        told = [[it.seconds for it in each] for each in priced]
        told.append([max(it.spread for it in both) for both in zip(*priced, strict=True)])
        costs[what] = [[float(f"{it:.3g}") for it in each] for each in told]
    return {"title": REGISTRY[name].title, "costs": costs}
