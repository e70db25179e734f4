"""The tables of the report as HTML, and the page around them."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Any

import pandas as pd

from experiments.claims import MEMORY, NO_CLAIM, VARIABLES
from experiments.complexity import Verdict
from experiments.errata import Erratum
from experiments.statements import Statement, bounds, span
from experiments.table import by_title, found
from experiments.verdicts import OUTCOMES
from structures import NAMED

CSS = """
:root { --ink: #1b1b1b; --soft: #667; --line: #e3e3e8; }
body { font: 16px/1.55 system-ui, "Segoe UI", "Liberation Sans", Arial, sans-serif;
  color: var(--ink); margin: 0 auto; padding: 2rem 1.2rem 4rem; max-width: 1160px; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: .6rem 0 .4rem; }
h2 { font-size: 1.2rem; margin-top: 2.2rem; }
a { color: #1f5f99; } nav { font-size: .92rem; } nav a { margin-right: 1.1rem; }
p, li { max-width: 74ch; } .soft { color: var(--soft); font-size: .9rem; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: .42rem .45rem; font-size: .88rem;
  border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid #999; } tbody th { font-weight: 600; max-width: 7.5rem; }
td b { font-size: .95rem; }
td small { display: block; color: #556; font-size: .78rem; line-height: 1.4; }
.grid { display: grid; grid-template-columns: repeat(4, auto); column-gap: .4rem;
  width: max-content; margin: .15rem 0; }
.grid i { font-style: normal; font-size: .69rem; line-height: 1.45; color: #445;
  white-space: nowrap; }
.consistent b { color: #17693a; } .violated { background: #fdeceb; }
.violated b { color: #a3170f; } .undetermined b { color: #8a5a00; }
.no-claim b { color: var(--soft); }
.numbers td:not(:first-child), .numbers th:not(:first-child) { text-align: right; }
.wide { overflow-x: auto; } img { max-width: 100%; height: auto; }
pre { white-space: pre-wrap; font-size: .8rem; } .anchor-link { display: none; }
"""


def page(title: str, body: str, links: dict[str, str]) -> str:
    """A page that opens from disk: everything it needs is in it."""
    nav = "".join(f'<a href="{escape(to)}">{escape(name)}</a>' for name, to in links.items())
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f"<title>{escape(title)}</title>"
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{CSS}</style></head>\n<body><nav>{nav}</nav>\n{body}\n</body></html>\n"
    )


def verdicts(table: pd.DataFrame) -> str:
    """The verdicts at a glance: what is printed, and whether it holds."""
    return _table(table, _glance)


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


def _table(table: pd.DataFrame, cell: Any) -> str:
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
    return f'<div class="wide"><table>{head}\n<tbody>{body}</tbody></table></div>'


def _glance(row: dict[str, Any]) -> str:
    outcome = row["outcome"]
    mark = f"<b>{OUTCOMES[outcome]} {escape(row['printed'])}</b>"
    if row["query"] == MEMORY:
        return f"{mark}<small>{outcome}: {found(row)} measured</small>"
    if row["printed"] == NO_CLAIM:
        return f"{mark}<small>nothing claimed, found {escape(found(row))}</small>"
    return f"{mark}<small>work: {row['outcome_work']}<br>time: {row['outcome_time']}</small>"


def _behind(row: dict[str, Any]) -> str:
    if row["query"] == MEMORY:
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
