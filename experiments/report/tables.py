"""Table 1 of the thesis, as printed beside as measured."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pandas as pd
from rich.console import Console
from rich.table import Table
from rich.text import Text

from experiments.claims.growth import MEMORY, TABLES, VARIABLES
from experiments.claims.judged import OUTCOMES, judged, save
from experiments.runs.results import CannotWriteError, Run, load
from experiments.runs.steadiness import noise
from hem.complexity.judge import Verdict
from structures import NAMED, THESIS

STYLES = {
    "consistent": "green",
    "violated": "bold red",
    "undetermined": "yellow",
    "no claim": "dim",
}


def show(run_folder: Path, console: Console, every: bool = False) -> None:
    """Judge a run, keep the verdicts beside it, and print them: of the thesis' four, or of all."""
    run = load(run_folder)
    table = judged(run)
    with suppress(CannotWriteError):  # who may not write beside the run may read it all the same
        save(run, table)
    for name, title in TABLES.items():
        part = table[table["table"] == name]
        part = part if every else part[part["structure"].isin(THESIS)]
        if part.empty:
            continue
        console.print(_rendered(part, title, run))
        console.print(_summary(part))
    seen = noise(run)
    if seen.too_busy:
        console.print(f"[yellow]{seen.words}[/]", highlight=False)
    console.print(
        "Under what is printed: the log-log slopes in n_t and in n_ev, by work (array elements "
        "accessed) and by time. The work decides.\n✓ consistent, ✗ violated, ? undetermined, – "
        "nothing claimed: beside it the class that was found; an edge that is not recorded is "
        "named by its two vertices.",
        style="dim",
    )


def markdown(run: Run, which: str = "queries") -> str:
    """A table for a page: what is printed, the mark, and what was found."""
    table = judged(run).query("table == @which")
    heads = [NAMED[name].title for name in _structures(table)]
    lines = ["| | " + " | ".join(heads) + " |", "|---" * (len(heads) + 1) + "|"]
    for title, rows in by_title(table):
        cells = [_markdown_cell(row) for row in rows]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def found(row: dict[str, Any]) -> str:
    """What was measured in a cell, in the table's own terms, such as ``O(n_ev)``."""
    if row["subject"] == MEMORY:
        return f"{row['bytes_per_vertex']:,.4g}"
    by_size = row["table"] == "listings"
    moved = {"faces": VARIABLES["faces"]} if by_size else VARIABLES
    factors = [_factor(row[f"work_{variable}"], symbol) for variable, symbol in moved.items()]
    if None in factors:
        return "?"
    joint = " + " if not by_size and _mostly_fixed(row["work_valence"]) else " · "
    return f"O({joint.join(it for it in factors if it) or '1'})"


def slopes(row: dict[str, Any], measure: str) -> str:
    """The slopes in n_t and n_ev by one measure, such as ``1.00 0.00``."""
    verdicts = [row[f"{measure}_{variable}"] for variable in VARIABLES]
    return " ".join(f"{round(it.slope, 2) + 0:.2f}" if it else "   –" for it in verdicts)


def _mostly_fixed(verdict: Verdict) -> bool:
    """Whether what grows with n_ev comes on top of a larger part that does not."""
    return verdict.slope < 0.5


def _factor(verdict: Verdict | None, symbol: str) -> str | None:
    if verdict is None:
        return None
    return "" if verdict.best == "O(1)" else verdict.best[2:-1].replace("n", symbol)


def by_title(table: pd.DataFrame) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """The rows of the table as it is printed: a title and a record per structure."""
    for title, rows in table.groupby("title", sort=False):
        records = rows.to_dict("records")
        yield str(title), [{str(key): value for key, value in row.items()} for row in records]


def _structures(table: pd.DataFrame) -> list[str]:
    return list(table["structure"].unique())


def _rendered(table: pd.DataFrame, what: str, run: Run) -> Table:
    meta = run.meta
    title = f"{what}, printed and measured · {run.folder.name} · preset {meta.get('preset')}"
    rendered = Table(title=title, show_lines=True, pad_edge=False)
    rendered.add_column("", style="bold")
    for name in _structures(table):
        rendered.add_column(NAMED[name].abbreviation)
    for heading, rows in by_title(table):
        rendered.add_row(heading, *(_cell(row) for row in rows))
    return rendered


def _cell(row: dict[str, Any]) -> Text:
    mark = OUTCOMES[row["outcome"]]
    text = Text(f"{row['printed']} {mark}", style=STYLES[row["outcome"]])
    if row["outcome"] != "consistent":
        text.append(f" {found(row)}", style="default")
    if row["subject"] == MEMORY:
        return text
    for measure in ("work", "time"):
        outcome = row[f"outcome_{measure}"]
        text.append(
            f"\n{measure} {slopes(row, measure)} {OUTCOMES[outcome]}", style=STYLES[outcome]
        )
    return text


def _markdown_cell(row: dict[str, Any]) -> str:
    mark = OUTCOMES[row["outcome"]]
    if mark == "✓":
        return f"{row['printed']} {mark}"
    return f"{row['printed']}{' ' + mark if mark != '–' else ''}, found {found(row)}"


def _summary(table: pd.DataFrame) -> Text:
    text = Text()
    for measure in ("work", "time"):
        counts = table[f"outcome_{measure}"].value_counts()
        parts = [f"{counts.get(outcome, 0)} {outcome}" for outcome in OUTCOMES]
        text.append(f"by {measure}: {', '.join(parts)}\n")
    memory = table[table["subject"] == MEMORY]["outcome"].value_counts()
    if memory.empty:
        return text
    text.append("by bytes: " + ", ".join(f"{count} {outcome}" for outcome, count in memory.items()))
    return text
