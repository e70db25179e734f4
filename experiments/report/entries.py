"""Every claim of the report in one list: cells of the tables and sentences, with their evidence."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from experiments.claims import sentences
from experiments.claims.growth import MEMORY, NO_CLAIM, TABLES, VARIABLES, Claim, load_claims
from experiments.claims.judged import OUTCOMES, Evidence
from experiments.claims.sentences import Statement
from experiments.report import claim_figures
from experiments.report.tables import found
from experiments.runs.results import Run
from hem.complexity.judge import Verdict
from structures import NAMED

SENTENCES = "sentences"
KINDS = {**TABLES, SENTENCES: "In sentences"}
"""The tables of the report, and the sentences."""

FOLDER = "claims"
"""The folder beside the pages that holds the plots and the data of the claims."""


@dataclass(frozen=True)
class Plot:
    """A plot of a claim: its file's name, what stands above it and below it, and the drawing."""

    name: str
    title: str
    caption: str
    drawing: str


@dataclass(frozen=True)
class Entry:
    """One claim, its verdict and what the verdict rests on.

    ``key`` is what a link names, such as ``half_edge/vertex_faces``. ``structure`` is empty for a
    sentence. ``claimed`` and ``found`` are short; ``words`` is the claim in a whole sentence.
    ``verdicts``: by measure and variable, of cells that grow.
    """

    key: str
    kind: str
    structure: str
    title: str
    claimed: str
    found: str
    outcome: str
    outcome_time: str
    words: str
    source: str
    chapter: str
    data: str
    plots: list[Plot] = field(default_factory=list)
    verdicts: dict[tuple[str, str], Verdict] = field(default_factory=dict)

    @property
    def file(self) -> str:
        """How the names of its files begin."""
        return self.key.replace("/", ".")

    @property
    def structure_title(self) -> str:
        """The structure's name in words."""
        return str(NAMED[self.structure].title) if self.structure else ""


def entries(run: Run, table: pd.DataFrame) -> list[Entry]:
    """All claims, in the order of their tables."""
    return [*_cells(run, table), *(_sentence(it) for it in sentences.judged(run))]


def key_of(table: str, structure: str, what: str) -> str:
    """What a link to a cell of a table names; the listings have operations of the same names."""
    return f"{structure}/{what}" + ("/listing" if table == "listings" else "")


CHAPTER = {"queries": "query_scaling", "operations": "operations", "listings": "errata"}
"""The chapter about the claims of a table."""


def _cells(run: Run, table: pd.DataFrame) -> Iterator[Entry]:
    evidence = Evidence(run)
    claims = {key_of(it.table, it.structure, it.subject): it for it in load_claims()}
    for record in table.to_dict("records"):
        row = {str(name): value for name, value in record.items()}
        key = key_of(row["table"], row["structure"], row["subject"])
        yield (_bytes if row["subject"] == MEMORY else _cell)(evidence, claims[key], row, key)


def _cell(evidence: Evidence, claim: Claim, row: dict[str, Any], key: str) -> Entry:
    claimed = claim.printed != NO_CLAIM
    panels = list(claim_figures.panels(evidence, claim, row))
    plots = [
        Plot(it.name, it.title, caption(it.verdict, claimed), drawing)
        for it in panels
        for drawing in [claim_figures.growth(it, claim.structure, claimed)]
    ]
    return Entry(
        **_head(claim, row, key),
        found=found(row),
        outcome_time=row["outcome_time"],
        chapter=CHAPTER[claim.table],
        data=claim_figures.table(panels),
        plots=plots,
        verdicts={(it.measure, it.variable): it.verdict for it in panels},
    )


def _bytes(evidence: Evidence, claim: Claim, row: dict[str, Any], key: str) -> Entry:
    cells, printed = evidence.memory(claim.structure, 8), claim.bytes_per_vertex
    caption = f"{found(row)} measured, {printed or 'nothing'} claimed"
    drawn = [] if cells.empty else [claim_figures.memory(cells, claim.structure, printed)]
    return Entry(
        **_head(claim, row, key),
        found=found(row).replace("nan", "?"),
        outcome_time="",
        chapter="memory",
        data=claim_figures.bytes_table(cells),
        plots=[Plot("bytes", "bytes per vertex", caption, it) for it in drawn],
    )


def _head(claim: Claim, row: dict[str, Any], key: str) -> dict[str, Any]:
    return {
        "key": key,
        "kind": claim.table,
        "structure": claim.structure,
        "title": claim.title,
        "claimed": claim.printed,
        "outcome": row["outcome"],
        "words": _words(claim),
        "source": claim.source,
    }


def _words(claim: Claim) -> str:
    """The claim as a sentence."""
    name, what = NAMED[claim.structure].title, claim.title
    if claim.printed == NO_CLAIM:
        return f"Of {what} on {name}, nothing is claimed. What was found stands here all the same."
    if claim.subject == MEMORY:
        return f"{name} takes {claim.printed} bytes per vertex, with references of 8 bytes."
    grown = [
        f"{_how(it)} {VARIABLES[variable]}" for variable, it in claim.expected.items()
    ]  # fmt: skip
    return f"{what} on {name} costs {claim.printed}: {' and '.join(grown)}."


def _how(growth: str) -> str:
    """How a cost of a class moves with its variable."""
    words = {
        "O(1)": "the same at every",
        "O(n)": "in proportion to",
        "≤ O(n)": "at most in proportion to",
        "O(n²)": "with the square of",
    }
    return words.get(growth, f"as {growth} in")


def caption(verdict: Verdict, claimed: bool) -> str:
    """Slope, interval, what is claimed and what was found."""
    slope, low, high = (
        f"{round(it, 2) + 0:.2f}" for it in (verdict.slope, verdict.slope_low, verdict.slope_high)
    )
    most = "at most " if verdict.bound == "upper" else ""
    told = f"claimed {most}{verdict.expected}, " if claimed else ""
    mark = f" {OUTCOMES[verdict.outcome]}" if claimed else ""
    return f"slope {slope} ({low} … {high}) · {told}found {verdict.best}{mark}"


def _sentence(it: Statement) -> Entry:
    spread = sentences.span(it)
    drawn = [claim_figures.quantity(it)] if len(it.values) else []
    return Entry(
        key=f"sentence/{it.quantity}",
        kind=SENTENCES,
        structure="",
        title=it.says,
        claimed=sentences.bounds(it),
        found=spread,
        outcome=it.outcome,
        outcome_time="",
        words=f"Measured: {it.measured}.",
        source=it.source,
        chapter="half_edge_or_indexed",
        data=claim_figures.values_table(it),
        plots=[Plot("values", "what was found", f"found {spread}", drawing) for drawing in drawn],
    )
