"""The tables of claims for a terminal, in 80 columns, and as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from experiments.claims import Between, JudgedClaim, Outcome, judge_run
from experiments.harness import Axis
from experiments.report.pages import by_subject, two_digits, was_measured
from experiments.report.session import MissingError
from experiments.runs import load, noise, tables
from structures import NAMED, THESIS

COMPACT: Any = {"box": box.SIMPLE_HEAD, "pad_edge": False, "padding": (0, 1, 0, 0)}
ABREAST = 4
"""Structures in one table: more do not fit into 80 columns without cutting a figure."""

LEGEND = """Each cell: what is claimed, the verdict by work (memory accesses) and that by time.
✓ consistent, ✗ violated, ? undetermined, – nothing claimed. The work decides.
Where the claim is not confirmed, what was found stands beside it."""


def show_claims(
    run_folder: Path, console: Console, every: bool = False, slopes: bool = False
) -> None:
    """Print the claims of a run and their verdicts: of the thesis' four structures, or of all."""
    run = load(run_folder)
    claims = [it for it in judge_run(run) if it.claim.structure and was_measured(it)]
    claims = [it for it in claims if every or it.claim.structure in THESIS]
    if not claims:
        raise MissingError(f"{run_folder} holds no measurements of these structures: try --all")
    console.print(f"[bold]{run.folder.name}[/], preset {run.meta.get('preset')}", highlight=False)
    for name, table in tables().items():
        mine = [it for it in claims if it.claim.table == name]
        if mine:
            console.print()
            console.print(f"[bold]{table.title}[/]", highlight=False)
            for part in _slopes(mine) if slopes else _verdicts(mine, name):
                console.print(part)
            console.print(_summary(mine))
    seen = noise(run)
    if seen.too_busy:
        console.print(f"[yellow]{seen.words}[/]", highlight=False)
    console.print(LEGEND, style="dim", highlight=False)


def _verdicts(claims: Sequence[JudgedClaim], name: str) -> Iterable[Table]:
    columns, rows = by_subject(claims, name)
    for start in range(0, len(columns), ABREAST):
        shown = columns[start : start + ABREAST]
        table = Table(**COMPACT)
        table.add_column("", style="bold", no_wrap=True)
        for structure in shown:
            table.add_column(NAMED[structure].abbreviation, no_wrap=True)
        for title, row in rows.items():
            cells = [_cell(row[it]) if it in row else Text() for it in shown]
            if any(cells):
                table.add_row(title, *cells)
        yield table


def _cell(judged: JudgedClaim) -> Text:
    """What is claimed, the marks by work and by time, and what was found where it differs."""
    text = Text(judged.claim.printed)
    if judged.outcome is Outcome.NO_CLAIM:
        return Text(f"– {judged.found}", style=Outcome.NO_CLAIM.color)
    text.append(f" {judged.outcome.mark}", style=judged.outcome.color)
    if judged.verdicts:
        text.append(judged.outcome_time.mark, style=judged.outcome_time.color)
    if judged.outcome is not Outcome.CONSISTENT:
        text.append(f" {judged.found}")
    return text


def _slopes(claims: Sequence[JudgedClaim]) -> Iterable[Table]:
    """By structure a line per claim and axis: slope, interval, the class found, the verdict."""
    for structure in dict.fromkeys(judged.claim.structure for judged in claims):
        table = Table(title=NAMED[structure].title, title_justify="left", **COMPACT)
        for head in ("", "axis", "slope", "interval", "claimed", "found", ""):
            table.add_column(head, no_wrap=True, justify="right" if head == "slope" else "left")
        for judged in claims:
            if judged.claim.structure == structure:
                for axis in judged.verdicts:
                    table.add_row(judged.claim.title, *_slope(judged, axis))
        if table.row_count:
            yield table


def _slope(judged: JudgedClaim, axis: Axis) -> tuple[str | Text, ...]:
    verdict, claimed = judged.verdicts[axis], judged.claim.claims_something
    low, slope, high = map(two_digits, (verdict.slope_low, verdict.slope, verdict.slope_high))
    outcome = Outcome(verdict.outcome) if claimed else Outcome.NO_CLAIM
    mark = Text(outcome.mark, style=outcome.color)
    expected = verdict.expected if claimed else ""
    return f"{axis.measure} {axis.symbol}", slope, f"{low}…{high}", expected, verdict.best, mark


def _summary(claims: Sequence[JudgedClaim]) -> Text:
    grown = [it for it in claims if it.verdicts]
    counted = {
        "by work": Counter(it.outcome for it in grown),
        "by time": Counter(it.outcome_time for it in grown),
        "by bytes": Counter(it.outcome for it in claims if not it.verdicts),
    }
    lines = (
        f"{how}: " + ", ".join(f"{counts[it]} {it.value}" for it in Outcome if counts[it])
        for how, counts in counted.items()
        if counts
    )
    return Text("\n".join(lines))


def markdown(claims: Iterable[JudgedClaim], name: str) -> str:
    """A table for a page: what is claimed, the mark, and what was found."""
    columns, rows = by_subject(claims, name)
    lines = ["| | " + " | ".join(NAMED[it].title for it in columns) + " |"]
    lines.append("|---" * (len(columns) + 1) + "|")
    for title, row in rows.items():
        cells = [_markdown_cell(row[it]) if it in row else "" for it in columns]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _markdown_cell(judged: JudgedClaim) -> str:
    if judged.outcome is Outcome.CONSISTENT:
        return f"{judged.claim.printed} {judged.outcome.mark}"
    mark = "" if judged.outcome is Outcome.NO_CLAIM else f" {judged.outcome.mark}"
    return f"{judged.claim.printed}{mark}, found {judged.found}"


def sentences_markdown(claims: Iterable[JudgedClaim]) -> str:
    """The claims that are sentences, as a table for a page."""
    lines = ["| what is said | measured by | claimed | found | |", "|---|---|---|---|---|"]
    for it in claims:
        if isinstance(it.claim.expects, Between):
            found = (it.claim.expects.words, it.found, f"{it.outcome.mark} {it.outcome.value}")
            lines.append(f"| {it.claim.text} | {it.claim.expects.measured} | {' | '.join(found)} |")
    return "\n".join(lines)
