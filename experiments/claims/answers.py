"""The research question and its answer in five sentences, with numbers from the run.

The sentences stand in ``answers.toml``, as templates; every number in them is a function here. A
sentence with a number that was not measured gives way to one that says so.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from html import escape
from importlib.resources import files
from string import Formatter
from typing import Any

import numpy as np
import pandas as pd

from experiments.claims.breakeven import break_even
from experiments.claims.growth import MEMORY
from experiments.claims.judged import Evidence
from experiments.runs.results import Run

SOON = 0.1
"""Edits per vertex and build up to which building is soon made up for, as in statements.toml."""

LITTLE = 0.5
"""The part of the time that a pass over all faces must still take for half-edges to gain little."""


class Number(float):
    """A measured number that knows how sentences write it: as count, time, factor or plainly."""

    def __format__(self, spec: str) -> str:
        """``count``: 12,345; ``time``: 3.1 µs; ``factor``: two digits; ``plain``: as it is."""
        return FORMATS[spec](float(self)) if spec in FORMATS else float.__format__(self, spec)


def _digits(value: float, digits: int = 2) -> str:
    """So many digits that count, without powers: 0.036, 5.1, 64, 12,000."""
    if value == 0:
        return "0"
    rounded = float(f"{value:.{digits - 1}e}")
    behind = digits - 1 - int(np.floor(np.log10(abs(rounded))))
    return f"{rounded:,.{max(behind, 0)}f}"


def _time(seconds: float) -> str:
    units = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))
    size, unit = next((it for it in units if seconds >= 0.995 * it[0]), units[-1])
    return f"{_digits(seconds / size)} {unit}"


FORMATS: dict[str, Callable[[float], str]] = {
    "count": lambda value: f"{np.ceil(value):,.0f}",
    "time": _time,
    "factor": lambda value: _digits(value, 3 if value >= 100 or 1 <= value < 10 else 2),
    "plain": lambda value: f"{value:,.4g}",
}
"""How a number is written, by the name that templates use."""


class Findings:
    """What a run found of the things that the sentences speak of; nan where it found nothing.

    Of a run of several machines no times are compared: the structures were on different ones.
    """

    def __init__(self, run: Run, table: pd.DataFrame) -> None:
        self.run, self.evidence = run, Evidence(run)
        self.claims = table[(table["outcome"] != "no claim") & (table["subject"] != MEMORY)]

    def cost(self, structure: str, what: str, measure: str = "time") -> dict[int, float]:
        """Seconds or accesses of a query or operation, by number of faces."""
        cases = self.evidence.curve(measure, "faces", structure, what)
        return _medians(cases, "faces")

    def both(self, *asked: tuple[str, str]) -> int | None:
        """The largest number of faces at which all of these were timed."""
        shared = set.intersection(*(set(self.cost(*it)) for it in asked))
        return max(shared, default=None)

    @cached_property
    def largest(self) -> int | None:
        """The largest mesh on which an indexed and a half-edge mesh were compared."""
        pairs = [(s, w) for s in ("indexed", "half_edge") for w in ("vertex_faces", "split_edge")]
        return self.both(*pairs)

    def at_largest(self, structure: str, what: str) -> float:
        """Seconds there."""
        if self.run.machines:
            return np.nan
        return self.cost(structure, what).get(self.largest or 0, np.nan)

    def outcomes(self, outcome: str) -> int:
        """How many cases of the tables have this verdict."""
        return int((self.claims["outcome"] == outcome).sum())

    def bytes(self, structure: str) -> float:
        """Bytes per vertex, with references as the thesis counts them."""
        return self.evidence.bytes_per_vertex(structure)

    def ratio(self, cases: pd.DataFrame) -> tuple[int, float]:
        """The largest mesh that both were measured on, and half-edge by indexed."""
        if self.run.machines:
            return 0, np.nan
        names = cases["structure"]
        half, indexed = (_medians(cases[names == it]) for it in ("half_edge", "indexed"))
        vertices = max(set(half) & set(indexed), default=0)
        return vertices, half[vertices] / indexed[vertices] if vertices else np.nan

    @cached_property
    def building(self) -> tuple[int, float]:
        """Vertices, and the time to build a half-edge mesh by that to build an indexed one."""
        cases = self.run.cases
        alone = (cases["experiment"] == "bench_build") & (cases["order"] == "consecutive")
        narrow = (cases["reference_bytes"] == 4) & (cases["family"] == "torus")
        return self.ratio(cases[alone & narrow])

    def workload(self, name: str) -> float:
        """The time of a workload, half-edge by indexed, at the largest size of both."""
        cases = self.run.cases[self.run.cases["experiment"] == "bench_workloads"]
        return self.ratio(cases[cases["subject"] == name])[1]

    @cached_property
    def _break_even(self) -> pd.DataFrame:
        table = break_even(self.run)
        mine = table[
            (table["structure"] == "half_edge") & np.isfinite(table["times"].astype(float))
        ]
        wanted = mine[mine["what"].isin(("vertex_faces", "split_edge"))]
        both = wanted.groupby("vertices")["what"].transform("nunique") == 2
        return wanted[both]

    @property
    def even_vertices(self) -> float:
        """The largest mesh on which the half-edge mesh was seen to catch up."""
        return float(self._break_even["vertices"].max())

    def even(self, what: str) -> float:
        """Queries or edits per build until the half-edge mesh is ahead, there."""
        if self.run.machines:
            return np.nan
        mine = self._break_even.query("what == @what and vertices == @self.even_vertices")
        return float(mine["times"].iloc[0]) if len(mine) else np.nan

    def growth(self, structure: str) -> tuple[float, float]:
        """How much larger the largest mesh is, and how much more a listed edge split costs."""
        cases = self.evidence.curve("work", "faces", structure, "split_edge", "listings")
        if len(cases) < 2:
            return np.nan, np.nan
        work = [float(np.mean(it)) for it in cases["samples"]]
        return float(cases["faces"].iloc[-1] / cases["faces"].iloc[0]), work[-1] / work[0]


def _medians(cases: pd.DataFrame, by: str = "vertices") -> dict[int, float]:
    columns = zip(cases[by], cases["samples"], strict=True)
    return {int(size): float(np.median(it)) for size, it in columns}


NUMBERS: dict[str, Callable[[Findings], float]] = {
    "ring_faces": lambda it: it.largest or np.nan,
    "ring_indexed": lambda it: it.at_largest("indexed", "vertex_faces"),
    "ring_half_edge": lambda it: it.at_largest("half_edge", "vertex_faces"),
    "split_indexed": lambda it: it.at_largest("indexed", "split_edge"),
    "split_half_edge": lambda it: it.at_largest("half_edge", "split_edge"),
    "bytes_indexed": lambda it: it.bytes("indexed"),
    "bytes_half_edge": lambda it: it.bytes("half_edge"),
    "bytes_ratio": lambda it: it.bytes("half_edge") / it.bytes("indexed"),
    "build_vertices": lambda it: it.building[0] or np.nan,
    "build_ratio": lambda it: it.building[1],
    "even_vertices": lambda it: it.even_vertices,
    "even_queries": lambda it: it.even("vertex_faces"),
    "even_splits": lambda it: it.even("split_edge"),
    "normals_ratio": lambda it: it.workload("vertex_normals"),
    "impacts_ratio": lambda it: it.workload("impacts"),
    "simplify_ratio": lambda it: it.workload("simplification"),
    "claims": lambda it: len(it.claims) or np.nan,
    "consistent": lambda it: it.outcomes("consistent"),
    "violated": lambda it: it.outcomes("violated"),
    "undetermined": lambda it: it.outcomes("undetermined"),
    "printed_sizes": lambda it: it.growth("as_printed")[0],
    "printed_growth": lambda it: it.growth("as_printed")[1],
    "mended_growth": lambda it: it.growth("half_edge_objects")[1],
}
"""Every number that a sentence may name."""


def _walks_do_not_grow(it: Findings) -> bool:
    """Whether by their work the scans were found to grow with the mesh, and the walks not to."""
    for what in ("vertex_faces", "split_edge"):
        scan, walk = (list(it.cost(s, what, "work").values()) for s in ("indexed", "half_edge"))
        if len(scan) < 2 or len(walk) < 2 or scan[-1] < 2 * scan[0] or walk[-1] > 1.2 * walk[0]:
            return False
    return True


CONDITIONS: dict[str, Callable[[Findings], bool]] = {
    "walks_do_not_grow": _walks_do_not_grow,
    "soon_even": lambda it: it.even("split_edge") <= SOON * it.even_vertices,
    "each_has_its_use": lambda it: (
        it.building[1] > 1
        and it.workload("vertex_normals") > LITTLE
        and it.workload("impacts") < 1
        and it.workload("simplification") < 1
    ),
    "tables_hold": lambda it: (
        it.outcomes("violated") == 0
        and it.outcomes("consistent") > 0.9 * len(it.claims)
        and it.growth("as_printed")[1] > 2
    ),
}
"""What must have been found for a sentence to stand as it is."""


@dataclass(frozen=True)
class Answer:
    """One sentence; ``rests`` says where to: what the link is called -> a claim or a chapter."""

    text: str
    measured: bool
    rests: dict[str, str]


def question() -> str:
    """What the study asks."""
    return str(_content()["question"])


def answers(run: Run, table: pd.DataFrame) -> list[Answer]:
    """The five sentences, told of this run."""
    findings = Findings(run, table)
    return [tell(row, findings) for row in _content()["answer"]]


def tell(row: dict[str, Any], findings: Findings) -> Answer:
    """One sentence of the file: as it stands, otherwise, or that something was not measured."""
    condition = row.get("holds")
    holds = condition is None or CONDITIONS[condition](findings)
    template = row["says"] if holds else row["otherwise"]
    numbers = {name: Number(NUMBERS[name](findings)) for name in names(template)}
    measured = all(np.isfinite(it) for it in numbers.values())
    text = template.format(**numbers) if measured else row["missing"]
    return Answer(text, measured, row["rests"])


def names(template: str) -> list[str]:
    """The numbers that a template names."""
    return [name for _, name, _, _ in Formatter().parse(template) if name]


def shown(every: list[Answer]) -> str:
    """The sentences as a list, each with the way to what it rests on."""
    items = []
    for it in every:
        links = ", ".join(
            f'<a href="{escape(to)}">{escape(name)}</a>' for name, to in it.rests.items()
        )
        css = "" if it.measured else ' class="missing"'
        rests = f'<span class="rests">Rests on: {links}</span>'
        items.append(f"<li><span{css}>{escape(it.text)}</span>{rests}</li>")
    return f'<ol class="answers">{"".join(items)}</ol>'


def _content() -> dict[str, Any]:
    return tomllib.loads((files("experiments.claims") / "answers.toml").read_text("utf-8"))
