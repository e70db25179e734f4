"""The tables of the report as HTML."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from html import escape
from typing import Any

import pandas as pd

from experiments.claims.errata import Erratum
from experiments.claims.growth import MEMORY, NO_CLAIM, VARIABLES
from experiments.claims.judged import OUTCOMES
from experiments.claims.sentences import Statement, bounds, span
from experiments.report.entries import key_of
from experiments.report.tables import by_title, found
from hem.complexity.judge import Verdict
from structures import NAMED


def verdicts(table: pd.DataFrame) -> str:
    """The verdicts at a glance: what is printed, and whether it holds; each leads to its claim."""
    return _table(table, _linked, "glance")


def evidence(table: pd.DataFrame) -> str:
    """Every cell with its slopes and their intervals by work and by time, and what it costs."""
    return _table(table, _behind)


def statements(every: Iterable[Statement]) -> str:
    """What the thesis says in sentences, what was measured of it, and the verdict."""
    rows = "".join(
        f'<tr class="{it.outcome}"><td>{escape(it.says)}<small>{escape(it.source)}</small></td>'
        f"<td>{escape(it.measured)}<small>claimed: {escape(bounds(it))}</small></td>"
        f"<td>{escape(span(it))}</td><td><b>{OUTCOMES[it.outcome]} {it.outcome}</b></td></tr>"
        for it in every
    )
    heads = "".join(f"<th>{it}</th>" for it in ("The thesis", "measured by", "found", "verdict"))
    inner = f"<thead><tr>{heads}</tr></thead><tbody>{rows}</tbody>"
    return f'<div class="wide"><table>{inner}</table></div>'


def errata(every: Iterable[Erratum]) -> str:
    """What is printed, what it does, and what a run of it gave beside one of the sound version."""
    rows = []
    for number, it in enumerate(every, start=1):
        shown = it.show()
        outcome, mark = (
            ("consistent", "✓ shown") if shown.confirmed else ("violated", "✗ not shown")
        )
        rows.append(
            f'<tr class="{outcome}"><td>{number}</td>'
            f"<td><b>{escape(it.title)}</b><small>{escape(it.source)}</small></td>"
            f"<td>{escape(it.says)}<small>{escape(it.does)}</small></td>"
            f"<td>{escape(shown.printed)}</td><td>{escape(shown.sound)}</td><td>{mark}</td></tr>"
        )
    titles = ("", "erratum", "what is printed, and what it does", "as printed", "mended", "")
    heads = "".join(f"<th>{it}</th>" for it in titles)
    inner = f"<thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody>"
    return f'<div class="wide"><table>{inner}</table></div>'


def _table(table: pd.DataFrame, cell: Callable[[dict[str, Any]], str], css: str = "") -> str:
    heads = "".join(f"<th>{escape(NAMED[s].title)}</th>" for s in table["structure"].unique())
    rows = [
        f"<tr><th>{escape(title)}</th>"
        + "".join(
            f'<td class="{row["outcome"].replace(" ", "-")}">{cell(row)}</td>' for row in rows
        )
        + "</tr>"
        for title, rows in by_title(table)
    ]
    body = "\n".join(rows)
    head = f"<thead><tr><th></th>{heads}</tr></thead>"
    return (
        f'<div class="wide" tabindex="0"><table class="{css}">{head}\n'
        f"<tbody>{body}</tbody></table></div>"
    )


def _linked(row: dict[str, Any]) -> str:
    key = key_of(row["table"], row["structure"], row["subject"])
    return f'<a href="#{key}">{_glance(row)}</a>'


def _glance(row: dict[str, Any]) -> str:
    outcome = row["outcome"]
    mark = f"<b>{OUTCOMES[outcome]} {escape(row['printed'])}</b>"
    if row["subject"] == MEMORY:
        return f"{mark}<small>{outcome}: {found(row)} measured</small>"
    if row["printed"] == NO_CLAIM:
        return f"{mark}<small>nothing claimed, found {escape(found(row))}</small>"
    return f"{mark}<small>work: {row['outcome_work']}<br>time: {row['outcome_time']}</small>"


def _behind(row: dict[str, Any]) -> str:
    if row["subject"] == MEMORY:
        return _glance(row)
    head = f"<b>{OUTCOMES[row['outcome']]} {escape(row['printed'])}</b>"
    if row["printed"] == NO_CLAIM:
        head += f"<small>found {escape(found(row))}</small>"
    rows = [
        _line(f"{measure} {symbol}", row[f"{measure}_{variable}"], bool(row["printed"] != NO_CLAIM))
        for measure in ("work", "time", "random")
        for variable, symbol in VARIABLES.items()
        if row.get(f"{measure}_{variable}") or (measure != "random" and row.get("work_faces"))
    ]
    at_random = " at random" if row["table"] == "queries" else ""
    cost = f"{row['work_per_query']:,.0f} accesses, {_time(row['seconds_per_query'])}{at_random}"
    return f"{head}<div class=grid>{''.join(rows)}</div><small>{cost}</small>"


def _line(name: str, verdict: Verdict | None, claimed: bool) -> str:
    """Name, slope, its interval, the class found and the mark, as a line of the cell's grid."""
    if verdict is None:
        return f"<i>{name}</i><i>–</i><i></i><i></i>"
    slope, low, high = (
        f"{round(it, 2) + 0:.2f}" for it in (verdict.slope, verdict.slope_low, verdict.slope_high)
    )
    mark = f" {OUTCOMES[verdict.outcome]}" if claimed else ""
    return f"<i>{name}</i><i>{slope}</i><i>{low}…{high}</i><i>{escape(verdict.best)}{mark}</i>"


def _time(seconds: float) -> str:
    return f"{seconds * 1e9:,.1f} ns" if seconds < 1e-6 else f"{seconds * 1e6:,.1f} µs"
