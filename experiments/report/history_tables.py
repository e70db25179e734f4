"""The history as tables for a terminal: runs in brief, a claim by run, or many at a glance.

A line per run, change or claim, and 80 columns wide: structures by their abbreviations, figures
to five digits, the last runs as bars.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import pandas as pd
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from experiments.claims import Outcome
from experiments.regression import MEASURES, OUTCOMES, Trends, is_of
from experiments.regression.history import Line
from structures import NAMED

FEW = 6
"""Claims that get a table each; more of them share one."""
BARS = "▁▂▃▄▅▆▇█"
WIDEST = 500
RECENT = 8
"""Runs that bars are drawn of."""
COLUMNS = ["run", "claim", "measure", "before", "after"]
SHORT = {title: title.replace("verdict by ", "by ") for title in OUTCOMES.values()}


def show(
    trends: Trends, claim: str | None, console: Console, last: int | None, slopes: bool
) -> None:
    """Print the history of some claims, or all in brief; ``last``: just so many runs."""
    names = trends.claims(claim)
    shown = range(len(trends.runs))[-(last or len(trends.runs)) :]
    changes = is_of(names, trends.changes)
    changes = changes[changes["run"].isin(shown)]
    if claim is None:
        tables = [_runs(trends, shown, changes), _changes(trends, changes)]
    elif len(names) <= FEW:
        tables = [_claim(trends, name, shown, changes, slopes) for name in names]
    else:
        tables = [_glance(trends, names, shown, changes)]
    for table in tables:
        if table.row_count:  # a figure that is cut is a wrong one
            wide = console.measure(table, options=console.options.update(max_width=WIDEST))
            console.print(table, width=max(console.width, wide.maximum), crop=False)
    console.print(_legend(trends, claim is None), style="dim", highlight=False)


def _table(title: str, *heads: str) -> Table:
    table = Table(
        title=title, title_justify="left", box=box.SIMPLE_HEAD, padding=(0, 1), pad_edge=False
    )
    for head in heads:
        table.add_column(head, no_wrap=True)
    return table


def _told_apart(trends: Trends) -> list[str]:
    """What of profile and machine is not the same in all runs."""
    facts = {"profile": "profile", "machine": "machine"}
    return [it for it in facts if len({_facts(run)[it] for run in trends.runs}) > 1]


def _facts(run: Line) -> dict[str, str]:
    return {"profile": run["profile"], "machine": run["machine"]["id"]}


def _head(trends: Trends, k: int) -> list[str]:
    run, facts = trends.runs[k], _facts(trends.runs[k])
    return [short_commit(run), *(facts[it] for it in _told_apart(trends))]


def short_commit(run: Line) -> str:
    """The commit of a run, with a star where there were changes besides."""
    return str(run["commit"][:7]) + ("*" if run.get("dirty") else "")


def short_claim(name: str) -> str:
    """A claim with its structure's abbreviation: ``HEM vertex_faces``."""
    table, structure, subject = name.split("/")
    short = NAMED[structure].abbreviation if structure in NAMED else structure
    return f"{short} {subject}" + (" (listing)" if table == "listings" else "")


def count_outcomes(run: Line, key: str) -> str:
    """How many claims of a run have each outcome, such as ``85✓ 3✗``."""
    counts = Counter(claim[key] for claim in run["claims"].values() if key in claim)
    shown = (Outcome.CONSISTENT, Outcome.VIOLATED, Outcome.UNDETERMINED)
    return " ".join(f"{counts[it]}{it.mark}" for it in shown if counts[it])


def _runs(trends: Trends, shown: Sequence[int], changes: pd.DataFrame) -> Table:
    heads = "commit", *_told_apart(trends), "measured", "by work", "by time", "changed"
    table = _table(f"{len(trends.runs)} runs in {trends.history.path}", *heads)
    for k in shown:
        mine = changes[changes["run"] == k]
        verdicts = [int((mine["measure"] == what).sum()) for what in OUTCOMES.values()]
        changed = [*verdicts, int((~mine["verdict"].astype(bool)).sum())]
        text = Text("/".join(map(str, changed)) if any(changed) else "")
        text.stylize("bold yellow" if verdicts[0] else "")
        outcomes = (count_outcomes(trends.runs[k], key) for key in OUTCOMES)
        measured = trends.runs[k]["started"][:10]
        table.add_row(*_head(trends, k), measured, *outcomes, text)
    return table


def _changes(trends: Trends, changes: pd.DataFrame) -> Table:
    table = _table("What changed", "at", "claim", "figure", "before → after")
    rows = changes[changes["measure"] != OUTCOMES["outcome_time"]]
    for at, claim, what, before, after in rows[COLUMNS].itertuples(index=False, name=None):
        text = Text.assemble(_mark(before), " → ", _mark(after))
        table.add_row(
            short_commit(trends.runs[at]), short_claim(claim), SHORT.get(what, what), text
        )
    return table


def _claim(
    trends: Trends, name: str, shown: Sequence[int], changes: pd.DataFrame, slopes: bool
) -> Table:
    """A row per run, a column per figure, and below how it went."""
    figures = is_of([name], trends.figures)
    measures = [it for it in figures["measure"].unique() if MEASURES[it].slope == slopes]
    table = _table(name, "commit", *_told_apart(trends), "verdict")
    table.show_footer = True
    for measure in measures:
        bars = _bars(figures[figures["measure"] == measure], shown)
        table.add_column(MEASURES[measure].title, footer=bars, justify="right", no_wrap=True)
    changed = set(changes[changes["claim"] == name][["run", "measure"]].itertuples(index=False))
    for k in shown:
        claim = trends.runs[k]["claims"].get(name)
        if claim is not None:
            rows = figures[figures["run"] == k].set_index("measure")
            cells = [_figure(it, rows.loc[it] if it in rows.index else None) for it in measures]
            verdict = _verdict(claim, {what for run, what in changed if run == k})
            table.add_row(*_head(trends, k), verdict, *cells)
    return table


def _mark(outcome: str) -> Text:
    """A verdict's mark in its color, or any other text as it is."""
    if outcome not in set(Outcome):
        return Text(outcome)
    return Text(Outcome(outcome).mark, style=Outcome(outcome).color)


def _verdict(claim: dict[str, Any], changed: set[str]) -> Text:
    text = Text()
    for key, what in OUTCOMES.items():
        if key in claim:
            text.append_text(_mark(claim[key])).append("≠ " if what in changed else "  ")
    return text


def _figure(name: str, row: Any) -> Text:
    """A figure, a slope with its interval, gray where not comparable, marked where it steps."""
    if row is None:
        return Text("–", style="dim")
    measure = MEASURES[name]
    text = Text(_slope(row.value) if measure.slope else f"{row.value:,.5g}")
    if measure.slope and not measure.exact:
        text.append(f" [{_slope(row.low)}, {_slope(row.high)}]", style="dim")
    if not row.comparable:
        text.stylize("dim")
    if pd.notna(row.before):
        ratio = measure.slope or not row.before
        step = f"{row.after - row.before:+.2f}" if ratio else f"{row.after / row.before - 1:+.1%}"
        text.append(f" {'▲' if row.after > row.before else '▼'}{step}", style="bold yellow")
    return text


def _slope(value: float) -> str:
    return f"{round(value, 2) + 0:.2f}"


def _glance(trends: Trends, names: list[str], shown: Sequence[int], changes: pd.DataFrame) -> Table:
    """A row per claim: how its figures went, where they are now, and when they changed last."""
    heads = "claim", "verdict", "work or bytes", "time", "changed"
    table = _table(f"{len(names)} claims in {trends.history.path}", *heads)
    figures = dict(list(is_of(names, trends.figures).groupby(["claim", "measure"])))
    changes = changes[changes["measure"] != OUTCOMES["outcome_time"]]
    for name in names:
        work = figures.get((name, "bytes"), figures.get((name, "work")))
        cells = [_course(rows, shown) for rows in (work, figures.get((name, "time")))]
        at = list(dict.fromkeys(changes[changes["claim"] == name]["run"]))
        changed = short_commit(trends.runs[at[-1]]) if at else ""
        newest = next(it["claims"][name] for it in reversed(trends.runs) if name in it["claims"])
        table.add_row(short_claim(name), _verdict(newest, set()), *cells, changed)
    return table


def _course(rows: pd.DataFrame | None, shown: Sequence[int]) -> Text:
    if rows is None:
        return Text("–", style="dim")
    return Text(f"{_bars(rows, shown)} {rows['value'].iloc[-1]:,.5g}")


def _bars(rows: pd.DataFrame, shown: Sequence[int]) -> str:
    """The newest series of a figure as bars, the last runs of it."""
    newest = rows.iloc[-1]
    same = rows["comparable"] & (rows["profile"] == newest["profile"])
    values = dict(rows[same & (rows["machine"] == newest["machine"])][["run", "value"]].to_numpy())
    return sparkline([values.get(k) for k in list(shown)[-RECENT:]])


def sparkline(values: Sequence[float | None]) -> str:
    """A bar per value between the lowest and the highest; a gap where there is none.

    Values within 2 % of each other are drawn level, as they are.
    """
    there = [value for value in values if value is not None]
    if not there:
        return ""
    low, high = min(there), max(there)
    flat = high - low <= 0.02 * max(abs(low), abs(high), 1e-9)
    span, top = (high - low) or 1.0, len(BARS) - 1
    return "".join(
        " " if value is None else BARS[3] if flat else BARS[round(top * (value - low) / span)]
        for value in values
    )


def _legend(trends: Trends, brief: bool) -> str:
    marks = "✓ consistent, ✗ violated, ? undetermined; by work, which decides, and by time."
    changed = "Changed: verdicts by work/by time/figures." if brief else (
        "≠ not the verdict before, ▲▼ a step to a new level. Slopes and intervals: --slopes."
    )  # fmt: skip
    lines = [f"{marks} {changed} * with changes that were not committed."]
    lines.append("Work: elements accessed; bytes: per vertex; time: in memory accesses.")
    machines = {run["machine"]["id"]: run["machine"] for run in trends.runs}
    told = (f"{key}: {it.get('cores')} cores of {it.get('cpu')}" for key, it in machines.items())
    lines.append(f"Machine {'; '.join(told)}.")
    if len(machines) > 1:
        lines.append(
            "Work, bytes and verdicts by work are compared between the machines, times are not; "
            "--machine shows one."
        )
    if "profile" in _told_apart(trends):
        lines.append("Runs of different presets are not compared; --preset shows one.")
    return "\n".join(lines)


def as_json(trends: Trends, claim: str | None, last: int | None) -> dict[str, Any]:
    """Everything that is shown; ``at`` and ``run`` are indices into ``runs``."""
    names, count = trends.claims(claim), len(trends.runs)
    first = count - min(last or count, count)
    figures = is_of(names, trends.figures)
    keys = ["claim", "measure", "profile", "machine"]
    changes = is_of(names, trends.changes).rename(columns={"measure": "what"})
    return {
        "file": str(trends.history.path),
        "faults": trends.history.faults,
        "runs": [
            {key: value for key, value in run.items() if key != "claims"} | {"index": k}
            for k, run in enumerate(trends.runs)
        ],
        "series": [
            {**dict(zip(keys, (*key[:-1], key[-1] or None), strict=True)), **_series(part)}
            for key, part in figures[figures["comparable"]].groupby(keys, sort=False)
        ],
        "changes": [
            {**row, "commit": trends.runs[row["run"]]["commit"]}
            for row in changes[changes["run"] >= first].to_dict("records")
        ],
    }


def _series(part: pd.DataFrame) -> dict[str, Any]:
    steps = part.reset_index(drop=True)
    steps = steps[steps["before"].notna()][["before", "after"]].reset_index()
    return {
        "at": part["run"].tolist(),
        "values": part["value"].tolist(),
        "steps": steps.to_dict("records"),
    }
